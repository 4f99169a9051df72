"""Draws the rooms of the package from their imports: ``python docs/import_graph.py OUT.svg``.

A room stands one floor above the highest room that it imports from. What is drawn in bold is what a student's
answer passes on its way from a text to a mark.
"""

from __future__ import annotations

import ast
import sys
from pathlib import Path

import coursework
from coursework.figures import Figure, line, note, vector

PACKAGE = Path(coursework.__file__).parent
ANSWER = ("parsing", "kinds", "course", "marking", "gradebook", "cli")  #: what an answer passes on its way up
WIDTH, HEIGHT, GAP = 21.0, 7.0, 3.0  #: of a room and between two, mm


def rooms() -> dict[str, set[str]]:
    """The rooms that each room imports from."""
    needs: dict[str, set[str]] = {}
    for path in PACKAGE.rglob("*.py"):
        outside = path in (PACKAGE / "__init__.py", PACKAGE / "__main__.py")
        if outside or {"skeleton", "examples", "_course"} & set(path.parts):
            continue
        room = path.relative_to(PACKAGE).parts[0].removesuffix(".py")
        found = needs.setdefault(room, set())
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("coursework"):
                parts = [*node.module.split("."), node.names[0].name]
                found.add(parts[1])
    return {room: {n for n in found if n in needs and n != room} for room, found in needs.items()}


def floors(needs: dict[str, set[str]]) -> list[list[str]]:
    """The rooms by floor, from the ground up."""
    height: dict[str, int] = {}

    def of(room: str) -> int:
        if room not in height:
            height[room] = 1 + max((of(below) for below in needs[room]), default=-1)
        return height[room]

    top = max(map(of, needs))
    return [sorted(room for room in needs if height[room] == floor) for floor in range(top + 1)]


def drawing() -> Figure:
    """The rooms, the ground floor at the bottom."""
    plan = floors(rooms())
    wide = max(map(len, plan))
    place = {
        room: complex((k - (len(row) - 1) / 2) * (WIDTH + GAP), floor * (HEIGHT + GAP))
        for floor, row in enumerate(plan)
        for k, room in enumerate(row)
    }
    elements = []
    for room, centre in place.items():
        corners = [
            centre + complex(x * WIDTH, y * HEIGHT) / 2 for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))
        ]
        bold = room in ANSWER
        elements += [
            line(p, q, thin=not bold) for p, q in zip(corners, corners[1:] + corners[:1], strict=True)
        ]
        elements.append(note(centre, rf"\text{{{room}}}"))
    side = -(wide / 2) * (WIDTH + GAP) - 2
    top = complex(side, (len(plan) - 1) * (HEIGHT + GAP))
    elements.append(vector(top, complex(side, 0) - top, r"\text{imports}"))
    return Figure(*elements, paper_mm=(170, 140))


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(drawing().outlined_svg(), "utf-8")
