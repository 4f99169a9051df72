<?php
/*
 * Which files are not valid: from standard input {FILE: SCHEMA}, writes {FILE: [what is wrong, ...]}. First argument: the
 * folder of the schemas, which are all that is read; nothing is fetched.
 */
$folder = $argv[1];
libxml_use_internal_errors(true);
libxml_set_external_entity_loader(function ($public, $system) use ($folder) {
    if (str_ends_with($system, 'xlink.xsd')) {
        return fopen("$folder/xlink.xsd", 'r');
    }
    return preg_match('#^https?:#', $system) ? null : $system;
});
$wrong = [];
foreach (json_decode(file_get_contents('php://stdin'), true) as $file => $schema) {
    $document = new DOMDocument();
    $document->load($file);
    libxml_clear_errors();
    if (!$document->schemaValidate("$folder/$schema")) {
        $wrong[$file] = array_map(fn ($one) => "{$one->line}: " . trim($one->message), libxml_get_errors());
    }
}
echo json_encode($wrong, JSON_FORCE_OBJECT);
