"""Mechanisms stated in a file: bodies, joints, driver and what is asked, compiled to an exercise and its
solution.

``exercises/NAME.toml`` needs no Python. :mod:`linkage_file` reads it, :mod:`groups` puts the bodies in order
of assembly, :mod:`points`, :mod:`higher_groups` and :mod:`formulas` write the quantities of each group,
:mod:`questions` what is asked, :mod:`compiled` joins them to the two modules and four texts that an author
would have written.
"""
