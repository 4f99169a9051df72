"""Columns of a roster that an exam uses: a table of cells as schools write them."""

from fractions import Fraction

import pytest
from tables import each_row

from coursework.errors import BadInput
from coursework.issuing.attendance import seating_faults
from coursework.issuing.exam_columns import (
    duration_text,
    extra_time_of,
    group_of,
    is_private,
    minutes_of,
    room_of,
    seat_of,
    with_extra,
)
from coursework.issuing.roster import Student, read_roster
from coursework.issuing.variant_assignment import _neighbours

THIRD, HALF, NONE = Fraction(1, 3), Fraction(1, 2), Fraction(0)


def test_extra_time_is_read_as_schools_write_it():
    cells = {
        "": NONE,
        "no": NONE,
        "Non": NONE,
        "0": NONE,
        "x": THIRD,
        "Oui": THIRD,
        "YES": THIRD,
        "1": THIRD,
        "1/3": THIRD,
        "33 %": THIRD,
        "33,33%": THIRD,
        "0,33": THIRD,
        "Un tiers": THIRD,
        "Tiers-temps": THIRD,
        "+1/3": THIRD,
        "1/2": HALF,
        "50 %": HALF,
        "0.5": HALF,
        "25%": Fraction(1, 4),
    }
    assert {text: extra_time_of({"Tiers temps": text}) for text in cells} == cells


@each_row("text", ["20 min", "3/2", "1/0", "maybe", "-1/3", "300 %", "1e9", "²", "1/3/3", "9" * 50])
def test_an_unclear_extra_time_is_refused(text):
    with pytest.raises(BadInput, match="extra time is"):
        extra_time_of({"extra_time": text})


def test_columns_are_found_by_their_titles_in_both_languages():
    french = {"Groupe": "TD 3", "Salle": "Amphi  A", "N° de place": " B12 ", "tiers_temps": "oui"}
    english = {"group": "TD 3", "Room": "Amphi A", "seat": "B12", "extra_time": "yes"}
    for row in (french, english):
        assert (group_of(row), room_of(row), seat_of(row), extra_time_of(row)) == (
            "TD 3",
            "Amphi A",
            "B12",
            THIRD,
        )


def test_a_duration_is_lengthened_in_whole_minutes():
    durations = {
        "1 h 30": 90,
        "1h30": 90,
        "1 H 30 min": 90,
        "90 min": 90,
        "90 minutes": 90,
        "2 h": 120,
        "2 heures": 120,
        "1 hour 30 minutes": 90,
        "1 heure et 30 minutes": 90,
        "two hours": None,
        "": None,
        "90": None,
    }
    assert {text: minutes_of(text) for text in durations} == durations
    lengthened = [duration_text(with_extra(minutes, THIRD)) for minutes in (90, 45, 50, 95)]
    assert lengthened == ["2 h", "1 h", "1 h 07", "2 h 07"]
    assert duration_text(45) == "45 min"


def test_columns_about_birth_and_health_are_private_and_names_and_numbers_are_not():
    private = [
        "Date de naissance",
        "Né(e) le",
        "Né le",
        "birth date",
        "Born",
        "Tiers temps",
        "extra_time",
        "Aménagements",
        "RQTH",
        "Handicap",
    ]
    public = [
        "Groupe",
        "Numéro",
        "Nom de naissance",
        "Salle",
        "Session",
        "Année",
        "INE",
        "Besançon",
        "panier",
        "E-mail",
    ]
    assert [t for t in private if not is_private(t)] == []
    assert [t for t in public if is_private(t)] == []


def test_a_roster_with_an_unreadable_extra_time_is_refused_with_its_line(tmp_path):
    path = tmp_path / "class.csv"
    path.write_text("student,extra_time\nAnn,x\nBo,a bit\n")
    with pytest.raises(BadInput, match=r"line 3: extra time is yes, no or a share .* found 'a bit'"):
        read_roster(path)


def test_the_same_seat_in_another_room_is_no_neighbour():
    seats = [("A", "B1"), ("B", "C9"), ("B", "B2"), ("C", "D9"), ("A", "B2")]
    roster = [Student(f"S{n}", columns={"room": room, "seat": seat}) for n, (room, seat) in enumerate(seats)]
    near = _neighbours(roster, lambda student: student.name)
    assert "S4" in near["S0"]
    assert "S2" not in near["S0"]


def test_seats_that_two_have_and_students_without_a_room_are_noted():
    places = {"Ada": ("A", "B1"), "Bo": ("A", "b1"), "Cy": ("B", "B1"), "Di": ("", "")}
    students = [
        Student(name, columns={"salle": room, "place": seat}) for name, (room, seat) in places.items()
    ]
    assert [str(note) for note in seating_faults(students)] == [
        "the roster gives the seat A B1 to 2 students: Ada, Bo",
        "1 student without a room: Di",
    ]
    assert list(seating_faults(students[2:3])) == list(seating_faults([Student("Eve")])) == []
