<?php
/*
 * The qti-sdk's classes by their files in $source, and answers as its responses: what is no number is no answer.
 */
use qtism\common\datatypes\QtiFloat;
use qtism\common\datatypes\QtiIdentifier;
use qtism\common\datatypes\QtiString;
use qtism\common\enums\BaseType;
use qtism\common\enums\Cardinality;
use qtism\runtime\common\MultipleContainer;

spl_autoload_register(function ($class) use ($source) {
    $file = $source . '/' . str_replace('\\', '/', $class) . '.php';
    if (is_file($file)) {
        require $file;
    }
});

function value_of($declaration, $answer)
{
    if ($declaration->getCardinality() === Cardinality::MULTIPLE) {
        $some = array_map(fn ($one) => new QtiIdentifier($one), (array) $answer);
        return new MultipleContainer(BaseType::IDENTIFIER, $some);
    }
    if ($answer === null || $answer === '') {
        return null;
    }
    switch ($declaration->getBaseType()) {
        case BaseType::FLOAT:
            return is_numeric(trim($answer)) ? new QtiFloat((float) $answer) : null;
        case BaseType::IDENTIFIER:
            return new QtiIdentifier($answer);
    }
    return new QtiString($answer);
}
