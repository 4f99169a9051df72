<?php
/*
 * Marks answers with the qti-sdk: reads from standard input {"items": {FILE: [{"RESPONSE_x": "1.5", ...}, ...]}},
 * writes {FILE: [{"SCORE": 1.0, ...}, ...]}. First argument: the folder of the sdk's sources, which holds qtism/.
 * An answer arrives as a delivery reads it from a form: what is no number is no answer.
 */
error_reporting(E_ALL & ~E_DEPRECATED);
$source = $argv[1];
require __DIR__ . '/qti_sdk_values.php';

use qtism\common\datatypes\files\FileSystemFileManager;
use qtism\data\storage\xml\XmlDocument;
use qtism\runtime\common\ResponseVariable;
use qtism\runtime\common\State;
use qtism\runtime\tests\AssessmentItemSession;
use qtism\runtime\tests\SessionManager;

$asked = json_decode(file_get_contents('php://stdin'), true);
$found = [];
foreach ($asked['items'] as $file => $sheets) {
    $document = new XmlDocument();
    $document->loadFromString(file_get_contents($file));
    $item = $document->getDocumentComponent();
    $declared = [];
    foreach ($item->getResponseDeclarations() as $declaration) {
        $declared[$declaration->getIdentifier()] = $declaration;
    }
    $found[$file] = [];
    foreach ($sheets as $answers) {
        $session = new AssessmentItemSession($item, new SessionManager(new FileSystemFileManager()));
        $session->getItemSessionControl()->setMaxAttempts(1);
        $session->beginItemSession();
        $session->beginAttempt();
        $state = new State();
        foreach ($answers as $name => $answer) {
            $one = $declared[$name];
            $state->setVariable(
                new ResponseVariable($name, $one->getCardinality(), $one->getBaseType(), value_of($one, $answer))
            );
        }
        $session->endAttempt($state);
        $made = [];
        foreach ($item->getOutcomeDeclarations() as $outcome) {
            $value = $session[$outcome->getIdentifier()];
            $made[$outcome->getIdentifier()] = $value === null ? null : $value->getValue();
        }
        $found[$file][] = $made;
    }
}
echo json_encode($found, JSON_PRESERVE_ZERO_FRACTION);
