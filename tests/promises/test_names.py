"""Names and docstrings that a colleague guesses: a class name stands in one file, a docstring says what is returned or done."""

import ast
import re
from collections import defaultdict
from pathlib import Path

import coursework

PACKAGE = Path(coursework.__file__).resolve().parent

#: The public name of a variant is the class that course authors and notebooks see, and extends the course's own.
IN_TWO_FILES = {"Variant"}

CLAUSE = re.compile(r"(What|Who|Whoever|Whose|Whether|How|Where|Which|That|This|It)\b")

DEFINITIONS = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


def trees():
    for path in sorted(PACKAGE.rglob("*.py")):
        if not {"skeleton", "examples", "_course", "versions"} & set(path.parts):
            yield path.relative_to(PACKAGE).as_posix(), ast.parse(path.read_text("utf-8"))


def test_a_class_name_stands_in_one_file():
    files = defaultdict(set)
    for file, tree in trees():
        for node in ast.walk(tree):
            if isinstance(node, ast.ClassDef):
                files[node.name].add(file)
    shared = {name: sorted(where) for name, where in files.items() if len(where) > 1}
    assert {name: where for name, where in shared.items() if name not in IN_TWO_FILES} == {}


def test_a_docstring_begins_with_a_verb_or_a_noun_and_no_clause():
    clauses = [
        (file, text.splitlines()[0])
        for file, tree in trees()
        for node in ast.walk(tree)
        if isinstance(node, DEFINITIONS) and (text := ast.get_docstring(node)) and CLAUSE.match(text)
    ]
    assert clauses == []
