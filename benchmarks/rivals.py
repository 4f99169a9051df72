"""The motion in time of a mechanism by general multibody codes, and by a quadrature of many digits.

The rivals are handed the numbers that the package itself has read from a scene (bodies, centres, masses,
pins, slides, where everything stands and how fast it moves at the start); the quadrature has formulas of its
own.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from coursework.mechanics.linkage import BodyPoint, Linkage
from coursework.mechanics.wrenches import GRAVITY
from coursework.scenes.scenes import Scene

# ------------------------------------------------------------------------- exudyn


class Exudyn:
    """A scene as rigid bodies of exudyn, with joints as constraints; a constant torque on the driver."""

    def __init__(self, scene: Scene, start: float, speed: float, torque: float) -> None:
        import exudyn

        self.exudyn, self.linkage, self.start = exudyn, scene.linkage, start
        self.stance, self.speed, self.torque = scene.pose(np.array([start])), speed, torque

    def end(self, duration: float, steps: int, solver: str) -> float:
        """The driver's angle after a duration, radians, in so many equal steps of a solver."""
        system = self.exudyn.SystemContainer().AddSystem()
        nodes = self._build(system)
        settings = self.exudyn.SimulationSettings()
        time = settings.timeIntegration
        time.numberOfSteps, time.endTime, time.verboseMode = steps, duration, 0
        time.newton.relativeTolerance, time.newton.absoluteTolerance = 1e-10, 1e-12
        settings.solutionSettings.writeSolutionToFile = False
        settings.solutionSettings.sensorsWritePeriod = duration
        settings.displayComputationTime = False
        system.SolveDynamic(settings, solverType=getattr(self.exudyn.DynamicSolverType, solver))
        turned = system.GetNodeOutput(nodes[self.linkage.driven], self.exudyn.OutputVariableType.Coordinates)
        return self.start + float(turned[2])

    def _centre(self, body: int) -> complex:
        return next((mass.centre for mass in self.linkage.masses if mass.body == body), 0j)

    def _build(self, system: Any) -> list[Any]:
        from exudyn.itemInterface import LoadForceVector, LoadTorqueVector, ObjectGround

        self._ground, nodes, self._bodies = system.AddObject(ObjectGround()), [], []
        for mass in sorted(self.linkage.masses):
            nodes.append(self._add_body(system, mass))
        for mass in self.linkage.masses:
            at = self._marker(system, BodyPoint(mass.body, mass.centre))
            weight = [0, -mass.mass * GRAVITY, 0]
            system.AddLoad(LoadForceVector(markerNumber=at, loadVector=weight))
        driven = self._marker(system, BodyPoint(self.linkage.driven, self._centre(self.linkage.driven)))
        system.AddLoad(LoadTorqueVector(markerNumber=driven, loadVector=[0, 0, self.torque]))
        self._join(system)
        system.Assemble()
        return nodes

    def _add_body(self, system: Any, mass: Any) -> Any:
        from exudyn.itemInterface import NodeRigidBody2D, ObjectRigidBody2D

        held = BodyPoint(mass.body, mass.centre)
        place, rate = complex(self.stance.place(held)[0]), complex(self.stance.rate(held)[0]) * self.speed
        turn, turning = float(self.stance.turns[mass.body, 0]), float(self.stance.rates[mass.body, 0])
        node = system.AddNode(
            NodeRigidBody2D(
                referenceCoordinates=[place.real, place.imag, turn],
                initialVelocities=[rate.real, rate.imag, turning * self.speed],
            )
        )
        body = ObjectRigidBody2D(physicsMass=mass.mass, physicsInertia=mass.inertia, nodeNumber=node)
        self._bodies.append(system.AddObject(body))
        return node

    def _marker(self, system: Any, held: BodyPoint) -> Any:
        from exudyn.itemInterface import MarkerBodyRigid

        on_ground = held.body == -1
        local = held.place - (0j if on_ground else self._centre(held.body))
        body = self._ground if on_ground else self._bodies[held.body]
        return system.AddMarker(MarkerBodyRigid(bodyNumber=body, localPosition=[local.real, local.imag, 0]))

    def _join(self, system: Any) -> None:
        from exudyn.itemInterface import ObjectJointPrismatic2D, ObjectJointRevolute2D

        for pin in self.linkage.pins:
            markers = [self._marker(system, held) for held in (pin.on, pin.of)]
            system.AddObject(ObjectJointRevolute2D(markerNumbers=markers))
        for slide in self.linkage.slides:
            under = complex(self.stance.place(slide.of)[0]) - complex(self.stance.origins[slide.on, 0])
            under *= complex(self.stance.headings[slide.on, 0]).conjugate()
            markers = [self._marker(system, held) for held in (BodyPoint(slide.on, under), slide.of)]
            along = slide.along
            across = 1j * along * complex(self.stance.headings[slide.on, 0])
            across *= complex(self.stance.headings[slide.of.body, 0]).conjugate()
            system.AddObject(
                ObjectJointPrismatic2D(
                    markerNumbers=markers,
                    axisMarker0=[along.real, along.imag, 0],
                    normalMarker1=[across.real, across.imag, 0],
                )
            )


