"""Joints along the axes of space in whole numbers: what they leave free, what they transmit, exact ranks."""

AXES = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}

#: Free rotations and translations: along the direction (d), the one after it (e), the one after that (f).
FREE = {
    "revolute": ("d", ""),
    "prismatic": ("", "d"),
    "cylindrical": ("d", "d"),
    "spherical_pin": ("ef", ""),
    "spherical": ("def", ""),
    "planar": ("d", "ef"),
    "annular": ("def", "d"),
    "line_contact": ("de", "df"),
    "point_contact": ("def", "ef"),
}

#: Blocked rotations and translations: along the direction (d), the one after it (e), the one after that (f).
BLOCKED = {
    "revolute": ("ef", "def"),
    "prismatic": ("def", "ef"),
    "cylindrical": ("ef", "ef"),
    "spherical_pin": ("d", "def"),
    "spherical": ("", "def"),
    "planar": ("ef", "d"),
    "annular": ("", "ef"),
    "line_contact": ("f", "e"),
    "point_contact": ("", "d"),
}


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def exact_rank(rows):
    """Of rows of whole numbers, by elimination without fractions (each division is exact)."""
    rows, found, before = [list(row) for row in rows], 0, 1
    for column in range(len(rows[0]) if rows else 0):
        place = next((r for r in range(found, len(rows)) if rows[r][column]), None)
        if place is None:
            continue
        rows[found], rows[place] = rows[place], rows[found]
        leading = rows[found]
        pivot = leading[column]
        for r in range(found + 1, len(rows)):
            factor = rows[r][column]
            rows[r] = [(pivot * x - factor * y) // before for x, y in zip(rows[r], leading, strict=True)]
        before = pivot
        found += 1
    return found


def letters(direction):
    """The axes by letter: d along a direction, e the one after it, f the one after that.

    Of a direction of whole numbers in a coordinate plane, e is a quarter of a turn further in that plane.
    """
    if direction not in AXES:
        d = [int(x) for x in direction.split()]
        e = cross([int(x == 0) for x in d], d)
        return {"d": d, "e": e, "f": cross(d, e)}
    first = "xyz".index(direction)
    return {k: AXES[a] for k, a in zip("def", "xyzxy"[first : first + 3], strict=True)}


def motions(name, direction, point):
    """Rotation and velocity at the origin of what a joint leaves free."""
    axes, (turns, slides) = letters(direction), FREE[name]
    return [[*axes[k], *cross(point, axes[k])] for k in turns] + [[0, 0, 0, *axes[k]] for k in slides]


def actions(name, direction, point):
    """Moment at the origin and force of what a joint transmits."""
    axes, (moments, forces) = letters(direction), BLOCKED[name]
    return [[*axes[k], 0, 0, 0] for k in moments] + [[*cross(point, axes[k]), *axes[k]] for k in forces]
