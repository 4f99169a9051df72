"""Symbols of quantities, from the names with which they are typed."""

from __future__ import annotations

import re
from functools import lru_cache

_GREEK = (
    "alpha beta gamma delta epsilon zeta eta theta kappa lambda mu nu xi pi rho sigma tau phi chi psi omega"
).split()


@lru_cache(maxsize=4096)
def symbol_of(name: str) -> str:
    r"""Return the LaTeX symbol of a public name: ``theta4`` -> ``\theta_4``, ``rA_dot`` -> ``\dot{r}_A``.

    Parameters
    ----------
    name
        Name of the quantity.

    Returns
    -------
    LaTeX, without dollars.

    Examples
    --------
    >>> symbol_of("theta3_open")
    '\\theta_{3,\\mathrm{open}}'
    """
    stem, *rest = name.split("_")
    dots = ""
    while rest and rest[-1] in ("dot", "ddot"):
        dots = rest.pop()
    match = re.fullmatch(r"([A-Za-z]+?)(\d+[A-Z]?\d*|[A-Z]\d*)?", stem)
    letters, index = match.groups() if match else (stem, None)
    if letters in _GREEK:
        letters = r"\varepsilon" if letters == "epsilon" else "\\" + letters
    elif len(letters) > 1:
        letters = rf"\mathrm{{{letters}}}"
    if dots:
        letters = rf"\{dots}{{{letters}}}"
    subscripts = [index] if index else []
    subscripts += [r if len(r) == 1 or not r.isalpha() else rf"\mathrm{{{r}}}" for r in rest]
    if not subscripts:
        return letters
    joined = ",".join(subscripts)
    return f"{letters}_{joined}" if len(joined) == 1 else f"{letters}_{{{joined}}}"
