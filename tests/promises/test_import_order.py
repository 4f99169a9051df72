"""Order of imports: a file imports from its own folder and from folders below it, wherever the import
stands."""

import ast
from functools import cache

from package_trees import FILES, all_nodes
from tables import each_row

#: From the ground up.
ROOMS = (
    "messages errors degrees system language kinematics markup figures structure mechanics parsing "
    "quantities kinds model solution "
    "linkages course marking sheets scenes rendering accuracy issuing gradebook selfstudy scanning "
    "database platforms nbgrader authoring api site __init__ cli __main__"
).split()


def room_of(file):
    return file.split("/")[0].removesuffix(".py")


@cache
def imported(file):
    """The modules of the package that a file imports, with the line."""
    return [*imports(all_nodes(file))]


def imports(found):
    """The modules of the package that are imported at the top, inside functions or for types alone, with the
    line."""
    for node in found:
        if isinstance(node, ast.Import):
            yield from (
                (alias.name, node.lineno) for alias in node.names if alias.name.split(".")[0] == "coursework"
            )
        elif isinstance(node, ast.ImportFrom) and (
            node.level or (node.module or "").split(".")[0] == "coursework"
        ):
            assert not node.level, f"line {node.lineno}: a relative import; name the room"
            for alias in node.names:
                whole = f"{node.module}.{alias.name}"
                yield (whole if file_of(whole) else node.module), node.lineno


STEMS = frozenset(FILES)


@cache
def file_of(module):
    stem = "/".join(module.split(".")[1:])
    if not stem:
        return "__init__.py"
    return next((f for f in (f"{stem}.py", f"{stem}/__init__.py") if f in STEMS), None)


def upward(file, found):
    """What is imported from above the file."""
    floor = ROOMS.index(room_of(file))
    return [
        f"coursework/{file}:{line} imports {module} from above"
        for module, line in found
        if ROOMS.index(room_of(file_of(module) or module.split(".")[1])) > floor
    ]


@each_row("file", FILES)
def test_a_file_imports_from_its_own_room_and_from_rooms_below(file):
    assert not upward(file, imported(file))


@each_row(
    "planted",
    [
        "from coursework.cli.options import opened",
        "def late():\n    from coursework.api import open_course",
        "if TYPE_CHECKING:\n    from coursework.selfstudy.session import StudySession",
        "import coursework.rendering.renderer",
        "from coursework import api",
    ],
)
def test_a_planted_import_from_above_is_found(planted):
    assert upward("marking/marking.py", imports(ast.walk(ast.parse(planted))))


def test_every_file_stands_in_a_room():
    assert {room_of(file) for file in FILES} <= set(ROOMS)


def test_no_files_import_each_other_in_a_circle():
    needs = {f: {file_of(m) for m, _ in imported(f)} - {None, f} for f in FILES}
    while needs:
        free = {f for f, others in needs.items() if not others & needs.keys()}
        assert free, f"these import each other: {', '.join(sorted(needs))}"
        needs = {f: others for f, others in needs.items() if f not in free}
