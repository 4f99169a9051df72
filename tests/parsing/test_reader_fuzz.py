"""Nasty texts: no reader fails, runs away, or finds a number where there is none.

The texts are the same at each run; other seeds are among the slow tests.
"""

import itertools
import math
import random
import re
import time
import unicodedata
from collections import Counter
from collections.abc import Callable, Iterator

import numpy as np
import pytest

from coursework.parsing.choices import read_choice
from coursework.parsing.equations import parse_equation, read_equation
from coursework.parsing.equivalence import same_equation
from coursework.parsing.numbers import read_integer, read_number, read_numbers
from coursework.parsing.points import read_point
from coursework.parsing.reading import Reading

SLOW = 2.0  # seconds of processor: the slowest reading takes a tenth of it

UNITS = ("mm", "deg", "1", "rad/s", "N*m", "mm/s^2", "rad")
CHOICES = {"open": ("ouvert", "open"), "crossed": ("croisé", "crossed"), "2": ("deux", "$r_2$")}
NAMES = ("r1", "r2", "R", "theta2", "phi_dot", "psi", "e", "x")
REFERENCE = parse_equation("r1*cos(theta2) + R*sin(psi) = r2*phi_dot", NAMES)

# --- texts --------------------------------------------------------------------------------

SEPARATORS = (".", ",", " ", "'", "\u00a0", "\u202f", "’", "·", "..", ",,", ", ", "٫", "")
SIGNS = ("", "", "+", "-", "−", "–", "- ", "±", "--", "+-", "~", "≈")
WRITTEN_UNITS = (
    "",
    "",
    " mm",
    "mm",
    " m",
    " km",
    "°",
    " deg",
    " rad",
    " rad/s",
    " rad.s-1",
    " rad·s⁻¹",
    " tr/min",
    " rpm",
    " N.m",
    "Nm",
    " mm/s²",
    " m s^-2",
    " %",
    "'",
    '"',
    "° 12'",
    " µm",
    " Ω",
    " frogs",
    " kg",
    " MM",
    "(mm)",
    " [mm]",
    " mm^9",
    " m^-9",
    " m^99",
    "/s",
    "*m/s",
    " 1/s",
    " mm mm",
    "//",
    "°C",
    " \\mathrm{mm}",
    " s-1-1",
)
BRACKETS = ("", "", "()", "[]", "{}", "(", ")", "$$", "<>", "||", "((", "“”")
POWERS = (
    "e5",
    "E-3",
    "e+400",
    "e-400",
    "x10^2",
    "·10²",
    "*10**-2",
    "×10^{3}",
    " 10^2",
    ".10^2",
    "x10-2",
    "⁻³",
    "^2",
    "e99999999999",
    "^64",
    "^65",
    "**9**9",
    "e",
    "!",
)
LATEX = (
    "\\frac",
    "\\frac{1}{2}",
    "\\dfrac{",
    "\\sqrt{2}",
    "\\sqrt",
    "\\left(",
    "\\right)",
    "\\cdot",
    "\\times",
    "\\pi",
    "\\theta_2",
    "\\dot\\varphi",
    "\\ddot{r}_{1}",
    "\\dot",
    "^{",
    "}",
    "{",
    "_{",
    "\\mathrm{mm}",
    "\\SI{3}{mm}",
    "$",
    "$$",
    "\\,",
    "^\\circ",
    "\\degree",
    "\\prime",
    "^{\\prime\\prime}",
    "\\text{",
    "\\num{1}",
    "{,}",
    "\\\\",
    "\\",
    "\\begin{a}",
    "\\input{/etc/passwd}",
    "\\def\\a{\\a\\a}",
    "~",
    "&",
    "\\approx",
    "\\vec{v}",
    "\\qty{",
    "\\%",
)
CODE = (
    "__import__('os').system('true')",
    "().__class__.__bases__",
    "lambda: 1",
    "[x for x in (1,2)]",
    "{}",
    "None",
    "True",
    "float('nan')",
    "1if 1else 2",
    "0x1F",
    "0b11",
    "1_000",
    "1j",
    "1e1_0",
    "eval('1')",
    "exec",
    "%s%n",
    "{0}",
    "{0.__class__}",
    "${7*7}",
    "'; DROP TABLE",
    "<script>",
    "\x00",
    "\x1b[31m",
    "../..",
    "=1+1",
    "@SUM(1)",
    "nan",
    "inf",
    "Infinity",
    "-inf",
    "1e309",
    "NaN",
    "∞",
    "\ud800",
    "\U0010ffff",
    "\u202e",
    "\u0301",
    "0/0",
    "1//2",
    "1%2",
    "~1",
)
PIECES = (
    "sin",
    "cos",
    "tan",
    "atan2",
    "acos",
    "ln",
    "exp",
    "sqrt",
    "abs",
    "√",
    "pi",
    "π",
    "e",
    "i",
    "theta2",
    "θ₂",
    "r1",
    "r2",
    "R",
    "phi'",
    "φ̇",
    "psi",
    "x",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    "+",
    "-",
    "*",
    "/",
    "^",
    "**",
    "=",
    ",",
    ";",
    ".",
    " ",
    "°",
    "1",
    "2",
    "10",
    "0",
    "0.5",
    "1,5",
    "64",
    "1e3",
    "²",
    "⁻¹",
    "½",
    "'",
    "''",
    "|",
    ":",
    "≈",
    "to",
    "à",
    "or",
    "<",
)
LABELS = (
    "open",
    "ouvert",
    "croisé",
    "a)",
    "b) crossed",
    "(2)",
    "3.",
    "deux",
    "r_2",
    "$r_2$",
    "A",
    "z",
    "1",
    "0",
)
RUNS = (
    "(",
    "[",
    "{",
    "√",
    "2^",
    "9**",
    "-",
    "+",
    "1 ",
    "1'",
    "1,",
    "1.",
    "sin",
    "sin(",
    "r1",
    "r_",
    "a_",
    "e",
    "'",
    '"',
    "°",
    "1/",
    "m.",
    "m/",
    "(m",
    "rad ",
    "\\frac{1}{",
    "\\sqrt{",
    "\\dot{",
    "{,}",
    "$",
    "=",
    "x = ",
    "1;",
    "1 000 ",
    "1e1",
    "^(",
    "\\,",
    "~",
    " ",
    "\u0307",
    "²",
    "tan(",
    "ln ",
    "abs(",
    "1+",
    "1-",
    "(1)",
    "(r1)",
    "pi",
    "ee",
    "e^",
    "x10^",
    "|",
    "ee_",
    "pie",
    "r1r2",
    "1°",
    "to ",
    "..",
    "\\",
    "_{",
    "cos2",
    "atan2(1,",
)


