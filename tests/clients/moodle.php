<?php
// What the tests ask of a real Moodle, on the command line: a verb, JSON on standard input, JSON on standard output.
// The environment variable COURSEWORK_MOODLE names the folder of its code.
//
//   import  {"course", "file"}                          what an instructor does on the page "Import"
//   answer  {"lang", "attempts": [{"id", "data"}]}      attempts of questions by the question engine: points of each box
//   quiz    {"course", "name", "slots": [{"category", "mark"}], "students": [{...}], "attempts": [...]}
//   finish  {"attempts": [{"attempt", "answers": {slot: {place: answer}}}]}    answers given, attempt submitted
//   filter  {"name", "on"}                              a filter of texts is switched on or off for the whole site
//   reset   {"course"}                                  the course is deleted

define('CLI_SCRIPT', true);
ini_set('max_input_vars', 5000);
require(getenv('COURSEWORK_MOODLE') . '/config.php');
require_once($CFG->libdir . '/questionlib.php');
require_once($CFG->dirroot . '/course/lib.php');
require_once($CFG->dirroot . '/question/editlib.php');
require_once($CFG->dirroot . '/question/format/xml/format.php');

set_debugging(DEBUG_DEVELOPER, true);
\core\session\manager::set_user(get_admin());
$asked = json_decode(stream_get_contents(STDIN), true);
$verbs = ['import' => 'import', 'answer' => 'answer', 'quiz' => 'quiz', 'finish' => 'finish', 'reset' => 'forget',
    'filter' => 'filtering'];
echo json_encode($verbs[$argv[1]]($asked), JSON_UNESCAPED_UNICODE | JSON_PARTIAL_OUTPUT_ON_ERROR | JSON_THROW_ON_ERROR), "\n";

function course_of(string $name): stdClass {
    global $DB;
    return $DB->get_record('course', ['shortname' => $name])
        ?: create_course((object) ['shortname' => $name, 'fullname' => $name, 'category' => 1]);
}

function forget(array $asked): array {
    global $DB;
    $course = $DB->get_record('course', ['shortname' => $asked['course']]);
    return ['deleted' => $course ? delete_course($course, false) : false];
}

function filtering(array $asked): array {
    require_once($GLOBALS['CFG']->libdir . '/filterlib.php');
    filter_set_global_state($asked['name'], $asked['on'] ? TEXTFILTER_ON : TEXTFILTER_DISABLED);
    return ['on' => $asked['on']];
}

