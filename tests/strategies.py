"""What hypothesis draws for several tests: nasty texts and numbers as people type them, sides of a line."""

import hypothesis.strategies as st

NBSP, THIN, NARROW = "\u00a0", "\u2009", "\u202f"
FINITE = st.floats(allow_nan=False, allow_infinity=False)
SPACES = st.sampled_from(["", " ", NBSP, THIN, NARROW, "  "])
ODD = st.text("0123456789.,;+-−–*/×·^()[]{}=≈~ eExXπ√°'\"′″²⁻%µ\\_$rmsNadgtθ\u00a0\u202f", max_size=60)
PLAIN = st.from_regex(r"\s{0,2}[+-]?[0-9]{1,6}([.,][0-9]{1,5})?([eE][+-]?[0-9]{1,3})?\s?", fullmatch=True)
ANYTHING = st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=8) | PLAIN
CHOICES = {
    "crank-rocker": ("manivelle–balancier", "crank and rocker"),
    "double_crank": ("**Double** manivelle", "drag link"),
    "at_rest": ("$A$ et $B$ sont à l'arrêt", "$A$ and $B$ are at rest"),
}

#: Left or right of a directed line.
side = st.sampled_from([1, -1])
