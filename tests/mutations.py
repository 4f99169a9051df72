"""Files damaged at random: structure (JSON, tables) and bytes; the same for the same generator."""

from __future__ import annotations

import copy
import csv
import io
import json


class Written:
    """What stands in a JSON as it is written, which ``json.dumps`` would not write."""

    def __init__(self, text):
        self.text = text


ODD_VALUES = (
    None,
    True,
    False,
    [],
    {},
    "",
    " ",
    "x\0y",
    "\ud800",
    "\x1b[31m",
    "../../x",
    "=1+1",
    0,
    -1,
    1.5,
    10**30,
    1e308,
    "NaN",
    "1e400",
    [[]],
    {"": None},
    {"id": None},
    "é" * 3000,
    Written("NaN"),
    Written("1e999"),
    Written("-Infinity"),
    Written("9" * 5000),
    Written("[" * 3000 + "]" * 3000),
    Written('{"a":' * 3000 + "1" + "}" * 3000),
)
ODD_CELLS = (
    "",
    " ",
    "x\0y",
    "\x1b[31m",
    "9" * 5000,
    "-1",
    "1e999",
    "nan",
    "inf",
    "1,5",
    "=1+1",
    '"',
    '""',
    "'",
    ";",
    "\\N",
    "é" * 3000,
    "a\nb",
    "a\rb",
    "\u2028",
    "true",
    "[" * 3000,
    "{}",
    "[1",
    '{"a": 1}',
    "2026-99-99",
    "correct",
    "mistake:",
    ":",
    "\x85",
)


def damaged_json(random, text):
    """A JSON with one to three of its values exchanged, taken away, doubled or called otherwise, or with
    damaged bytes."""
    if random.random() < 0.2:
        return damaged_bytes(random, text.encode("utf-8"))
    content = copy.deepcopy(json.loads(text))
    for _ in range(random.choice((1, 1, 1, 2, 3))):
        content = _changed(random, content)
    marks = {}

    def plain(value):
        if isinstance(value, Written):
            marks[f"@@{len(marks)}@@"] = value.text
            return f"@@{len(marks) - 1}@@"
        if isinstance(value, dict):
            return {key: plain(one) for key, one in value.items()}
        return [plain(one) for one in value] if isinstance(value, list) else value

    made = json.dumps(plain(content), ensure_ascii=True)
    for mark, written in marks.items():
        made = made.replace(f'"{mark}"', written)
    return made.encode("utf-8")


def _places(content, path=()):
    if isinstance(content, (dict, list)):
        for key, one in list(content.items() if isinstance(content, dict) else enumerate(content)):
            yield (content, key)
            yield from _places(one)


def _changed(random, content):
    places = list(_places(content))
    if not places or random.random() < 0.03:
        return copy.deepcopy(random.choice(ODD_VALUES))
    inside, key = random.choice(places)
    what = random.randrange(6)
    if what == 0:
        del inside[key]
    elif what == 1 and isinstance(inside, dict):
        inside[random.choice(("", "x", key + " ", key.upper(), "id", "\0"))] = inside.pop(key)
    elif what == 1:
        inside.append(copy.deepcopy(inside[key]))
    elif what == 2:
        other, there = random.choice(places)
        taken = other[there] if there in (other if isinstance(other, dict) else range(len(other))) else None
        inside[key] = copy.deepcopy(taken)
    else:
        inside[key] = copy.deepcopy(random.choice(ODD_VALUES))
    return content


def damaged_table(random, data, delimiter=","):
    """A CSV with cells exchanged, rows or columns taken away or doubled, or with damaged bytes."""
    if random.random() < 0.3:
        return damaged_bytes(random, data)
    rows = list(csv.reader(io.StringIO(data.decode("utf-8-sig"), newline=""), delimiter=delimiter))
    for _ in range(random.choice((1, 1, 2, 4))):
        if not rows:
            break
        place = random.choice((0, random.randrange(len(rows))))
        row = rows[place]
        what = random.randrange(8)
        if what == 0:
            del rows[place]
        elif what == 1:
            rows.insert(random.randrange(len(rows) + 1), list(row))
        elif what == 2 and row:
            column = random.randrange(len(row))
            for one in rows:
                del one[column : column + 1]
        elif what == 3 and row:
            column = random.randrange(len(row))
            for one in rows:
                one[column:column] = one[column : column + 1]
        elif what == 4:
            row.append(random.choice(ODD_CELLS))
        elif row:
            row[random.randrange(len(row))] = random.choice(ODD_CELLS)
    made = io.StringIO()
    writer = csv.writer(made, delimiter=delimiter, quoting=random.choice((csv.QUOTE_MINIMAL, csv.QUOTE_ALL)))
    writer.writerows(rows)
    return made.getvalue().encode("utf-8")


def damaged_bytes(random, data):
    """Bytes changed, cut off, put in, doubled; or another encoding of the text."""
    data = bytearray(data)
    for _ in range(random.choice((1, 1, 2, 5, 20))):
        place, what = random.randrange(len(data) + 1), random.randrange(8)
        if what == 0:
            del data[place:]
        elif what == 1:
            del data[place : place + random.randrange(1, 40)]
        elif what == 2:
            data[place:place] = bytes(random.randrange(256) for _ in range(random.randrange(1, 5)))
        elif what == 3:
            data[place:place] = random.choice(
                (b"\0", b'"', b"\n", b"\r", b",", b";", b"{", b"[", b"]", b"\xff", b"\xef\xbb\xbf")
            )
        elif what == 4:
            data[place:place] = data[place : place + random.randrange(1, 200)]
        elif what == 5 and random.random() < 0.1:
            data = bytearray(bytes(data).decode("utf-8", "replace").encode("utf-16"))
        elif place < len(data):
            data[place] = random.choice((data[place] ^ (1 << random.randrange(8)), random.randrange(256)))
    return bytes(data)
