"""What a student wrote, kept by variant in a small file beside the notebook."""

from __future__ import annotations

import itertools
import json
import re
from pathlib import Path
from typing import Any


class Kept:
    """Answers and predictions by seed, in ``EXERCISE.study.json``.

    A blank never takes the place of what was written before. ``trouble`` says why nothing is written, or why an
    older file was set aside; it is empty when all is well. What a file holds beyond what is asked stays in it.
    """

    def __init__(self, path: Path, exercise: str):
        self.path = path
        self.trouble = ""
        self._content: dict[str, Any] = {"exercise": exercise, "variants": {}}
        if path.exists():
            self._read()

    def _read(self) -> None:
        try:
            content = json.loads(self.path.read_text("utf-8"))
            variants = {
                _seed(seed): {kind: dict(texts) for kind, texts in kinds.items()}
                for seed, kinds in content["variants"].items()
            }
        except (OSError, ValueError, TypeError, KeyError, AttributeError, RecursionError):
            self._set_aside("damaged")
            return
        if content.get("exercise", self._content["exercise"]) != self._content["exercise"]:
            self._set_aside("other")
            return
        self._content["variants"] = variants

    def _set_aside(self, why: str) -> None:
        """The file under a name that no older one has."""
        names = (self.path.with_suffix(f".damaged{n or ''}.json") for n in itertools.count())
        self.trouble = why
        try:
            self.path.replace(next(name for name in names if not name.exists()))
        except OSError:
            self.trouble = "unwritable"

    @property
    def seeds(self) -> tuple[int, ...]:
        """The variants of which something is kept, in order."""
        return tuple(sorted(int(seed) for seed in self._content["variants"]))

    def of(self, seed: int, kind: str) -> dict[str, Any]:
        """What is kept of a variant: its ``answers`` or its ``predictions``."""
        return dict(self._content["variants"].get(str(seed), {}).get(kind, {}))

    def add(self, seed: int, kind: str, texts: dict[str, Any]) -> None:
        """Keep what is not blank."""
        written = {name: text for name, text in texts.items() if not is_blank(text)}
        known = self.of(seed, kind)
        if all(known.get(name) == text for name, text in written.items()):
            return
        self._content["variants"].setdefault(str(seed), {})[kind] = {**known, **written}
        self._write()

    def _write(self) -> None:
        part = self.path.with_suffix(".part")
        text = json.dumps(self._content, ensure_ascii=False, indent=1, sort_keys=True, default=str) + "\n"
        try:
            part.write_text(text, "utf-8")
            part.replace(self.path)
        except OSError:
            self.trouble = "unwritable"


def _seed(text: str) -> str:
    """A seed as it is written; anything else is none."""
    if not re.fullmatch(r"0|[1-9][0-9]{0,99}", text):
        raise ValueError(text)
    return text


def is_blank(text: Any) -> bool:
    """Whether nothing was written."""
    return text is None or (isinstance(text, str) and not text.strip())