# -------------------------------------------------------------------------- sympy


class Kane:
    """A scene by Kane's method of sympy, its loops as constraints, written out as functions of numpy."""

    def __init__(self, scene: Scene, start: float, speed: float, torque: float) -> None:
        import sympy
        from sympy.physics import mechanics

        self.sympy, self.mechanics, self.linkage = sympy, mechanics, scene.linkage
        self.time, self.frame = sympy.Symbol("t"), mechanics.ReferenceFrame("N")
        mechanics.dynamicsymbols._t = self.time
        count = self.linkage.unknowns + 1
        self.angles = mechanics.dynamicsymbols(f"q:{count}")
        self.rates = mechanics.dynamicsymbols(f"u:{count}")
        self._origins = self._placed_origins()
        self._start(scene, start, speed)
        self.derivative = self._equations(torque)

    def end(self, duration: float, rtol: float) -> float:
        """The driver's angle after a duration, radians."""
        from scipy.integrate import solve_ivp

        found = solve_ivp(
            self.derivative, (0, duration), self.state, method="DOP853", rtol=rtol, atol=rtol * self._scale
        )
        return float(found.y[0, -1])

    def _start(self, scene: Scene, start: float, speed: float) -> None:
        stance = scene.pose(np.array([start]))
        state = {c: (stance.turns[b, 0], stance.rates[b, 0]) for b, c in enumerate(self.linkage.coordinates)}
        order = range(self.linkage.unknowns + 1)
        self.state = np.array([state[c][0] for c in order] + [state[c][1] * speed for c in order])
        self._scale = np.array([1.0] * len(order) + [abs(speed)] * len(order))

    def _turn(self, body: int) -> Any:
        own = self.linkage.coordinates[body]
        return self.sympy.Integer(0) if own == -1 else self.angles[own]

    def _arm(self, held: BodyPoint) -> Any:
        """A place from the origin of its body, as a column of two."""
        turn, x, y = self._turn(held.body), held.place.real, held.place.imag
        cos, sin = self.sympy.cos(turn), self.sympy.sin(turn)
        return self.sympy.Matrix([x * cos - y * sin, x * sin + y * cos])

    def _placed_origins(self) -> list[Any]:
        self._origins = [self.sympy.zeros(2, 1)] * (len(self.linkage.origins) + 1)
        for body, held in enumerate(self.linkage.origins):
            self._origins[body] = self._place(held)
        return self._origins

    def _place(self, held: BodyPoint) -> Any:
        return self._origins[held.body] + self._arm(held)

    def _constraints(self) -> list[Any]:
        """What pins and slides hold to nothing."""
        found = []
        for pin in self.linkage.pins:
            if pin.closes:
                found += list(self._place(pin.of) - self._place(pin.on))
        for slide in self.linkage.slides:
            across = self._arm(BodyPoint(slide.on, 1j * slide.along))
            gap = (self._place(slide.of) - self._origins[slide.on]).dot(across)
            found.append(gap - gap.subs(self._at_start))
        return found

    @property
    def _at_start(self) -> dict[Any, float]:
        return dict(zip(self.angles, self.state[: len(self.angles)].tolist(), strict=True))

    def _equations(self, torque: float) -> Callable[[float, np.ndarray], np.ndarray]:
        sympy, mechanics = self.sympy, self.mechanics
        held = self._constraints()
        moving = dict(zip([q.diff(self.time) for q in self.angles], self.rates, strict=True))
        kane = mechanics.KanesMethod(
            self.frame,
            q_ind=self.angles[:1],
            u_ind=self.rates[:1],
            kd_eqs=[q.diff(self.time) - u for q, u in zip(self.angles, self.rates, strict=True)],
            q_dependent=self.angles[1:],
            configuration_constraints=held,
            u_dependent=self.rates[1:],
            velocity_constraints=[c.diff(self.time).subs(moving) for c in held],
        )
        bodies, loads = self._bodies(moving, torque)
        kane.kanes_equations(bodies, loads)
        both = [kane.mass_matrix_full, kane.forcing_full]
        functions = sympy.lambdify([*self.angles, *self.rates], both, modules="numpy", cse=True)

        def derivative(_: float, state: np.ndarray) -> np.ndarray:
            mass, forcing = functions(*state)
            return np.linalg.solve(mass, forcing)[:, 0]

        return derivative

    def _bodies(self, moving: Any, torque: float) -> tuple[list[Any], list[Any]]:
        mechanics, frame = self.mechanics, self.frame
        bodies, loads = [], []
        fixed = mechanics.Point("fixed")
        fixed.set_vel(frame, 0)
        for mass in self.linkage.masses:
            x, y = self._place(BodyPoint(mass.body, mass.centre))
            centre = fixed.locatenew(f"G{mass.body}", x * frame.x + y * frame.y)
            rates = [c.diff(self.time).subs(moving) for c in (x, y)]
            centre.set_vel(frame, rates[0] * frame.x + rates[1] * frame.y)
            turned = frame.orientnew(f"B{mass.body}", "Axis", [self._turn(mass.body), frame.z])
            turned.set_ang_vel(frame, self._turn(mass.body).diff(self.time).subs(moving) * frame.z)
            inertia = (mechanics.inertia(turned, 0, 0, mass.inertia), centre)
            bodies.append(mechanics.RigidBody(f"b{mass.body}", centre, turned, mass.mass, inertia))
            loads.append((centre, -mass.mass * GRAVITY * frame.y))
            if mass.body == self.linkage.driven:
                loads.append((turned, torque * frame.z))
        return bodies, loads


