"""Steps of nbgrader that keep the answers cells, restore the cells that a student changed, and mark.

nbgrader's database says which notebooks are ours; the notebook that came back does not. None of our cells is
run.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from nbconvert.exporters.exporter import ResourcesDict
from nbformat.notebooknode import NotebookNode
from nbgrader.api import Gradebook, MissingEntry
from nbgrader.preprocessors import ClearSolutions, Execute, NbGraderPreprocessor, SaveAutoGrades
from traitlets import Unicode

from coursework.messages import Message
from coursework.platforms.nbgrader.cells import OURS, SCHEMA
from coursework.platforms.nbgrader.marking import MarkedNotebook, marked_notebook
from coursework.system.visible import one_line

Done = tuple[NotebookNode, ResourcesDict]
_RESOURCE = "coursework"  #: key of the resources by which a step passes data to later steps


def _grade_id(cell: NotebookNode) -> str:
    """Return nbgrader's name of a cell; empty if the cell or its metadata are not nbgrader's."""
    fields = cell.metadata.get("nbgrader") if isinstance(cell.metadata, dict) else None
    name = fields.get("grade_id") if isinstance(fields, dict) else None
    return name if isinstance(name, str) else ""


class KeepAnswers(ClearSolutions):
    """Step that clears solutions as nbgrader does, except in our cells: an answers cell holds no solution."""

    def preprocess_cell(self, cell: NotebookNode, resources: ResourcesDict, cell_index: int) -> Done:
        if _grade_id(cell).startswith(OURS):
            return cell, resources
        return super().preprocess_cell(cell, resources, cell_index)


# ------------------------------------------------------------------- what is there


def _known_cells(resources: ResourcesDict) -> dict[str, NotebookNode]:
    """Return the cells of our notebook as released, by nbgrader's database and in its order; empty for other
    notebooks."""
    about = resources["nbgrader"]
    with Gradebook(about["db_url"]) as gradebook:
        try:
            book = gradebook.find_notebook(about["notebook"], about["assignment"])
        except MissingEntry:
            return {}
        if not any(cell.name.startswith(OURS) for cell in book.source_cells):
            return {}
        points = {cell.name: cell.max_score for cell in book.grade_cells}
        solutions = {cell.name for cell in book.solution_cells}
        return {
            cell.name: _released(cell, points.get(cell.name), cell.name in solutions)
            for cell in book.source_cells
        }


def _released(cell: Any, points: float | None, solution: bool) -> NotebookNode:
    fields = {
        "schema_version": SCHEMA,
        "grade_id": cell.name,
        "grade": points is not None,
        "solution": solution,
    }
    fields |= {
        "locked": bool(cell.locked),
        "task": False,
        "checksum": cell.checksum,
        "cell_type": cell.cell_type,
    }
    fields |= {} if points is None else {"points": points}
    locked = {"deletable": False} if solution else {"deletable": False, "editable": False}
    content = {"cell_type": cell.cell_type, "source": cell.source, "metadata": {**locked, "nbgrader": fields}}
    if cell.cell_type == "code":
        content |= {"execution_count": None, "outputs": []}
    node: NotebookNode = _node(content)
    return node


def _node(value: Any) -> Any:
    """Return plain dictionaries and lists as nodes of nbformat."""
    if isinstance(value, dict):
        return NotebookNode({key: _node(item) for key, item in value.items()})
    return [_node(item) for item in value] if isinstance(value, list) else value


class RestoreCells(NbGraderPreprocessor):
    """Step that restores the locked cells of our notebooks and leaves the student's own cells alone.

    Without it, metadata that a student changed could stop the marking of a notebook or of the class, and a
    deleted grade cell would never be marked.
    """

    def preprocess(self, nb: NotebookNode, resources: ResourcesDict) -> Done:
        released_cells = _known_cells(resources)
        if released_cells:
            changed = restore(nb, released_cells)
            for change in changed:
                self.log.warning("%s: %s", *map(one_line, (resources["nbgrader"]["student"], change)))
        return nb, resources


def restore(nb: NotebookNode, released_cells: Mapping[str, NotebookNode]) -> list[Message]:
    """Put the released cells back into a notebook; return the changes that had to be undone."""
    changes, cells, seen = [], [], set[str]()
    for cell in nb.cells:
        if not _completed(cell):
            changes.append(Message("something that is not a cell was left out"))
            continue
        name = _grade_id(cell)
        if name in released_cells and name not in seen:
            seen.add(name)
            cells.append(_restored(cell, released_cells[name], changes))
            continue
        if "nbgrader" in cell.metadata:
            del cell.metadata["nbgrader"]
            if name in released_cells:
                change = Message("a second cell {name} counts as the student's own", name=name)
            else:
                change = Message("a cell that was not in the released notebook counts as the student's own")
            changes.append(change)
        cells.append(cell)
    for index, (name, cell) in enumerate(released_cells.items()):
        if name not in seen:
            changes.append(Message("the cell {name} was missing", name=name))
            cells.insert(_behind(cells, list(released_cells)[:index]), cell)
    nb.cells = cells
    for cell in nb.cells:  # restored cells have no id, and copies share one
        cell.pop("id", None)
    nb.nbformat, nb.nbformat_minor = 4, 4
    return changes


def _completed(cell: Any) -> bool:
    """Return whether a value is a cell; add the fields that it lacks."""
    if not isinstance(cell, dict) or cell.get("cell_type") not in ("code", "markdown", "raw"):
        return False
    if not isinstance(cell.get("metadata"), dict):
        cell["metadata"] = NotebookNode()
    if not isinstance(cell.get("source"), str):
        cell["source"] = ""
    if cell["cell_type"] == "code":
        cell["outputs"], cell["execution_count"] = [], None
    return True


def _restored(cell: NotebookNode, released: NotebookNode, changes: list[Message]) -> NotebookNode:
    """Return a cell as it was released; the source of a solution stays the student's."""
    fields = released.metadata.nbgrader
    if cell.cell_type != fields.cell_type or (fields.locked and cell.source != released.source):
        changes.append(Message("the cell {grade_id} was changed", grade_id=fields.grade_id))
    back = _node({**released, "metadata": {**cell.metadata, **released.metadata}})
    if not fields.locked:
        back["source"] = cell.source
    if "attachments" in cell and cell.cell_type == back.cell_type == "markdown":
        back["attachments"] = cell.attachments
    node: NotebookNode = back
    return node


