"""A students' copy, the folder without ``solutions/``: it draws what the full course draws, and what it holds computes
no rate, acceleration or force that is asked.

A figure to scale must place the mechanism: positions that it draws stay with it, and are listed here by exercise.
"""

from __future__ import annotations

import importlib
import inspect
import math
import types
import warnings
from collections.abc import Mapping

import numpy as np
import pytest

from coursework.authoring import recorded_draws
from coursework.cli import run
from coursework.course import draws
from coursework.course.sources import imported, parsed
from coursework.errors import BadCourse, NoSolution

NAMES = __import__("coursework").open_course().names

#: What a figure to scale shows, exact as its points are: the figure of the exercise, or of another with the same linkage.
SHOWN = {
    "coupler_curve": {"theta3", "xP", "yP"}, "curved_slot": {"theta3", "theta4"}, "four_bar_motion": {"theta3", "theta4"},
    "flat_faced_cam": {"s", "q", "v"}, "havens_planetary": {"theta4", "rA"},
    "jack_mechanism": {"theta4"}, "quick_return": {"theta2", "xC"}, "quick_return_shaper": {"xC"},
    "quick_return_whitworth": {"xC"}, "slider_crank": {"theta3"}, "slider_extras": {"theta4", "r6"},
    "slotted_mechanism": {"rA", "theta4"}, "three_loop_shaper": {"theta3", "theta4", "theta5", "d5", "theta7"},
    "toggle_press": {"yC", "theta2"}, "two_loop_linkage": {"theta3", "theta4", "theta6", "theta7"},
    "two_circles": {"theta3_crossed", "theta4_crossed"},
}  # fmt: skip
SEEDS = range(6)
MOST = 64  #: numbers that are looked at of one value


def modules(exercise):
    """The modules of an exercise and of all that it imports from its course."""
    folder, met = exercise.folder, {}
    package = folder.module("exercises", exercise.name).__name__.partition(".")[0]
    waiting = [folder.home("exercises", exercise.name)]
    while waiting:
        path = waiting.pop()
        if path not in met:
            place = path.relative_to(folder.root).with_suffix("")
            met[path] = importlib.import_module(".".join((package, *place.parts)))
            waiting += imported(parsed(path), path)
    return list(met.values())


def functions(exercise):
    """By module and name, every function that a students' copy holds for an exercise: those that draw and tell apart."""
    told = {"figure", "tells"}
    return {
        (module.__name__.rpartition(".")[2], name): function
        for module in modules(exercise)
        for name, function in vars(module).items()
        if isinstance(function, types.FunctionType)
        and function.__module__ == module.__name__
        and name not in told
    }


def _needs(function):
    parameters = inspect.signature(function).parameters.values()
    return [p.name for p in parameters if p.default is p.empty and p.kind is p.POSITIONAL_OR_KEYWORD]


def computed(exercise, given):
    """What the functions give for given values and for what one another gives, by the names of their parameters; one
    that names its parameter otherwise is tried on everything found. By module and name, and what it was tried on."""
    waiting = functions(exercise)
    known, found = dict(given), {}
    for _ in range(8):
        for place, function in list(waiting.items()):
            needs = _needs(function)
            if all(n in known for n in needs):
                del waiting[place]
                value = _called(function, [known[n] for n in needs])
                if value is not None:
                    found[place] = value
                    known.setdefault(place[1], value)
    for place, function in waiting.items():
        unknown = [n for n in _needs(function) if n not in known]
        if len(unknown) == 1:
            for other, own in list(found.items()):
                arguments = {**known, unknown[0]: own}
                value = _called(function, [arguments[n] for n in _needs(function)])
                if value is not None:
                    found[*place, *other[:2]] = value
    return found


def _called(function, arguments):
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return function(*arguments)
        except Exception:
            return None  # of other arguments


def numbers(value):
    """The numbers in a value, whatever holds them: arrays, tuples in tuples, what a record computes of itself."""
    if isinstance(value, Mapping):
        value = tuple(value.values())
    if isinstance(value, tuple | list):
        properties = [n for n, p in vars(type(value)).items() if isinstance(p, property)]
        return [z for part in (*value, *(getattr(value, n) for n in properties)) for z in numbers(part)][
            :MOST
        ]
    if isinstance(value, str | bool | np.bool_ | None):
        return []
    try:
        array = np.asarray(value)
    except ValueError:
        return []
    return [complex(z) for z in array.ravel()[:MOST]] if array.dtype.kind in "fiuc" else []


