"""Forces in plane mechanisms, from one statement of bodies and joints.

A solution states its mechanism once, in the names of its quantities::

    MECHANISM = Mechanism(
        ground={"O": 0, "C": "r1"},
        bodies=(
            Body("2", "theta2", "O", {"A": "r2"}),
            Body("3", "theta3", "A", {"B": "r3"}),
            Body("4", "theta4", "C", {"B": "r4"}),
        ),
    )

A point that bodies share is a pin. From this follow mobility, the motion of every point, what the drive must
supply, what the joints bear, friction, sticking and jamming, and the motion in time.
"""

from coursework.mechanics.statement import GROUND, Body, Gear, Load, Mechanism, Slide

__all__ = ["GROUND", "Body", "Gear", "Load", "Mechanism", "Slide"]
