"""Reader of the bodies and joints of a mechanism's file, and of what drives it."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from coursework.errors import nearest
from coursework.linkages.entries import (
    GROUND,
    BodyEntry,
    DriverEntry,
    GearEntry,
    GivenEntry,
    Place,
    SlideEntry,
)
from coursework.linkages.expressions import QuantityExpression
from coursework.linkages.table_reader import NAME, POINT, TableReader

_BODY = re.compile(r"(?:[2-9]|[1-9][0-9]|[a-z][a-z0-9]*)\Z")


class JointReader(TableReader):
    """Reader of bodies, slides, gears and the driver."""

    # -------------------------------------------------------------------- bodies

    def _bodies(self, ground: Mapping[str, Place]) -> Mapping[str, BodyEntry]:
        table = self._table("bodies")
        if not table:
            raise self.refused(
                ("bodies",),
                "a mechanism has bodies: [bodies], then {example}",
                example='2 = { at = "O", angle = "theta2", points = { A = "r2" } }',
            )
        results = {}
        for name, value in table.items():
            at = ("bodies", name)
            if not _BODY.match(name) or name == GROUND:
                raise self.refused(
                    at,
                    "a body is called by a number from 2 on, or a small letter; found {name!r} (the "
                    "ground is 1)",
                    name=name,
                )
            if not isinstance(value, Mapping):
                raise self.refused(
                    at, 'a body is {{ points = {{ A = "0 mm", B = "r3" }} }}; found {value!r}', value=value
                )
            self.only(value, ("at", "angle", "points"), at, name)
            points = self._body_points(name, value)
            origin = value.get("at") or next((p for p, place in points.items() if place.is_origin), "")
            if not origin:
                raise self.refused(
                    at, 'body {name} says where its frame begins: at = "A", or a point at "0 mm"', name=name
                )
            if "at" in value:
                self._check_point(at, str(origin))
                if str(origin) in points:
                    raise self.refused(
                        at,
                        "the frame of body {name} begins at {point}, which has no other place in it",
                        name=name,
                        point=origin,
                    )
                points = {str(origin): Place(), **points}
            angle = value.get("angle")
            results[name] = BodyEntry(
                name,
                points,
                str(origin),
                None if angle is None else self._expression((*at, "angle"), angle, "deg"),
            )
        for name, body in results.items():
            others = [p for b in results.values() if b is not body for p in b.points]
            if "at" in table[name] and body.at not in (*ground, *others):
                raise self.refused(
                    ("bodies", name),
                    "body {name} begins at {point}, a point of no other body{found}",
                    name=name,
                    point=body.at,
                    found=nearest(body.at, dict.fromkeys([*ground, *others])),
                )
        return results

    def _body_points(self, name: str, value: Mapping[str, Any]) -> dict[str, Place]:
        points = value.get("points", {})
        if not isinstance(points, Mapping):
            raise self.refused(
                ("bodies", name), 'points = {{ A = "0 mm", B = "r3" }}; found {points!r}', points=points
            )
        origin = str(
            value.get("at")
            or next((p for p, place in points.items() if re.match(r"\s*0\b(?!\.)", str(place))), "")
        )
        results = {}
        for point, place in points.items():
            self._check_point(("bodies", name), point)
            own = (f"{origin}{point}", f"x_{point}_{name}", f"y_{point}_{name}", f"gamma_{point}")
            results[point] = self._place(("bodies", name), place, own)
        return results

    def _driver(
        self,
        bodies: Mapping[str, BodyEntry],
        slides: Mapping[str, SlideEntry],
        jacks: Sequence[DriverEntry],
        given: Mapping[str, GivenEntry],
    ) -> DriverEntry:
        """Return what drives: a body that a given angle turns, a slide of a given distance, or a jack of a
        given length."""
        turned = {b.name: b.angle for b in bodies.values() if b.angle is not None and not b.angle.is_number}
        driven = [DriverEntry("turn", name, angle.code) for name, angle in turned.items()]
        places = [("bodies", name) for name in turned]
        for point, slide in slides.items():
            if slide.distance in given:
                limits = self._limits(("slides", point), slide.distance, given)
                driven.append(DriverEntry("slide", slide.of, slide.distance, limits=limits))
                places.append(("slides", point))
        driven += jacks
        places += [("jacks", jack.body) for jack in jacks]
        if not driven:
            raise self.refused(
                ("bodies",),
                "there is no driver: one body must be turned by a given angle: {example}",
                example='2 = { at = "O", angle = "theta2", … }',
            )
        if len(driven) > 1:
            raise self.refused(
                places[1],
                "two bodies are driven, {name} and {name_2}; one angle or length drives, those of the "
                "others follow",
                name=driven[0].body,
                name_2=driven[1].body,
            )
        (found,) = driven
        if found.kind == "turn" and not (turned[found.body].is_name and found.moved.startswith("theta")):
            raise self.refused(
                ("bodies", found.body),
                "the driving angle is a given quantity such as theta2; found {code!r}",
                code=found.moved,
            )
        return found

    def _limits(
        self, at: Sequence[str | int], length: str, given: Mapping[str, GivenEntry]
    ) -> tuple[str, str]:
        """Return the quantities between which a driven length goes: those that the file states, or the ends
        of its own range."""
        table = self._table(*at)
        stated = table.get("limits")
        if stated is None:
            low, high = (given[length].low, given[length].high)
            if given[length].value is not None or not (low.is_number and high.is_number):
                return "", ""
            stated = [f"{low.code} mm", f"{high.code} mm"]
        ends = (
            zip(stated, ("min", "max"), strict=False) if isinstance(stated, list) and len(stated) == 2 else ()
        )
        names = [self._expression(at, v, "mm", f"{length}_{end}", always=True) for v, end in ends]
        if not names or not all(name.is_name for name in names):
            form = 'limits = ["300 mm", "500 mm"]'
            raise self.refused(
                at,
                "a driven length goes between its limits: {form}; found {stated!r}",
                form=form,
                stated=stated,
            )
        numbers = [self.constants[n.code].value for n in names if n.code in self.constants]
        if len(numbers) == 2 and not (numbers[0] or 0) < (numbers[1] or 0):
            raise self.refused(
                at,
                "limits go from the smaller length to the greater; found {first}, {last}",
                first=stated[0],
                last=stated[1],
            )
        return names[0].code, names[1].code

    # -------------------------------------------------------------------- joints

    def _jacks(
        self, ground: Mapping[str, Place], bodies: Mapping[str, BodyEntry], given: Mapping[str, GivenEntry]
    ) -> dict[str, tuple[BodyEntry, DriverEntry]]:
        """Return the jacks: each as a body that holds both its pins, and as a driver."""
        results = {}
        for name, value in self._table("jacks").items():
            at = ("jacks", name)
            form = '2 = { from = "C", to = "B", rod = "3", length = "L" }'
            keys = ("from", "to", "rod", "length")
            if not isinstance(value, Mapping) or not all(isinstance(value.get(k), str) for k in keys):
                raise self.refused(at, "a jack is {form}; found {value!r}", form=form, value=value)
            self.only(value, (*keys, "limits"), at, name)
            start, end, rod, length = (value[key] for key in keys)
            if name in bodies or rod in bodies or rod == name or not (_BODY.match(name) and _BODY.match(rod)):
                raise self.refused(
                    at,
                    "cylinder and rod of a jack are two bodies with names of their own; found {name!r} "
                    "and {rod!r}",
                    name=name,
                    rod=rod,
                )
            points = [*dict.fromkeys([*ground, *(p for b in bodies.values() for p in b.points)])]
            for point in (start, end):
                if point not in points:
                    raise self.refused(
                        at, "no point {point!r}{found}", point=point, found=nearest(point, points)
                    )
            ends = [
                {b for b in (GROUND, *bodies) if p in (ground if b == GROUND else bodies[b].points)}
                for p in (start, end)
            ]
            if shared := sorted(ends[0] & ends[1]):
                raise self.refused(
                    at,
                    "a jack joins two bodies; its ends {start} and {end} are both points of body {body}",
                    start=start,
                    end=end,
                    body="1" if GROUND in shared else shared[0],
                )
            if length not in given or given[length].unit != "mm":
                raise self.refused(
                    at,
                    "the length of a jack is a given quantity, which drives: [given], then {length} = "
                    "{example}",
                    length=length,
                    example='{ from = "300 mm", to = "400 mm" }',
                )
            out = Place(QuantityExpression(length, (length,)))
            entry = BodyEntry(name, {start: Place(), end: out}, start)
            results[name] = entry, DriverEntry("jack", name, length, rod, self._limits(at, length, given))
        return results

    def _slides(
        self, ground: Mapping[str, Place], bodies: Mapping[str, BodyEntry], given: Mapping[str, GivenEntry]
    ) -> Mapping[str, SlideEntry]:
        results = {}
        for point, value in self._table("slides").items():
            at = ("slides", point)
            if not isinstance(value, Mapping):
                raise self.refused(
                    at,
                    'a slide is {point} = {{ of = "4", on = "ground", through = "C", along = "0 deg" '
                    "}}; found {value!r}",
                    point=point,
                    value=value,
                )
            self.only(value, ("of", "on", "through", "along", "distance", "limits"), at, point)
            names = [*bodies, GROUND]
            of, on = str(value.get("of", "")), str(value.get("on", GROUND))
            on = GROUND if on == "1" else on
            for body in (of, on):
                if body not in names:
                    raise self.refused(at, "no body {body!r}{found}", body=body, found=nearest(body, names))
            if of == GROUND or point not in bodies[of].points:
                raise self.refused(
                    at,
                    "the sliding point {point} is a point of body {value}; it has none of this name",
                    point=point,
                    value=of or "…",
                )
            if of == on:
                raise self.refused(at, "body {of} does not slide on itself", of=of)
            if point in (ground if on == GROUND else bodies[on].points):
                raise self.refused(
                    at,
                    "{point} is a point of body {on} itself, where it cannot slide; another body holds "
                    "it there",
                    point=point,
                    on=on,
                )
            through, name = self._through(at, value.get("through", ["0 mm", "0 mm"]), on, ground, bodies)
            distance = str(value.get("distance", f"s_{point}"))
            drives = on == GROUND and distance in given and given[distance].unit == "mm"
            if not NAME.match(distance) or (distance in self.units and not drives):
                raise self.refused(
                    at,
                    "distance names the distance along the slide, which follows; found {distance!r}",
                    distance=distance,
                )
            along = self._expression(at, value.get("along", "0 deg"), "deg", f"delta_{point}")
            results[point] = SlideEntry(point, of, on, through, name, along, distance)
        return results

    def _through(
        self,
        at: Sequence[str | int],
        value: Any,
        on: str,
        ground: Mapping[str, Place],
        bodies: Mapping[str, BodyEntry],
    ) -> tuple[Place, str]:
        """Return the point through which a slide goes, in the guide's frame, and its name if it has one."""
        points = ground if on == GROUND else bodies[on].points
        if isinstance(value, str) and POINT.match(value):
            if value not in points:
                raise self.refused(
                    at,
                    "body {on} has no point {value!r}{found}",
                    on=on,
                    value=value,
                    found=nearest(value, points),
                )
            return points[value], value
        return self._place(at, value, (f"p_{at[-1]}", f"p_{at[-1]}", f"q_{at[-1]}", f"gamma_{at[-1]}")), ""

    def _gears(self, bodies: Mapping[str, BodyEntry]) -> tuple[GearEntry, ...]:
        results = []
        for name, value in self._table("gears").items():
            at = ("gears", name)
            form = (
                'G = { first = "2", second = "3", carrier = "ground", radii = ["R2", "R3"], inner = false }'
            )
            if (
                not isinstance(value, Mapping)
                or not isinstance(value.get("radii"), list)
                or len(value["radii"]) != 2
            ):
                raise self.refused(at, "a gear is {form}; found {value!r}", form=form, value=value)
            self.only(value, ("first", "second", "carrier", "radii", "inner"), at, name)
            names = [*bodies, GROUND]
            pair = [str(value.get(key, GROUND)) for key in ("first", "second", "carrier")]
            for body in pair:
                if body not in names:
                    raise self.refused(at, "no body {body!r}{found}", body=body, found=nearest(body, names))
            first, second = (
                self._expression(at, r, "mm", f"R{body}")
                for r, body in zip(value["radii"], pair, strict=False)
            )
            for text, radius in zip(value["radii"], (first, second), strict=True):
                constant = self.constants.get(radius.code)
                if radius.is_zero or (constant and not (constant.value or 0) > 0):
                    raise self.refused(at, "a radius is above 0; found {found!r}", found=text)
            results.append(
                GearEntry(pair[0], pair[1], pair[2], (first, second), bool(value.get("inner", False)))
            )
        return tuple(results)
