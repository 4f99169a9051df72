"""Components of a wrench that may differ from zero: ``X Y M``."""

from coursework.kinds.torsors import Pattern
from coursework.parsing.torsors import WRENCH


class WrenchPattern(Pattern):
    name = "wrench_pattern"
    form = WRENCH
