"""A class in bulk: a million answers marked by ``grade``, plain ones, and as people write them.

python benchmarks/marking.py [ANSWERS] [FOLDER]

Each answer stands on a sheet of one of five exercises, each exercise in 300 variants. Plain: digits alone, all right.
Mixed: a third is not right, of which a quarter each shows a usual error, a slip of sign or unit, follows from such an answer
or is nothing that one could name; right ones carry units, commas and powers of ten; some are blank, some nonsense. Feedback
sheets are not made. Told: seconds and the most memory of all processes together, of the whole command.
"""

from __future__ import annotations

import csv
import json
import random
import resource
import shutil
import subprocess
import sys
import time
from pathlib import Path

import coursework
from coursework.issuing.issuing import distinct_variants
from coursework.language.numbers import significant

EXERCISES = ("slotted_mechanism", "four_bar_motion", "slider_crank", "quick_return", "ball_reducer")
VARIANTS = 300
NONSENSE = ("?", "je ne sais pas", "voir feuille", "12 ou 13", "1 [2]", "-", "n/a", "3,2,1")


def written(value, part, rng):
    """A right value as somebody writes it."""
    text = significant(value, rng.choice((4, 5, 6)))
    if rng.random() < 0.5:
        text = text.replace(".", ",")
    unit = "" if part.unit == "1" else f" {part.unit}"
    return text + rng.choice(("", "", unit))


def wrong(variant, part, rng):
    """A value that is not right, by an error that people make or by none."""
    right = variant.key.reference[part.quantity]
    kind = rng.random()
    if kind < 0.25:
        _, values = variant.key.usual_ways(part.quantity)
        made = [float(v) for v in values if v == v and abs(v) < 1e9]
        if made:
            return significant(rng.choice(made), 5)
    if kind < 0.5:
        return significant(right * rng.choice((-1, 1000, 0.001)), 5)
    return significant(right * rng.uniform(0.2, 3.0), 5)


def sheet(variant, rng, *, mixed):
    """The answers of one student, by part: numbers alone, of which cases and equations are left as they are."""
    answers = {}
    for part in variant.parts:
        value = variant.key.reference[part.quantity]
        if not isinstance(value, (int, float)) or part.judge:
            answers[part.id] = str(value) if isinstance(value, str) else "; ".join(map(repr, value.tolist()))
        elif not mixed:
            answers[part.id] = significant(value, 6)
        elif rng.random() < 0.05:
            answers[part.id] = rng.choice(("", *NONSENSE))
        elif rng.random() < 0.3:
            answers[part.id] = wrong(variant, part, rng)
        else:
            answers[part.id] = written(value, part, rng)
    return answers


def write(folder, count, *, mixed):
    """The files of a class: what was issued, and its answers."""
    course, rng = coursework.open_course(), random.Random(20_26)
    folder.mkdir(parents=True, exist_ok=True)
    variants = [v for n in EXERCISES for v in distinct_variants(course[n], 0, VARIANTS, "fr")]
    items = [{"student": "", "record": v.record} for v in variants]
    content = {"format": 1, "roster": False, "issued": items}
    (folder / "issued.json").write_text(json.dumps(content), "utf-8")
    with (folder / "answers.csv").open("w", encoding="utf-8", newline="") as file:
        out = csv.writer(file)
        out.writerow(("student", "exercise", "seed", "part", "answer"))
        rows = student = 0
        while rows < count:
            variant = variants[student % len(variants)]
            answers = sheet(variant, rng, mixed=mixed)
            out.writerows(
                (f"s{student}", variant.exercise.name, variant.seed, i, a) for i, a in answers.items()
            )
            rows, student = rows + len(answers), student + 1
    return rows


def main(count=1_000_000, folder="build/marking"):
    for name in ("plain", "mixed"):
        home = Path(folder) / name
        rows = write(home, count, mixed=name == "mixed")
        start = time.perf_counter()
        run = "import sys; from coursework.cli import main; sys.exit(main())"
        shutil.rmtree(home / "marks", ignore_errors=True)
        command = [sys.executable, "-P", "-c", run, "grade", str(home / "answers.csv")]
        options = ["--issued", str(home / "issued.json"), "--out", str(home / "marks"), "--no-feedback"]
        done = subprocess.run([*command, *options], capture_output=True, text=True, check=False)
        seconds = time.perf_counter() - start
        largest = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
        print(
            f"{name}: {rows} answers in {seconds:.1f} s, largest process {largest:.0f} MB; exit {done.returncode}"
        )
        print(done.stdout.strip()[-400:], done.stderr.strip()[-400:])


if __name__ == "__main__":
    main(*(int(sys.argv[1]),) * (len(sys.argv) > 1), *sys.argv[2:3])
