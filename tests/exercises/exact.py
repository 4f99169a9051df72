"""Chains of solids in whole numbers, by the velocities of the bodies instead of the rates of the joints."""

AXES = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}

#: Hindered rotations and translations: along the direction (d), the next (e), the one after that (f).
HINDERED = {
    "revolute": ("ef", "def"),
    "prismatic": ("def", "ef"),
    "cylindrical": ("ef", "ef"),
    "spherical": ("", "def"),
    "planar": ("ef", "d"),
    "annular": ("", "ef"),
    "line_contact": ("f", "e"),
    "point_contact": ("", "d"),
}


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def rank(rows):
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


def hindered(name, along, point):
    """What a joint forbids of the relative motion (rotation, velocity at the origin), a row each."""
    first = "xyz".index(along)
    letters = {k: AXES[a] for k, a in zip("def", "xyzxy"[first : first + 3], strict=True)}
    turns, slides = HINDERED[name]
    rows = [[*letters[k], 0, 0, 0] for k in turns]
    # The velocity at the point along a direction: that at the origin, and rotation × point.
    return rows + [[*cross(point, letters[k]), *letters[k]] for k in slides]


def held(body):
    """A joint with the frame that forbids everything."""
    return ((0, body), [[int(i == j) for j in range(6)] for i in range(6)])


def freedoms(bodies, joints):
    """Independent motions of the moving bodies; a joint is (between, what it forbids)."""
    rows = []
    for (one, other), forbidden in joints:
        for row in forbidden:
            whole = [0] * (len(row) * (bodies + 1))
            whole[len(row) * one : len(row) * (one + 1)] = row
            whole[len(row) * other : len(row) * (other + 1)] = [-x for x in row]
            rows.append(whole[len(row) :])
    width = len(rows[0])
    return width - rank(rows), len(rows)