def _behind(cells: Sequence[NotebookNode], before: Sequence[str]) -> int:
    """Return the index after the last cell whose name is in ``before``."""
    return next((index + 1 for index in reversed(range(len(cells))) if _grade_id(cells[index]) in before), 0)


# ----------------------------------------------------------------------- marking


class MarkAnswers(Execute):
    """Step that reads the answers cell as data and writes points and feedback into the grade cells.

    It replaces nbgrader's ``Execute`` and runs no cell of our notebooks; it runs all other notebooks as
    ``Execute`` does.
    """

    folder = Unicode(
        "",
        help="The folder of nbgrader's course, which has issued/ASSIGNMENT.json; by default where it runs.",
    ).tag(config=True)
    course = Unicode("", help="The course that the exercises are of; by default the built-in one.").tag(
        config=True
    )

    def preprocess(self, nb: NotebookNode, resources: ResourcesDict, km: Any = None) -> Done:
        released_cells = _known_cells(resources)
        if not released_cells:
            done: Done = super().preprocess(nb, resources, km)
            return done
        about = resources["nbgrader"]
        issued = Path(self.folder) / "issued" / f"{about['assignment']}.json"
        marked = marked_notebook(self.course or None, issued, about["student"], _text(nb))
        if any(name not in {_grade_id(cell) for cell in nb.cells} for name in released_cells):
            restore(nb, released_cells)  # where RestoreCells is not among the steps
        for message in marked.messages:
            self.log.warning("%s: %s", *map(one_line, (about["student"], message)))
        for cell in nb.cells:
            self._fill(cell, released_cells, marked)
        resources[_RESOURCE] = {"waiting": marked.waiting}
        return nb, resources

    def _fill(
        self, cell: NotebookNode, released_cells: Mapping[str, NotebookNode], marked: MarkedNotebook
    ) -> None:
        """Replace the outputs of a cell; nothing of the student's outputs remains."""
        if cell.cell_type == "code":
            cell.outputs, cell.execution_count = [], None
        name = _grade_id(cell)
        if name not in released_cells:
            return
        fields = released_cells[name].metadata.nbgrader
        if fields.grade:
            cell.outputs = _node(marked.grade_outputs(name, float(fields.points), self.log.warning))
        elif fields.solution:
            cell.outputs = _node(marked.notes_of(name))


def _text(nb: NotebookNode) -> bytes:
    return json.dumps(nb, default=dict).encode("utf-8", "surrogatepass")


class SaveMarks(SaveAutoGrades):
    """Step that saves the points as nbgrader does, and lists under Manual Grading the parts that a person
    must look at."""

    def preprocess(self, nb: NotebookNode, resources: ResourcesDict) -> Done:
        self._waiting = frozenset(resources.get(_RESOURCE, {}).get("waiting", ()))
        done: Done = super().preprocess(nb, resources)
        return done

    def _add_score(self, cell: NotebookNode, resources: ResourcesDict) -> None:
        super()._add_score(cell, resources)
        name = cell.metadata["nbgrader"]["grade_id"]
        if name in self._waiting:
            grade = self.gradebook.find_grade(name, self.notebook_id, self.assignment_id, self.student_id)
            grade.needs_manual_grade = True
            self.gradebook.db.commit()
