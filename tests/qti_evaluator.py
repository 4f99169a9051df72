"""A small player of QTI: reads an item in either spelling, takes answers, and does what its response
processing says.

From the semantics of the specification alone: three values of truth, NULL for a response that holds nothing.
"""

from __future__ import annotations

import re
from xml.etree import ElementTree as ET

_NUMBER = re.compile(r"\s*[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?\s*")


def camel(name):
    """The words of both versions as one: ``qti-is-null`` -> ``isNull``."""
    head, *rest = name.rpartition("}")[2].removeprefix("qti-").split("-")
    return head + "".join(word.capitalize() for word in rest)


def plain(element):
    """The same tree in the words of 2.1, without namespaces; what is HTML or a formula as it is."""
    made = ET.Element(camel(element.tag), {camel(name): value for name, value in element.attrib.items()})
    made.text, made.tail = element.text, element.tail
    made.extend(plain(child) for child in element)
    return made


class Player:
    """An item being answered."""

    def __init__(self, data: bytes):
        self.item = plain(ET.fromstring(data))
        self.declared = {one.get("identifier"): one for one in self.item if one.tag == "responseDeclaration"}

    def outcomes(self, answers):
        """The outcomes of an attempt with these answers, by their names."""
        self.values = {
            one.get("identifier"): self._default(one) for one in self.item if one.tag == "outcomeDeclaration"
        }
        kept = dict(self.values)
        for name, declared in self.declared.items():
            self.values[name] = self._taken(declared, answers.get(name))
        for rule in self.item.find("responseProcessing"):
            self._rule(rule)
        return {name: self.values[name] for name in kept}

    def right(self):
        """What the declarations say is right."""
        found = {}
        for name, declared in self.declared.items():
            values = [value.text for value in declared.iterfind("correctResponse/value")]
            found[name] = values if declared.get("cardinality") == "multiple" else (values or [None])[0]
        return found

    def _default(self, declared):
        found = [_value(declared, one.text) for one in declared.iterfind("defaultValue/value")]
        return found[0] if found else None

    def _taken(self, declared, answer):
        if declared.get("cardinality") == "multiple":
            return tuple(answer or ()) or None
        if answer is None or answer == "":
            return None
        return _value(declared, answer)

    def _rule(self, rule):
        if rule.tag == "setOutcomeValue":
            assert rule.get("identifier") in self.values, rule.get("identifier")
            self.values[rule.get("identifier")] = self._of(rule[0])
            return
        assert rule.tag == "responseCondition", rule.tag
        for branch in rule:
            does = list(branch)
            if branch.tag == "responseElse" or self._of(does.pop(0)) is True:
                for one in does:
                    self._rule(one)
                return

    def _of(self, expression):
        inner = [self._of(one) for one in expression]
        match expression.tag:
            case "variable":
                return self.values[expression.get("identifier")]
            case "baseValue":
                return _value(expression, expression.text)
            case "isNull":
                return inner[0] is None
            case "and":
                return False if False in inner else None if None in inner else True
            case "or":
                return True if True in inner else None if None in inner else False
            case "gte" | "lte" | "match" if None in inner:
                return None
            case "gte":
                return inner[0] >= inner[1]
            case "lte":
                return inner[0] <= inner[1]
            case "match":
                return inner[0] == inner[1]
            case "sum":
                return None if None in inner else sum(inner)
            case "mapResponse":
                return self._mapped(expression.get("identifier"))
        raise AssertionError(f"an expression that not every player has: {expression.tag}")

    def _mapped(self, name):
        mapping = self.declared[name].find("mapping")
        worth = {one.get("mapKey"): float(one.get("mappedValue")) for one in mapping}
        total = sum(
            worth.get(one, float(mapping.get("defaultValue"))) for one in set(self.values[name] or ())
        )
        low, high = mapping.get("lowerBound"), mapping.get("upperBound")
        total = total if low is None else max(total, float(low))
        return total if high is None else min(total, float(high))


def _value(declared, text):
    if declared.get("baseType") == "float":
        return float(text) if text and _NUMBER.fullmatch(text) else None
    return text