def one_step(z, given):
    """A number, and what one step makes of it: its parts, size and direction, an angle of
    it, times or over a given one, more or less."""
    direct = {"": z.real, "im": z.imag, "abs": abs(z)} if z.imag else {"": z.real}
    yield from direct.items()
    yield "direction", math.degrees(math.atan2(z.imag, z.real))
    for how, value in direct.items():
        if value:
            yield f"1/{how}", 1 / value
        yield f"atan{how}", math.degrees(math.atan(value))
        if abs(value) <= 1:
            yield f"asin{how}", math.degrees(math.asin(value))
            yield f"acos{how}", math.degrees(math.acos(value))
    for name, g in given.items():
        if isinstance(g, int | float) and g:
            for how, value in direct.items():
                for step, made in (("*", value * g), ("**", value * g * g), ("/", value / g), ("+", value + g),
                                   ("-", value - g)):  # fmt: skip
                    yield f"{how}{step}{name}", made


def wanted(variant):
    """The numbers of the answers that a variant asks, by part and component; no zero, which any zero gives."""
    for part in variant.parts:
        if part.sort.is_open:
            continue
        reference = numbers(variant.reference(part.quantity))
        flat = [x for z in reference for x in ((z.real, z.imag) if z.imag else (z.real,))]
        for k, x in enumerate(flat):
            if x:
                yield part, (part.id if len(flat) == 1 else f"{part.id}[{k}]"), x


def leaks(own, copy):
    """The asked quantities that what a copy computes gives in one step at most, on every seed, each with that way.

    Counts and cases are looked for as they are: by a step, a small number is anything.
    """
    ways, values = {}, {}
    for variant in own.variants(SEEDS):
        given = dict(variant.given)
        echoes = {x for x in given.values() if not isinstance(x, str)}
        made = [
            ((place, k, how), x)
            for place, value in computed(copy, given).items()
            for k, z in enumerate(numbers(value))
            if z and z not in echoes
            for how, x in one_step(z, given)
        ]
        keys, array = [key for key, _ in made], np.array([x for _, x in made])
        for part, place, x in wanted(variant):
            off = array - x
            off = (off + 180) % 360 - 180 if part.sort.turn else off
            here = {keys[i] for i in np.flatnonzero(abs(off) <= 1e-9 * abs(x))}
            if part.sort.is_exact:
                here = {key for key in here if not key[2]}
            ways[place] = ways.get(place, here) & here
            values.setdefault(place, set()).add(x)
    return {place: min(found, key=str) for place, found in ways.items() if found and len(values[place]) > 1}


@pytest.mark.parametrize("name", NAMES)
def test_no_asked_quantity_is_a_step_from_what_the_copy_computes(course, students_copy, name):
    found = leaks(course[name], students_copy[name])
    assert {part: way for part, way in found.items() if part not in SHOWN.get(name, ())} == {}


def test_what_is_listed_leaks_still(course, students_copy):
    """The list is no longer than what is left."""
    left = {name: shown - leaks(course[name], students_copy[name]).keys() for name, shown in SHOWN.items()}
    assert not any(left.values()), left


@pytest.mark.parametrize("name", NAMES)
def test_recorded_draws_are_those_of_the_full_course(course, name):
    exercise = course[name]
    assert recorded_draws.path_of(exercise).is_file() == exercise.spec.kept_by_solution
    if exercise.spec.kept_by_solution:
        told = recorded_draws.path_of(exercise).read_text().split()
        some = range(0, recorded_draws.SEEDS, 83)
        assert len(told) == recorded_draws.SEEDS
        assert [int(told[seed]) for seed in some] == draws.places(name, exercise.drawing, some)


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_every_recorded_draw_is_that_of_the_full_course(course, name):
    assert recorded_draws.fault(course[name]) == ""


@pytest.fixture(scope="module")
def students_copy(tmp_path_factory, course):
    import shutil

    import coursework

    root = tmp_path_factory.mktemp("students")
    for kind in ("exercises", "templates"):
        shutil.copytree(course.folder.root / kind, root / kind, ignore=shutil.ignore_patterns("__pycache__"))
    return coursework.open_course(root)