def any_unicode(rng: random.Random) -> str:
    planes = (0x80, 0x250, 0x3000, 0x10000, 0x110000)
    return "".join(chr(rng.randrange(rng.choice(planes))) for _ in range(rng.randrange(1, 60)))


def number_like(rng: random.Random) -> str:
    digits = str(rng.randrange(10 ** rng.randrange(1, 5)))
    for _ in range(rng.randrange(4)):
        digits += rng.choice(SEPARATORS) + str(rng.randrange(10 ** rng.choice((1, 2, 3, 3))))
    brackets = rng.choice(BRACKETS) if rng.random() < 0.3 else ""
    opening, closing = brackets[:1], brackets[1:]
    power = rng.choice(POWERS) if rng.random() < 0.3 else ""
    return f"{rng.choice(SIGNS)}{opening}{digits}{power}{rng.choice(WRITTEN_UNITS)}{closing}"


def bomb(rng: random.Random) -> str:
    tower = rng.choice(("**", "^", "^-", "^(", "e", "!", "*", "10^")).join(
        str(rng.choice((9, 64, 99, 0, 2, 10**9))) for _ in range(rng.randrange(2, 12))
    )
    return rng.choice(("", "1/", "exp(", "sqrt(-", "r1^", "2 = ")) + tower


def run(rng: random.Random) -> str:
    """One or two pieces repeated, which is what makes a reader go back and forth."""
    one, other = rng.choice(RUNS), rng.choice(("", "", *RUNS))
    count = rng.choice((3, 10, 29, 31, 60, 120, 249, 500, 2000))
    return (
        rng.choice(("", "1", "r1 = "))
        + (one + other) * count
        + rng.choice(("", "1", ")", "1)", " mm", "!", "= 2"))
    )


