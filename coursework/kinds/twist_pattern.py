"""Components of a twist that may differ from zero: ``wz vx``."""

from coursework.kinds.torsors import Pattern
from coursework.parsing.torsors import TWIST


class TwistPattern(Pattern):
    name = "twist_pattern"
    form = TWIST
