"""A student with a finger on the drawing surface of a practice page: taps, tools, and what comes of them in
the boxes."""

import cmath
import math
import re
from collections import defaultdict

from site_browser import context_of, watched
from site_people import ZOE
from site_practising import right_answer

from coursework.figures.student_drawing import StudentDrawing
from coursework.marking.marking import mark
from coursework.rendering.surface import surface
from coursework.sheets.handout import handout

_SEEDS = defaultdict(set)  #: a variant for each drawing

#: Where a point of the paper is on the screen, px; the surface is scrolled into sight where it is not.
_PLACE = """([x, y]) => {
  const n = document.querySelector("[data-surface]"), at = n.getBoundingClientRect();
  if (at.top < 140 || at.bottom > innerHeight) n.scrollIntoView({ block: "center" });
  const b = n.getBoundingClientRect(), v = n.getAttribute("viewBox").split(" ").map(Number);
  return [b.left + (x - v[0]) * b.width / v[2], b.top + (-y - v[1]) * b.height / v[3],
    b.left, b.top, b.right, b.bottom];
}"""

#: The middle of a control of the surface, px, and whether it had to be scrolled to: out of sight, or under a
#: bar.
_BUTTON = """(selector) => {
  const one = document.querySelector(".surface").querySelector(selector), middle = () => {
    const b = one.getBoundingClientRect();
    return [b.left + b.width / 2, b.top + b.height / 2];
  };
  const seen = () => one.contains(document.elementFromPoint(...middle()));
  const was = seen();
  if (!was) one.scrollIntoView({ block: "center" });
  return [...middle(), was, seen()];
}"""


class Pencil:
    """A finger on the drawing surface of a practice page; ``number`` says which variant, whatever other tests
    have drawn."""

    def __init__(self, desk, exercise, size="telephone", lang="en", number=None):
        self.class_, address, browser = desk
        self.context = context_of(browser, self.class_, address, ZOE, lang=lang, size=size)
        self.page = self.context.new_page()
        self.faults = watched(self.page)
        self.page.set_default_timeout(20_000)
        seeds = _SEEDS[exercise] if number is None else set()
        for _ in range(1 if number is None else number + 1):
            seed = self.class_.site.pool.choose_seed(exercise, self.class_.ids[ZOE], seeds)
            seeds.add(seed)
        self.page.goto(f"{address}/practice/{exercise}/{seed}")
        self.fingers = self.context.new_cdp_session(self.page)
        self.variant = self.class_.site.variant(exercise, seed, lang)
        self.handout = handout(self.variant)
        self.has_touch = size == "telephone"
        self.taps = self.keys = self.scrolls = 0

    # ------------------------------------------------------------------ fingers

    def place(self, z):
        """Pixels of a point of the paper, mm."""
        return self.page.evaluate(_PLACE, [z.real, z.imag])[:2]

    def touch(self, kind, *places):
        points = [{"x": x, "y": y, "id": k} for k, (x, y) in enumerate(places)]
        self.fingers.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    def tap(self, z):
        self.taps += 1
        self.touch("touchStart", self.place(z))
        self.touch("touchEnd")

    def drag(self, start, *way):
        self.taps += 1
        self.touch("touchStart", self.place(start))
        for z in way:
            self.touch("touchMove", self.place(z))
        self.touch("touchEnd")

    def pinch(self, z, by=3.0):
        """Spread two fingers about a point of the paper."""
        self.taps += 1
        x, y = self.place(z)
        start = 14
        self.touch("touchStart", (x - start, y), (x + start, y))
        for k in range(1, 5):
            reach = start * (1 + (by - 1) * k / 4)
            self.touch("touchMove", (x - reach, y), (x + reach, y))
        self.touch("touchEnd")

    def press(self, selector):
        """Press a control of the surface, with the finger where the screen has touch."""
        self.taps += 1
        if not self.has_touch:
            self.page.evaluate("s => document.querySelector('.surface').querySelector(s).click()", selector)
            return
        x, y, was_seen, is_seen = self.page.evaluate(_BUTTON, selector)
        assert is_seen, f"{selector} stands under something"
        self.scrolls += not was_seen
        self.page.touchscreen.tap(x, y)

    def enter(self, name, value):
        """Type into a box of the surface, over what stands there."""
        text = str(value)
        self.press(f"[data-in={name}]")
        self.keys += len(text)
        self.page.evaluate(
            """([name, value]) => { const box = document.querySelector(`[data-in=${name}]`);
              box.value = value;
            box.dispatchEvent(new Event("input", { bubbles: true })); }""",
            [name, text],
        )

    # -------------------------------------------------------------------- tools

    def tool(self, name):
        """Take a tool, where it is not in the hand."""
        if self.page.get_attribute(f"[data-tool={name}]", "aria-pressed") != "true":
            self.press(f"[data-tool={name}]")

    def dot(self, z, name):
        self.tool("point")
        self.tap(z)
        self.press(f"[data-name={name}]")

    def measure(self, p, q, *parts):
        self.tool("measure")
        self.tap(p)
        self.tap(q)
        for part in parts:
            self.press(f"[data-put={part}]")

    # ------------------------------------------------------------------ answers

    def fill(self, parts):
        """Type what is no drawing."""
        for part in parts:
            if part.choices:
                self.page.locator(f"[name=a-{part.id}][value='{right_answer(self.variant, part)}']").check()
            else:
                self.type(part.id, right_answer(self.variant, part))

    def type(self, part, text):
        self.page.fill(f"[name=a-{part}]", str(text))

    def answers(self):
        """Texts of the boxes by part."""
        form = self.page.evaluate("Array.from(new FormData(document.getElementById('sheet')))")
        return {part.id: dict(form).get(f"a-{part.id}", "") for part in self.variant.parts}

    def text(self):
        return self.page.input_value("[name=a-drawing]")

    def drawn(self):
        return StudentDrawing.parse(self.text())

    def marks(self):
        return mark(self.variant, self.answers())

    def close(self):
        assert self.faults == []
        self.context.close()