def long_digits(rng: random.Random) -> str:
    digits = "".join(rng.choices("0123456789", k=rng.choice((17, 40, 100, 308, 309, 400, 499, 501))))
    place = rng.randrange(len(digits))
    return (
        rng.choice(SIGNS)
        + digits[:place]
        + rng.choice(SEPARATORS)
        + digits[place:]
        + rng.choice(WRITTEN_UNITS)
    )


def soup(rng: random.Random) -> str:
    pieces = rng.choice((PIECES, PIECES, LATEX, CODE, LATEX + PIECES, CODE + PIECES, LABELS + PIECES))
    return rng.choice(("", " ")).join(rng.choices(pieces, k=rng.randrange(1, rng.choice((4, 8, 25)))))


RIGHT = (
    "319,8 mm",
    "1 234,5",
    "-12.5 mm/s²",
    "104°38'24\"",
    "2π/3 rad",
    "sqrt(2)/2",
    "1 1/2",
    "3,2·10² mm",
    "90 tr/min",
    "(12,3 ; 4,5) mm",
    "[1, 0, 1]",
    "A = (1 ; 2)",
    "x = 1 ; y = 2",
    "b) crossed",
    "rA ≈ 319.8",
    "\\frac{2\\pi}{3}",
    "r1 cosθ2 + R sinψ = r2 φ̇",
    "r1 \\cos\\theta_2 = r2 \\dot\\varphi - R sin(psi)",
    "r1cosθ2/x + R sinψ/x = r2 φ'/x",
    "(r1 + R tanψ)/cosθ2 = e^(x)",
)


def mutated(rng: random.Random) -> str:
    text = list(rng.choice(RIGHT))
    for _ in range(rng.choice((1, 1, 2, 5))):
        place = rng.randrange(len(text) + 1)
        match rng.randrange(4):
            case 0:
                text[place : place + 1] = []
            case 1:
                text.insert(place, rng.choice(PIECES + WRITTEN_UNITS))
            case 2:
                text.insert(place, chr(rng.randrange(0x2200)))
            case _:
                text[place:place] = text[: rng.randrange(8)]
    return "".join(text)


def formula(rng: random.Random, names: tuple[str, ...], depth: int) -> str:
    """A formula that follows the grammar, with no care for its domain or its size."""
    if depth <= 0 or rng.random() < 0.15:
        return rng.choice((*names, "2", "0", "1,5", "10", "π", "e", "0.001", "3e2", "45°", "1 000"))
    one, other = (formula(rng, names, depth - rng.randrange(1, 3)) for _ in range(2))
    return rng.choice(
        (
            f"{one} + {other}",
            f"{one} - {other}",
            f"({one})({other})",
            f"({one})/({other})",
            f"{one}/{other}",
            f"-({one})",
            f"({one})^{rng.choice(('2', '-1', '3', '64', '{2}', '(1/2)', f'({other})'))}",
            f"{rng.choice(('sin', 'cos', 'tan', 'ln', 'exp', 'sqrt', 'acos', 'abs', '√', 'cos²'))}({one})",
            f"cos {other}",
            f"atan2({one}; {other})",
            f"\\frac{{{one}}}{{{other}}}",
            f"e^(i ({one}))",
        )
    )


def number_formula(rng: random.Random) -> str:
    return formula(rng, ("1", "7", "12", "π/3"), rng.randrange(1, 7)) + rng.choice(WRITTEN_UNITS)


def equation(rng: random.Random) -> str:
    names = (*NAMES, "θ2", "φ'", "\\dot\\varphi", "r_1", "\\psi")
    one, other = (formula(rng, names, rng.randrange(1, 6)) for _ in range(2))
    return rng.choice(
        (f"{one} = {other}", f"{one} = 0", f"({REFERENCE.text.replace('=', ')/(' + one + ') = (')})/({one})")
    )


KINDS = (
    any_unicode,
    number_like,
    number_like,
    bomb,
    run,
    long_digits,
    soup,
    soup,
    mutated,
    mutated,
    number_formula,
    equation,
)


def nasty_texts(count: int, seed: int) -> Iterator[str]:
    rng = random.Random(seed)
    for kind in itertools.islice(itertools.cycle(KINDS), count):
        yield kind(rng)


# --- what must hold -----------------------------------------------------------------------


NUMBERLESS = re.compile(r"\d|pi|(?<![A-Za-z])e(?![A-Za-z])", re.I)

