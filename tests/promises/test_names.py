"""Names and docstrings that a colleague guesses: a class name stands in one file, a docstring says what is
taken, returned or done."""

import ast
import re
from collections import defaultdict
from pathlib import Path

from package_trees import nodes, trees

ROOT = Path(__file__).resolve().parents[2]
ROOMS = ("coursework", "exercises", "solutions", "tests", "docs", "benchmarks", "locks")
#: The public name of a variant is the class that course authors and notebooks see, and extends the course's
#: own.
IN_TWO_FILES = {"Variant"}

CLAUSE = re.compile(r"(What|Who|Whoever|Whose|Whether|How|Where|Which|That|This|It)\b")

#: Rooms whose public functions state parameters and return value: the interface and the numeric core.
DESCRIBED = (
    "api.py",
    "model.py",
    "solution.py",
    "kinematics/",
    "figures/polygons/",
    "structure/",
    "mechanics/",
)

DEFINITIONS = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


def test_a_class_name_stands_in_one_file():
    files = defaultdict(set)
    for file, classes in nodes(ast.ClassDef).items():
        for node in classes:
            files[node.name].add(file)
    shared = {name: sorted(where) for name, where in files.items() if len(where) > 1}
    assert {name: where for name, where in shared.items() if name not in IN_TWO_FILES} == {}


def test_the_formatter_decides_every_layout():
    """Lines of 110 are the linter's to keep."""
    spared = re.compile("# *fmt" + ": *(skip|off)")
    written = [path for room in ROOMS for path in (ROOT / room).rglob("*.py")]
    assert len(written) > 1000
    assert [path for path in written if spared.search(path.read_text("utf-8"))] == []


def test_a_docstring_begins_with_a_verb_or_a_noun_and_no_clause():
    clauses = [
        (file, text.splitlines()[0])
        for file, definitions in nodes(DEFINITIONS).items()
        for node in definitions
        if (text := ast.get_docstring(node)) and CLAUSE.match(text)
    ]
    assert clauses == []


def public_functions(tree):
    """Yield the public functions of a module and the public methods of its public classes."""
    for node in tree.body:
        is_class = isinstance(node, ast.ClassDef) and not node.name.startswith("_")
        for function in node.body if is_class else (node,):
            if isinstance(function, ast.FunctionDef) and not function.name.startswith("_"):
                yield f"{node.name}.{function.name}" if is_class else function.name, function


def described(text):
    """Return the names listed under the heading ``Parameters`` of a docstring."""
    section = re.search(r"^Parameters\n-+\n(.*?)(?=\n\n\S|\Z)", text, re.M | re.S)
    entries = re.findall(r"^(\w.*)$", section[1], re.M) if section else []
    return {name.strip() for entry in entries for name in entry.split(",")}


def test_the_interface_and_the_numeric_core_describe_each_parameter_and_the_return_value():
    missing, seen = [], set()
    for file, tree in trees().items():
        room = next((room for room in DESCRIBED if file.startswith(room)), None)
        for name, function in public_functions(tree) if room else ():
            taken = function.args
            every = (*taken.posonlyargs, *taken.args, *taken.kwonlyargs, taken.vararg, taken.kwarg)
            parameters = {argument.arg for argument in every if argument} - {"self", "cls"}
            if not parameters:
                continue
            seen.add(room)
            text = ast.get_docstring(function) or ""
            if parameters != described(text):
                missing.append((file, name, sorted(parameters ^ described(text))))
            returns_none = function.returns is not None and ast.unparse(function.returns) == "None"
            if not returns_none and "\nReturns\n---" not in text:
                missing.append((file, name, "Returns"))
    assert seen == set(DESCRIBED)
    assert missing == []
