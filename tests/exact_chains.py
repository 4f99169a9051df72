"""Chains of solids in whole numbers, by the velocities of the bodies instead of the rates of the joints."""

from exact_joints import actions, exact_rank

#: What a joint forbids of the relative motion (rotation, velocity at the origin), a row each: what it
#: transmits.
hindered = actions


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
    return width - exact_rank(rows), len(rows)
