"""What the pages of all lessons weigh, in kilobytes, as the site compresses them.

    python benchmarks/lessons.py      five minutes

It prints a Markdown table, which stands in docs/site.md: the whole lesson as one page, what comes at each
visit, and what a browser keeps after the first (steps and figures).
"""

from __future__ import annotations

import gzip
import re
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

from site_people import ZOE, Class
from timing import print_table

from coursework.site.lessons.lesson_content import lesson_of

LEVEL = 6  #: of compression, as the site has it


def kilobytes(*contents: bytes) -> float:
    """Return the size of contents that are each compressed."""
    return sum(len(gzip.compress(content, LEVEL)) for content in contents) / 1000


def weighed(class_: Class, name: str, lang: str) -> list[str]:
    """Return the kilobytes of a lesson: as one page, its page, the first part of its steps, all its steps,
    its figures."""
    browser = class_.browser(ZOE, lang)
    whole, page = browser.get(f"/lessons/{name}?whole"), browser.get(f"/lessons/{name}")
    parts = [browser.get(part).content for part in re.search(r' data-steps="([^"]+)"', page.text)[1].split()]
    figures = lesson_of(class_.site, name, lang).figures.values()
    contents = [whole.content], [page.content], parts[:1], parts, figures
    sizes = [kilobytes(*these) for these in contents]
    return [f"{size:.1f}" for size in sizes]


def main() -> None:
    class_ = Class(f"sqlite:///{tempfile.mkdtemp()}/site.db")
    rows = [
        (
            f"`{name}`",
            *(
                " / ".join(pair)
                for pair in zip(*(weighed(class_, name, lang) for lang in ("en", "fr")), strict=True)
            ),
        )
        for name in class_.site.course.folder.lessons
    ]
    names = (
        "lesson, English / French",
        "one page",
        "each visit",
        "kept: first steps",
        "all steps",
        "kept: figures",
    )
    print_table(names, rows)


if __name__ == "__main__":
    main()