@pytest.mark.parametrize("name", NAMES)
def test_the_copy_draws_what_the_full_course_draws(course, students_copy, name):
    seeds = [0, 3, 77, 999]
    here, there = course[name].variants(seeds), students_copy[name].variants(seeds)
    assert [v.record for v in there] == [v.record for v in here]


def test_beyond_its_record_the_copy_says_what_would_do(course, students_copy):
    record = course["slotted_mechanism"].variant(123_456).record
    with pytest.raises(NoSolution, match=r"seeds below 1000.*from_record"):
        students_copy["slotted_mechanism"].variant(123_456)
    assert students_copy["slotted_mechanism"].from_record(record).record == record


def _built(folder, out, *asked):
    return run(["--course", str(folder), "build", *asked, "--formats", "ipynb,html", "--out", str(out)])


@pytest.mark.parametrize("asked", [["grashof"], ["slotted_mechanism", "--roster", "{roster}"], ["{paper}"]])
def test_the_copy_issues_nothing_of_its_own(students_copy, tmp_path, capsys, asked):
    """It cannot tell which variants the full course passes over, and says what would do."""
    (tmp_path / "class.csv").write_text("student\nAda\nBo\n")
    (tmp_path / "paper.toml").write_text(
        'title = "Paper"\nroster = "class.csv"\n[[exercises]]\nname = "grashof"\n'
    )
    told = [a.format(roster=tmp_path / "class.csv", paper=tmp_path / "paper.toml") for a in asked]
    out = tmp_path / "out"
    assert run(["--course", str(students_copy.folder.root), "build", *told, "--out", str(out)]) == 2
    said = capsys.readouterr()
    assert "has no solutions/, as a students' copy" in said.err
    assert "--issued issued.json" in said.err
    assert said.err.count("\n") == 1
    assert not list(tmp_path.glob("**/issued.json"))


def test_the_copy_writes_the_sheets_of_what_was_issued(course, students_copy, tmp_path):
    (tmp_path / "class.csv").write_text("student,lang,number\nAda,en,1\nBo,fr,2\n")
    here, there = tmp_path / "here", tmp_path / "there"
    asked = "slotted_mechanism", "grashof", "--roster", str(tmp_path / "class.csv")
    assert _built(course.folder.root, here, *asked) == 0
    assert _built(students_copy.folder.root, there, "--issued", str(here / "issued.json")) == 0
    wanted = {p.relative_to(here) for p in here.rglob("*") if p.is_file() and "instructor" not in p.parts}
    made = {p.relative_to(there) for p in there.rglob("*") if p.is_file()}
    assert made == wanted
    assert len(wanted) > 8
    assert [
        p for p in wanted if p.name != ".built.json" and (here / p).read_bytes() != (there / p).read_bytes()
    ] == []


def test_what_was_issued_says_all_of_it(course, tmp_path, capsys):
    assert _built(course.folder.root, tmp_path / "a", "grashof") == 0
    assert (
        _built(course.folder.root, tmp_path / "b", "grashof", "--issued", str(tmp_path / "a/issued.json"))
        == 2
    )
    assert "name no exercises" in capsys.readouterr().err


@pytest.mark.parametrize("command", [["show"], ["variant", "--json"]])
def test_one_variant_is_shown_as_the_full_course_shows_it(course, students_copy, capsys, command):
    shown = []
    for root in (course.folder.root, students_copy.folder.root):
        assert run(["--course", str(root), *command, "slotted_mechanism", "--seed", "17"]) == 0
        shown.append(capsys.readouterr().out)
    assert shown[0] == shown[1]
    assert (
        run(["--course", str(students_copy.folder.root), *command, "slotted_mechanism", "--seed", "1000"])
        == 2
    )
    assert "seeds below 1000" in capsys.readouterr().err


def test_a_solution_that_keeps_nothing_is_told(course, monkeypatch):
    import coursework

    own = coursework.open_course()
    monkeypatch.delattr(own.folder.keep_module("slotted_mechanism"), "KEEP")
    exercise = type(own["slotted_mechanism"])("slotted_mechanism", own.folder, own, coursework.Variant)
    with pytest.raises(BadCourse, match="states no KEEP"):
        exercise.drawing  # noqa: B018  is read
