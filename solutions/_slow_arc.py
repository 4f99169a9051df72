"""A wanted time ratio: what the slow stroke takes of a turn, and beyond half a turn."""

from coursework.solution import formula, mistake, stable


@formula(r"360^{\circ} \times \frac{<Q>}{1 + <Q>}")
def alpha(Q):
    """The slow stroke takes this of a turn."""
    return 360 * Q / (1 + Q)


@stable(lambda Q: 180 * (Q - 1) / (Q + 1))
def phi(alpha):
    return alpha - 180


@mistake("alpha")
def share_of_half_a_turn(Q):
    return 180 * Q


@mistake("alpha", kind="exchanged")
def angle_of_the_return(Q):
    return 360 / (1 + Q)


@mistake("alpha")
def excess_twice(alpha):
    return 2 * alpha - 180
