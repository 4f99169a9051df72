"""Interface of all kinds of parts: reading, judging, printing, and the spellings of students.

A part says its kind by a word, and the word is the stem of a file of this room: ``number`` is
:mod:`coursework.kinds.number`. A course may bring kinds of its own: a class derived from :class:`Kind` that
an exercise imports is known by its ``name``.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Protocol

import numpy as np

from coursework.errors import BadCourse, WrongValue, nearest

if TYPE_CHECKING:
    from coursework.parsing.reading import Reading


class Stated(Protocol):
    """Attributes of a part that a kind reads."""

    @property
    def id(self) -> str: ...
    @property
    def quantity(self) -> str: ...
    @property
    def unit(self) -> str: ...
    @property
    def choices(self) -> tuple[str, ...]: ...
    @property
    def variables(self) -> tuple[str, ...]: ...
    @property
    def parameters(self) -> tuple[str, ...]: ...
    @property
    def has_margin(self) -> bool: ...
    @property
    def room(self) -> Any: ...
    def half_width(self, reference: float) -> float: ...


class Asking(Protocol):
    """Attributes of the variant of a part that a kind may read."""

    def labels(self, part: Any) -> Mapping[str, Any]:
        """Return the labels of each case of a choice."""

    def letters(self, part: Any) -> Mapping[str, str]:
        """Return the letters of a choice by case, in the order printed; none where the sheet has none."""

    @property
    def stated(self) -> Mapping[str, tuple[float, str]]:
        """The numbers that the statement gives by their names, each with its unit."""

    def reference(self, quantity: str) -> Any:
        """Return a reference value: a vector has as many coordinates as its reference."""


class Tick(NamedTuple):
    """A box to tick on paper that is read back."""

    case: str
    printed: str  #: beside the box, Markdown: a letter, a symbol; nothing where the engine has a word for it


class ComponentBox(NamedTuple):
    """A box for one component of an answer."""

    symbol: str  #: LaTeX before it
    unit: str  #: as a part states it; ``1`` for none


class AnswerSpelling(NamedTuple):
    """A right answer in one of the ways that people write it; ways of one name stand on one sheet."""

    way: str  #: exact, printed, comma or edge
    answer: Any


class Kind(ABC):
    """One kind of part. A newcomer has a ``name``, reads, measures a distance, and says how a value is
    written; where the rest differs from what stands here, it says so."""

    name: ClassVar[str] = ""  #: the word by which a part asks for it
    goes_with: ClassVar[tuple[str, ...]] = ()  #: fields of a part that come with this kind, and must
    unit: ClassVar[str] = "1"  #: of a part that states none

    is_exact: ClassVar[bool] = False  #: judged by identity: no tolerance
    is_text: ClassVar[bool] = False  #: words or symbols, not numbers
    is_scalar: ClassVar[bool] = False  #: one number, whole or not
    #: One number measured: its sign, its unit may be mistaken, and it has a curve.
    is_number: ClassVar[bool] = False
    turn: ClassVar[float] = 0.0  #: after which values are the same, in the part's unit; 0 for none
    #: A student goes on from it, and it follows from what was answered before.
    is_followed: ClassVar[bool] = False
    #: It follows from what was answered before, and nobody goes on from it.
    goes_on_only: ClassVar[bool] = False
    has_few_values: ClassVar[bool] = False  #: so few that many mistakes lead to the same one
    disproves: ClassVar[bool] = True  #: a right answer shows that a mistake was not made that would change it
    rounds: ClassVar[bool] = True  #: rounding on the way widens its margin, which has the part's unit
    rank: ClassVar[int] = 0  #: axes of one value: 1 for a vector, 2 for a matrix
    of_largest: ClassVar[bool] = False  #: a relative tolerance is of the largest entry, and holds for each
    is_open: ClassVar[bool] = False  #: a person marks it, and the solution need not give it
    #: On the sheet, of a part that states none; a part of another kind has no such room.
    room: ClassVar[Any] = None
    most_lines: ClassVar[int] = 0  #: of its room, where that is a number of lines
    #: On paper that is read back: number (a row of boxes a coordinate), ticks, written, drawing.
    field: ClassVar[str] = "number"
    #: Whether such a row has boxes behind the point, and for a power of ten.
    has_decimals: ClassVar[bool] = True
    has_several_ticks: ClassVar[bool] = False  #: whether more than one box may be ticked
    lines: ClassVar[int] = 1  #: to write on there, of a part that has no room of its own
    has_rule: ClassVar[bool] = False  #: the sheet says how its points are counted
    share_stands: ClassVar[bool] = False  #: a named mistake leaves at least the :meth:`share` that is right

    has_symbol: ClassVar[bool] = True  #: the quantity's symbol stands before the box
    #: Feedback calls it so too; else by the number of the question.
    is_called_by_symbol: ClassVar[bool] = True
    box: ClassVar[str] = "usual"  #: room for the answer: usual, wide, line, lines, blank, millimetre
    has_cells: ClassVar[bool] = False  #: on a page, a box for each component stands for the one line
    #: Letters before their units, where a question may ask in another order.
    columns: ClassVar[tuple[str, ...]] = ()
    #: How it is predicted before it is computed: quadrant, guess, size; nothing for not at all.
    prediction: ClassVar[str] = ""
    family: ClassVar[str] = "number"  #: in the words for a student alone whose answer cannot be read

    wrong: ClassVar[str] = "wrong"  #: the sentence for an answer that nothing explains
    unitless: ClassVar[str] = "wrong_unit_ratio"  #: the sentence for a unit where there is none
    #: Faults of which the piece that stops the reading is quoted.
    quoted: ClassVar[tuple[str, ...]] = ("unknown_unit",)
    #: Faults whose message is that of another.
    faults: ClassVar[Mapping[str, str]] = {"unknown_symbol": "not_a_number"}
    #: By language, the form of an answer, where the engine's words have none.
    hint: ClassVar[Mapping[str, str]] = {}

    def __init_subclass__(cls, **more: Any) -> None:
        super().__init_subclass__(**more)
        if cls.name:
            _known[cls.name] = cls()

    @property
    def follows(self) -> bool:
        """Return whether a value may follow from a student's earlier answers."""
        return self.is_followed or self.goes_on_only

    # ------------------------------------------------------------------ reading

    @abstractmethod
    def read(self, answer: Any, part: Stated, asking: Asking) -> Reading:
        """Return the reading of an answer."""

    def kept(self, read_as: str) -> Any:
        """Return the value of an answer that is known to be right, from its echo."""
        return float(read_as.partition(" ")[0])

    # ------------------------------------------------------------------ judging

    @abstractmethod
    def distance(
        self, part: Stated, value: Any, reference: Any, along: Any = None, envelope: float = 0.0
    ) -> float:
        """Return the distance of a value from a reference, as a multiple of the accepted half-width: right up
        to 1.

        The half-width is the part's own, or the ``envelope`` where that is wider.
        """

    def accepted(self, values: np.ndarray, references: np.ndarray, half_widths: np.ndarray) -> np.ndarray:
        """Return which values of a column in plain digits are right, by the rule of :meth:`distance`, shapes
        ``(n,)``; NaN is never right, and a kind that does not mark columns accepts none."""
        return np.zeros(np.shape(values), dtype=bool)

    @classmethod
    def marks_columns(cls) -> bool:
        """Return whether the rule for columns belongs to the class that also defines reading and distance; a
        subclass that changes these for one answer must not mark columns."""
        definer = next(base for base in cls.__mro__ if "accepted" in vars(base))
        return definer is not Kind and all(
            getattr(cls, rule) is getattr(definer, rule) for rule in ("read", "distance")
        )

    def apart(
        self, part: Stated, value: Any, reference: Any, along: Any = None, envelope: float = 0.0
    ) -> float:
        """Return the distance of two values that the solution gives, one of them by a mistake."""
        return self.distance(part, value, reference, along, envelope)

    def size(self, reference: Any) -> float:
        """Return the size that a relative tolerance is a share of."""
        return abs(reference) if isinstance(reference, float) else float(np.linalg.norm(reference))

    def is_trivial(self, value: Any) -> bool:
        """Return whether nothing follows from such a value."""
        return not self.is_exact and not value

    def share(self, part: Stated, value: Any, reference: Any) -> float:
        """Return the share of the points that an answer earns which is not wholly right, and which no mistake
        explains."""
        return 0.0

    def checked_room(self, room: Any) -> Any:
        """Return the room that a part states, or why it is none, as a :class:`WrongValue`."""
        is_number = isinstance(room, int) and not isinstance(room, bool)
        if self.most_lines and not (is_number and 1 <= room <= self.most_lines):
            raise WrongValue(f"its room is a number of lines, 1 to {self.most_lines}; found {room!r}")
        return room

    def slips(self, part: Stated, value: Any, reference: Any, numbers: Mapping[str, float]) -> Iterator[str]:
        """Slips of this kind alone that explain a wrong value; ``numbers`` are the given ones that are no
        angles."""
        yield from ()

    def others(self, part: Stated, value: Any, half_width: float) -> tuple[Any, ...]:
        """Wrong values for a right one: just beyond what is accepted, and far from it; few cases have one
        other."""
        return ()

    def remarks(self, part: Stated, value: Any, reference: Any, lang: str) -> Iterator[tuple[str, str]]:
        """Yield further sentences on an unexplained answer, each with the filling of its ``{list}``."""
        yield from ()

    # ----------------------------------------------------------------- printing

    def called(self, case: str, lang: str) -> str:
        """Return the engine's label for a case that the statement need not name; an empty text if the
        statement must."""
        return ""

    def words(self, value: Any, label: Callable[[str], str]) -> str:
        """Return a reference in words, Markdown, where it is not a formula; ``label`` calls its cases."""
        return ""

    def units(self, unit: str) -> tuple[str, ...]:
        """Return the units that an answer to a part of this unit is in: one, or one a column."""
        return (unit,)

    def keys(self, part: Stated) -> tuple[str, ...]:
        """Return what an answer needs and keyboards of numbers lack, each as a page inserts it; ``,`` for the
        decimal sign."""
        if self.is_text or self.is_open:
            return ()
        return "-", ",", "(", ")", "^", "√(", "π", *(("°",) if part.unit == "deg" else ())

    def units_asked(self, part: Stated, asking: Asking) -> tuple[int, ...]:
        """Return the places in :meth:`units` of the columns, in the order in which the question asks for
        them."""
        return tuple(range(len(self.units(part.unit))))

    def cells(self, part: Stated, asking: Asking) -> tuple[tuple[ComponentBox, ...], ...]:
        """Return the boxes for the components in the order of :meth:`coordinates`, in groups that stand
        together."""
        return (tuple(ComponentBox(symbol, part.unit) for symbol in self.coordinates(part, asking)),)

    def formula(self, value: np.ndarray, number: Callable[[float], str]) -> str:
        """Return a reference that is an array, as a formula without its unit; nothing where its entries say
        enough."""
        return ""

    def latex(self, value: str, symbols: Mapping[str, str]) -> str:
        """Return a reference that is a text, as a formula; nothing where it is none."""
        return ""

    # ------------------------------------------------- paper that is read back

    def coordinates(self, part: Stated, asking: Asking) -> tuple[str, ...]:
        """Return the LaTeX before each row of boxes; empty before the one row of a plain number."""
        return ("",)

    def ticks(self, part: Stated, asking: Asking) -> tuple[Tick, ...]:
        """Return the boxes to tick, in the order printed."""
        return ()

    def from_paper(self, boxes: Sequence[str], part: Stated, asking: Asking, *, unit: bool = False) -> str:
        """Return the answer that a page says, as :meth:`read` takes it: of the number of each row, or of the
        ticked cases; ``unit``: the box beside the printed unit is ticked."""
        behind = f" {part.unit}" if unit and part.unit != "1" else ""
        return f"{self.joined(boxes, part, asking)}{behind}"

    def joined(self, texts: Sequence[str], part: Stated, asking: Asking) -> str:
        """Return the numbers of the rows as one text."""
        return texts[0] if len(texts) == 1 else "(" + " ; ".join(texts) + ")"

    # ----------------------------------------------------------------- students

    @abstractmethod
    def written(self, value: Any, digits: int, label: Callable[[str], str]) -> str:
        """Return a right answer as a careful student writes it, without its unit, to so many significant
        digits."""

    def comma(self, written: str) -> str:
        """Return the same with decimal commas."""
        return written if self.is_text else written.replace(".", ",")

    def spellings(self, part: Stated, value: Any, label: Callable[[str], str]) -> Iterator[AnswerSpelling]:
        """Yield a right answer in the ways people write it."""
        printed = self.written(value, 6, label)
        yield AnswerSpelling("exact", value)
        yield AnswerSpelling("printed", printed)
        if self.comma(printed) != printed:
            yield AnswerSpelling("comma", self.comma(printed))


_known: dict[str, Kind] = {}
_ROOM = Path(__file__).parent


def kinds() -> tuple[str, ...]:
    """Return the names of the kinds there are: those of this room, and those that courses brought."""
    for path in _ROOM.glob("*.py"):
        import_module(f"coursework.kinds.{path.stem}".removesuffix(".__init__"))
    return tuple(sorted(_known))


def kind_of(name: str) -> Kind:
    """Return the kind of a name.

    Raises
    ------
    BadCourse
        There is none; with the nearest name.
    """
    if name not in _known and name.isidentifier() and (_ROOM / f"{name}.py").exists():
        import_module(f"coursework.kinds.{name}")
    if name not in _known:
        raise BadCourse(f"no kind {name!r}{nearest(name, kinds())}")
    return _known[name]
