"""The twist of a motion at a point: angular velocity in rad/s before velocity, in the part's unit."""

from coursework.kinds.torsors import Torsor
from coursework.parsing.torsors import TWIST


class Twist(Torsor):
    name = "twist"
    unit = "mm/s"
    form = TWIST
    columns = ("ω", "v")  # the plane one has its velocity first

    def of_resultant(self, unit: str) -> str:
        return "rad/s"
