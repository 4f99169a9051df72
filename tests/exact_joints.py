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
    if isinstance(direction, dict):
        return direction
    if direction not in AXES:
        d = [int(x) for x in direction.split()]
        e = cross([int(x == 0) for x in d], d)
        return {"d": d, "e": e, "f": cross(d, e)}
    first = "xyz".index(direction)
    return {k: AXES[a] for k, a in zip("def", "xyzxy"[first : first + 3], strict=True)}


def turned(vector, tilt):
    """Five times a vector turned about the axis of a letter, by the angle of cosine 4/5 and sine 3/5; or the
    vector."""
    if not tilt:
        return list(vector)
    k = "xyz".index(tilt)
    i, j = (k + 1) % 3, (k + 2) % 3
    found = [5 * x for x in vector]
    found[i], found[j] = 4 * vector[i] - 3 * vector[j], 3 * vector[i] + 4 * vector[j]
    return found


#: How many joints an arrangement has, and what it does to them.
COUNTS = {"two": 2, "two_tilted": 2, "two_inclined": 2, "three": 3, "three_tilted": 3, "four": 4}


def arrangement(given):
    """The joints of a variant: name, axes by letter and point in whole numbers."""
    found = []
    tilt = given["tilt"] if given["arrangement"].endswith("tilted") else ""
    for k in range(1, COUNTS[given["arrangement"]] + 1):
        along = (
            given["inclined"] if (k, given["arrangement"]) == (2, "two_inclined") else given[f"direction_{k}"]
        )
        axes = {letter: turned(axis, tilt) for letter, axis in letters(along).items()}
        point = [int(given[f"{c}{k}"]) if k > 1 else 0 for c in "xyz"]
        place = turned(point, tilt)
        found.append((given[f"joint_{k}"], axes, [c // 5 for c in place] if tilt else place))
    return found


def motions(name, direction, point):
    """Rotation and velocity at the origin of what a joint leaves free; a direction may be given by its
    axes."""
    axes, (turns, slides) = letters(direction), FREE[name]
    return [[*axes[k], *cross(point, axes[k])] for k in turns] + [[0, 0, 0, *axes[k]] for k in slides]


def actions(name, direction, point):
    """Moment at the origin and force of what a joint transmits; a direction may be given by its axes."""
    axes, (moments, forces) = letters(direction), BLOCKED[name]
    return [[*axes[k], 0, 0, 0] for k in moments] + [[*cross(point, axes[k]), *axes[k]] for k in forces]
