"""The twist of a motion at a point: angular velocity in rad/s before velocity, in the part's unit."""

from coursework.kinds.torsors import Torsor
from coursework.reading.torsors import TWIST


class Twist(Torsor):
    name = "twist"
    unit = "mm/s"
    form = TWIST

    def of_resultant(self, unit: str) -> str:
        return "rad/s"