function import(array $asked): array {
    global $DB;
    force_current_language($asked['lang'] ?? 'en');
    $course = course_of($asked['course']);
    $context = context_course::instance($course->id);
    $contexts = new \core_question\local\bank\question_edit_contexts($context);
    $format = new qformat_xml();
    $format->setCategory(question_make_default_categories($contexts->all()));
    $format->setContexts($contexts->having_one_edit_tab_cap('import'));
    $format->setCourse($course);
    $format->setFilename($asked['file']);
    $format->setRealfilename(basename($asked['file']));
    $format->setMatchgrades('error');
    $format->setCatfromfile(true);
    $format->setContextfromfile(true);
    $format->setStoponerror(true);
    $format->set_display_progress(false);
    $start = microtime(true);
    ob_start();
    $done = $format->importpreprocess() && $format->importprocess() && $format->importpostprocess();
    $said = trim(strip_tags(ob_get_clean()));
    $questions = [];
    foreach ($format->questionids ?? [] as $id) {
        $bank = $DB->get_record_sql(
            'SELECT q.id, q.name, q.qtype, q.defaultmark, e.idnumber, c.name AS category, c.id AS categoryid
               FROM {question} q JOIN {question_versions} v ON v.questionid = q.id
               JOIN {question_bank_entries} e ON e.id = v.questionbankentryid
               JOIN {question_categories} c ON c.id = e.questioncategoryid WHERE q.id = ?', [$id]);
        $boxes = [];
        foreach (question_bank::load_question($id)->subquestions as $box) {
            $boxes[] = [
                'type' => $box->qtype->name(),
                'weight' => (float) $box->defaultmark,
                'answers' => array_map(fn($one) => [
                    'answer' => $one->answer, 'share' => (float) $one->fraction, 'says' => $one->feedback,
                    'margin' => $one->tolerance ?? null,
                ], array_values($box->answers)),
            ];
        }
        $questions[] = (array) $bank + ['boxes' => $boxes];
    }
    return ['done' => $done, 'said' => $said, 'seconds' => microtime(true) - $start, 'course' => (int) $course->id,
        'questions' => $questions];
}

// Boxes of an attempt are told by their place, from 1: a text, the place of an option, or the places of several.
function posted(question_definition $question, array $answers): array {
    $data = [];
    foreach ($answers as $place => $answer) {
        $box = $question->subquestions[$place];
        if ($box->qtype->name() !== 'multichoice') {
            $data["sub{$place}_answer"] = (string) $answer;
        } else if (is_array($answer)) {
            foreach (array_keys(array_values($box->answers)) as $k) {
                $data["sub{$place}_choice{$k}"] = in_array($k, $answer) ? '1' : '0';
            }
        } else {
            $data["sub{$place}_answer"] = (string) $answer;
        }
    }
    return $data;
}

function answer(array $asked): array {
    force_current_language($asked['lang']);
    $marked = [];
    foreach ($asked['attempts'] as $attempt) {
        $question = question_bank::load_question($attempt['id']);
        $usage = question_engine::make_questions_usage_by_activity('core_question_preview', context_system::instance());
        $usage->set_preferred_behaviour('deferredfeedback');
        $slot = $usage->add_question($question, $question->defaultmark);
        $usage->start_question($slot);
        $step = $usage->get_question_attempt($slot)->get_step(0);
        $data = posted($question, $attempt['data'] === 'right' ? [] : $attempt['data']);
        if ($attempt['data'] === 'right') {
            $data = $question->get_correct_response();
        }
        $usage->process_action($slot, $data);
        $usage->finish_question($slot);
        $qa = $usage->get_question_attempt($slot);
        $shares = [];
        foreach ($question->subquestions as $i => $box) {
            $part = (new question_attempt_step_subquestion_adapter($step, "sub{$i}_"))->filter_array($data);
            $shares[$i] = $box->is_gradable_response($part) ? (float) $box->grade_response($part)[0] : null;
        }
        $marked[] = ['fraction' => $qa->get_fraction(), 'state' => (string) $qa->get_state(), 'shares' => $shares,
            'response' => $qa->get_response_summary()];
    }
    return $marked;
}

function quiz(array $asked): array {
    global $CFG, $DB;
    require_once($CFG->libdir . '/testing/generator/lib.php');
    require_once($CFG->dirroot . '/mod/quiz/locallib.php');
    $generator = new testing_data_generator();
    $course = course_of($asked['course']);
    $quiz = $generator->get_plugin_generator('mod_quiz')->create_instance(
        ['course' => $course->id, 'name' => $asked['name'], 'questionsperpage' => 1, 'grade' => 10] + ($asked['options'] ?? []));
    $structure = \mod_quiz\quiz_settings::create($quiz->id)->get_structure();
    foreach ($asked['slots'] as $slot) {
        $structure->add_random_questions(0, 1, ['filter' => ['category' => [
            'jointype' => \core\output\datafilter::JOINTYPE_ANY, 'values' => [$slot['category']],
            'filteroptions' => ['includesubcategories' => false]]]]);
    }
    $structure = \mod_quiz\quiz_settings::create($quiz->id)->get_structure();
    foreach (array_values($structure->get_slots()) as $k => $slot) {
        $structure->update_slot_maxmark($slot, $asked['slots'][$k]['mark']);
    }
    \mod_quiz\quiz_settings::create($quiz->id)->get_grade_calculator()->recompute_quiz_sumgrades();
    $told = [];
    foreach ($asked['students'] as $student) {
        $user = $DB->get_record('user', ['username' => $student['username']])
            ?: $generator->create_user($student + ['password' => 'Student.123', 'lang' => $student['lang'] ?? 'en']);
        $generator->enrol_user($user->id, $course->id, 'student');
        $told[] = ['username' => $user->username] + (empty($student['browser']) ? attempted($quiz->id, $user, $asked) : []);
    }
    return ['course' => (int) $course->id, 'quiz' => (int) $quiz->id, 'cmid' => (int) $quiz->cmid, 'students' => $told];
}

// An attempt begun for a student; what it asks. It is answered by the verb "finish" once the test knows the answers.
function attempted(int $quizid, stdClass $user, array $asked): array {
    \core\session\manager::set_user($user);
    force_current_language($user->lang);
    $settings = \mod_quiz\quiz_settings::create($quizid, $user->id);
    $attempt = quiz_prepare_and_start_new_attempt($settings, 1, null, false, [], [], $user->id);
    $object = \mod_quiz\quiz_attempt::create($attempt->id);
    $posed = [];
    foreach ($object->get_slots() as $slot) {
        $posed[$slot] = $object->get_question_attempt($slot)->get_question()->name;
        $shown[$slot] = $object->get_question_attempt($slot)->get_question_summary();
    }
    \core\session\manager::set_user(get_admin());
    return ['attempt' => (int) $attempt->id, 'posed' => $posed, 'shown' => $shown];
}

function finish(array $asked): array {
    global $CFG, $DB;
    require_once($CFG->dirroot . '/mod/quiz/locallib.php');
    $told = [];
    foreach ($asked['attempts'] as $one) {
        $record = $DB->get_record('quiz_attempts', ['id' => $one['attempt']], '*', MUST_EXIST);
        \core\session\manager::set_user($DB->get_record('user', ['id' => $record->userid]));
        $usage = question_engine::load_questions_usage_by_activity($record->uniqueid);
        foreach ($one['answers'] as $slot => $answers) {
            $usage->process_action($slot, posted($usage->get_question($slot), $answers));
        }
        question_engine::save_questions_usage_by_activity($usage);
        \mod_quiz\quiz_attempt::create($record->id)->process_finish(time(), false);
        $told[] = (float) $DB->get_field('quiz_attempts', 'sumgrades', ['id' => $record->id]);
    }
    \core\session\manager::set_user(get_admin());
    return $told;
}
