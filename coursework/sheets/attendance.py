"""Lists of an exam: who sits where, and who signs."""

from __future__ import annotations

from dataclasses import dataclass

from coursework.sheets.paper import PaperHeading


@dataclass(frozen=True)
class ListedStudent:
    """Line of a list of an exam; a cell is empty where the roster or the assignment has none."""

    name: str
    room: str = ""
    seat: str = ""
    number: str = ""
    group: str = ""
    code: str = ""  #: that stands on the paper in place of the name
    version: str = ""
    time: str = ""  #: as printed, of a student with extra time


@dataclass(frozen=True)
class RoomList:
    """Students of a room, in the order of their seats."""

    room: str  #: empty where the roster names none
    students: tuple[ListedStudent, ...]

    def has(self, column: str) -> bool:
        """Return whether a student has a cell of this name."""
        return any(getattr(student, column) for student in self.students)


@dataclass(frozen=True)
class ExamLists:
    """Lists of an exam in a language."""

    heading: PaperHeading
    rooms: tuple[RoomList, ...]

    @property
    def everybody(self) -> RoomList:
        """All students in the order of their names, for the door: without codes, versions and extra time."""
        students = (student for room in self.rooms for student in room.students)
        public = [ListedStudent(s.name, s.room, s.seat, s.number, s.group) for s in students]
        return RoomList("", tuple(sorted(public, key=lambda student: student.name.casefold())))
