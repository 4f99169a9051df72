<?php
// Questions of STACK in a Moodle, imported and proved: a line of JSON a question.
//
//   php stack_proves.php MOODLE FILE [ANSWERS]
//
// MOODLE is the folder of Moodle's code, FILE a file of its XML. Each question is imported into a course of its own, which is
// deleted again, and runs its own tests. ANSWERS is a JSON file, {question's name: [{"ans1": "typed", …}, …]}: each is typed
// into the question, and what becomes of it is told, tree by tree.
define('CLI_SCRIPT', true);
[, $moodle, $file, $typed] = array_pad($argv, 4, null);
require($moodle . '/config.php');
global $CFG, $DB;
require_once($CFG->dirroot . '/course/lib.php');
require_once($CFG->libdir . '/questionlib.php');
require_once($CFG->dirroot . '/question/format/xml/format.php');
require_once($CFG->dirroot . '/question/type/stack/locallib.php');
require_once($CFG->dirroot . '/question/type/stack/stack/questiontest.php');
\core\session\manager::set_user(get_admin());
error_reporting(E_ALL & ~E_DEPRECATED & ~E_WARNING & ~E_NOTICE);

function imported(string $file, $course): array {
    $context = context_course::instance($course->id);
    $format = new qformat_xml();
    $format->setContexts([$context]);
    $format->setCourse($course);
    $format->setFilename($file);
    $format->setRealfilename(basename($file));
    $format->setCatfromfile(true);
    $format->setContextfromfile(false);
    $format->setStoponerror(false);
    $format->setCategory(question_make_default_categories([$context]));
    ob_start(fn ($told) => '', 0);
    ob_start();
    $done = $format->importpreprocess() && $format->importprocess() && $format->importpostprocess();
    $said = trim(preg_replace('/\s+/', ' ', strip_tags(ob_get_clean())));
    ob_end_clean();
    return [$done, $said, $format->questionids];
}

function tests_of($question, $context): array {
    $told = [];
    foreach (question_bank::get_qtype('stack')->load_question_tests($question->id) as $number => $test) {
        $result = $test->test_question($question->id, 1, $context);
        $states = [];
        foreach ($result->get_prt_states() as $name => $state) {
            if (!$state->testoutcome) {
                $states[$name] = [
                    'score' => $state->score, 'expected' => $state->expectedscore,
                    'note' => $state->answernote, 'wanted' => $state->expectedanswernote,
                    'penalty' => $state->penalty, 'reason' => $state->reason,
                ];
            }
        }
        $told[] = ['test' => $number, 'passed' => $result->passed(), 'states' => $states];
    }
    return $told;
}

function judged($question, array $answers): array {
    $told = [];
    foreach ($answers as $one) {
        $question = question_bank::load_question($question->id);
        $step = new question_attempt_step();
        $question->start_attempt($step, 1);
        $response = [];
        foreach ($question->inputs as $name => $input) {
            $typed = $one[$name] ?? '';
            if (is_array($typed)) {
                foreach ($typed as $place) {
                    $response["{$name}_{$place}"] = (string) $place;
                }
            } else {
                $response[$name] = $typed;
            }
        }
        $made = ['inputs' => [], 'trees' => []];
        foreach ($question->inputs as $name => $input) {
            $state = $question->get_input_state($name, $response);
            $made['inputs'][$name] = [$state->status, trim(strip_tags((string) $state->errors))];
        }
        foreach ($question->prts as $name => $tree) {
            $state = $question->get_prt_result($name, $response, true);
            $made['trees'][$name] = [$state->get_score(), $state->get_answernotes(), strip_tags((string) $state->get_feedback())];
        }
        $made['summary'] = $question->summarise_response($response);
        $told[] = $made;
    }
    return $told;
}

$course = create_course((object) [
    'fullname' => 'Proof', 'shortname' => 'stack-proof-' . getmypid() . '-' . time(), 'category' => 1,
]);
try {
    [$done, $said, $ids] = imported($file, $course);
    echo json_encode(['imported' => $done, 'questions' => count($ids), 'said' => $done ? '' : $said]), "\n";
    $answers = $typed ? json_decode(file_get_contents($typed), true) : [];
    foreach ($ids as $id) {
        $started = microtime(true);
        try {
            $question = question_bank::load_question($id);
            $told = ['name' => $question->name, 'grade' => (float) $question->defaultmark];
            $told['errors'] = array_values(array_filter((array) ($question->runtimeerrors ?? [])));
            $told['tests'] = tests_of($question, context_course::instance($course->id));
            $told['judged'] = judged($question, $answers[$question->name] ?? []);
        } catch (Throwable $fault) {
            $told['errors'][] = get_class($fault) . ': ' . $fault->getMessage() . ' ' . $fault->getFile() . ':' . $fault->getLine();
        }
        $told['seconds'] = round(microtime(true) - $started, 2);
        echo json_encode($told, JSON_UNESCAPED_UNICODE | JSON_PARTIAL_OUTPUT_ON_ERROR), "\n";
    }
} catch (Throwable $fault) {
    fwrite(STDERR, get_class($fault) . ': ' . $fault->getMessage() . ' ' . ($fault->debuginfo ?? '') . "\n" . $fault->getTraceAsString() . "\n");
    exit(1);
} finally {
    ob_start();
    delete_course($course, false);
    ob_end_clean();
}
