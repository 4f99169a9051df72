"""Forces in a mechanism at many digits, by another road: positions alone are taken from the textbook
formulas, motions are differences of positions, moments are taken about the centres of mass, friction is found
by substitution.
"""

from __future__ import annotations

import mpmath

from coursework.mechanics.statement import GROUND, number

DIGITS = 90
STEP = mpmath.mpf(10) ** -25  #: radians: differences are good to some 40 digits, also beside a dead point


class ExactMechanics:
    """A mechanism of an exercise, at a driver's angle (degrees), speed and acceleration; at a jack's length
    (mm), speed and acceleration where one drives: then its thrust (N) is what balances."""

    def __init__(self, exercise, mechanism, given, angle, speed, acceleration):
        self.mp = mpmath.MPContext()
        self.mp.dps = DIGITS
        self.exercise, self.mechanism = exercise, mechanism
        self.jack, self.driver = exercise.spec.driver.jack, exercise.spec.driver.moved
        self.graph = exercise.solution.graph.textbook
        names = exercise.quantity_names
        accepted = {**exercise.intake.defaults, **given}
        self.given = {
            n: v if isinstance(v, str) else self.mp.mpf(v) for n, v in accepted.items() if n in names
        }
        self.values = dict(self.given)
        self.unit = self.mp.mpf(1) if self.jack else self.mp.pi / 180
        self.q = self.mp.mpf(angle) * self.unit
        self.speed, self.acceleration = self.mp.mpf(speed), self.mp.mpf(acceleration)
        self.poses = [self._pose(self.q + k * STEP) for k in (-1, 0, 1)]

    # ------------------------------------------------------------------ positions

    def _pose(self, q):
        """Angles of bodies, radians, and places of points by (body, point), metres."""
        wanted = [n for n in self.mechanism.angles if n != self.driver]
        degrees = {self.driver: q / self.unit}
        degrees |= self.graph.evaluate(wanted, {**self.given, **degrees})
        angles, places = {GROUND: self.mp.mpf(0)}, {}
        for point in self.mechanism.ground:
            places[GROUND, point] = self._place(point, GROUND)
        for body in self.mechanism.bodies:
            turned = body.angle if isinstance(body.angle, (int, float)) else degrees[body.angle]
            angles[body.name] = self.mp.mpf(turned) * self.mp.pi / 180
            home = next(h for h in self.mechanism.holders(body.at) if (h, body.at) in places)
            for point in body.places:
                arm = self._place(point, body.name) * self.mp.expj(angles[body.name])
                places[body.name, point] = places[home, body.at] + arm
        return angles, places

    def _place(self, point, body):
        return self.mp.mpmathify(number(self.mechanism.place(point, body), self.values)) / 1000

    def _moved(self, read):
        """First and second derivative in time of something that a pose gives."""
        before, now, after = (read(pose) for pose in self.poses)
        # Directions are reduced to one turn: a step never is one.
        if not isinstance(now, self.mp.mpc):
            turn = 2 * self.mp.pi
            before, after = (x - turn * self.mp.nint((x - now) / turn) for x in (before, after))
        rate, bend = (after - before) / (2 * STEP), (after - 2 * now + before) / STEP**2
        return rate * self.speed, bend * self.speed**2 + rate * self.acceleration

    def place(self, point, body=None):
        body = body or self.mechanism.holders(point)[0]
        return self.poses[1][1][body, point]

    def velocity(self, point, body=None):
        body = body or self.mechanism.holders(point)[0]
        return self._moved(lambda pose: pose[1][body, point])[0]

    def turning(self, body):
        return self._moved(lambda pose: pose[0][body])

    # --------------------------------------------------------------------- forces

    def borne(self, *, gravity=False, inertia=False, loads=(), friction=None):
        """Unknowns by name, as the equations of the project call them.

        ``loads``: pairs of a point and a complex force; ``friction``: as a mechanism states it, by joint.
        """
        mp, unknowns, columns = self.mp, [], []
        several = {p.at: sum(q.at == p.at for q in self.mechanism.pins) for p in self.mechanism.pins}
        rubs = []
        for pin in self.mechanism.pins:
            name = f"{pin.at} {pin.of}" if several[pin.at] > 1 else pin.at
            at = self.place(pin.at, pin.of)
            for axis, force in (("x", mp.mpf(1)), ("y", mp.mpc(0, 1))):
                unknowns.append(f"{name}_{axis}")
                columns.append([(pin.of, at, force, 0), (pin.on, at, -force, 0)])
            if friction and name in friction and isinstance(friction[name], tuple):
                coefficient, radius = friction[name]
                spin = self.turning(pin.of)[0] - (self.turning(pin.on)[0] if pin.on != GROUND else 0)
                size = mp.mpf(coefficient) * mp.mpf(radius) / 1000 * mp.sign(spin)
                rubs.append(((f"{name}_x", f"{name}_y"), size, [(pin.of, at, 0, -1), (pin.on, at, 0, 1)]))
        for slide in self.mechanism.slides:
            name = f"{slide.at} slide" if slide.at in several else slide.at
            at = self.place(slide.at, slide.of)
            along = mp.expj(
                self.poses[1][0][slide.on] + mp.mpf(number(slide.along, self.values)) * mp.pi / 180
            )
            unknowns += [f"{name}_n", f"{name}_m"]
            columns.append([(slide.of, at, 1j * along, 0), (slide.on, at, -1j * along, 0)])
            columns.append([(slide.of, at, 0, 1), (slide.on, at, 0, -1)])
            if friction and slide.at in friction and not isinstance(friction[slide.at], tuple):
                rubs.append(
                    (
                        (f"{name}_n",),
                        mp.mpf(friction[slide.at]) * mp.sign(self._slip(slide, along)),
                        [(slide.of, at, -along, 0), (slide.on, at, along, 0)],
                    )
                )
        for gear in self.mechanism.gears:
            first, second = (mp.mpf(number(r, self.values)) for r in gear.radii)
            one, two = (self.place(self.mechanism.body(n).at, n) for n in (gear.first, gear.second))
            touch = one + (two - one) * first / (first + second)
            tangent = 1j * (two - one) / abs(two - one)
            unknowns.append(f"{gear.first}/{gear.second}_t")
            columns.append([(gear.first, touch, tangent, 0), (gear.second, touch, -tangent, 0)])
        unknowns.append("effort")
        columns.append(self._of_jack() if self.jack else self._of_crank())
        applied = [(self.mechanism.holders(p)[-1], self.place(p), force, 0) for p, force in loads]
        matrix = mp.matrix(len(columns), len(columns))
        for k, column in enumerate(columns):
            for row, value in enumerate(self._rows(column)):
                matrix[row, k] = value
        right = [-x for x in self._rows(applied, gravity=gravity, inertia=inertia)]
        solve = lambda rows: mp.lu_solve(matrix, mp.matrix(rows))  # noqa: E731
        free = solve(right)
        responses = [solve([-x for x in self._rows(unit)]) for _, _, unit in rubs]
        found, strengths = free, [mp.mpf(0)] * len(rubs)
        for _ in range(400 if rubs else 0):
            before = list(strengths)
            for k, (names, size, _) in enumerate(rubs):
                strengths[k] = size * mp.norm([found[unknowns.index(n)] for n in names], 2)
            found = free + sum(
                (r * w for r, w in zip(responses, strengths, strict=True)), mp.zeros(len(columns), 1)
            )
            if max(abs(a - b) for a, b in zip(before, strengths, strict=True)) < mp.mpf(10) ** -40:
                break
        return dict(zip(unknowns, found, strict=True))

    def _of_crank(self):
        driven = self.mechanism.driven_by(self.driver)
        return [(driven, self.place(self.mechanism.body(driven).at, driven), 0, 1)]

    def _of_jack(self):
        """A thrust between the ends of the jack, on the line through its two pins."""
        (slide,) = (s for s in self.mechanism.slides if s.at == self.mechanism.pushed)
        foot, head = self.place(self.mechanism.body(slide.on).at, slide.on), self.place(slide.at, slide.of)
        along = (head - foot) / abs(head - foot)
        return [(slide.of, head, along, 0), (slide.on, foot, -along, 0)]

    def _slip(self, slide, along):
        """Velocity along the guide, from differences of the place in the guide's frame."""

        def seen(pose):
            angles, places = pose
            home = (
                self.mechanism.body(slide.on).at if slide.on != GROUND else next(iter(self.mechanism.ground))
            )
            arm = places[slide.of, slide.at] - places[slide.on, home]
            return arm * self.mp.expj(-angles[slide.on])

        rate = self._moved(lambda pose: self.mp.mpc(seen(pose)))[0]
        return (rate / (along * self.mp.expj(-self.poses[1][0][slide.on]))).real

    def _rows(self, acting, *, gravity=False, inertia=False):
        """Sums of forces and of moments about the centre of mass, body by body."""
        rows = []
        for body in self.mechanism.bodies:
            centre = body.centre or body.at
            at = self.place(centre, body.name)
            mass, spin = (self.mp.mpf(number(x, self.values)) for x in (body.mass, body.inertia))
            force, moment = self.mp.mpc(0), self.mp.mpf(0)
            for name, where, push, turn in acting:
                if name == body.name:
                    push = self.mp.mpc(push)
                    force += push
                    moment += (self.mp.conj(where - at) * push).imag + turn
            if gravity:
                force += mass * self.mp.mpc(0, -self.mp.mpf(9.81))
            if inertia and (mass or spin):
                force -= mass * self._moved(lambda pose, b=body, c=centre: self.mp.mpc(pose[1][b.name, c]))[1]
                moment -= spin * self.turning(body.name)[1] if body.angle is not None else 0
            rows += [force.real, force.imag, moment]
        return rows
