"""Steps of nbgrader: our notebooks keep their answers cell, get back the cells that a student changed, and are marked.

Which notebooks are ours nbgrader's database says, never the notebook that came back. No cell of ours is run.
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

from coursework.nbgrader.cells import OURS, SCHEMA
from coursework.nbgrader.marking import MarkedNotebook, marked_notebook
from coursework.system.visible import one_line

Done = tuple[NotebookNode, ResourcesDict]
_TOLD = "coursework"  #: where a step leaves word for those behind it


def _grade_id(cell: NotebookNode) -> str:
    """What nbgrader calls a cell; nothing for one that is none of its, or whose metadata are no metadata."""
    said = cell.metadata.get("nbgrader") if isinstance(cell.metadata, dict) else None
    found = said.get("grade_id") if isinstance(said, dict) else None
    return found if isinstance(found, str) else ""


def _is_ours(cell: NotebookNode) -> bool:
    return _grade_id(cell).startswith(OURS)


class KeepAnswers(ClearSolutions):
    """Clears solutions as nbgrader does, but for the cells of ours: an answers cell holds no solution."""

    def preprocess_cell(self, cell: NotebookNode, resources: ResourcesDict, cell_index: int) -> Done:
        if _is_ours(cell):
            return cell, resources
        return super().preprocess_cell(cell, resources, cell_index)


# ------------------------------------------------------------------- what is there


def _known_cells(resources: ResourcesDict) -> dict[str, NotebookNode]:
    """The cells of a notebook of ours as they were released, by nbgrader's database and in its order; nothing for a notebook
    that is not ours."""
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
    said = {
        "schema_version": SCHEMA,
        "grade_id": cell.name,
        "grade": points is not None,
        "solution": solution,
    }
    said |= {
        "locked": bool(cell.locked),
        "task": False,
        "checksum": cell.checksum,
        "cell_type": cell.cell_type,
    }
    said |= {} if points is None else {"points": points}
    locked = {"deletable": False} if solution else {"deletable": False, "editable": False}
    made = {"cell_type": cell.cell_type, "source": cell.source, "metadata": {**locked, "nbgrader": said}}
    if cell.cell_type == "code":
        made |= {"execution_count": None, "outputs": []}
    found: NotebookNode = _node(made)
    return found


def _node(value: Any) -> Any:
    """Plain tables as nbformat's."""
    if isinstance(value, dict):
        return NotebookNode({key: _node(item) for key, item in value.items()})
    return [_node(item) for item in value] if isinstance(value, list) else value


class RestoreCells(NbGraderPreprocessor):
    """Gives a notebook of ours back the cells that were locked, whatever became of them; the student's own cells stay.

    Metadata that a student wrote would else stop the marking of one notebook or of a class, and a grade cell that is gone
    would be marked by nobody.
    """

    def preprocess(self, nb: NotebookNode, resources: ResourcesDict) -> Done:
        known = _known_cells(resources)
        if known:
            changed = restore(nb, known)
            for told in changed:
                self.log.warning("%s: %s", *map(one_line, (resources["nbgrader"]["student"], told)))
        return nb, resources


def restore(nb: NotebookNode, known: Mapping[str, NotebookNode]) -> list[str]:
    """Put the ``known`` cells in their places of a notebook; gives what had been changed."""
    told, kept, seen = [], [], set[str]()
    for cell in nb.cells:
        if not _made_whole(cell):
            told.append("a cell that is none was left out")
            continue
        name = _grade_id(cell)
        if name in known and name not in seen:
            seen.add(name)
            kept.append(_restored(cell, known[name], told))
            continue
        if "nbgrader" in cell.metadata:
            del cell.metadata["nbgrader"]
            which = f"a second cell {name}" if name in known else "a cell that was not released"
            told.append(f"{which} counts as the student's own")
        kept.append(cell)
    for place, (name, cell) in enumerate(known.items()):
        if name not in seen:
            told.append(f"the cell {name} was gone")
            kept.insert(_behind(kept, list(known)[:place]), cell)
    nb.cells = kept
    for cell in nb.cells:  # what is restored has no id, and copies have the same one
        cell.pop("id", None)
    nb.nbformat, nb.nbformat_minor = 4, 4
    return told