# ---------------------------------------------------------------------- quadrature


class Quadrature:
    """The motion from its first integral, by many digits: the kinetic energy is what torque and weights have
    worked, so the speed is known at every angle, and the time to an angle is an integral.

    ``shape``: ``"four_bar"`` or ``"slider_crank"``, with its lengths in mm.
    """

    def __init__(
        self, linkage: Linkage, shape: str, given: Any, start: float, speed: float, torque: float
    ) -> None:
        import mpmath

        self.mp = mpmath.MPContext()
        self.mp.dps = 30
        self.masses = linkage.masses
        self.given = {
            n: self.mp.mpf(v) / 1000 for n, v in given.items() if n in ("r1", "r2", "r3", "r4", "e")
        }
        self.angles = getattr(self, f"_{shape}")
        self.crossed = given.get("mode") == "crossed"
        self.start, self.torque = self.mp.mpf(start), self.mp.mpf(torque)
        inertia, height = self._inertia_and_height(self.start)
        self.energy = inertia * self.mp.mpf(speed) ** 2 / 2 + height - self.torque * self.start

    def _four_bar(self, theta2: Any) -> list[tuple[Any, Any, Any]]:
        """Angle, rate and origin with its rate, of the bodies in turn: by where two circles meet."""
        mp, (r1, r2, r3, r4) = self.mp, (self.given[f"r{k}"] for k in range(1, 5))
        crank = mp.expj(theta2)
        line = r1 - r2 * crank
        length = abs(line)
        along = (length**2 + r3**2 - r4**2) / (2 * length)
        across = mp.sqrt(r3**2 - along**2) * (-1 if self.crossed else 1)
        coupler = line / length * mp.mpc(along, across) / r3
        rocker = (r2 * crank + r3 * coupler - r1) / r4
        between = (coupler / rocker).imag
        rates = r2 * (rocker / crank).imag / (r3 * between), r2 * (coupler / crank).imag / (r4 * between)
        return [
            (crank, 1, (0, 0)),
            (coupler, rates[0], (r2 * crank, 1j * r2 * crank)),
            (rocker, rates[1], (r1, 0)),
        ]

    def _slider_crank(self, theta2: Any) -> list[tuple[Any, Any, Any]]:
        mp, (r2, r3, e) = self.mp, (self.given[n] for n in ("r2", "r3", "e"))
        crank = mp.expj(theta2)
        sine = (e - r2 * crank.imag) / r3
        rod = mp.mpc(mp.sqrt(1 - sine**2), sine)
        rate = -r2 * crank.real / (r3 * rod.real)
        pin, pin_rate = r2 * crank, 1j * r2 * crank
        piston = pin + r3 * rod, (pin_rate + 1j * rate * r3 * rod).real
        return [(crank, 1, (0, 0)), (rod, rate, (pin, pin_rate)), (mp.mpc(1), 0, piston)]

    def _inertia_and_height(self, theta2: Any) -> tuple[Any, Any]:
        """The generalised inertia, kg m^2, and the energy of the weights, J."""
        bodies, inertia, potential = self.angles(theta2), self.mp.mpf(0), self.mp.mpf(0)
        for own in self.masses:
            heading, rate, (origin, origin_rate) = bodies[own.body]
            arm = self.mp.mpc(own.centre) * heading
            inertia += own.mass * abs(origin_rate + 1j * rate * arm) ** 2 + own.inertia * rate**2
            potential += own.mass * self.mp.mpf(GRAVITY) * self.mp.im(origin + arm)
        return inertia, potential

    def speed(self, theta2: Any) -> Any:
        inertia, height = self._inertia_and_height(theta2)
        return self.mp.sqrt(2 * (self.energy + self.torque * theta2 - height) / inertia)

    def duration(self, start: Any, end: Any, pieces: int) -> Any:
        """Seconds from one angle to another, forwards."""
        places = self.mp.linspace(start, end, pieces + 1)
        return self.mp.quad(lambda q: 1 / self.speed(q), places, method="gauss-legendre", maxdegree=5)

    def end(self, duration: float, near: float) -> float:
        """The driver's angle after a duration, radians, from one near it: two steps of Newton's method."""
        near = self.mp.mpf(near)
        lacking = duration - self.duration(self.start, near, max(8, math.ceil(4 * float(near - self.start))))
        for _ in range(2):
            step = lacking * self.speed(near)
            lacking -= self.duration(near, near + step, 1)
            near += step
        return float(near)
