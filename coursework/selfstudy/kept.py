"""What a student wrote, kept by variant in a small file beside the notebook."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any


class Kept:
    """Answers and predictions by seed, in ``EXERCISE.study.json``.

    A blank never takes the place of what was written before. ``trouble`` says why nothing is written, or why an
    older file was set aside; it is empty when all is well.
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
                str(int(seed)): {kind: dict(texts) for kind, texts in kinds.items()}
                for seed, kinds in content["variants"].items()
            }
        except (OSError, ValueError, TypeError, KeyError, AttributeError):
            aside = self.path.with_suffix(".damaged.json")
            self.trouble = "damaged"
            try:
                self.path.replace(aside)
            except OSError:
                self.trouble = "unwritable"
            return
        self._content["variants"] = variants

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


def is_blank(text: Any) -> bool:
    """Whether nothing was written."""
    return text is None or (isinstance(text, str) and not text.strip())
