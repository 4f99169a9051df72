"""The wrench of an action at a point: force, in N or in what goes with the part's unit, before moment."""

from coursework.kinds.torsors import Torsor
from coursework.parsing.torsors import WRENCH


class Wrench(Torsor):
    name = "wrench"
    unit = "N*mm"
    form = WRENCH

    def of_resultant(self, unit: str) -> str:
        """``N*mm`` goes with N, ``kN*m`` with kN."""
        return unit.partition("*")[0]
