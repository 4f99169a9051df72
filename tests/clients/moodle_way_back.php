<?php
// A course with a quiz, attempts at it, and marks taken in: what tests/clients/test_moodle_way_back.py asks of a Moodle.
// php moodle_way_back.php MOODLE set_up|answer|marks|import_csv|import_xml|forget FILE.json   (JSON in, JSON out)
define('CLI_SCRIPT', true);
$asked = json_decode(file_get_contents($argv[3]), true);
require($argv[1] . '/config.php');
require_once($CFG->libdir . '/testing/generator/lib.php');
require_once($CFG->libdir . '/gradelib.php');
require_once($CFG->libdir . '/csvlib.class.php');
require_once($CFG->dirroot . '/course/lib.php');
require_once($CFG->dirroot . '/user/lib.php');
require_once($CFG->dirroot . '/mod/quiz/locallib.php');
require_once($CFG->dirroot . '/question/format.php');
require_once($CFG->dirroot . '/question/format/xml/format.php');
require_once($CFG->dirroot . '/grade/lib.php');
require_once($CFG->dirroot . '/grade/import/lib.php');
require_once($CFG->dirroot . '/grade/import/xml/lib.php');

use mod_quiz\quiz_settings;
use mod_quiz\quiz_attempt;

\core\session\manager::set_user(get_admin());
$told = ('way_back_' . $argv[2])($asked);
echo "\n" . json_encode($told, JSON_UNESCAPED_UNICODE) . "\n";

function course_called($shortname) {
    global $DB;
    return $DB->get_record('course', ['shortname' => $shortname], '*', MUST_EXIST);
}

// {course, students: [{username, firstname, lastname, email, idnumber}], xml: file, grade, items: [{name, idnumber, max}]}
function way_back_set_up($asked) {
    global $DB, $CFG;
    $generator = new testing_data_generator();
    way_back_forget($asked);
    $course = $generator->create_course(['shortname' => $asked['course'], 'fullname' => $asked['fullname'] ?? 'Mechanisms']);
    foreach ($asked['students'] as $student) {
        $user = $DB->get_record('user', ['username' => $student['username'], 'deleted' => 0]);
        if (!$user) {
            $user = (object) ($student + ['confirmed' => 1, 'mnethostid' => $CFG->mnet_localhost_id, 'auth' => 'manual', 'password' => 'Student.123']);
            $user->id = user_create_user($user, true, false);
        }
        $generator->enrol_user($user->id, $course->id, 'student');
    }
    foreach ($asked['items'] as $item) {
        $made = new grade_item(['courseid' => $course->id, 'itemtype' => 'manual', 'itemname' => $item['name'],
            'idnumber' => $item['idnumber'], 'grademax' => $item['max'], 'grademin' => 0,
            'categoryid' => grade_category::fetch_course_category($course->id)->id]);
        $made->insert('test');
    }
    $quiz = $generator->create_module('quiz', ['course' => $course->id, 'name' => $asked['quiz'], 'grade' => $asked['grade'],
        'sumgrades' => 0, 'attempts' => 0, 'questionsperpage' => 0, 'preferredbehaviour' => 'deferredfeedback']);
    $context = context_module::instance($quiz->cmid);
    $category = question_get_default_category($context->id) ?: question_make_default_categories([$context]);
    $format = new qformat_xml();
    $format->setCategory($category);
    $format->setContexts([$context]);
    $format->setCourse($course);
    $format->setFilename($asked['xml']);
    $format->setRealfilename('questions.xml');
    $format->setMatchgrades('error');
    $format->setCatfromfile(0);
    $format->setContextfromfile(0);
    $format->setStoponerror(1);
    $format->set_display_progress(false);
    ob_start();
    $ok = $format->importpreprocess() && $format->importprocess();
    $said = trim(strip_tags(ob_get_clean()));
    $names = [];
    foreach ($format->questionids as $id) {
        quiz_add_quiz_question($id, $quiz);
        $names[] = $DB->get_field('question', 'name', ['id' => $id]);
    }
    quiz_settings::create($quiz->id)->get_grade_calculator()->recompute_quiz_sumgrades();
    return ['ok' => $ok, 'said' => $ok ? '' : $said, 'course' => $course->id, 'quiz' => $quiz->id, 'cmid' => $quiz->cmid, 'questions' => $names];
}

