"""Mechanisms' files to start from, and the report on one without any exercise."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from coursework.authoring.scaffold import check_name, course_files
from coursework.course.exercise import CourseExercise
from coursework.errors import BadInput, nearest, reason_of, unknown
from coursework.linkages.compiled import CompiledLinkage, compiled
from coursework.linkages.groups import Dyad, Wheel
from coursework.linkages.points import value_of
from coursework.messages import Message
from coursework.structure.assour import roman
from coursework.structure.grashof import linkage_type
from coursework.system.toml_files import source_of
from coursework.system.writing import write_whole

LINKAGES = Path(__file__).parent / "linkages"  #: a course of mechanisms to start from
_DEGREES = 1.0  #: between two positions at which a mechanism is tried


def linkage_names() -> tuple[str, ...]:
    """Return the names of the mechanisms to start from."""
    return tuple(sorted(p.stem for p in (LINKAGES / "exercises").glob("*.toml") if p.stem != "course"))


def new_linkage(folder: Path, linkage: str, name: str, langs: Collection[str]) -> list[Path]:
    """Write a mechanism's file into a course folder, which is made if need be.

    Parameters
    ----------
    folder
        Folder of the course.
    linkage
        One of :func:`linkage_names`.
    name
        Name of the exercise.
    langs
        Languages of a course that is made.

    Returns
    -------
    The files written.

    Raises
    ------
    UnknownName
        There is no such mechanism.
    BadInput
        The name cannot be an exercise's, or is taken.
    """
    if linkage not in linkage_names():
        raise unknown("mechanism", linkage, linkage_names(), "--linkage")
    return _written(folder, name, (LINKAGES / "exercises" / f"{linkage}.toml").read_text("utf-8"), langs)


def _written(folder: Path, name: str, text: str, langs: Collection[str]) -> list[Path]:
    check_name(name)
    written = []
    if not (folder / "exercises").is_dir():
        for path, content in course_files(folder, langs).items():
            write_whole(path, content)
            written.append(path)
    target = folder / "exercises" / f"{name}.toml"
    if target.exists() or target.with_suffix(".py").exists():
        raise BadInput("{target} exists already; choose another name", target=target)
    write_whole(target, text.encode("utf-8"))
    return [*written, target]


# --------------------------------------------------------------------------- report


@contextmanager
def mechanism_alone(
    path: Path, opened: Callable[[Path], Any]
) -> Iterator[tuple[CourseExercise[Any], CompiledLinkage]]:
    """Provide the exercise of a mechanism's file that stands in no course; one that asks nothing is asked its
    mobility.

    Parameters
    ----------
    path
        The file.
    opened
        A function that opens a course's folder.

    Raises
    ------
    BadCourse
        The file states what makes no sense, with the line.
    """
    with tempfile.TemporaryDirectory() as place:
        exercises = Path(place) / "exercises"
        exercises.mkdir()
        name = path.stem if path.stem.isidentifier() else "mechanism"
        copy = exercises / f"{name}.toml"
        text = source_of(path)
        asks = any(line.strip().startswith("[ask]") for line in text.splitlines())
        copy.write_text(text if asks else f"{text}\n[ask]\nclass = true\n", "utf-8")
        made = compiled(copy, str(path))
        yield opened(Path(place))[name], made


def report(exercise: CourseExercise[Any], made: CompiledLinkage, seed: int) -> list[dict[str, Any]]:
    """Return what a mechanism is, as rows of a table.

    Parameters
    ----------
    exercise, made
        The mechanism, as an exercise and compiled.
    seed
        Seed of the variant whose values stand for quantities that are drawn.

    Returns
    -------
    Rows of property and value.
    """
    linkage, formulas = made.linkage, made.formulas
    given = dict(exercise.variant(seed).given)
    rows: list[tuple[str, Any]] = [
        (Message("degrees of freedom"), linkage.mobility),
        (Message("moving bodies"), ", ".join([*linkage.bodies, *filter(None, [linkage.drive.rod])])),
        (Message("groups, in order of assembly"), "; ".join(map(_group, formulas.groups)) or "-"),
    ]
    if not linkage.gears:
        rows.append((Message("class"), roman(formulas.rank)))
    if kind := _grashof(made, exercise, given):
        rows.append((Message("four-bar linkage"), kind))
    places, unit = np.arange(-180.0, 180.0, _DEGREES), "°"
    if linkage.drive.kind != "turn":
        around = 0.5 * given[linkage.moved], 1.5 * given[linkage.moved]
        low, high = (given[n] if n else end for n, end in zip(linkage.drive.limits, around, strict=True))
        places, unit = np.linspace(low, high, 361), " mm"
    names = [*formulas.followed_turns]
    distances = [s.distance for s in linkage.followed_slides]
    found = (
        exercise.solve(only=[*names, *distances], **{**given, linkage.moved: places})
        if names or distances
        else {}
    )
    closed = (
        np.all([np.isfinite(np.broadcast_to(v, places.shape)) for v in found.values()], axis=0)
        if found
        else places == places
    )
    label = Message("the driver turns") if unit == "°" else Message("the driving length goes")
    rows.append((label, _range(places, np.broadcast_to(closed, places.shape), unit)))
    for name, values in found.items():
        along = np.broadcast_to(np.asarray(values, dtype=float), places.shape)[closed]
        if not len(along):
            continue
        if name in names:
            along, own = np.unwrap(along, period=360), "°"
            if np.ptp(along) > 355:
                rows.append((Message("{name} over the motion", name=name), Message("turns all round")))
                continue
        else:
            own = " mm"
        # Rounding moves nothing: a body that stands still has one place.
        ends = (f"{value:.4g}{own}" for value in np.round([along.min(), along.max()], 9) + 0.0)
        rows.append((Message("{name} over the motion", name=name), " … ".join(dict.fromkeys(ends))))
    return [{"property": name, "value": value} for name, value in rows]


def _group(group: Any) -> str:
    if isinstance(group, Dyad):
        return f"{group.p}, {group.q} ({group.kind})"
    return f"{', '.join(group.bodies)}" + ("" if isinstance(group, Wheel) else f" ({roman(group.rank)})")


def _grashof(made: CompiledLinkage, exercise: CourseExercise[Any], given: Mapping[str, Any]) -> str:
    """Return the type of a mechanism that is a four-bar linkage; '' for any other."""
    linkage, groups = made.linkage, made.formulas.groups
    if (
        linkage.drive.kind != "turn"
        or len(groups) != 1
        or not isinstance(groups[0], Dyad)
        or groups[0].kind != "RRR"
    ):
        return ""
    dyad = groups[0]
    points = [str(dyad.outer_p), str(dyad.outer_q)]
    A = next((p for p in points if p not in linkage.ground), "")
    C = next((p for p in points if p in linkage.ground), "")
    if not A or not C:
        return ""
    pivot = linkage.bodies[linkage.driver].at
    names = [f"{axis}{p}" for p in (A, str(dyad.inner)) for axis in "xy"]
    found = exercise.solve(only=names, **given)
    z = {p: complex(found[f"x{p}"], found[f"y{p}"]) for p in (A, str(dyad.inner))}
    fixed = {p: _fixed(made, p, given) for p in (pivot, C)}
    B = z[str(dyad.inner)]
    lengths = abs(fixed[C] - fixed[pivot]), abs(z[A] - fixed[pivot]), abs(B - z[A]), abs(B - fixed[C])
    return str(linkage_type(*(round(length, 9) for length in lengths)))


def _fixed(made: CompiledLinkage, point: str, given: Mapping[str, Any]) -> complex:
    return value_of(
        made.formulas.local(point, "ground"), {n: v for n, v in given.items() if not isinstance(v, str)}
    )


def _range(places: np.ndarray, closed: np.ndarray, unit: str) -> object:
    """Return where the driver can stand."""
    if closed.all() and unit == "°":
        return Message("all round")
    if unit != "°":  # a length does not come round
        places, closed = (np.append(v, more) for v, more in ((places, places[-1]), (closed, False)))
    if not closed.any():
        return Message("nowhere: the mechanism does not close for these values")
    starts = np.flatnonzero(closed & ~np.roll(closed, 1))
    ends = np.flatnonzero(closed & ~np.roll(closed, -1))
    pairs = []
    for start in starts:
        end = next((e for e in ends if e >= start), ends[0])
        last = places[end] + (360 if end < start else 0)
        pairs.append(f"{places[start]:.0f}{unit} … {last:.0f}{unit}")
    return "; ".join(pairs)


# -------------------------------------------------------------------------- pylinkage


def from_pylinkage(path: Path) -> str:
    """Return a mechanism's file of a linkage that pylinkage wrote as JSON.

    Parameters
    ----------
    path
        The JSON file.

    Returns
    -------
    TOML.

    Raises
    ------
    BadInput
        It is no such file, or has a joint that has no counterpart; the message names it.
    """
    try:
        data = json.loads(path.read_text("utf-8-sig"))
        joints = data["joints"]
        listed = {str(j["name"]): j for j in joints}
    except OSError as fault:
        raise BadInput("{file} cannot be read: {problem}", file=path, problem=reason_of(fault)) from fault
    except (ValueError, KeyError, TypeError, AttributeError) as fault:
        raise BadInput(
            "{file} is not a linkage of pylinkage: it has no joints, or is not JSON", file=path
        ) from fault
    return _Imported(path, str(data.get("name") or path.stem), listed).text()


class _Imported:
    """Linkage of pylinkage on its way to a mechanism's file; its units are taken for centimetres, times
    ten."""

    def __init__(self, path: Path, name: str, joints: Mapping[str, Mapping[str, Any]]) -> None:
        self.path, self.name, self.joints = path, name, joints
        self.points: dict[str, str] = {}  #: letters by the joints' own names
        self.places: dict[str, complex] = {}
        self.ground: list[str] = []
        self.bodies: list[str] = []
        self.sides: list[str] = []
        self.given: list[str] = []

    def text(self) -> str:
        """Return the file."""
        for name, joint in self.joints.items():
            self._add(name, joint)
        if len([b for b in self.bodies if "theta2" in b]) != 1:
            raise BadInput(
                "{file}: one joint of type Crank drives; found {count}",
                file=self.path,
                count=len([b for b in self.bodies if "theta2" in b]),
            )
        lines = [
            f'title = {{ fr = "{self.name}", en = "{self.name}" }}',
            "",
            "[given]",
            *self.given,
            'omega2 = "10 rad/s"',
            "",
            "[ground]",
            *self.ground,
            "",
            "[bodies]",
            *self.bodies,
        ]
        if self.sides:
            lines += ["", "[assembly]", *self.sides]
        asked = [
            f'"{self.points[n]}"'
            for n in self.joints
            if self.joints[n].get("type") not in ("Static", "Crank")
        ]
        lines += ["", "[ask]", "mobility = true", f"positions = [{', '.join(asked[-2:])}]", ""]
        return "\n".join(lines)

    def _add(self, name: str, joint: Mapping[str, Any]) -> None:
        kind = str(joint.get("type"))
        if name in self.points:
            return
        if kind not in ("Static", "Crank", "Fixed", "Revolute", "Pivot"):
            known = ("Static", "Crank", "Fixed", "Revolute")
            raise BadInput(
                "{file}: joint {name} is of type {kind}{near}; there are {known}",
                file=self.path,
                name=name,
                kind=kind,
                near=nearest(kind, known),
                known=", ".join(known),
            )
        ends = [self._reference(joint, key) for key in ("joint0", "joint1")]
        point = self.points[name] = self._letter()
        self.places[point] = complex(float(joint.get("x") or 0.0), float(joint.get("y") or 0.0)) * 10
        if kind == "Static":
            self._static(point)
        elif kind == "Crank":
            self._crank(point, ends[0], joint)
        elif kind == "Fixed":
            self._fixed(point, ends, joint)
        else:
            self._pair(point, ends, joint)

    def _letter(self) -> str:
        used = len(self.points)
        letters = "OABCDEFGHKLMNPQRSTUVWXYZ"
        return letters[used % len(letters)] + (str(used // len(letters) + 1) if used >= len(letters) else "")

    def _reference(self, joint: Mapping[str, Any], key: str) -> str:
        """Return the letter of a joint that another hangs on; one that stands inline becomes a point of the
        ground."""
        value = joint.get(key)
        if value is None:
            return ""
        if isinstance(value, Mapping) and value.get("inline"):
            point = self._letter()
            self.points[f"{joint.get('name')} {key}"] = point
            self.places[point] = complex(float(value.get("x") or 0.0), float(value.get("y") or 0.0)) * 10
            self._static(point)
            return point
        name = str(value.get("ref") if isinstance(value, Mapping) else value)
        if name not in self.joints:
            raise BadInput(
                "{file}: no joint {name!r}{near}", file=self.path, name=name, near=nearest(name, self.joints)
            )
        self._add(name, self.joints[name])
        return self.points[name]

    def _static(self, point: str) -> None:
        place = self.places[point]
        self.ground.append(f'{point} = ["{place.real:.9g} mm", "{place.imag:.9g} mm"]')

    def _length(self, joint: Mapping[str, Any], key: str, start: str, point: str) -> float:
        value = joint.get(key)
        return float(value) * 10 if value else abs(self.places[point] - self.places[start])

    def _crank(self, point: str, start: str, joint: Mapping[str, Any]) -> None:
        length = self._length(joint, "distance", start, point)
        angle = np.degrees(np.angle(self.places[point] - self.places[start]))
        self.given.append(
            f'theta2 = {{ from = "{round(angle)} deg", to = "{round(angle) + 355} deg", step = "5 deg" }}'
        )
        self.bodies.append(
            f'2 = {{ at = "{start}", angle = "theta2", points = {{ {point} = "{length:.9g} mm" }} }}'
        )

    def _number(self) -> int:
        return len(self.bodies) + 2

    def _pair(self, point: str, ends: list[str], joint: Mapping[str, Any]) -> None:
        lengths = [self._length(joint, f"distance{k}", end, point) for k, end in enumerate(ends)]
        number = self._number() if any("theta2" in b for b in self.bodies) else self._number() + 1
        for k, (end, length) in enumerate(zip(ends, lengths, strict=True)):
            self.bodies.append(
                f'{number + k} = {{ at = "{end}", points = {{ {point} = "{length:.9g} mm" }} }}'
            )
        start, end = ends
        z, p, q = (self.places[x] for x in (point, start, end))
        side = "left" if ((q - p).conjugate() * (z - p)).imag >= 0 else "right"
        self.sides.append(f'{point} = "{side} of {start} -> {end}"')

    def _fixed(self, point: str, ends: list[str], joint: Mapping[str, Any]) -> None:
        """Add a point to the body that holds both ends."""
        start, end = ends
        for number, body in enumerate(self.bodies):
            if f'at = "{start}"' in body and f"{{ {end} = " in body:
                length = self._length(joint, "distance", start, point)
                angle = np.degrees(float(joint.get("angle") or 0.0))
                place = f'{point} = {{ r = "{length:.9g} mm", angle = "{angle:.9g} deg" }}'
                self.bodies[number] = body.replace(" } }", f", {place} }} }}")
                return
        raise BadInput(
            "{file}: joint {name} is fixed to {start} and {end}, which are not the ends of one bar",
            file=self.path,
            name=point,
            start=start,
            end=end,
        )


def new_from_pylinkage(folder: Path, path: Path, name: str, langs: Collection[str]) -> list[Path]:
    """Write the mechanism's file of a linkage that pylinkage wrote; as :func:`new_linkage`."""
    return _written(folder, name, from_pylinkage(path), langs)
