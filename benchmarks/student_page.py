"""A student's pages in Chromium, as a telephone on a slow line has them: bytes cold and warm, first paint,
layout shift, taps to a marked answer, a polygon constructed by touch, axe.

    python benchmarks/student_page.py [EXERCISE]      slotted_mechanism; a minute

The line is emulated: 400 ms, 50 kB/s each way. It prints a Markdown table, which stands in docs/site.md.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

import constructions
from site_browser import chromium, context_of, served
from site_pencil import Draughtsman
from site_people import ZOE, Class
from site_practising import right_answer
from timing import print_table

LINE = {"offline": False, "latency": 400, "downloadThroughput": 50_000, "uploadThroughput": 50_000}
DRAWN = "velocity_polygon"  #: with a surface to draw on
SCRIPTED = (DRAWN, "acceleration_polygon", "two_circles", "havens_construction", "crank_shaper_drawn")
#: Seconds of a tap that is aimed, and of a key (Card, Moran and Newell, 1983, rounded up).
TAP, KEY = 2.0, 0.5
#: How far what is seen moved while the page came: the browser's cumulative layout shift.
SHIFT = """() => new Promise((done) => {
  let moved = 0;
  const add = (list) => list.getEntries().forEach((one) => { moved += one.value; });
  new PerformanceObserver(add).observe({ type: "layout-shift", buffered: true });
  setTimeout(() => done(moved), 100);
})"""
PAINT = "performance.getEntriesByName('first-contentful-paint')[0].startTime"


class Measured:
    """A page that counts the bytes that come, as they are on the line."""

    def __init__(self, context: Any):
        self.page = context.new_page()
        self.session = context.new_cdp_session(self.page)
        self.session.send("Network.enable")
        self.session.send("Network.emulateNetworkConditions", LINE)
        self.bytes = 0
        self.session.on("Network.loadingFinished", self._count)

    def _count(self, event: Any) -> None:
        self.bytes += int(event["encodedDataLength"])

    def open(self, address: str) -> tuple[float, float]:
        """Return kilobytes and seconds to the first paint."""
        self.bytes = 0
        self.page.goto(address, wait_until="networkidle")
        self.page.wait_for_timeout(1500)
        return self.bytes / 1000, self.page.evaluate(PAINT) / 1000


def weighed(context: Any, place: str, called: str) -> tuple[Any, list[tuple[str, str]]]:
    """Return the page, and its rows: kilobytes, first paint and layout shift, cold and warm."""
    measured, rows = Measured(context), []
    for state, at in (("cold", place), ("warm", "")):
        size, paint = measured.open(at or measured.page.url)
        rows += [(f"{called}, {state}, kB", f"{size:.0f}"), ("first paint, s", f"{paint:.2f}")]
        rows.append(("layout shift", f"{measured.page.evaluate(SHIFT):.3f}"))
    return measured.page, rows


def constructed(desk: Any) -> list[tuple[str, str]]:
    """Return the taps and keys of each construction by touch, seconds of the script, and those of a hand at a
    usual pace."""
    rows = []
    for exercise in SCRIPTED:
        hand, begun = Draughtsman(desk, exercise), time.perf_counter()
        getattr(constructions, exercise)(hand)
        script = time.perf_counter() - begun
        pace = TAP * hand.taps + KEY * hand.keys
        told = f"{hand.taps} taps, {hand.keys} keys; {script:.0f} s by script, {pace:.0f} s at 2 s a tap"
        rows.append((f"`{exercise}` drawn by touch", told))
        hand.close()
    return rows


def findings(page: Any) -> int:
    """Return how many rules of axe a page breaks."""
    from axe_core_python.sync_playwright import Axe

    return len(Axe().run(page)["violations"])


def main(exercise: str) -> None:
    folder = tempfile.mkdtemp()
    class_ = Class(f"sqlite:///{folder}/site.db")
    rows = []
    with served(class_) as address, chromium() as browser:
        # The course is read.
        context_of(browser, class_, address, ZOE).new_page().goto(f"{address}/practice/{exercise}")
        # Bytes that a service worker asks for are counted nowhere.
        context = context_of(browser, class_, address, ZOE, service_workers="block")
        page, found = weighed(context, f"{address}/practice/{exercise}", "page")
        rows += found
        taps, begun = 0, time.perf_counter()
        name, seed = page.url.rsplit("/", 2)[1:]
        variant = class_.site.variant(name, int(seed), "en")
        part = next(part for part in variant.parts if part.sort.is_number)
        for selector in (f"#answer-a-{part.id}", f"#below-a-{part.id} button[name=check]"):
            page.tap(selector)
            taps += 1
            if taps == 1:
                page.keyboard.type(right_answer(variant, part))
        page.wait_for_selector(f"#told-a-{part.id} .right")
        rows.append(("taps from the open page to a marked number", str(taps)))
        rows.append(("seconds of it by script, on that line", f"{time.perf_counter() - begun:.1f}"))
        context.close()
        context = context_of(browser, class_, address, ZOE, service_workers="block")
        rows += weighed(context, f"{address}/practice/crank_shaper_drawn", "page to draw on")[1]
        context.close()
        rows += constructed((class_, address, browser))
        for scheme in ("light", "dark"):
            context = context_of(browser, class_, address, ZOE, color_scheme=scheme)
            page, found = context.new_page(), 0
            for place in (
                "/practice",
                f"/practice/{exercise}",
                "/progress",
                "/assignments",
                "/account",
                "/accessibility",
            ):
                page.goto(address + place)
                found += findings(page)
            rows.append((f"axe, {scheme}: rules broken on six pages", str(found)))
            context.close()
    print_table(("measure", "value"), rows)


if __name__ == "__main__":
    main(*sys.argv[1:2] or ["slotted_mechanism"])
