"""What is drawn or printed hangs on no last digit: other processors and libraries, whose last bits differ,
print the same."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import zlib
from pathlib import Path

import numpy as np
import pytest
from sweeps import sampled

import coursework
from coursework.issuing.issued import KEY_DIGITS, key_content, key_rows
from coursework.issuing.issuing import issue
from coursework.language.numbers import rounded, settled, significant
from coursework.quantities import graph
from coursework.rendering.renderer import renderer_of

NAMES = coursework.open_course().names
SHAKEN = 1e-12  #: of each quantity, a thousand times what libraries differ by


def shaken(name, value):
    """The value of a quantity as another processor might have computed it, and worse."""
    off = SHAKEN if zlib.crc32(name.encode()) % 2 else -SHAKEN
    if isinstance(value, tuple):
        parts = [shaken(f"{name}{k}", one) for k, one in enumerate(value)]
        return value._make(parts) if hasattr(value, "_make") else tuple(parts)
    if isinstance(value, np.ndarray) and value.dtype.kind in "fc":
        return value * (1 + off * np.where(np.arange(value.size) % 2, -1, 1).reshape(value.shape))
    is_number = isinstance(value, (float, complex, np.inexact))
    return value * (1 + off) if is_number else value


@pytest.fixture
def shake(monkeypatch):
    """Let every quantity that is computed from now on be a little off."""
    run = graph._run

    def running(steps, values):
        for step in steps:
            run([step], values)
            values[step[0]] = shaken(step[0], values[step[0]])

    return lambda: monkeypatch.setattr(graph, "_run", running)


def printed(record):
    """What is made of a record, by a course that has computed nothing before."""
    course = coursework.open_course()
    renderer = renderer_of(course.folder)
    variant = course[record["exercise"]].from_record(record)
    handout, solution = variant.handout("Ana"), variant.answer_sheet("Ana")
    return {
        "page": renderer.html(handout),
        "page of the solution": renderer.html(solution),
        "notebook": renderer.notebook(handout),
        "source": renderer.tex(handout, ["a.pdf"], ["b.pdf"]),
        "source of the solution": renderer.tex(solution, ["a.pdf"], ["b.pdf"]),
    }


@pytest.mark.parametrize(
    "name", sampled(NAMES, ("slotted_mechanism", "velocity_polygon", "parallel_joints", "curved_slot"))
)
def test_what_is_printed_is_the_same_when_every_quantity_is_a_little_off(name, shake):
    records = [variant.record for variant in coursework.open_course()[name].variants(range(2))]
    before = [printed(record) for record in records]
    shake()
    for record, told in zip(records, before, strict=True):
        now = printed(record)
        assert [what for what in told if now[what] != told[what]] == [], record["seed"]


# -------------------------------------------------------------------------- key


@pytest.mark.parametrize("name", sampled(NAMES))
def test_the_key_has_ten_digits_and_no_more(name):
    course = coursework.open_course()
    for record in key_content(issue(course, [name], first_seed=0, count=3, langs=["en"])):
        variant = course[name].from_record({k: record[k] for k in record if k not in ("answers", "student")})
        for part in variant.parts:
            told, value = record["answers"][part.id]["value"], variant.key.reference.get(part.quantity)
            if not isinstance(value, (float, np.ndarray)) or np.asarray(value).dtype.kind != "f":
                continue
            size = max(np.max(np.abs(value)), record["answers"][part.id]["tolerance"] or 0.0)
            assert told == pytest.approx(np.asarray(value).tolist(), rel=0, abs=6 * size * 10.0**-KEY_DIGITS)
            for number in np.ravel(told):
                digits = repr(float(number)).partition("e")[0].replace(".", "").strip("-0")
                assert len(digits) <= KEY_DIGITS


def test_a_key_of_noise_is_zero_beside_its_margin_and_beside_what_stands_with_it():
    from coursework.issuing.issued import _in_key

    assert _in_key(3e-17, 0.01) == 0.0
    assert _in_key(np.array([120.0, -4e-15])).tolist() == [120.0, 0.0]
    assert _in_key(1 / 3 + 2e3j) == 0.333333 + 2000j
    assert (_in_key("1j"), _in_key(7), _in_key(True), _in_key(None)) == ("1j", 7, True, None)
    assert list(key_rows([])) == []


def test_halfway_between_two_printed_numbers_last_bits_choose_nothing():
    for tie in (46.75, 9315.0 / 100, 541.575, -82.5, 0.00125):
        near = [tie * (1 + off) for off in (-SHAKEN, -1e-15, 0.0, 1e-15, SHAKEN)]
        assert len({settled(x) for x in near}) == 1
        assert len({significant(x, 4) for x in near}) == len({rounded(x, 1) for x in near}) == 1
    assert repr(rounded(-1e-17, 2)) == "0.0"


# ------------------------------------------------------------------------ golden

_BUILD = """
import hashlib, json, sys
from pathlib import Path
from coursework.cli import run
out = sys.argv[1]
assert run(["build", *sys.argv[2:], "--variants", "2", "--formats", "html,ipynb,tex", "--out", out]) == 0
files = {
    p.relative_to(out).as_posix(): hashlib.sha256(p.read_bytes()).hexdigest()
    for p in Path(out).rglob("*") if p.is_file()
}
print(json.dumps(files), file=sys.stderr)
"""


def built(folder, names, around):
    root = str(Path(coursework.__file__).parent.parent)
    kept = {**os.environ, "PYTHONPATH": root, **around}
    done = subprocess.run(
        [sys.executable, "-P", "-c", _BUILD, folder, *names],
        env=kept,
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(done.stderr.splitlines()[-1])


@pytest.mark.slow
@pytest.mark.parametrize("names", [NAMES[k::4] for k in range(4)], ids=["first", "second", "third", "fourth"])
def test_a_build_has_the_same_bytes_without_vector_units(names, tmp_path):
    """The same numbers by other instructions, so that last bits differ; other versions of numpy:
    ``make golden``."""
    found = np.show_config("dicts").get("SIMD Extensions", {}).get("found", [])
    plain = {
        "NPY_DISABLE_CPU_FEATURES": " ".join(found),
        "OPENBLAS_CORETYPE": "Nehalem",
        "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-AVX2_Usable,-FMA_Usable",
    }
    one, other = built(tmp_path / "one", names, {}), built(tmp_path / "other", names, plain)
    assert [path for path in one if one[path] != other.get(path)] == []
