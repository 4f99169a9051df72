<?php
// What the LTI tests ask of a real Moodle, on the command line: a verb, JSON on standard input, JSON on standard output.
// The environment variable COURSEWORK_MOODLE names the folder of its code.
//
//   prepare  {"course", "url", "password"}   a course with a teacher and two students, and the tool that is registered at url
//   open     {}                              loopback may be asked: for a test on one machine, never for a site that others use
//   close    {"kept"}                        … no more
//   grades   {"course"}                      every grade with its feedback, by item and user
//   link     {"course", "type", "name", "custom", "points"}   a link without deep linking; its course module
//   reset    {"course"}                      the course, its people and its tool are deleted

define('CLI_SCRIPT', true);
ini_set('max_input_vars', 5000);
require(getenv('COURSEWORK_MOODLE') . '/config.php');
require_once($CFG->dirroot . '/course/lib.php');
require_once($CFG->dirroot . '/course/modlib.php');
require_once($CFG->dirroot . '/user/lib.php');
require_once($CFG->dirroot . '/mod/lti/locallib.php');
require_once($CFG->libdir . '/gradelib.php');

const BLOCKS = ['curlsecurityblockedhosts', 'curlsecurityallowedport'];

\core\session\manager::set_user(get_admin());
$verbs = ['prepare' => 'prepare', 'open' => 'open_loopback', 'close' => 'close_loopback', 'grades' => 'grades', 'link' => 'add_link',
    'reset' => 'forget'];
$asked = json_decode(stream_get_contents(STDIN), true) ?: [];
echo json_encode($verbs[$argv[1]]($asked), JSON_UNESCAPED_UNICODE | JSON_THROW_ON_ERROR), "\n";

function open_loopback(array $asked): array {
    $kept = array_map(fn($name) => get_config('core', $name), array_combine(BLOCKS, BLOCKS));
    foreach (BLOCKS as $name) {
        set_config($name, '');
    }
    return $kept;
}

function close_loopback(array $asked): array {
    foreach ($asked['kept'] as $name => $value) {
        set_config($name, $value);
    }
    return [];
}

function prepare(array $asked): array {
    global $DB;
    forget($asked);
    $name = $asked['course'];
    $course = create_course((object) ['shortname' => $name, 'fullname' => 'Mechanics (LTI tests)', 'category' => 1]);
    $manual = enrol_get_plugin('manual');
    $instance = $DB->get_record('enrol', ['courseid' => $course->id, 'enrol' => 'manual'], '*', MUST_EXIST);
    foreach ([['teacher', 'Emmy', 'Noether', 'editingteacher'], ['ada', 'Ada', 'Byron', 'student'], ['bob', 'Bob', 'Noyce', 'student']] as [$who, $first, $last, $role]) {
        $id = user_create_user((object) ['username' => "{$name}_$who", 'password' => $asked['password'], 'firstname' => $first, 'lastname' => $last,
            'email' => "$who.$name@example.org", 'idnumber' => "$name-$who", 'auth' => 'manual', 'confirmed' => 1, 'mnethostid' => 1]);
        $manual->enrol_user($instance, $id, $DB->get_field('role', 'id', ['shortname' => $role]));
        $people[$who] = (string) $id;
    }
    $url = $asked['url'];
    $type = (object) ['state' => LTI_TOOL_STATE_CONFIGURED];
    $id = lti_add_type($type, (object) [
        'lti_typename' => $name, 'lti_toolurl' => "$url/launch", 'lti_ltiversion' => LTI_VERSION_1P3, 'lti_keytype' => LTI_JWK_KEYSET,
        'lti_publickeyset' => "$url/jwks", 'lti_initiatelogin' => "$url/login", 'lti_redirectionuris' => "$url/launch",
        'lti_contentitem' => 1, 'lti_toolurl_ContentItemSelectionRequest' => "$url/launch", 'lti_coursevisible' => LTI_COURSEVISIBLE_ACTIVITYCHOOSER,
        'lti_launchcontainer' => LTI_LAUNCH_CONTAINER_EMBED, 'lti_sendname' => LTI_SETTING_ALWAYS, 'lti_sendemailaddr' => LTI_SETTING_ALWAYS,
        'lti_acceptgrades' => LTI_SETTING_ALWAYS, 'ltiservice_gradesynchronization' => 2, 'ltiservice_memberships' => 1,
    ]);
    return ['course' => (int) $course->id, 'people' => $people, 'type' => $id,
        'client_id' => $DB->get_field('lti_types', 'clientid', ['id' => $id]), 'deployment' => (string) $id];
}

function add_link(array $asked): array {
    global $DB;
    $course = $DB->get_record('course', ['shortname' => $asked['course']], '*', MUST_EXIST);
    $module = add_moduleinfo((object) ['modulename' => 'lti', 'module' => $DB->get_field('modules', 'id', ['name' => 'lti']), 'course' => $course->id,
        'section' => 0, 'visible' => 1, 'name' => $asked['name'], 'intro' => '', 'introformat' => FORMAT_HTML, 'typeid' => $asked['type'],
        'toolurl' => '', 'instructorcustomparameters' => $asked['custom'], 'launchcontainer' => LTI_LAUNCH_CONTAINER_DEFAULT,
        'instructorchoiceacceptgrades' => 1, 'instructorchoicesendname' => 1, 'instructorchoicesendemailaddr' => 1, 'grade' => $asked['points'],
        'showtitlelaunch' => 1, 'showdescriptionlaunch' => 0, 'cmidnumber' => ''], $course);
    return ['module' => (int) $module->coursemodule];
}

function grades(array $asked): array {
    global $DB;
    $course = $DB->get_record('course', ['shortname' => $asked['course']], '*', MUST_EXIST);
    $found = [];
    foreach (grade_item::fetch_all(['courseid' => $course->id]) ?: [] as $item) {
        foreach (grade_grade::fetch_all(['itemid' => $item->id]) ?: [] as $grade) {
            $found[] = ['item' => $item->itemname, 'type' => $item->itemtype, 'max' => (float) $item->grademax, 'user' => (string) $grade->userid,
                'grade' => $grade->finalgrade === null ? null : (float) $grade->finalgrade, 'feedback' => $grade->feedback];
        }
    }
    return $found;
}

function forget(array $asked): array {
    global $DB;
    $name = $asked['course'];
    if ($course = $DB->get_record('course', ['shortname' => $name])) {
        delete_course($course, false);
    }
    foreach ($DB->get_records_select('user', 'deleted = 0 AND ' . $DB->sql_like('username', '?'), [$DB->sql_like_escape("{$name}_") . '%']) as $user) {
        user_delete_user($user);
    }
    foreach ($DB->get_records('lti_types', ['name' => $name]) as $type) {
        lti_delete_type($type->id);
    }
    return [];
}