#: Every letter that a number may have beside its digits, whole words at a time: functions, constants, powers
#: of ten, LaTeX, and what units are made of.
KNOWN_LETTERS = re.compile(
    "(?:arcsin|arccos|arctan2?|asin|acos|atan2?|arctg|sin|cos|tan|tg|sqrt|exp|abs|ln|pi|e|x|"
    "rad|rd|rpm|tr|rev|grad|gon|gr|deg(?:rees?)?|degr[ée]s?|min|sec|mm|km|cm|dm|um|nm|pm|fm"
    "|[fpnumcdhkMGT]|da|m|s|g|r|h|t|"
    "N|J|W|Pa|Hz|A|C|V|Ω|ohm|μ|millim[èe]tres?|frac|dfrac|tfrac|mathrm|text|num|si|SI|qty|left|right"
    "|cdot|times|"
    "circ|degree|approx|prime|environ|env|about|ca|soit)+",
    re.IGNORECASE,
)


def visible(text: str) -> str:
    """A text with one form for each character and without those that have no width."""
    plain = unicodedata.normalize("NFKC", text)
    return re.sub("[\\u200b-\\u200d\\u2060\\ufeff\\u00ad]", "", plain).replace("Π", "π").replace("π", "pi")


def may_be_a_number(text: str) -> bool:
    """Whether a text holds a digit of any script or a constant by name, without which there is no number."""
    return bool(NUMBERLESS.search(unicodedata.normalize("NFKD", visible(text))))


def has_only_known_letters(text: str) -> bool:
    """Whether the letters of a number, its name aside, are those of functions, constants and units."""
    plain = re.sub(r"\\(?:approx|simeq)", "≈", visible(text))
    value = re.split("[=≈≃:]", plain)[-1]
    return all(KNOWN_LETTERS.fullmatch(run) for run in re.findall(r"[^\W\d_]+", value))


def check_common(text: object, reading: Reading) -> None:
    assert reading.text == text
    assert reading.status in ("read", "missing", "unreadable", "wrong_unit")
    assert (reading.status == "read") == bool(reading.values) == bool(reading.read_as)
    assert (reading.status in ("unreadable", "wrong_unit")) == bool(reading.code)
    assert len(reading.values) == len(reading.read_as) <= 2
    assert len(reading.found) <= 60
    assert hash(reading) == hash(reading)


def check_number(text: str, reading: Reading) -> None:
    assert all(type(value) is float and math.isfinite(value) for value in reading.values)
    assert not reading.values or may_be_a_number(text)
    assert not reading.values or has_only_known_letters(text)
    assert len(set(reading.values)) == len(reading.values)


def check_integer(text: str, reading: Reading) -> None:
    assert all(type(value) is int and abs(value) <= 10**15 for value in reading.values)
    assert not reading.values or may_be_a_number(text)


def check_point(text: str, reading: Reading) -> None:
    assert all(len(value) == 2 and all(map(math.isfinite, value)) for value in reading.values)
    assert not reading.values or may_be_a_number(text)


def check_choice(text: str, reading: Reading) -> None:
    assert all(value in CHOICES for value in reading.values)


def check_equation(text: str, reading: Reading) -> None:
    for equation in reading.values:
        assert equation.variables <= set(NAMES)
        assert unicodedata.normalize("NFKC", text).replace("==", "=", 1).count("=") == 1


READERS: dict[str, tuple[Callable, Callable]] = {
    "number": (lambda text, k: read_number(text, UNITS[k % len(UNITS)]), check_number),
    "integer": (lambda text, k: read_integer(text), check_integer),
    "point": (lambda text, k: read_point(text, UNITS[k % len(UNITS)], 2), check_point),
    "choice": (lambda text, k: read_choice(text, CHOICES), check_choice),
    "equation": (lambda text, k: read_equation(text, NAMES), check_equation),
}


