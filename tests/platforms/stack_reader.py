"""A reader of STACK's questions that shares nothing with the writer, and a judge that runs their trees in
Python."""

from __future__ import annotations

import cmath
import math
import re
from xml.etree import ElementTree as ET


def questions_of(data):
    """Each question by its name, and the categories in order."""
    root = ET.fromstring(data)
    found = {
        one.find("name/text").text: _question(one)
        for one in root.iter("question")
        if one.get("type") == "stack"
    }
    return found, [
        one.find("category/text").text for one in root.iter("question") if one.get("type") == "category"
    ]


def _question(one):
    return {
        "text": one.find("questiontext/text").text,
        "files": {file.get("name"): file.text for file in one.iter("file")},
        "variables": one.find("questionvariables/text").text,
        "grade": float(one.find("defaultgrade").text),
        "idnumber": one.find("idnumber").text,
        "decimals": one.find("decimals").text,
        "inputs": {
            box.find("name").text: {field.tag: field.text or "" for field in box} for box in one.iter("input")
        },
        "trees": {tree.find("name").text: _tree(tree) for tree in one.iter("prt")},
        "trials": [_trial(test) for test in one.iter("qtest")],
    }


def _tree(tree):
    return {
        "value": float(tree.find("value").text),
        "variables": tree.find("feedbackvariables/text").text or "",
        "nodes": {
            node.find("name").text: {
                "test": node.find("sans").text,
                "score": float(node.find("truescore").text),
                "otherwise": float(node.find("falsescore").text),
                "next": node.find("falsenextnode").text,
                "stops": node.find("truenextnode").text == "-1",
                "says": node.find("truefeedback/text").text or "",
                "note": node.find("trueanswernote").text,
            }
            for node in tree.iter("node")
        },
    }


def _trial(test):
    return {
        "answers": {one.find("name").text: one.find("value").text or "" for one in test.iter("testinput")},
        "expected": {
            one.find("name").text: float(one.find("expectedscore").text) for one in test.iter("expected")
        },
    }


class FromOne(list):
    def __getitem__(self, place):
        return super().__getitem__(place - 1)


def score(question, tree, answers):
    """What a tree gives for answers by the name of their box: numbers, letters, lists of letters."""
    space = _space(question, answers)
    for line in _statements(question["trees"][tree]["variables"]):
        name, value = line.split(":", 1)
        space[name] = _run(value, space)
    nodes, at = question["trees"][tree]["nodes"], "0"
    while at != "-1":
        node = nodes[at]
        if _run(node["test"], space):
            assert node["stops"]
            return node["score"], node
        assert node["otherwise"] == 0
        at = node["next"]
    return 0.0, None


def _space(question, answers):
    space = {
        "co_number": lambda x, u: x if isinstance(x, (int, float)) else False,
        "co_in": lambda v, a, b: v is not False and a <= v <= b,
        "co_turned": lambda v, a, b, t: (
            v is not False and abs(v - (a + b) / 2 - t * round((v - (a + b) / 2) / t)) <= (b - a) / 2
        ),
        "co_tried": lambda v, r: abs(v) <= 100 * abs(r) and 100 * abs(v) >= abs(r),
        "numberp": lambda v: v is not False,
        "_is": bool,
        "float": lambda z: z if z is False else complex(z).real,
        "sin": cmath.sin,
        "cos": cmath.cos,
        "tan": cmath.tan,
        "asin": cmath.asin,
        "acos": cmath.acos,
        "atan": cmath.atan,
        "sqrt": cmath.sqrt,
        "exp": cmath.exp,
        "cabs": abs,
        "carg": cmath.phase,
        "realpart": lambda z: complex(z).real,
        "imagpart": lambda z: complex(z).imag,
        "atan2": lambda y, x: math.atan2(complex(y).real, complex(x).real),
        "PI": math.pi,
        "I": 1j,
    }
    for line in _statements(question["variables"]):
        if found := re.fullmatch(r"(co_r\d+): \[(.*)\]", line):
            space[found[1]] = FromOne(map(float, re.sub(r"[()]", "", found[2]).split(",")))
        elif found := re.match(r"(co_u\d+):", line):
            space[found[1]] = None
    return space | {name: answers.get(name) for name in question["inputs"]}


def _statements(text):
    return [line.strip() for line in text.replace("\n", " ").split(";") if line.strip()]


def _run(maxima, space):
    text = maxima.strip()
    if found := re.fullmatch(r"if (.*?) then (.*) else (\S+)", text):
        return _run(found[2] if _run(found[1], space) else found[3], space)
    if found := re.fullmatch(r'is\((ans\d+)="(.*)"\)', text):
        return space[found[1]] == found[2]
    if found := re.fullmatch(r"is\((ans\d+)=EMPTYANSWER\)", text):
        return space[found[1]] is None
    text = re.sub(r"\bis\(", "_is(", text).replace("%pi", "PI").replace("%i", "I").replace("^", "**")
    text = re.sub(r"\bfalse\b", "False", text)
    return eval(text, {"__builtins__": {"max": max, "min": min, "abs": abs}}, space)
