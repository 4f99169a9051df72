<?php
/*
 * A student sits a test of QTI 2.1 in the qti-sdk: the sections deal out their items, the answers are marked, and the result
 * is reported. Arguments: the folder of the sdk's sources, the folder of an unpacked package. From standard input
 * {"student": "s1", "answers": {ITEM: {"RESPONSE_x": "1.5"}}}; writes the assessmentResult (XML).
 */
error_reporting(E_ALL & ~E_DEPRECATED);
[, $source, $package] = $argv;
require __DIR__ . '/qti_sdk_values.php';

use qtism\common\datatypes\files\FileSystemFileManager;
use qtism\common\datatypes\QtiIdentifier;
use qtism\data\storage\xml\filesystem\FilesystemInterface;
use qtism\data\storage\xml\XmlCompactDocument;
use qtism\data\storage\xml\XmlDocument;
use qtism\data\storage\xml\XmlResultDocument;
use qtism\runtime\common\ResponseVariable;
use qtism\runtime\common\State;
use qtism\runtime\results\AssessmentResultBuilder;
use qtism\runtime\tests\SessionManager;

$files = new class () implements FilesystemInterface {
    public function read(string $url)
    {
        return file_get_contents($url);
    }

    public function write(string $url, string $content): bool
    {
        return (bool) file_put_contents($url, $content);
    }
};

$asked = json_decode(file_get_contents('php://stdin'), true);
$document = new XmlDocument();
$document->setFilesystem($files);
$document->load("$package/test.xml");
$test = XmlCompactDocument::createFromXmlAssessmentTestDocument($document)->getDocumentComponent();
$session = (new SessionManager(new FileSystemFileManager()))->createAssessmentTestSession($test);
$session->setSessionId($test->getIdentifier());
$session->beginTestSession();
while ($session->isRunning()) {
    $reference = $session->getCurrentAssessmentItemRef();
    $state = new State();
    $session->beginAttempt();
    foreach ($reference->getResponseDeclarations() as $declared) {
        $name = $declared->getIdentifier();
        $answer = $asked['answers'][$reference->getIdentifier()][$name] ?? null;
        $value = value_of($declared, $answer);
        $state->setVariable(new ResponseVariable($name, $declared->getCardinality(), $declared->getBaseType(), $value));
    }
    $session->endAttempt($state);
    $session->moveNext();
}
$result = (new AssessmentResultBuilder($session))->buildResult();
$result->getContext()->setSourcedId(new QtiIdentifier($asked['student']));
$report = new XmlResultDocument('2.1.0', $result);
echo $report->saveToString();