def cis(degrees):
    return cmath.rect(1, math.radians(degrees))


#: What is taken for the other where a direction is mistaken.
_OTHER = {"parallel": "perpendicular", "perpendicular": "parallel"}


class Draughtsman(Pencil):
    """A student who constructs with set-square and compass, from what the sheet gives and the links of its
    figure.

    ``mistakes`` are those that they make, by the point that is found: of a vector that is laid off its
    ``sense``, ``length``, ``direction``, ``vector`` or the point from which it starts wrongly; of two lines
    that meet the number of the line, and its ``direction``, its ``sense`` or the point through which it goes
    wrongly. A ``scale`` is so many times what it should be, or ``stated`` so; ``radii`` are exchanged.
    """

    def __init__(self, *more, mistakes=None, **named):
        super().__init__(*more, **named)
        self.mistakes = mistakes or {}
        told = self.variant.exercise.spec.statement_values(self.variant.given)
        found = {name: re.search(r"-?\d[\d.]*", str(text)) for name, text in told.items()}
        numbers = {name: float(number[0]) for name, number in found.items() if number}
        self.given = {**self.variant.given, **numbers}
        self.links = {"x": 0.0} | {
            link.name.replace("_", ""): link.degrees for link in surface(self.handout).links
        }
        self.at = {}  #: named points, mm on paper
        self.scale = 1.0

    def set_scale(self, longest, part="", most=75.0):
        """Choose the round scale at which a known size is long and fits the paper."""
        round_ones = (m * 10.0**k for k in range(-3, 7) for m in (1, 2, 5))
        self.scale = next(k for k in round_ones if longest / k <= most) * self.mistakes.get("scale", 1)
        if part and self.page.locator("[data-scale]").count() > 1:
            self.press(f"[data-scale={part}]")
        self.enter("scale", f"{self.scale * self.mistakes.get('stated', 1):g}")

    def start(self, z, name):
        """Put a point anywhere."""
        self.dot(z, name)
        self.at[name] = z

    def line(self, tool, z, link=None, degrees=None):
        """Draw a line through a point, along or square to a link or an angle; return its direction,
        complex."""
        self.tool(tool)
        angle = self.links[link] if link else degrees
        if link:
            self.press(f"button[data-link='{angle:g}']" if link == "x" else f"button[data-link='{angle}']")
        else:
            self.enter("direction", f"{degrees:g}")
        self.sure(z)
        return cis(angle + 90 * (tool == "perpendicular"))

    def circle(self, z, radius):
        self.tool("compass")
        self.enter("radius", radius)
        self.sure(z)

    def sure(self, z):
        """Tap a point that is there, with the paper so that it is in sight."""
        self.bring(z)
        self.tap(z)

    def bring(self, z, margin=18):
        """Zoom out until a point of the paper is in sight."""
        for _ in range(5):
            x, y, left, top, right, bottom = self.page.evaluate(_PLACE, [z.real, z.imag])
            if left + margin < x < right - margin and top + margin < y < bottom - margin:
                return
            self.press("[data-act=zoom_out]")
        raise AssertionError(f"{z} is out of sight")

    def measure(self, p, q, *parts):
        for z in (p, q):
            self.bring(z)
        super().measure(p, q, *parts)

    def crossing(self, z, name=None):
        """Take the intersection at a point; where the finger finds another, nearer."""
        for _ in range(4):
            before = self.text()
            self.tool("intersection")
            self.sure(z)
            found = min(
                (i.at for i in self.drawn().items.values() if i.kind == "point"),
                key=lambda p: abs(p - z),
                default=1e9,
            )
            if abs(found - z) < 0.05:
                break
            if self.text() != before:
                self.press("[data-tool=undo]")
            self.pinch(z)
        else:
            raise AssertionError(f"no intersection was found at {z}")
        if name:
            self.press(f"[data-name={name}]")
            self.at[name] = z
        return z

    def lay_off(self, start, tool, link, vector, name=None, text=None, step=None):
        """Lay off a vector of known length along or square to a link; ``text`` is the length as it is typed,
        mm."""
        degrees = None
        match self.mistakes.get(step or name):
            case None:
                pass
            case "sense":
                vector = -vector
            case "length":
                vector, text = 0.65 * vector, None
            case "direction":
                vector, tool = 1j * vector, _OTHER[tool]
            case "vector":
                vector, text, tool, link = 1.6 * cis(75) * vector, None, "parallel", None
                degrees = math.degrees(cmath.phase(vector))
            case point:
                start = self.at[point]
        self.line(tool, start, link, degrees)
        self.circle(start, text or f"{abs(vector):.4g}")
        return self.crossing(start + vector, name)

    def meet(self, name, *lines):
        """Find the point where two lines meet, each stated as point, tool and link."""
        which, how = self.mistakes.get(name, (None, None))
        ways = []
        for k, (z, tool, link) in enumerate(lines):
            degrees = None
            if which == k and how == "direction":  # as if an angle were misread
                link, degrees = None, self.links[link] + 20
            elif which == k and how != "sense":
                z = self.at[how]
            ways.append((z, self.line(tool, z, link, degrees)))
        (p, u), (q, v) = ways
        met = p + u * ((q - p).conjugate() * v).imag / (u.conjugate() * v).imag
        if how == "sense":  # as far on the other side of the point from which the line goes
            z = ways[which][0]
            self.circle(z, f"{abs(met - z):.4g}")
            met = 2 * z - met
        return self.crossing(met, name)

    def rate(self, start, end, link, length):
        """Rate of a bar from the part of a drawn vector across it, anticlockwise positive."""
        across = 1j * cis(self.links[link])
        return ((self.at[end] - self.at[start]) * self.scale / across).real / length


