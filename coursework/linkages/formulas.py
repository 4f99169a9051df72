"""Quantities of a mechanism, group by group: the formula that a worked solution prints, and the closed form
that keeps its digits."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from coursework.linkages.entries import AssemblyEntry, LinkageFile, SlideEntry
from coursework.linkages.groups import Dyad, Group, HigherGroup, Wheel
from coursework.linkages.higher_groups import HigherGroupWriter
from coursework.linkages.points import Arm, SlideLine, UsualMistake, dotted, local_plane, over, rotated
from coursework.linkages.terms import Heading, Plane, Sum
from coursework.messages import Message


class FormulaWriter(HigherGroupWriter):
    """Writer of the quantities of a mechanism.

    Parameters
    ----------
    linkage
        The mechanism.
    """

    def __init__(self, linkage: LinkageFile) -> None:
        super().__init__(linkage)
        for group in self.groups:
            self._place(group)
        self._refuse_unused_assembly()
        for point in linkage.points:  # a length that places one is a quantity, whatever is asked
            self.at(point)

    def _refuse_unused_assembly(self) -> None:
        """Refuse a way to assemble that no group has, which its author would believe to be taken."""
        linkage = self.linkage
        for point in linkage.assembly:
            if point not in self.modes:
                raise linkage.refused(
                    ("assembly", point),
                    "{point} is assembled in one way; two ways have {found}",
                    point=point,
                    found=", ".join(self.modes) or "-",
                )
        if linkage.near and not any(isinstance(group, HigherGroup) for group in self.groups):
            raise linkage.refused(
                ("assembly", "near"),
                "near is for a group of class III and above, and all groups here are pairs of bodies: leave "
                "it out",
            )

    def _bar(self, body: str, start: str, end: str) -> Arm:
        """Return the vector of a body between two joints, which are apart."""
        if (self.local(end, body) - self.local(start, body)).vanishes:
            raise self.linkage.refused(
                ("bodies", body),
                "the joints {start} and {end} of body {body} are in one place: a bar has a length",
                start=start,
                end=end,
                body=body,
            )
        return self.arm(body, start, end)

    def _place(self, group: Group) -> None:
        match group:
            case Dyad(kind="RRR"):
                self._rrr(group)
            case Dyad(kind="RRP"):
                self._rrp(group)
            case Dyad(kind="RPR"):
                self._rpr(group)
            case Dyad():
                self._two_slides(group)
            case Wheel():
                self._wheel(group)
            case HigherGroup():
                self._large(group)

    def _mode(self, point: str, default: str, ends: tuple[str, str] | None) -> str:
        """Return the quantity that is +1 or -1 by the way in which a group is assembled; ``ends`` of the line
        whose left is +1."""
        linkage = self.linkage
        entry = linkage.assembly.get(point)
        if entry is None:
            if not default:
                assert ends is not None
                first, last = ends
                raise linkage.refused(
                    ("assembly",),
                    '{point} can be assembled in two ways: [assembly], then {point} = "left of {first} '
                    '-> {last}"',
                    point=point,
                    first=first,
                    last=last,
                )
            entry = AssemblyEntry((default,), ends[0] if ends else "")
        wanted = {"left", "right"} if ends and ends[1] else {"ahead", "behind"}
        if not set(entry.ways) <= wanted:
            raise linkage.refused(
                ("assembly", point),
                "{point} is assembled {found}; found {value}",
                point=point,
                found=Message("left or right") if "left" in wanted else Message("ahead or behind"),
                value=entry.ways[0],
            )
        sign = 1
        if ends and ends[1]:
            if {entry.start, entry.end} != set(ends):
                raise linkage.refused(
                    ("assembly", point),
                    "{point} lies left or right of {value} -> {value_2}; found {start} -> {end}",
                    point=point,
                    value=ends[0],
                    value_2=ends[1],
                    start=entry.start,
                    end=entry.end,
                )
            sign = 1 if (entry.start, entry.end) == ends else -1
        self.modes[point] = entry
        first = entry.ways[0]
        words = {"B": point, "P": entry.start, "Q": entry.end, "way": first}
        name, symbol = f"side_{point}", rf"\varepsilon_{{{point}}}"
        self.mistakes.append(
            UsualMistake(f"other_assembly_{point}", (name,), (f"-{name}",), "other_assembly", words)
        )
        kind = "side" if ends and ends[1] else "ahead"
        if not entry.is_drawn:
            value = sign if first in ("left", "ahead") else -sign
            return self.write(name, str(value), "1", f"{kind}_fixed_{first}", symbol, words=words)
        code = f"{'-' if sign < 0 else ''}np.where(np.isin(mode_{point}, ('left', 'ahead')), 1, -1)"
        return self.write(name, code, "1", f"{kind}_drawn", symbol, words=words)

    def _line(self, start: str, end: str) -> tuple[str, str]:
        """Write the distance and the direction between two placed points."""
        gap = self.at(end) - self.at(start)
        length, turn = f"d_{start}{end}", f"phi_{start}{end}"
        if turn not in self.quantities:
            symbols = f"{start}{end}", rf"\varphi_{{{start}{end}}}"
            self.write_polar((length, turn), gap, ("distance", "direction"), symbols, {"P": start, "Q": end})
        return length, turn

    def _rrr(self, group: Dyad) -> None:
        P, B, Q = group.outer_p, group.inner, group.outer_q
        assert isinstance(P, str)
        assert isinstance(B, str)
        assert isinstance(Q, str)
        p, q = group.p, group.q
        to_p, to_q = self._bar(p, P, B), self._bar(q, Q, B)
        words = {"P": P, "B": B, "Q": Q, "p": p, "q": q}
        distance, line = self._line(P, Q)
        side = self._mode(B, "", (P, Q))
        first, second = to_p.length, to_q.length
        point = self.hide(
            f"_{B}",
            f"dyads.rrr({self.complex(P)}, {self.complex(Q)}, {first.code}, {second.code}, {side})",
            f"{p}, {q}",
            B,
            P,
            Q,
        )
        corner = self.write(
            f"psi_{B}",
            f"acos(({distance}**2 + {first.factor}**2 - {second.factor}**2) / (2 * {distance} * "
            f"{first.factor}))",
            "deg",
            "corner",
            rf"\psi_{{{B}}}",
            words=words,
            stable=f"abs(wrap(angle({point} - {self.complex(P)}) - angle({self.complex(Q)} - "
            f"{self.complex(P)})))",
        )
        offset = to_p.heading - self.heading(p)
        self._write_turn(p, f"{line} + {side} * {corner}", to_p, offset, P, point, "turn_by_corner", words)
        self._finish_rod(p, P)
        away = self.at(B) - self.at(Q)
        self._write_turn(
            q,
            f"atan2({away.y.code}, {away.x.code})",
            to_q,
            to_q.heading - self.heading(q),
            Q,
            point,
            "turn_by_ends",
            words,
            wrapped=True,
        )
        self._finish_rod(q, Q)
        self._rates_rrr(group, to_p, to_q, words)

    def _write_turn(
        self,
        body: str,
        code: str,
        arm: Arm,
        offset: Heading,
        start: str,
        end: str,
        step: str,
        words: Mapping[str, str],
        wrapped: bool = False,
    ) -> None:
        """Write the angle of a body from the direction of an arm on it, which ends at a hidden point."""
        back = Heading((), 180.0 if arm.sign < 0 else 0.0) + -offset
        whole = code if wrapped and back.vanishes else f"wrap({back.after(code)})"
        vector = f"{end} - {self.complex(start)}" if arm.sign > 0 else f"{self.complex(start)} - {end}"
        stable = f"angle({vector})" if offset.vanishes else f"wrap(angle({vector}) - ({offset.code}))"
        turned = step if back.vanishes else f"{step}_offset"
        self.write(self.turns[body], whole, "deg", turned, words={**words, "body": body}, stable=stable)

    def _rates_rrr(self, group: Dyad, to_p: Arm, to_q: Arm, words: Mapping[str, str]) -> None:
        P, B, Q, p, q = words["P"], words["B"], words["Q"], group.p, group.q
        between = to_q.heading - to_p.heading
        lever_p, lever_q = to_p.length.times(sign=to_p.sign), to_q.length.times(sign=to_q.sign)
        below_p = lever_p.times(between.sin)
        below_q = lever_q.times((-between).sin)
        arms = f"{self.complex(B)} - {self.complex(P)}, {self.complex(B)} - {self.complex(Q)}"
        rates, gains = f"_rates_{B}", f"_gains_{B}"
        v_p, v_q = self._own(P, p, to_p, "v"), self._own(Q, q, to_q, "v")
        self.hide(rates, f"dyads.rrr_rates({arms}, ({v_p.complex},), ({v_q.complex},))")
        jack = "_jack" if self.linkage.jack in group.bodies else ""

        def apart(kind: str) -> tuple[Sum, Sum]:
            """Return what the rates of one end have more than those of the other, along ``q`` and along
            ``p``."""
            first, last = self._motion(P, kind), self._motion(Q, kind)
            results = []
            for gap, heading, sign in ((last - first, to_q.heading, 1), (first - last, to_p.heading, -1)):
                grown = self.growth(q, to_q, kind, heading).x - self.growth(p, to_p, kind, heading).x
                results.append(gap.along(heading) + (grown if sign > 0 else -grown))
            return results[0], results[1]

        for body, own, below, start, index in zip(
            (p, q), apart("v"), (below_p, below_q), (q, p), (0, 1), strict=True
        ):
            self.write(
                self.omega(body),
                over(own, below),
                "rad/s",
                f"omega_rrr{jack}",
                words={**words, "body": body, "other": start},
                stable=f"{rates}[{index}][0]",
            )
        a_p, a_q = self._own(P, p, to_p, "a"), self._own(Q, q, to_q, "a")
        self.hide(
            gains, f"dyads.rrr_rates({arms}, ({v_p.complex}, {a_p.complex}), ({v_q.complex}, {a_q.complex}))"
        )
        w_p, w_q = f"{self.omega(p)}**2", f"{self.omega(q)}**2"
        bare_p, bare_q = apart("a")
        above_p = bare_p + lever_p.times(w_p, between.cos) - lever_q.times(w_q)
        above_q = bare_q - lever_p.times(w_p) + lever_q.times(w_q, between.cos)
        self.sines[B] = between.sin
        self.mistakes.append(
            UsualMistake(
                f"normal_terms_forgotten_{B}",
                (self.alpha(p), self.alpha(q)),
                (over(bare_p, below_p), over(bare_q, below_q)),
                "normal_terms_forgotten",
                words,
            )
        )
        for body, above, below, other, index in ((p, above_p, below_p, q, 0), (q, above_q, below_q, p, 1)):
            self.write(
                self.alpha(body),
                over(above, below),
                "rad/s^2",
                f"alpha_rrr{jack}",
                words={**words, "body": body, "other": other},
                stable=f"{gains}[{index}][1]",
            )

    def _own(self, start: str, body: str, arm: Arm, kind: str) -> Plane:
        """Return the velocity, or the acceleration, that the end of an arm has without the turning of its
        body."""
        return self._motion(start, kind) + self.growth(body, arm, kind)

    def _rrp(self, group: Dyad) -> None:
        P, B, slide = group.outer_p, group.inner, group.outer_q
        assert isinstance(P, str)
        assert isinstance(B, str)
        assert isinstance(slide, SlideEntry)
        p, q = group.p, group.q
        arm = self._bar(p, P, B)
        track = self.track(slide, q, B)
        placed, base, sign, heading = track
        words = {"P": P, "B": B, "p": p, "q": q, "guide": placed, "s": slide.distance}
        rise = self.at(P) - base
        height = self.write(f"h_{B}", rise.across(heading).code, "mm", "height", f"h_{{{B}}}", words=words)
        side = self._mode(B, "ahead", (P, ""))
        length = arm.length
        unit = f"polar(1, {heading.code})"
        start = self.hide(f"_line_{B}", base.complex)
        point = self.hide(
            f"_{B}",
            f"dyads.rrp({self.complex(P)}, {length.code}, {start} + 0j, {side}, {unit})",
            f"{p}, {q}",
            B,
            P,
        )
        reach = f"sqrt({length.factor}**2 - {height}**2)"
        ahead = rise.along(heading)
        run = f"{ahead.code} + {side} * {reach}" if not ahead.vanishes else f"{side} * {reach}"
        distance = self.write(
            slide.distance,
            run if sign > 0 else f"-({run})",
            "mm",
            "slide_rrp",
            self.slide_symbol(slide),
            words=words,
            stable=f"{'' if sign > 0 else '-'}(({point} - {start}) * np.conj({unit})).real",
        )
        self.write_end(B, track.moved(base, distance), words, point)
        away = self.at(B) - self.at(P)
        self._write_turn(
            p,
            f"atan2({away.y.code}, {away.x.code})",
            arm,
            arm.heading - self.heading(p),
            P,
            point,
            "turn_by_ends",
            {**words, "Q": P},
            wrapped=True,
        )
        self._finish_rod(p, P)
        self._finish_rod(q, B)
        self._rates_rrp(words, arm, track, distance)

    def _rates_rrp(self, words: Mapping[str, str], arm: Arm, track: SlideLine, distance: str) -> None:
        placed, _, sign, heading = track
        P, B, p = words["P"], words["B"], words["p"]
        speed, gain = f"{distance}_dot", f"{distance}_ddot"
        symbol = self.quantities[distance].symbol
        lever = arm.length.times(sign=arm.sign)
        between = arm.heading - heading
        below = lever.times(between.cos)
        v_P, v_c = self.velocity(P), self.carried(placed, self.at(B), "v")
        moved = "" if v_c.vanishes else "_moved"
        grown = self.growth(p, arm, "v", heading)
        self.write(
            self.omega(p),
            over((v_c - v_P).across(heading) - grown.y, below),
            "rad/s",
            f"omega_rrp{moved}",
            words={**words, "body": p},
        )
        along = (v_P - v_c).along(heading) + grown.x - lever.times(self.omega(p), between.sin)
        self.write(
            speed,
            along.times(sign=sign).code,
            "mm/s",
            f"slide_rate_rrp{moved}",
            dotted(symbol, 1),
            words=words,
        )
        self.write_rates(B, track.moved(v_c, speed), "v", "slides", words)
        a_P, a_c = self.acceleration(P), self.carried(placed, self.at(B), "a")
        coriolis = self.coriolis(track, speed)
        square = f"{self.omega(p)}**2"
        grown = self.growth(p, arm, "a", heading)
        across = (a_c - a_P).across(heading) - grown.y
        above = across + coriolis + lever.times(square, between.sin)
        self.write(
            self.alpha(p), over(above, below), "rad/s^2", f"alpha_rrp{moved}", words={**words, "body": p}
        )
        along = (
            (a_P - a_c).along(heading)
            + grown.x
            - lever.times(self.alpha(p), between.sin)
            - lever.times(square, between.cos)
        )
        self.write(
            gain,
            along.times(sign=sign).code,
            "mm/s^2",
            f"slide_gain_rrp{moved}",
            dotted(symbol, 2),
            words=words,
        )
        self.write_rates(B, track.moved(a_c, gain) + track.across(coriolis), "a", "slides", words)
        self.sines[B] = between.cos
        bare = (a_P - a_c).along(heading) + grown.x - lever.times(self.alpha(p), between.sin)
        self.mistakes.append(
            UsualMistake(
                f"normal_terms_forgotten_{B}",
                (self.alpha(p), gain),
                (over(across + coriolis, below), bare.times(sign=sign).code),
                "normal_terms_forgotten",
                words,
            )
        )
        if not coriolis.vanishes:
            wrong = over(across + lever.times(square, between.sin), below)
            self.mistakes.append(
                UsualMistake(
                    f"coriolis_forgotten_{B}", (self.alpha(p),), (wrong,), "coriolis_forgotten", words
                )
            )

    def _rpr(self, group: Dyad) -> None:
        P, slide, Q = group.outer_p, group.inner, group.outer_q
        assert isinstance(P, str)
        assert isinstance(slide, SlideEntry)
        assert isinstance(Q, str)
        p, q = group.p, group.q
        direction = Heading.of(slide.along.code)
        constant = local_plane(slide.through) - self.local(Q, q) + self.local(P, p) - self.local(slide.at, p)
        ahead, aside = constant.along(direction), constant.across(direction)
        words = {"P": P, "Q": Q, "p": p, "q": q, "s": slide.distance, "B": slide.at, "guide": q}
        length, line = self._line(Q, P)
        offset = ""
        if not aside.vanishes:
            offset = (
                aside.code
                if aside.code.isidentifier()
                else self.write(f"e_{slide.at}", aside.code, "mm", "offset", f"e_{{{slide.at}}}", words=words)
            )
        side = self._mode(slide.at, "ahead", (Q, ""))
        pair = self.hide(
            f"_guide_{slide.at}",
            f"dyads.rpr({self.complex(P)}, {self.complex(Q)}, {offset or '0.0'}, {side})",
            f"{p}, {q}",
            slide.at,
            P,
            Q,
        )
        reach = length if not offset else f"sqrt({length}**2 - {offset}**2)"
        run = f"{side} * {reach}"
        rest = "" if ahead.vanishes else f" - {ahead.factor}"
        distance = self.write(
            slide.distance,
            run + rest,
            "mm",
            "slide_rpr_offset" if offset else "slide_rpr",
            self.slide_symbol(slide),
            words=words,
            stable=f"{pair}[1]{rest}",
        )
        whole = Sum.of(distance) + ahead
        turn = f"{line} - atan2({offset}, {whole.code})" if offset else f"{line} + 90 * (1 - {side})"
        back = -direction
        self.write(
            self.turns[q],
            f"wrap({back.after(turn)})",
            "deg",
            "turn_rpr_offset" if offset else "turn_rpr",
            words={**words, "body": q},
            stable=f"wrap({back.after(f'angle({pair}[0])')})",
        )
        self._finish_rod(q, Q)
        self._finish_rod(p, P)
        heading = self.heading(q) + direction
        speed, gain = slide.rates
        symbol = self.quantities[distance].symbol
        rate, growth = self.omega(q), self.alpha(q)
        v, shift = self.velocity(P) - self.velocity(Q), Sum.of(offset or "0")
        moved = "" if self.velocity(Q).vanishes else "_moved"
        self.write(
            rate, over(v.across(heading), whole), "rad/s", f"omega_rpr{moved}", words={**words, "body": q}
        )
        self.write(
            speed,
            (v.along(heading) + shift.times(rate)).code,
            "mm/s",
            f"slide_rate_rpr{moved}",
            dotted(symbol, 1),
            words=words,
        )
        a = self.acceleration(P) - self.acceleration(Q)
        above = a.across(heading) + shift.times(f"{rate}**2") - Sum.of(speed).times("2", rate)
        self.write(growth, over(above, whole), "rad/s^2", f"alpha_rpr{moved}", words={**words, "body": q})
        wrong = over(a.across(heading) + shift.times(f"{rate}**2"), whole)
        self.mistakes.append(
            UsualMistake(f"coriolis_forgotten_{slide.at}", (growth,), (wrong,), "coriolis_forgotten", words)
        )
        along = a.along(heading) + shift.times(growth) + whole.times(f"{rate}**2")
        self.write(gain, along.code, "mm/s^2", f"slide_gain_rpr{moved}", dotted(symbol, 2), words=words)

    def _two_slides(self, group: Dyad) -> None:
        """Write a point that is on two lines: the pin of two blocks, or a placed pin that two slides
        reach."""
        if group.kind == "PRP":
            B = group.inner
            one, other = group.outer_p, group.outer_q
            assert isinstance(B, str)
            assert isinstance(one, SlideEntry)
            assert isinstance(other, SlideEntry)
            first, second = self.track(one, group.p, B), self.track(other, group.q, B)
            gap = second.base - first.base
            name = B
        else:
            P, inner, outer = group.outer_p, group.inner, group.outer_q
            assert isinstance(P, str)
            assert isinstance(inner, SlideEntry)
            assert isinstance(outer, SlideEntry)
            p, q = group.p, group.q
            frame = self.heading(outer.on if outer.of == q else outer.of)
            if inner.of == p:
                first, end = self._track_place(outer, q, inner.through), self.local(inner.at, p)
            else:
                first, end = self.track(outer, q, inner.at), local_plane(inner.through)
            base = first.base + rotated(self.local(P, p) - end, frame)
            first = first._replace(base=base)
            way = frame + Heading.of(inner.along.code)
            second = SlideLine(first.placed, base, 1 if inner.of == p else -1, way)
            one, other = outer, inner
            gap = self.at(P) - base
            name = P
        way_1, way_2 = first.heading, second.heading
        between = way_2 - way_1
        below = (
            Sum.of(between.sin)
            if between.sin not in ("1", "-1")
            else Sum.of("1").times(sign=int(between.sin))
        )
        if below.vanishes:
            raise self.linkage.refused(
                ("slides", other.at),
                "the slides at {at} and {at_2} are parallel: they do not fix the position",
                at=one.at,
                at_2=other.at,
            )
        words = {
            "B": name,
            "p": group.p,
            "q": group.q,
            "s": one.distance,
            "t": other.distance,
            "guide": first.placed,
        }
        sign_of_second = -second.sign if group.kind == "PRP" else second.sign

        def split(vector: Plane) -> tuple[str, str]:
            """Return the two components of a vector along both slides."""
            along_1 = (vector.x.times(way_2.sin) - vector.y.times(way_2.cos)).times(sign=first.sign)
            along_2 = (vector.y.times(way_1.cos) - vector.x.times(way_1.sin)).times(sign=sign_of_second)
            return over(along_1, below), over(along_2, below)

        def write(vector: Plane, ending: str, unit: str, step: str, order: int) -> None:
            for slide, code in zip((one, other), split(vector), strict=True):
                symbol = dotted(self.slide_symbol(slide), order)
                self.write(
                    slide.distance + ending, code, unit, step, symbol, words={**words, "s": slide.distance}
                )

        kind = "prp" if group.kind == "PRP" else "rpp"
        write(gap, "", "mm", f"slides_{kind}", 0)
        if group.kind == "PRP":
            start_1, start_2 = (
                self.hide(f"_line_{s.at}_{name}", t.base.complex) for s, t in ((one, first), (other, second))
            )
            units = [f"polar(1, {way.code})" for way in (way_1, way_2)]
            hidden = self.hide(
                f"_{name}",
                f"dyads.prp({start_1} + 0j, {units[0]}, {start_2} + 0j, {units[1]})",
                f"{group.p}, {group.q}",
                name,
            )
            self.write_end(name, first.moved(first.base, one.distance), words, hidden)
            self._finish_rod(group.p, name)
            self._finish_rod(group.q, name)
            carried = [self.carried(t.placed, self.at(name), "v") for t in (first, second)]
            write(carried[1] - carried[0], "_dot", "mm/s", f"slides_{kind}_rate", 1)
            self.write_rates(name, first.moved(carried[0], one.rates[0]), "v", "slides", words)
            turned = [t.across(self.coriolis(t, s.rates[0])) for s, t in ((one, first), (other, second))]
            carried = [self.carried(t.placed, self.at(name), "a") for t in (first, second)]
            gains = carried[1] + turned[1] - carried[0] - turned[0]
            write(gains, "_ddot", "mm/s^2", f"slides_{kind}_gain", 2)
            there = first.moved(carried[0], one.rates[1]) + turned[0]
            self.write_rates(name, there, "a", "slides", words)
            return
        # The body of the first slide is known by the point of it that the slide moves.
        self._finish_rod(group.p, name)
        moved = one.at if one.of == group.q else next(iter(self.linkage.bodies[group.q].points))
        track = self.track(one, group.q, moved)
        hidden = f"_{moved}"
        self.hide(f"_line_{moved}", track.base.complex)
        self.hide(
            hidden,
            f"_line_{moved} + {'-' if track.sign < 0 else ''}polar({one.distance}, {track.heading.code})",
        )
        self.write_end(moved, track.moved(track.base, one.distance), words, hidden)
        self._finish_rod(group.q, moved)
        v = self.velocity(name) - self.carried(track.placed, self.at(name), "v")
        write(v, "_dot", "mm/s", f"slides_{kind}_rate", 1)
        there = track.moved(self.carried(track.placed, self.at(moved), "v"), one.rates[0])
        self.write_rates(moved, there, "v", "slides", words)
        turned = [t.across(self.coriolis(t, s.rates[0])) for s, t in ((one, first), (other, second))]
        a = self.acceleration(name) - self.carried(track.placed, self.at(name), "a") - turned[0] - turned[1]
        write(a, "_ddot", "mm/s^2", f"slides_{kind}_gain", 2)
        there = track.moved(self.carried(track.placed, self.at(moved), "a"), one.rates[1])
        own = track.across(self.coriolis(track, one.rates[0]))
        self.write_rates(moved, there + own, "a", "slides", words)

    def _wheel(self, wheel: Wheel) -> None:
        gear, body = wheel.gear, wheel.body
        first, second = (f"({r.code})" if not r.code.isidentifier() else r.code for r in gear.radii)
        other = gear.first if body == gear.second else gear.second
        own, far = (second, first) if body == gear.second else (first, second)
        words = {"body": body, "other": other, "carrier": gear.carrier}

        def rolled(value: Any) -> str:
            mate, carrier = value(other), value(gear.carrier)
            ratio = f"{far} / {own}"
            about = (
                f"({mate} - {carrier})"
                if carrier != "0" and mate != "0"
                else mate
                if carrier == "0"
                else f"-{carrier}"
            )
            turned = f"{'' if gear.inner else '-'}{ratio} * {about}" if about != "0" else "0"
            turned = turned.replace("--", "")
            return turned if carrier == "0" else f"{carrier} {'+' if gear.inner else '-'} {ratio} * {about}"

        self.write(self.turns[body], rolled(lambda b: self.turns[b]), "deg", "turn_gear", words=words)
        self._finish_rod(body, wheel.at)
        self.write(self.omega(body), rolled(self.omega), "rad/s", "omega_gear", words=words)
        self.write(self.alpha(body), rolled(self.alpha), "rad/s^2", "alpha_gear", words=words)
