"""Cost of accuracy in time: one mechanism computed in many ways, each timed and compared with fifty digits.

Every exercise with numbers takes part: its formulas in several precisions, tables, Newton's method on its
loops, library solvers, rates by differences, at generic places and at hard ones, which are found.
``ACCURACY = Study(…)`` in a solution adds a motion in time.
"""

from coursework.accuracy.study import Motion, Study

__all__ = ["Motion", "Study"]