class Typist(Draughtsman):
    """The same without mouse or finger: from one control to the next by Tab and, among the tools, arrow
    keys."""

    def key(self, name, times=1):
        for _ in range(times):
            self.page.keyboard.press(name)
            self.keys += 1

    def stand(self, selector):
        """Go to a control by the keys, as far as it is one's turn."""
        bar = self.page.locator(selector).first.evaluate(
            "n => (n.closest('[role=toolbar]') || { ariaLabel: '' }).ariaLabel"
        )
        tools = f'[role=toolbar][aria-label="{bar}"] button'
        goal = tools if bar else selector
        for _ in range(80):
            if self._stands_on(goal):
                break
            before = self.page.locator(goal).first.evaluate(
                "n => !!(document.activeElement.compareDocumentPosition(n) & 2)"
            )
            self.key("Shift+Tab" if before else "Tab")
        if bar:
            ahead = self.page.locator(selector).first.evaluate(
                "(n, tools) => { const all = [...document.querySelectorAll(tools)];"
                " return all.indexOf(n) - all.indexOf(document.activeElement); }",
                tools,
            )
            self.key("ArrowRight" if ahead > 0 else "ArrowLeft", abs(ahead))
        assert self._stands_on(selector), f"no key leads to {selector}"

    def _stands_on(self, selector):
        return self.page.evaluate("selector => document.activeElement.matches(selector)", selector)

    def press(self, selector):
        self.stand(selector)
        self.key("Enter")

    def enter(self, name, value):
        self.stand(f"[data-in={name}]")  # what stands there is selected
        self.keys += len(str(value))
        self.page.keyboard.type(str(value))

    def cursor(self):
        """Place of the cursor, as it is read aloud."""
        x, y = re.search(r"x (-?[\d.,]+)\s+y (-?[\d.,]+)", self.page.inner_text(".surface-told")).groups()
        return complex(float(x.replace(",", ".")), float(y.replace(",", ".")))

    def tap(self, z):
        """Go to a point or an intersection by the full stop; where there is none, by the arrow keys."""
        self.stand("[data-surface]")
        stops = []
        while True:
            self.key(".")
            is_place = "x " in self.page.inner_text(".surface-told")
            if not is_place or (stops and abs(self.cursor() - stops[0]) < 1e-6) or len(stops) > 60:
                break
            stops.append(self.cursor())
            if abs(stops[-1] - z) < 0.1:
                self.key("Enter")
                return
        self.key("ArrowRight")
        way = z - self.cursor()
        for far, keys in ((way.real, ("ArrowRight", "ArrowLeft")), (way.imag, ("ArrowUp", "ArrowDown"))):
            self.key(keys[far < 0], round(abs(far)))
        self.key("Enter")

    def bring(self, z, margin=18):
        """The cursor brings the paper along."""
