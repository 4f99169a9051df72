"""Common base of lesson figures: joint graphs with several joints between two bodies."""

from coursework.figures import circle, line, note, trace

RADIUS = 4.5  #: of a body's circle, mm


def bodies(places, *, frame="0"):
    """A circle a body, with its number at its place; the frame has a second circle."""
    found = []
    for name, place in places.items():
        found += [circle(place, RADIUS), note(place, name)]
    if frame in places:
        found.append(circle(places[frame], 1.2 * RADIUS))
    return found


def joint(p, q, label=None, bend=0.0):
    """A line between the rims of two bodies; ``bend`` is how far its middle stands off, mm, to the left of p
    to q."""
    way = (q - p) / abs(q - p)
    if not bend:
        return [line(p + 1.2 * RADIUS * way, q - 1.2 * RADIUS * way, thin=False, label=label)]
    control = (p + q) / 2 + 2 * bend * 1j * way
    start, end = (z + 1.2 * RADIUS * (control - z) / abs(control - z) for z in (p, q))
    curve = [
        (1 - s / 16) ** 2 * start + 2 * s / 16 * (1 - s / 16) * control + (s / 16) ** 2 * end
        for s in range(17)
    ]
    found = [trace(curve, dotted=False)]
    return [*found, note(curve[8] + 4j * way * (1 if bend > 0 else -1), label)] if label else found