def read_all(texts: Iterator[str]) -> Counter[tuple[str, str]]:
    """Read every text as a number, and as one of the other kinds in turn; return what became of them."""
    statuses: Counter[tuple[str, str]] = Counter()
    others = [name for name in READERS if name != "number"]
    for k, text in enumerate(texts):
        other = others[k // len(KINDS) % len(others)] if KINDS[k % len(KINDS)] is not equation else "equation"
        for name in ("number", other):
            read, check = READERS[name]
            start = time.process_time()
            reading = read(text, k)
            assert time.process_time() - start < SLOW, text[:100]
            statuses[name, reading.status] += 1
            check_common(text, reading)
            check(text, reading)
        for one in reading.values if other == "equation" else ():
            # It can be compared with another.
            same = same_equation(one, REFERENCE, parameters=("r1", "r2", "R"))
            statuses["comparison", str(same)] += 1
    return statuses


# --- spellings of a known value -------------------------------------------------------------


def known_values(count: int, seed: int) -> Iterator[tuple[str, float]]:
    """Doubles of every size in an accepted spelling, in millimetres, with the double."""
    rng = random.Random(seed)
    spaces = ("", " ", "\u00a0", "\u202f", "\u2009", "\t")
    for _ in range(count):
        size = rng.choice((0, 1, 3, 6, 200))
        value = rng.uniform(-1, 1) * 10.0 ** rng.uniform(-size, size)
        value = round(value, rng.randrange(6)) if rng.random() < 0.5 else value
        mantissa, power = f"{value:.17e}".split("e")
        power = int(power)
        text = rng.choice(
            (
                repr(value),
                f"{mantissa}e{power}",
                f"{mantissa.replace('.', ',')}E{power:+d}",
                f"{mantissa} × 10^{power}",
                f"{mantissa}·10^({power})",
                f"{mantissa}x10^{{{power}}}",
                f"{mantissa}*10**{power}",
                f"{mantissa}·10{str(power).translate(str.maketrans('-0123456789', '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'))}",
            )
        )
        text = text.replace("-", rng.choice("-−–")) if rng.random() < 0.5 else text
        before, after = rng.choice(spaces), rng.choice(spaces)
        unit = rng.choice(("", "mm", "(mm)", "[mm]", "*mm", "millimètres", "\\mathrm{mm}"))
        yield f"{before}{rng.choice(('', 'rA = ', '≈ ', 'environ '))}{text}{after}{unit}{before}", value


JUNK = ("qz", "xyz", "frog", "ж", "長", "zz", "nope", "wq")


def with_junk(count: int, seed: int) -> Iterator[str]:
    """A number that would be read, with letters in it that mean nothing."""
    rng = random.Random(seed)
    for text, _ in known_values(count, seed):
        plain = re.sub(r"^\s*(?:rA = |≈ |environ )|\\mathrm\{mm\}|\s+$", "", text)
        place = rng.randrange(len(plain) + 1)
        yield plain[:place] + rng.choice(JUNK) + plain[place:]


# --- in the test suite ----------------------------------------------------------------------


def counted(few, many):
    return pytest.mark.parametrize("count", [few, pytest.param(many, marks=pytest.mark.slow)])


@pytest.mark.parametrize(
    ("seed", "count"),
    [(7, 600), *(pytest.param(seed, 3000, marks=pytest.mark.slow) for seed in (0, 1, 2, 3))],
)
def test_a_nasty_text_is_read_or_said_to_be_unreadable(seed, count):
    with np.errstate(all="raise"):
        statuses = read_all(nasty_texts(count, seed))
    assert {name for name, _ in statuses} == {*READERS, "comparison"}
    for name in READERS:
        assert statuses[name, "read"] > 0
        assert statuses[name, "unreadable"] > 0


@counted(1_500, 4_000)
def test_a_double_reads_back_from_any_accepted_spelling(count):
    for text, value in known_values(count, seed=11):
        reading = read_number(text, "mm")
        assert reading.values[:1] == (value,), (text, value, reading)


@counted(400, 1_000)
def test_letters_that_mean_nothing_never_leave_a_number(count):
    for text in with_junk(count, seed=12):
        assert read_number(text, "mm").status == "unreadable", text


@counted(400, 1_000)
def test_texts_read_at_once_or_between_spaces_are_read_as_each_alone(count):
    texts = list(nasty_texts(count, seed=13))
    values, left = read_numbers(texts, "mm")
    for text, value, later in zip(texts, values, left, strict=True):
        reading = read_number(text, "mm")
        if not later:
            assert reading.values == (() if math.isnan(value) else (value,)), text
        if len(text) < 400:
            spaced = read_number(f"\u00a0 {text}\u202f ", "mm")
            assert (spaced.status, spaced.values) == (reading.status, reading.values), text
