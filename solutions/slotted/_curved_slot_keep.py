"""A crank pin in the curved slot of a lever: the conditions on answers that a variant must satisfy."""

__all__ = ["HELPERS", "KEEP"]


def rates(bars):
    """omega3 and omega4 over omega2."""
    crank, radius, lever = bars
    area = _cross(lever, radius)
    return _cross(crank, lever) / area, _cross(crank, radius) / area


def accelerations(bars, rates):
    """alpha3 and alpha4 over omega2 squared, the crank turning steadily."""
    crank, radius, lever = bars
    along = crank + rates[0] ** 2 * radius - rates[1] ** 2 * lever
    area = _cross(radius, lever)
    return _dot(along, lever) / area, _dot(along, radius) / area


def _cross(u, v):
    return u.real * v.imag - u.imag * v.real


def _dot(u, v):
    return u.real * v.real + u.imag * v.imag


def pin_slides_visibly(rates):
    return abs(rates[0] - rates[1]) > 0.15


def lever_turns_visibly(rates):
    return abs(rates[1]) > 0.12


def rates_of_sliding_change_visibly(accelerations):
    return (abs(accelerations[0] - accelerations[1]) > 0.1) & (abs(accelerations[1]) > 0.08)


HELPERS = (
    rates,
    accelerations,
)
KEEP = (
    pin_slides_visibly,
    lever_turns_visibly,
    rates_of_sliding_change_visibly,
)