def _made_whole(cell: Any) -> bool:
    """Whether something is a cell; what it lacks of one is put in."""
    if not isinstance(cell, dict) or cell.get("cell_type") not in ("code", "markdown", "raw"):
        return False
    if not isinstance(cell.get("metadata"), dict):
        cell["metadata"] = NotebookNode()
    if not isinstance(cell.get("source"), str):
        cell["source"] = ""
    if cell["cell_type"] == "code":
        cell["outputs"], cell["execution_count"] = [], None
    return True


def _restored(cell: NotebookNode, known: NotebookNode, told: list[str]) -> NotebookNode:
    """A cell as it was released; the source of a solution is the student's."""
    said = known.metadata.nbgrader
    if cell.cell_type != said.cell_type or (said.locked and cell.source != known.source):
        told.append(f"the cell {said.grade_id} was changed")
    back = _node({**known, "metadata": {**cell.metadata, **known.metadata}})
    if not said.locked:
        back["source"] = cell.source
    if "attachments" in cell and cell.cell_type == back.cell_type == "markdown":
        back["attachments"] = cell.attachments
    found: NotebookNode = back
    return found


def _behind(cells: Sequence[NotebookNode], before: Sequence[str]) -> int:
    """The place behind the last of the cells that stand before one."""
    return next((place + 1 for place in reversed(range(len(cells))) if _grade_id(cells[place]) in before), 0)


# ----------------------------------------------------------------------- marking


class MarkAnswers(Execute):
    """Reads the answers cell as data and writes the points and what is said of each answer into the grade cells.

    It stands in the place of nbgrader's ``Execute``, and runs nothing of a notebook of ours; a notebook that is not ours is run
    as ``Execute`` does.
    """

    folder = Unicode(
        "",
        help="The folder of nbgrader's course, which has issued/ASSIGNMENT.json; where it runs unless told.",
    ).tag(config=True)
    course = Unicode("", help="The course that the exercises are of; the built-in one unless told.").tag(
        config=True
    )

    def preprocess(self, nb: NotebookNode, resources: ResourcesDict, km: Any = None) -> Done:
        known = _known_cells(resources)
        if not known:
            done: Done = super().preprocess(nb, resources, km)
            return done
        about = resources["nbgrader"]
        issued = Path(self.folder) / "issued" / f"{about['assignment']}.json"
        marked = marked_notebook(self.course or None, issued, about["student"], _text(nb))
        if any(name not in {_grade_id(cell) for cell in nb.cells} for name in known):
            restore(nb, known)  # where RestoreCells is not among the steps
        for told in marked.told:
            self.log.warning("%s: %s", *map(one_line, (about["student"], told)))
        for cell in nb.cells:
            self._fill(cell, known, marked)
        resources[_TOLD] = {"waiting": marked.waiting}
        return nb, resources

    def _fill(self, cell: NotebookNode, known: Mapping[str, NotebookNode], marked: MarkedNotebook) -> None:
        """What a cell shows: nothing of what the student's own had."""
        if cell.cell_type == "code":
            cell.outputs, cell.execution_count = [], None
        name = _grade_id(cell)
        if name not in known:
            return
        said = known[name].metadata.nbgrader
        if said.grade:
            cell.outputs = _node(marked.grade_outputs(name, float(said.points), self.log.warning))
        elif said.solution:
            cell.outputs = _node(marked.notes_of(name))


def _text(nb: NotebookNode) -> bytes:
    return json.dumps(nb, default=dict).encode("utf-8", "surrogatepass")


class SaveMarks(SaveAutoGrades):
    """Saves points as nbgrader does; what a person must look at is listed under Manual Grading."""

    def preprocess(self, nb: NotebookNode, resources: ResourcesDict) -> Done:
        self._waiting = frozenset(resources.get(_TOLD, {}).get("waiting", ()))
        done: Done = super().preprocess(nb, resources)
        return done

    def _add_score(self, cell: NotebookNode, resources: ResourcesDict) -> None:
        super()._add_score(cell, resources)
        name = cell.metadata["nbgrader"]["grade_id"]
        if name in self._waiting:
            grade = self.gradebook.find_grade(name, self.notebook_id, self.assignment_id, self.student_id)
            grade.needs_manual_grade = True
            self.gradebook.db.commit()