// {course, attempts: [{username, finish, answers: {slot: {field: text}}}]}
function way_back_answer($asked) {
    global $DB;
    $course = course_called($asked['course']);
    $quiz = $DB->get_record('quiz', ['course' => $course->id], '*', MUST_EXIST);
    $done = [];
    foreach ($asked['attempts'] as $one) {
        $user = $DB->get_record('user', ['username' => $one['username']], '*', MUST_EXIST);
        \core\session\manager::set_user($user);
        force_current_language($one['language'] ?? 'en');
        $settings = quiz_settings::create($quiz->id, $user->id);
        $quba = question_engine::make_questions_usage_by_activity('mod_quiz', $settings->get_context());
        $quba->set_preferred_behaviour('deferredfeedback');
        $number = $DB->count_records('quiz_attempts', ['quiz' => $quiz->id, 'userid' => $user->id]) + 1;
        $now = time();
        $attempt = quiz_create_attempt($settings, $number, false, $now, false, $user->id);
        quiz_start_new_attempt($settings, $quba, $attempt, $number, $now);
        quiz_attempt_save_started($settings, $quba, $attempt);
        $object = quiz_attempt::create($attempt->id);
        $answers = [];
        foreach ($one['answers'] as $slot => $fields) {
            $answers[(int) $slot] = $fields;
        }
        if ($answers) {
            $object->process_submitted_actions($now, false, $answers);
        }
        if ($one['finish']) {
            quiz_attempt::create($attempt->id)->process_finish($now + 4, false);
        }
        $done[] = $attempt->id;
    }
    force_current_language('en');
    \core\session\manager::set_user(get_admin());
    return $done;
}

// {course}: marks by item and username, as they stand in the gradebook
function way_back_marks($asked) {
    global $DB;
    $course = course_called($asked['course']);
    $found = [];
    foreach (grade_item::fetch_all(['courseid' => $course->id]) as $item) {
        foreach (grade_grade::fetch_all(['itemid' => $item->id]) ?: [] as $grade) {
            $name = $DB->get_field('user', 'username', ['id' => $grade->userid]);
            $found[$item->itemname ?: $item->itemtype][$name] = $grade->finalgrade === null ? null : (float) $grade->finalgrade;
        }
    }
    return $found;
}

// {course, file, item, column, by, language}: Moodle's own import of a CSV, mapped as its form maps
function way_back_import_csv($asked) {
    global $SESSION;
    $course = course_called($asked['course']);
    $SESSION->lang = $asked['language'] ?? 'en';
    force_current_language($SESSION->lang);
    $load = new gradeimport_csv_load_data();
    $load->load_csv_content(file_get_contents($asked['file']), 'UTF-8', $asked['separator'] ?? 'comma', 10);
    $header = $load->get_headers();
    $item = grade_item::fetch(['courseid' => $course->id, 'itemname' => $asked['item']]);
    $code = get_new_importcode();
    $form = (object) ['mapfrom' => array_search($asked['by'], $header), 'mapto' => $asked['mapto'] ?? 'useremail', 'iid' => $load->get_iid(),
        'importcode' => $code, 'groupid' => 0, 'forceimport' => 1];
    foreach ($header as $place => $title) {
        $form->{"mapping_$place"} = $title === $asked['column'] ? $item->id : '0';
    }
    $reader = new csv_import_reader($load->get_iid(), 'grade');
    $reader->init();
    $status = $load->prepare_import_grade_data($header, $form, $reader, $course->id, 0, 0, false);
    $errors = $load->get_gradebookerrors();
    if ($status) {
        ob_start();
        grade_import_commit($course->id, $code, false, false);
        ob_end_clean();
    }
    force_current_language('en');
    return ['status' => $status, 'errors' => $errors, 'header' => $header];
}

// {course, file}
function way_back_import_xml($asked) {
    $error = '';
    $course = course_called($asked['course']);
    $code = import_xml_grades(file_get_contents($asked['file']), $course, $error);
    if ($code) {
        ob_start();
        grade_import_commit($course->id, $code, false, false);
        ob_end_clean();
    }
    return ['status' => (bool) $code, 'errors' => $error ? [$error] : []];
}

// {course}
function way_back_forget($asked) {
    global $DB;
    if ($course = $DB->get_record('course', ['shortname' => $asked['course']])) {
        delete_course($course, false);
    }
    return true;
}
