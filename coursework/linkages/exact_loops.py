"""Loops that the numeric core knows as a whole: near dead centres and change points it keeps digits that
points with rounded coordinates lose.

A pair of bars between a point that turns about a fixed pivot and another fixed pivot is a four-bar linkage; a
rod from such a point to a fixed guide is a slider-crank. Their closed forms take lengths and the crank's
angle as they are given.
"""

from __future__ import annotations

from dataclasses import replace

from coursework.linkages.entries import GROUND, SlideEntry
from coursework.linkages.formulas import FormulaWriter
from coursework.linkages.groups import Dyad
from coursework.linkages.points import Arm
from coursework.linkages.terms import Heading, Plane, Sum


def keep_digits(writer: FormulaWriter) -> None:
    """Compute the loops of a mechanism that the numeric core knows as a whole by their closed forms.

    Parameters
    ----------
    writer
        The writer, with all quantities of the mechanism.
    """
    for group in writer.groups:
        if writer.linkage.jack in group.bodies:
            continue
        if isinstance(group, Dyad) and group.kind == "RRR":
            to_p = writer.arm(group.p, str(group.outer_p), str(group.inner))
            to_q = writer.arm(group.q, str(group.outer_q), str(group.inner))
            keep_digits_of_bars(writer, group, to_p, to_q)
        elif isinstance(group, Dyad) and group.kind == "RRP" and isinstance(group.outer_q, SlideEntry):
            arm = writer.arm(group.p, str(group.outer_p), str(group.inner))
            placed, base, sign, heading = writer.track(group.outer_q, group.q, str(group.inner))
            if placed == GROUND:
                keep_digits_of_slider(writer, group, arm, base, sign, heading, group.outer_q.distance)


def keep_digits_of_bars(writer: FormulaWriter, group: Dyad, to_p: Arm, to_q: Arm) -> None:
    """Compute a pair of bars as a four-bar linkage where it is one.

    Parameters
    ----------
    writer
        The writer, with the quantities of the pair.
    group
        The pair.
    to_p, to_q
        Vectors of both bars from their outer joints to the inner one.
    """
    P, B, Q = str(group.outer_p), str(group.inner), str(group.outer_q)
    for start, coupler, to_coupler, end, rocker, to_rocker, sign in (
        (P, group.p, to_p, Q, group.q, to_q, 1),
        (Q, group.q, to_q, P, group.p, to_p, -1),
    ):
        crank = _crank(writer, start)
        if crank is None or end not in writer.linkage.ground:
            continue
        body, pivot, arm = crank
        frame = writer.local(end, GROUND) - writer.local(pivot, GROUND)
        if frame.vanishes:
            return
        writer.hide(f"_frame_{B}", f"atan2({frame.y.code}, {frame.x.code})")
        side = f"side_{B}" if sign > 0 else f"-side_{B}"
        lengths = [length.code for length in (arm.length, to_coupler.length, to_rocker.length)]
        loop = writer.hide(
            f"_loop_{B}",
            f"FourBar(abs({frame.complex}), {', '.join(lengths)}, "
            f"{side}).at(Degrees.between(_frame_{B}, {_direction(arm)}))",
        )
        named = f"'{coupler}, {rocker}', '{B}', '{start}', '{end}'"
        _turn(writer, coupler, to_coupler, f"from_radians({loop}.coupler_angle) + _frame_{B}", named)
        _turn(writer, rocker, to_rocker, f"from_radians({loop}.rocker_angle) + _frame_{B}", named)
        if sign > 0:
            _stable(writer, f"psi_{B}", f"from_radians({loop}.corner)", named)
        place = (
            f"{writer.complex(end)} + polar({to_rocker.length.code}, from_radians({loop}.rocker_angle) + "
            f"_frame_{B})"
        )
        writer.quantities[f"_{B}"] = replace(writer.quantities[f"_{B}"], code=place, meeting=named)
        rate, gain = writer.omega(body), writer.alpha(body)
        for turned, ratio in ((coupler, "coupler"), (rocker, "rocker")):
            _stable(writer, writer.omega(turned), f"{loop}.{ratio}_ratio * {rate}", named)
            more = f" + {loop}.{ratio}_ratio * {gain}" if gain != "0" else ""
            _stable(writer, writer.alpha(turned), f"{loop}.{ratio}_gain * {rate}**2{more}", named)
        for hidden in (f"_rates_{B}", f"_gains_{B}"):
            del writer.quantities[hidden]
        return


