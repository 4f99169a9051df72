"""What accuracy costs in time: one mechanism computed in many ways, each timed and compared with fifty digits.

A solution that states ``ACCURACY = Study(…)`` takes part: its formulas in several precisions, tables, Newton's
method on its loops, library solvers, rates by differences, motion in time by tolerance.
"""

from coursework.accuracy.study import Motion, Study

__all__ = ["Motion", "Study"]
