"""Marking of large classes by ``grade``: plain answers, and answers as people write them.

python benchmarks/marking.py [CLASS] [ANSWERS] [FOLDER]

Classes: ``plain`` and ``mixed`` of a million answers to five exercises in 300 variants each, ``five`` of
200 000 answers to the same, ``course`` of as many to every exercise of the course in 100 variants each; all
four unless one is named. Plain: digits alone, all right. Mixed: a third is not right. Five and course: a
tenth is wrong, a twentieth is blank or nonsense. A quarter each of the wrong ones shows a usual error, a slip
of sign or unit, follows from such an answer or is nothing that one could name; right ones carry units, commas
and powers of ten. Feedback sheets are not made. Printed: seconds by the clock, seconds of all processors, and
the most memory of one process.
"""

from __future__ import annotations

import csv
import json
import multiprocessing
import os
import random
import shutil
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

import coursework
from coursework.issuing.issuing import distinct_variants
from coursework.language.numbers import significant

EXERCISES = ("slotted_mechanism", "four_bar_motion", "slider_crank", "quick_return", "ball_reducer")
NONSENSE = ("?", "je ne sais pas", "voir feuille", "12 ou 13", "1 [2]", "-", "n/a", "3,2,1")


class Mix(NamedTuple):
    """Class of students: its size, its exercises, and the shares of its answers that are not right."""

    answers: int
    exercises: tuple[str, ...]  #: every exercise of the course where it is empty
    variants: int  #: of each exercise
    unreadable: float
    wrong: float  #: of those that can be read


CLASSES = {
    "plain": Mix(1_000_000, EXERCISES, 300, 0.0, 0.0),
    "mixed": Mix(1_000_000, EXERCISES, 300, 0.05, 0.3),
    "five": Mix(200_000, EXERCISES, 300, 0.05, 0.1),
    "course": Mix(200_000, (), 100, 0.05, 0.1),
}


def written(value, part, rng):
    """Return a right value as somebody writes it."""
    text = significant(value, rng.choice((4, 5, 6)))
    if rng.random() < 0.5:
        text = text.replace(".", ",")
    unit = "" if part.unit == "1" else f" {part.unit}"
    return text + rng.choice(("", "", unit))


def wrong(variant, part, rng):
    """Return a value that is not right, by an error that people make or by none."""
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


def sheet(variant, rng, mix):
    """Return the answers of one student, by part: numbers alone, of which cases and equations are left as
    they are."""
    answers = {}
    for part in variant.parts:
        value = variant.key.reference.get(part.quantity, "")
        if not isinstance(value, (int, float)) or part.judge:
            answers[part.id] = (
                str(value) if isinstance(value, (str, float, int)) else "; ".join(map(repr, value.tolist()))
            )
        elif not mix.wrong:
            answers[part.id] = significant(value, 6)
        elif rng.random() < mix.unreadable:
            answers[part.id] = rng.choice(("", *NONSENSE))
        elif rng.random() < mix.wrong:
            answers[part.id] = wrong(variant, part, rng)
        else:
            answers[part.id] = written(value, part, rng)
    return answers


def write(folder, mix):
    """Write the files of a class: what was issued, and its answers."""
    course, rng = coursework.open_course(), random.Random(20_26)
    folder.mkdir(parents=True, exist_ok=True)
    names = mix.exercises or tuple(course)
    variants = [v for n in names for v in distinct_variants(course[n], 0, mix.variants, "fr")]
    items = [{"student": "", "record": v.record} for v in variants]
    content = {"format": 1, "roster": False, "issued": items}
    (folder / "issued.json").write_text(json.dumps(content), "utf-8")
    with (folder / "answers.csv").open("w", encoding="utf-8", newline="") as file:
        out = csv.writer(file)
        out.writerow(("student", "exercise", "seed", "part", "answer"))
        rows = student = 0
        while rows < mix.answers:
            variant = variants[student % len(variants)]
            answers = sheet(variant, rng, mix)
            out.writerows(
                (f"s{student}", variant.exercise.name, variant.seed, i, a) for i, a in answers.items()
            )
            rows, student = rows + len(answers), student + 1


def main(name="", answers=0, folder="build/marking"):
    for each in [name] if name else CLASSES:
        home, mix = Path(folder) / each, CLASSES[each]
        mix = mix._replace(answers=int(answers) or mix.answers)
        # What writes the answers is large, and a process counts the memory of the one that started it.
        writer = multiprocessing.get_context("spawn").Process(target=write, args=(home, mix))
        writer.start()
        writer.join()
        shutil.rmtree(home / "marks", ignore_errors=True)
        command = [sys.executable, "-P", "-m", "coursework", "grade", str(home / "answers.csv")]
        options = ["--issued", str(home / "issued.json"), "--out", str(home / "marks"), "--no-feedback"]
        start = time.perf_counter()
        grade = subprocess.Popen([*command, *options], stdout=subprocess.DEVNULL)
        _, status, used = os.wait4(grade.pid, 0)
        seconds, processors = time.perf_counter() - start, used.ru_utime + used.ru_stime
        print(
            f"{each}: {mix.answers} answers in {seconds:.1f} s, {processors:.1f} s of processors, "
            f"largest process {used.ru_maxrss / 1024:.0f} MB; exit {os.waitstatus_to_exitcode(status)}"
        )


if __name__ == "__main__":
    main(*sys.argv[1:])