def keep_digits_of_slider(
    writer: FormulaWriter, group: Dyad, arm: Arm, base: Plane, sign: int, heading: Heading, distance: str
) -> None:
    """Compute a rod with its slider as a slider-crank where it is one.

    Parameters
    ----------
    writer
        The writer, with the quantities of the pair.
    group
        The pair.
    arm
        Vector of the rod to the slider.
    base, sign, heading
        Where the slider is at the distance 0, the sign of the distance, and the direction of the fixed guide.
    distance
        Name of the distance along the guide.
    """
    B = str(group.inner)
    crank = _crank(writer, str(group.outer_p))
    if crank is None:
        return
    body, pivot, to_start = crank
    away = base - writer.local(pivot, GROUND)
    loop = f"SliderCrank({to_start.length.code}, {arm.length.code}, {away.across(heading).code}, side_{B})"
    angle = f"Degrees.between({heading.code}, {_direction(to_start)})"
    rate, gain = writer.omega(body), writer.alpha(body)
    for stem, rates in (("at", ""), ("rates", f"{rate}, "), ("gains", f"{rate}, {gain}, ")):
        code = f"{loop}.motion({angle}, {rates}order={rates.count(',')})"
        writer.hide(f"_{stem}_{B}", code, f"{group.p}, {group.q}", B, str(group.outer_p))
    turn = f"from_radians(_at_{B}.rod_angle)" + (
        f" + {heading.code}" if heading.names or heading.constant else ""
    )
    _turn(writer, group.p, arm, turn)
    along = (Sum.of(f"_at_{B}.position") - away.along(heading)).times(sign=sign)
    _stable(writer, distance, along.code)
    offset = Plane.polar(Sum.of(f"_at_{B}.position"), heading)
    across = Plane.polar(away.across(heading), heading + Heading((), 90.0))
    place = writer.local(pivot, GROUND) + offset + across
    writer.quantities[f"_{B}"] = replace(writer.quantities[f"_{B}"], code=place.complex)
    minus = "-" if sign < 0 else ""
    for name, code in (
        (writer.omega(group.p), f"_rates_{B}.rod_rate"),
        (f"{distance}_dot", f"{minus}_rates_{B}.velocity"),
        (writer.alpha(group.p), f"_gains_{B}.rod_acceleration"),
        (f"{distance}_ddot", f"{minus}_gains_{B}.acceleration"),
    ):
        _stable(writer, name, code)


def _crank(writer: FormulaWriter, point: str) -> tuple[str, str, Arm] | None:
    """Return the body that carries a point about a fixed pivot, the pivot, and the vector between them; None
    for any other point."""
    if point in writer.linkage.ground:
        return None
    body, pivot = writer.carrier(point)
    if pivot not in writer.linkage.ground or pivot == point or body == writer.linkage.jack:
        return None
    return body, pivot, writer.arm(body, pivot, point)


def _direction(arm: Arm) -> str:
    """Return the direction of a vector on a body, as code."""
    return (arm.heading + Heading((), 180.0 if arm.sign < 0 else 0.0)).code


def _turn(writer: FormulaWriter, body: str, arm: Arm, code: str, meeting: str = "") -> None:
    """Compute the angle of a body from the direction of a vector on it."""
    back = -(arm.heading - writer.heading(body)) + Heading((), 180.0 if arm.sign < 0 else 0.0)
    _stable(writer, writer.turns[body], f"wrap({back.after(code)})", meeting)


def _stable(writer: FormulaWriter, name: str, code: str, meeting: str = "") -> None:
    writer.quantities[name] = replace(writer.quantities[name], stable=code, meeting=meeting)
