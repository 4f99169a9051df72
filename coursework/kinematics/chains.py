"""Any closed chain, triads and beyond, by Newton's method on its loop-closure equations.

A loop is a list of vectors ``sign * length * e^{i (angle + turn)}`` whose sum is zero; a length or an
angle is a number or a name, and a name is known or unknown. The Jacobian is exact: a vector turned by a
quarter for its angle, its unit vector for its length. Which of the assemblies is found is decided by the
start, so that it must be near the one that is meant; every answer comes with a certificate.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from coursework.errors import CannotAssemble, Undefined, WrongValue
from coursework.kinematics.angles import Degrees, full_angle
from coursework.kinematics.scaling import exponent_of, scaled
from coursework.kinematics.vectors import derivative
from coursework.system.blocks import in_blocks

_STEPS = 60  #: Newton needs about six from a good start; damped steps may need more
_HALVINGS = 12
_EPS = np.finfo(float).eps


class Vector(NamedTuple):
    """Vector of a loop. ``turn`` is a constant angle added to ``angle``, such as the corner of a ternary
    link."""

    length: str | float
    angle: str | float
    sign: int = 1
    turn: str | float = 0.0


class Pose(NamedTuple):
    """Unknowns of a closed chain by name, with residual, condition number and convergence.

    ``residual``: the largest loop gap, in units of length. ``condition``: of the Jacobian by its singular
    values, lengths measured by the longest known one, so that the unit does not matter; infinite at a
    dead point. ``converged``: whether the gap is rounding.
    """

    values: dict[str, Any]
    residual: Any
    condition: Any
    converged: Any


class ClosedChain:
    """Closed chain of any number of loops, with two unknowns a loop.

    Raises
    ------
    WrongValue
        The number of unknowns is not twice that of the loops, or an unknown is in no loop or is a length
        and an angle.
    """

    def __init__(self, loops: Sequence[Sequence[Vector]], unknowns: Sequence[str]) -> None:
        self.loops = tuple(tuple(loop) for loop in loops)
        self.unknowns = tuple(unknowns)
        vectors = [vector for loop in self.loops for vector in loop]
        self._lengths = {v.length for v in vectors if isinstance(v.length, str)}
        turns = {v.turn for v in vectors if isinstance(v.turn, str)}
        self._angles = {v.angle for v in vectors if isinstance(v.angle, str)} | turns
        if len(self.unknowns) != 2 * len(self.loops):
            raise WrongValue(
                "{loops} loops fix {fixed} unknowns; {asked} are asked",
                loops=len(self.loops),
                fixed=2 * len(self.loops),
                asked=len(self.unknowns),
            )
        for name in self.unknowns:
            if (name in self._lengths) == (name in self._angles):
                raise WrongValue(
                    "the unknown {name!r} must be a length or an angle of some vector", name=name
                )
            if name in turns:
                raise WrongValue(
                    "{name!r} is a constant angle added to another; it cannot be unknown", name=name
                )
        self.known = tuple(sorted((self._lengths | self._angles) - set(self.unknowns)))
        self._measures = [v.length for v in vectors if not isinstance(v.length, str)]

    def solve(self, known: Mapping[str, Any], start: Mapping[str, Any]) -> Pose:
        """Close the loops.

        Parameters
        ----------
        known
            Values by name, scalars or arrays that broadcast; angles in radians or as :class:`Degrees`.
        start
            A first guess of each unknown, scalars or arrays that broadcast with the known values.

        Returns
        -------
        Unknown angles in (-pi, pi] and lengths, of the broadcast shape, with their certificate.

        Raises
        ------
        CannotAssemble
            Scalars only: no closed pose was reached from this start; says what gap is left. In arrays
            such a place is NaN and not ``converged``.
        """
        directions = {
            name: full_angle(
                known[name] if isinstance(known[name], Degrees) else np.asarray(known[name], float)
            )
            for name in self.known
            if name in self._angles
        }
        lengths = {name: np.asarray(known[name], float) for name in self.known if name in self._lengths}
        exponent = exponent_of(*lengths.values(), *self._measures, 0.0)
        guesses = [
            scaled(start[name], -exponent) if name in self._lengths else np.asarray(start[name], float)
            for name in self.unknowns
        ]
        inputs = [
            exponent,
            *[scaled(value, -exponent) for value in lengths.values()],
            *[part for value in directions.values() for part in value],
            *guesses,
        ]

        def kernel(exponent: Any, *given: Any) -> tuple:
            given = np.broadcast_arrays(exponent, *given)
            shape = given[0].shape
            exponents, *flat = (np.ravel(x) for x in given)
            values = dict(zip(lengths, flat, strict=False))
            rest = flat[len(lengths) :]
            for i, name in enumerate(directions):
                values[name] = rest[2 * i] + 1j * rest[2 * i + 1]
            result = self._newton(values, np.stack(rest[2 * len(directions) :], axis=1), exponents)
            return tuple(x.reshape(shape) for x in result)

        result: list[Any]
        residual: Any
        condition: Any
        converged: Any
        *result, residual, condition, converged, widest = in_blocks(kernel, *inputs)
        for i, name in enumerate(self.unknowns):
            if name in self._lengths:
                result[i] = scaled(result[i], exponent)
        residual, converged = scaled(residual, exponent), converged == 1.0
        if not residual.ndim:
            result, residual, condition = [x.item() for x in result], residual.item(), condition.item()
            converged = bool(converged)
            if not converged:
                raise CannotAssemble(
                    "the loops do not close from this start: a gap of {residual:.3g} is left in loop {loop}; "
                    "another start, nearer to the pose that is meant, may close, or none exists",
                    residual=residual,
                    loop=int(widest.item()) + 1,
                )
        return Pose(dict(zip(self.unknowns, result, strict=True)), residual, condition, converged)

    def rates(
        self, values: Mapping[str, Any], known_rates: Mapping[str, Sequence[Any]], *, order: int = 1
    ) -> dict[str, tuple]:
        """Return the time derivatives of the unknowns by name; all orders share the Jacobian.

        Parameters
        ----------
        values
            Known values and unknowns of a closed pose by name: lengths in one unit, angles in radians or as
            headings; scalars or arrays that broadcast.
        known_rates
            Time derivatives of the known names that vary, from the first on: rad/s or the unit of length per
            second, and so on.
        order
            Highest order of the derivatives, 1 to 3.

        Returns
        -------
        By unknown its derivatives from the first to ``order``, of the broadcast shape, in the units of the
        known ones.

        Raises
        ------
        Undefined
            Scalars only: a dead point, where the Jacobian is singular. Not finite in arrays.

        Source
        ------
        The loop-closure equations, differentiated: each order is one linear system.
        """
        exponent = exponent_of(
            *[np.asarray(values[name], float) for name in sorted(self._lengths)], *self._measures, 0.0
        )
        values = {
            name: scaled(value, -exponent) if name in self._lengths else _unit_of(value)
            for name, value in values.items()
            if name in self._lengths or name in self._angles
        }
        rates = {
            name: tuple(scaled(x, -exponent) if name in self._lengths else x for x in given)
            for name, given in known_rates.items()
        }
        rates |= dict.fromkeys(self.unknowns, ())
        jacobian = self._jacobian(values, exponent)
        for n in range(1, order + 1):
            sums = [
                sum(self._vector_rate(v, values, rates, exponent, n) for v in loop) for loop in self.loops
            ]
            right = np.stack(
                np.broadcast_arrays(*[x for z in sums for x in (-np.real(z), -np.imag(z))]), axis=-1
            )
            shape = np.broadcast_shapes(jacobian.shape[:-1], right.shape)
            steps = _steps(
                np.broadcast_to(jacobian, (*shape, shape[-1])), np.broadcast_to(right, shape), np.nan
            )
            rates |= {name: (*rates[name], steps[..., i]) for i, name in enumerate(self.unknowns)}
        results = {
            name: tuple((scaled(x, exponent) if name in self._lengths else x)[()] for x in rates[name])
            for name in self.unknowns
        }
        if any(not np.ndim(x) and not np.isfinite(x) for given in results.values() for x in given):
            raise Undefined(
                "the chain is at a dead point: its Jacobian is singular and the rates do not exist"
            )
        return results

    def _newton(self, values: dict[str, Any], x: np.ndarray, exponents: np.ndarray) -> tuple:
        """Take damped Newton steps on rows of unknowns, each until its gap is rounding or no longer
        shrinks."""
        x = x.copy()
        gaps, size = self._gaps(values, x, exponents)
        best = _norm(gaps)
        working = np.flatnonzero(best > 0)
        for _ in range(_STEPS):
            if not len(working):
                break
            working_values = {name: value[working] for name, value in values.items()}
            scale = exponents[working]
            jacobian = self._jacobian(working_values | self._named(x[working]), scale)
            step = _steps(jacobian, -gaps[working], 0.0)
            trial, trial_gaps, trial_best, share = (
                x[working],
                gaps[working],
                best[working],
                np.ones(len(working)),
            )
            pending = np.ones(len(working), dtype=bool)
            for _ in range(_HALVINGS):
                moved = x[working] + share[:, None] * step
                moved_gaps, _ = self._gaps(working_values, moved, scale)
                better = pending & (_norm(moved_gaps) < best[working])
                trial = np.where(better[:, None], moved, trial)
                trial_gaps = np.where(better[:, None], moved_gaps, trial_gaps)
                trial_best = np.where(better, _norm(moved_gaps), trial_best)
                # A gap that is rounding is not worth a shorter step.
                pending &= ~better & (best[working] > 8 * _EPS * size[working])
                if not pending.any():
                    break
                share = np.where(pending, share / 2, share)
            improved = trial_best < best[working]
            x[working], gaps[working], best[working] = trial, trial_gaps, trial_best
            working = working[improved & (trial_best > 0)]
        converged = best <= 32 * _EPS * size
        x = np.where(converged[:, None], x, np.nan)
        condition = _condition(self._jacobian(values | self._named(x), exponents))
        for i, name in enumerate(self.unknowns):
            if name in self._angles:
                x[:, i] = _wrapped(x[:, i])
        widest = abs(gaps).argmax(axis=1) // 2
        return *x.T, best, condition, converged.astype(float), widest.astype(float)

    def _named(self, x: np.ndarray) -> dict[str, Any]:
        """Return the columns of unknowns by name, an angle as its unit vector."""
        return {
            name: x[:, i] if name in self._lengths else np.cos(x[:, i]) + 1j * np.sin(x[:, i])
            for i, name in enumerate(self.unknowns)
        }

    def _gaps(self, values: dict[str, Any], x: np.ndarray, exponents: np.ndarray) -> tuple:
        """Return the sum of each loop, real and imaginary parts in turn, and the size of its terms."""
        values = values | self._named(x)
        parts, size = [], np.zeros(len(x))
        for loop in self.loops:
            vectors = [self._vector(v, values, exponents)[0] for v in loop]
            total = sum(vectors)
            parts += [np.real(total), np.imag(total)]
            size = np.maximum(size, sum(abs(z) for z in vectors))
        return np.stack(np.broadcast_arrays(*parts, np.zeros(len(x)))[:-1], axis=1), size

    def _vector(self, v: Vector, values: Mapping[str, Any], exponents: Any) -> tuple[Any, Any]:
        """Return the vector and its unit vector, signed."""
        length = values[v.length] if isinstance(v.length, str) else scaled(v.length, -exponents)
        fixed = sum(a for a in (v.angle, v.turn) if not isinstance(a, str))
        unit = v.sign * complex(math.cos(fixed), math.sin(fixed)) if fixed else v.sign
        for name in (v.angle, v.turn):
            unit = unit * values[name] if isinstance(name, str) else unit
        return length * unit, unit

    def _vector_rate(self, v: Vector, values: Mapping, rates: Mapping, exponents: Any, n: int) -> Any:
        arm, unit = self._vector(v, values, exponents)
        of_length = rates.get(v.length, ()) if isinstance(v.length, str) else ()
        of_angle = rates.get(v.angle, ()) if isinstance(v.angle, str) else ()
        return derivative(arm, unit, of_length[:n], of_angle[:n], n)

    def _jacobian(self, values: Mapping[str, Any], exponents: Any) -> np.ndarray:
        """Return the Jacobian, shape ``(..., 2 loops, unknowns)``. Lengths are scaled, so that every column
        is of order 1."""
        rows = []
        for loop in self.loops:
            columns = dict.fromkeys(self.unknowns, 0.0)
            for v in loop:
                arm, unit = self._vector(v, values, exponents)
                if v.length in columns:
                    columns[v.length] = columns[v.length] + unit
                if v.angle in columns:
                    columns[v.angle] = columns[v.angle] + 1j * arm
            rows += [[np.real(c) for c in columns.values()], [np.imag(c) for c in columns.values()]]
        flat = np.broadcast_arrays(*[entry for row in rows for entry in row])
        return np.stack(flat, axis=-1).reshape(*flat[0].shape, len(rows), len(self.unknowns))


def _unit_of(angle: Any) -> Any:
    cos, sin = full_angle(angle)
    return cos + 1j * sin


def _norm(gaps: np.ndarray) -> np.ndarray:
    result = abs(gaps).max(axis=-1)
    return np.where(np.isnan(result), np.inf, result)


def _wrapped(angles: np.ndarray) -> np.ndarray:
    """Return the angles reduced to (-pi, pi]; an angle already there keeps all its digits."""
    inside = (angles > -math.pi) & (angles <= math.pi)
    return np.where(inside, angles, math.pi - np.mod(math.pi - angles, 2 * math.pi))


def _steps(jacobian: np.ndarray, right: np.ndarray, otherwise: float) -> np.ndarray:
    """Solve many linear systems; the solution is ``otherwise`` where a matrix is singular to rounding or not
    finite."""
    finite = np.isfinite(jacobian).all(axis=(-1, -2)) & np.isfinite(right).all(axis=-1)
    identity = np.eye(jacobian.shape[-1])
    regular = finite & (abs(np.linalg.det(np.where(finite[..., None, None], jacobian, 0.0))) > 0)
    result = np.linalg.solve(
        np.where(regular[..., None, None], jacobian, identity),
        np.where(regular[..., None], right, 0.0)[..., None],
    )
    return np.where(regular[..., None], result[..., 0], otherwise)


def _condition(jacobian: np.ndarray) -> np.ndarray:
    """Return the ratio of the largest to the least singular value; NaN where the matrix is not finite."""
    finite = np.isfinite(jacobian).all(axis=(-1, -2))
    sizes = np.linalg.svd(np.where(finite[..., None, None], jacobian, 0.0), compute_uv=False)
    return np.where(finite, np.divide(sizes[..., 0], sizes[..., -1]), np.nan)
