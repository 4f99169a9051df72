"""Reader of a mechanism's file: its tables as bodies, joints, given quantities and questions, each fault with
its line."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from coursework.errors import BadCourse, BadInput, CourseworkError, nearest
from coursework.linkages.entries import (
    AssemblyEntry,
    BodyEntry,
    DriverEntry,
    GivenEntry,
    LinkageFile,
    LoadEntry,
    NearEntry,
)
from coursework.linkages.expressions import amount
from coursework.linkages.joint_reader import JointReader
from coursework.linkages.linkage_faults import linkage_faults
from coursework.linkages.table_reader import NAME
from coursework.messages import Message, as_message
from coursework.system.toml_files import source_of, table_of

KEYS = (
    "title",
    "version",
    "given",
    "ground",
    "bodies",
    "slides",
    "jacks",
    "gears",
    "assembly",
    "ask",
    "known",
)
ASKED = (
    "mobility",
    "class",
    "positions",
    "equations",
    "velocities",
    "accelerations",
    "polygon",
    "instant_centres",
    "advantage",
    "torque",
    "thrust",
    "points",
)
_MOST_CHARACTERS = 60_000  #: of a file
_MOST_POINTS = 1000  #: that a question is worth
_SIDE = re.compile(r"\s*(left|right)\s+of\s+([A-Z]\d*)\s*->\s*([A-Z]\d*)\s*\Z")
_AHEAD = re.compile(r"\s*(ahead of|behind)\s+([A-Z]\d*)\s*\Z")


@contextmanager
def author_faults() -> Iterator[None]:
    """Raise what is wrong in a file as an error of the course."""
    try:
        yield
    except BadCourse:
        raise
    except CourseworkError as fault:
        raise BadCourse("{problem}", problem=as_message(fault)) from fault


def read_linkage(path: Path, shown: str = "") -> LinkageFile:
    """Read a mechanism's file.

    Parameters
    ----------
    path
        The file.
    shown
        Its name in messages; by default its path.

    Returns
    -------
    The mechanism.

    Raises
    ------
    BadCourse
        It cannot be read, or states what makes no sense: with the line, what was found and what would do.
    """
    with author_faults():
        source = source_of(path)
        name = Path(shown or path)
        if len(source) > _MOST_CHARACTERS:
            raise BadInput(
                "{source_name} has {count} characters; such a file has at most {most}",
                source_name=name,
                count=len(source),
                most=_MOST_CHARACTERS,
            )
        return _LinkageReader(name, source, table_of(source, str(name))).linkage()


class _LinkageReader(JointReader):
    """Reader of the tables of a mechanism."""

    def linkage(self) -> LinkageFile:
        self.only(self.table, KEYS)
        title = self._title()
        given = self._given()
        ground = self._places(("ground",))
        if not ground:
            raise self.refused(("ground",), 'the ground has points: [ground], then O = ["0 mm", "0 mm"]')
        bodies = self._bodies(ground)
        jacks = self._jacks(ground, bodies, given)
        bodies = {**bodies, **{name: entry for name, (entry, _) in jacks.items()}}
        slides = self._slides(ground, bodies, given)
        drive = self._driver(bodies, slides, [d for _, d in jacks.values()], given)
        assembly, near = self._assembly(drive)
        gears, loads = self._gears(bodies), self._loads(bodies)
        linkage = LinkageFile(
            self.path,
            self.source,
            title,
            self._whole("version", 1),
            self._ordered(given, drive),
            ground,
            bodies,
            slides,
            gears,
            assembly,
            near,
            self._ask(),
            loads,
            self._required(),
            drive,
            self.path.stem,
            self._known(),
        )
        for fault in linkage_faults(linkage):
            raise fault
        return linkage

    def _ordered(self, given: Mapping[str, GivenEntry], drive: DriverEntry) -> Mapping[str, GivenEntry]:
        """Return all given quantities as the sheet lists them: what places the joints, the driver, what acts
        on it."""
        driver = {drive.moved, *drive.rates}
        first = {**given, **self.constants}
        ranks = {n: 2 if e.unit in ("N", "N*m") else int(n in driver) for n, e in first.items()}
        return dict(sorted(first.items(), key=lambda item: ranks[item[0]]))

    def _required(self) -> tuple[str, ...]:
        required = self._table("given").get("require", [])
        required = [required] if isinstance(required, str) else required
        if not isinstance(required, list) or not all(isinstance(r, str) for r in required):
            raise self.refused(
                ("given", "require"),
                'require = ["r2 < r4", "is_crank(2)"]; found {required!r}',
                required=required,
            )
        return tuple(required)

    # ------------------------------------------------------------------ assembly

    def _assembly(self, drive: DriverEntry) -> tuple[Mapping[str, AssemblyEntry], NearEntry | None]:
        results = {}
        near = None
        for point, value in self._table("assembly").items():
            if point == "near":
                near = self._near(value, drive)
                continue
            at = ("assembly", point)
            texts = value if isinstance(value, list) else [value]
            found = [self._way(at, text) for text in texts]
            ways, ends = tuple(way for way, *_ in found), {tuple(rest) for _, *rest in found}
            if len(ends) > 1 or len(set(ways)) < len(ways) or not ways:
                raise self.refused(
                    at,
                    'the ways to assemble {point} are ["left of A -> C", "right of A -> C"]; found {value!r}',
                    point=point,
                    value=value,
                )
            results[point] = AssemblyEntry(ways, *ends.pop())
        return results, near

    def _way(self, at: Sequence[str | int], text: object) -> tuple[str, str, str]:
        if match := _SIDE.match(str(text)):
            return match[1], match[2], match[3]
        if match := _AHEAD.match(str(text)):
            return "ahead" if match[1] == "ahead of" else "behind", match[2], ""
        raise self.refused(
            at,
            'a way to assemble is "left of A -> C", "right of A -> C", "ahead of A" or "behind A"; '
            "found {text!r}",
            text=text,
        )

    def _near(self, value: Any, drive: DriverEntry) -> NearEntry:
        at = ("assembly", "near")
        key, unit = ("angle", "deg") if drive.kind == "turn" else ("length", "mm")
        form = f'near = {{ {key} = "60 {unit}", E = ["120 mm", "80 mm"], F = ["150 mm", "20 mm"] }}'
        if not isinstance(value, Mapping) or key not in value:
            raise self.refused(
                at,
                "the place from which Newton's method starts is {form}; found {value!r}",
                form=form,
                value=value,
            )
        driver = self._checked(at, amount, value[key], unit)
        places = {}
        for point, place in value.items():
            if point == key:
                continue
            self._check_point(at, point)
            if not isinstance(place, list) or len(place) != 2:
                raise self.refused(
                    at,
                    "the place from which Newton's method starts is {form}; found {point} = {place!r}",
                    form=form,
                    point=point,
                    place=place,
                )
            x, y = (self._checked(at, amount, each, "mm") for each in place)
            places[point] = complex(x, y)
        return NearEntry(places, driver)

    # ----------------------------------------------------------------------- ask

    def _ask(self) -> Mapping[str, Any]:
        ask = self._table("ask")
        if not ask:
            raise self.refused(("ask",), 'an exercise asks something: [ask], then positions = ["theta3"], …')
        self.only(ask, ASKED, ("ask",))
        for key in ("positions", "velocities", "accelerations", "polygon", "instant_centres"):
            value = ask.get(key, [])
            if not isinstance(value, list) or not all(isinstance(each, str) for each in value):
                raise self.refused(
                    ("ask", key),
                    '{key} is a list of names: ["…", "…"]; found {value!r}',
                    key=key,
                    value=value,
                )
        for key in ("mobility", "class"):
            if not isinstance(ask.get(key, True), bool):
                raise self.refused(("ask", key), "{key} = true; found {value!r}", key=key, value=ask[key])
        points = ask.get("points", {})
        if not isinstance(points, Mapping) or not all(
            isinstance(n, (int, float)) and 0 < n <= _MOST_POINTS for n in points.values()
        ):
            raise self.refused(
                ("ask", "points"),
                "points = {{ theta3 = 2 }} weighs questions; found {points!r}",
                points=points,
            )
        return ask

    def _loads(self, bodies: Mapping[str, BodyEntry]) -> tuple[LoadEntry, ...]:
        ask = self._table("ask")
        key = next((k for k in ("torque", "thrust") if k in ask), None)
        if key is None:
            return ()
        at, torque = ("ask", key), ask[key]
        loads = torque.get("load") if isinstance(torque, Mapping) else None
        loads = [loads] if isinstance(loads, Mapping) else loads
        form = Message(
            "{moment}, or {force}",
            moment=f'{key} = {{ load = {{ on = "4", moment = "20 N*m" }} }}',
            force='{ on = "B", force = "100 N", angle = "180 deg" }',
        )
        if not isinstance(loads, list) or not loads or not all(isinstance(each, Mapping) for each in loads):
            raise self.refused(at, "{form}; found {torque!r}", form=form, torque=torque)
        results = []
        for load in loads:
            keys = ("moment",) if "moment" in load and "force" not in load else ("force", "angle", "moment")
            self.only(load, ("on", *keys), at, "load")
            on = str(load.get("on", ""))
            points = [p for b in bodies.values() for p in b.points]
            known = bodies if "moment" in load else points
            if ("moment" in load) == ("force" in load) or on not in known:
                raise self.refused(
                    at,
                    "a moment acts on a body, a force at a point: {form}; found {found!r}",
                    form=form,
                    found=dict(load),
                )
            if on in self._table("ground"):
                raise self.refused(at, "{point} is a fixed point, where a force does no work", point=on)
            results.append(
                LoadEntry(
                    on,
                    self._expression(at, load["moment"], "N*m", f"M{on}") if "moment" in load else None,
                    self._expression(at, load["force"], "N", f"F{on}") if "force" in load else None,
                    self._expression(at, load.get("angle", "0 deg"), "deg", f"delta_F_{on}"),
                )
            )
        return tuple(results)

    def _known(self) -> tuple[tuple[Mapping[str, float | str], Mapping[str, tuple[str, str]]], ...]:
        """Return results that are known, such as those of a textbook."""
        cases = self.table.get("known", [])
        form = '[[known]], then given = { r2 = "50 mm" } and gives = { theta3 = "36.87 deg" }'
        if not isinstance(cases, list) or not all(
            isinstance(c, Mapping)
            and isinstance(c.get("given"), Mapping)
            and isinstance(c.get("gives"), Mapping)
            for c in cases
        ):
            raise self.refused(
                ("known",), "known results are {form}; found {cases!r}", form=form, cases=cases
            )
        results = []
        for number, case in enumerate(cases):
            at = ("known", number)
            self.only(case, ("given", "gives"), at, "known")
            given: dict[str, float | str] = {}
            for name, value in case["given"].items():
                if name.startswith("mode_"):
                    given[name] = str(value)
                elif name not in self.units:
                    near = nearest(name, self.units)
                    raise self.refused(at, "no quantity {name!r}{near}", name=name, near=near)
                else:
                    given[name] = self._checked(at, amount, value, self.units[name])
            gives = {}
            for name, value in case["gives"].items():
                match = re.fullmatch(r"\s*([+-]?\d+(?:\.\d+)?)\s*(\S*)\s*", str(value))
                if match is None or not NAME.match(name):
                    raise self.refused(at, "known results are {form}; found {cases!r}", form=form, cases=case)
                gives[name] = match[1], match[2]
            results.append((given, gives))
        return tuple(results)
