"""The documentation keeps up with what it tells of: links, commands, code, and the gallery of every
exercise."""

from __future__ import annotations

import csv
import importlib.util
import re
import shlex
import tomllib
from dataclasses import fields
from pathlib import Path

import click
import pytest
from class_of_three import filled, table, write_rows
from pygments.lexers import get_all_lexers
from tables import each_row

import coursework
from coursework.cli import run
from coursework.cli.commands import commands as cli
from coursework.course.marking_rules import Rules
from coursework.errors import BadInput
from coursework.issuing.assignment import OPTIONS, read_assignment
from coursework.language.words import file_of
from coursework.markup.mathml import to_mathml
from coursework.rendering.renderer import renderer_of

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
# Beside an installed wheel there is no README.
PAGES = [*sorted(DOCS.rglob("*.md")), *(p for p in [ROOT / "README.md"] if p.exists())]
COURSE = coursework.open_course()

every_page = pytest.mark.parametrize("page", PAGES, ids=lambda p: p.relative_to(ROOT).as_posix())
every_exercise = pytest.mark.parametrize("name", COURSE.names)

FENCE = re.compile(r"^(?P<ticks>`{3,})(\S*)\n(.*?)^(?P=ticks)$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\(([^()\s]+)\)")


def blocks(page: Path, kind: str) -> list[str]:
    return [body for _, name, body in FENCE.findall(page.read_text("utf-8")) if name == kind]


def anchors(page: Path) -> set[str]:
    """The anchors of a page's headings, as both GitHub and the site make them."""
    text = FENCE.sub("", page.read_text("utf-8"))
    headings = re.findall(r"^#+ (.+)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", h.lower()).strip().replace(" ", "-") for h in headings}


def commands(page: Path) -> list[list[str]]:
    """The arguments of every ``coursework`` command of a page; where a block has prompts, of their lines."""
    found = []
    for block in blocks(page, "console"):
        lines = block.splitlines()
        prompted = [line[2:] for line in lines if line.startswith("$ ")]
        for line in prompted or lines:
            words = shlex.split(line.replace("\\", "/"), comments=True)
            if words and Path(words[0]).name == "coursework":
                found.append(words[1:])
    return found


def read_command(arguments: list[str]) -> tuple[str, dict]:
    """A command line as click reads it, without running it: the command, its options and arguments."""
    with cli.make_context("coursework", list(arguments)) as context:
        name, command, rest = cli.resolve_command(context, [*context._protected_args, *context.args])
        while isinstance(command, click.Group):  # a command of several: lti keys new
            _, command, rest = command.resolve_command(context, rest)
        with click.Context(command, parent=context, info_name=name) as inner:
            options, unread, _ = command.make_parser(inner).parse_args(list(rest))
        assert not unread, f"{name} takes no {unread}"
        for parameter in command.params:
            if parameter.required:
                assert isinstance(options.get(parameter.name), (str, tuple)), (
                    f"{name} needs {parameter.opts[0]}"
                )
    return name, {n: value for n, value in options.items() if isinstance(value, (str, tuple))}


def gallery(name="gallery"):
    spec = importlib.util.spec_from_file_location(name, DOCS / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


# ------------------------------------------------------------------------ links


@every_page
def test_every_internal_link_leads_somewhere(page):
    for target in LINK.findall(FENCE.sub("", page.read_text("utf-8"))):
        if "://" in target:
            continue
        path, _, anchor = target.partition("#")
        if path.startswith("gallery/"):
            assert Path(path).stem in (*COURSE.names, "index", "rooms"), target
            continue
        there = (page.parent / path).resolve() if path else page
        assert there.exists(), target
        if anchor:
            assert anchor in anchors(there), target


@every_page
def test_the_files_of_this_repository_that_commands_name_are_there(page):
    text = "\n".join(blocks(page, "console"))
    named = re.findall(r"(?<![\w./-])(?:tests|benchmarks|docs|coursework)/[\w./-]+", text)
    assert [name for name in named if not (ROOT / name).exists()] == []


def listed(index: Path) -> set[str]:
    """The pages of the hidden table of contents of a page."""
    found = re.search(r"```\{toctree\}\n:hidden:\n\n(.*?)```", index.read_text("utf-8"), re.DOTALL)
    return set(found[1].split())


@each_row("folder", sorted({p.parent for p in DOCS.rglob("*.md")}))
def test_every_page_is_in_the_table_of_contents(folder):
    below = {f"{p.parent.name}/index" for p in folder.glob("*/index.md")}
    made = {"gallery/index"} if folder == DOCS else set()
    assert {p.stem for p in folder.glob("*.md")} - {"index"} | below | made == listed(folder / "index.md")


def test_every_block_of_the_pages_is_in_a_language_that_can_be_coloured():
    known = {"answer", *(alias for _, aliases, _, _ in get_all_lexers() for alias in aliases)}
    named = {
        (page.name, lang)
        for page in DOCS.rglob("*.md")
        for lang in re.findall(r"^```(\w+)$", page.read_text("utf-8"), re.MULTILINE)
    }
    assert [(page, lang) for page, lang in sorted(named) if lang not in known] == []


def test_the_site_names_no_other_place():
    """But hosts that stand for any."""
    sources = [*DOCS.rglob("*.md"), *DOCS.glob("*.py"), *DOCS.glob("_static/*")]
    for source in sources:
        found = re.findall(r"https?://([\w.-]+)", source.read_text("utf-8"))
        assert all(
            re.search(r"(^|\.)example\.(org|com)$|^(localhost|127\.0\.0\.1)$", host) for host in found
        ), source.name


def test_every_page_begins_with_what_its_reader_can_do_after_it():
    """But the front page, which says to each reader where to go."""
    pages = {page for page in DOCS.rglob("*.md") if page != DOCS / "index.md"}
    first = {page.name: page.read_text("utf-8").split("\n\n", 2)[1] for page in pages}
    assert not {
        name
        for name, lead in first.items()
        if not re.match("After th(is|ese) pages? |Après cette page, ", lead)
    }


def test_the_readme_is_one_screen_and_the_changes_are_a_summary():
    for name, most in (("README.md", 90), ("CHANGELOG.md", 40)):
        if (ROOT / name).exists():
            assert len((ROOT / name).read_text("utf-8").splitlines()) <= most, name


# --------------------------------------------------------------------- commands


@every_page
def test_every_command_shown_exists_with_its_options(page):
    for arguments in commands(page):
        name, given = read_command(arguments)
        if name != "new" and "--course" not in arguments:
            named = {given["exercise"]} if "exercise" in given else set(given.get("exercises", ()))
            assert {one for one in named if not one.endswith(".toml")} <= set(COURSE.names), arguments


def test_pages_do_show_commands():
    found = {read_command(a)[0] for page in DOCS.rglob("*.md") for a in commands(page)}
    assert {"list", "show", "build", "grade", "report", "check", "new", "accuracy", "lesson"} <= found


@each_row(
    "wrong",
    [["grade", "returned/", "--isued", "x"], ["solve"], ["gade"], ["list", "--seed", "1"]],
)
def test_a_command_that_does_not_exist_would_be_found(wrong):
    with pytest.raises((click.UsageError, AssertionError)):
        read_command(wrong)


@pytest.mark.e2e
@pytest.mark.parametrize(("page", "course"), [("first_hour.md", None), ("writing.md", "mine")])
def test_what_check_is_shown_to_print_is_what_it_prints(page, course, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    if course is not None:
        assert run(["new", course]) == run(["new", course, "tram_linkage"]) == 0
    (shown,) = (block for block in blocks(DOCS / page, "console") if " check " in block and "┏" in block)
    command, printed = shown.removeprefix("$ coursework ").split("\n", 1)
    capsys.readouterr()
    assert run(shlex.split(command)) == 0
    assert capsys.readouterr().out == printed


HOURS = [
    (DOCS / "first_hour.md", "en_US.UTF-8", "week3", "returned"),
    (DOCS / "first_hour.fr.md", "fr_FR.UTF-8", "semaine3", "rendus"),
]
NO_BREAK = re.compile("[\N{NO-BREAK SPACE}\N{NARROW NO-BREAK SPACE}]")
ROW_OF_MARKS = re.compile(
    r"^\| (\w+) \| `(\w+)` \| (.*?) \| (.*?) \| `([\w:]+)` \| ([\d.]+) \| (.*) \|$", re.M
)


def tables(text: str) -> list[dict[str, str]]:
    return list(csv.DictReader(text.splitlines()))


def sample(page: Path, start: str) -> str:
    """The block of a page that begins so."""
    (found,) = (block for block in blocks(page, "text") if block.startswith(start))
    return found


def hand_in(answers: dict[tuple[str, str], str], typed: dict[str, str], built: str, returned: str) -> None:
    """A folder of what came back: a notebook of Smith, a table of the others with one name mistyped."""
    Path(returned).mkdir()
    rows = [
        row | {"answer": answers.get((row["student"], row["part"]), row["answer"])}
        for row in filled(Path(built))
    ]
    paper = [row for row in rows if row["student"] != "smith"]
    write_rows(Path(returned, "paper.csv"), [*paper, paper[0] | {"student": "durant"}])
    notebook = Path(built, "handouts/slotted_mechanism/smith.en.ipynb").read_text("utf-8")
    own = [row for row in rows if row["student"] == "smith"]
    names = re.findall(r'"    \\"(\w+)\\": \\"\\",', notebook)
    for name, row in zip(names, own, strict=True):
        answer = typed.pop(name, row["answer"])
        notebook = notebook.replace(rf'"    \"{name}\": \"\",', rf'"    \"{name}\": \"{answer}\",')
    assert typed == {}
    Path(returned, "smith.ipynb").write_text(notebook, "utf-8")


@pytest.mark.e2e
@pytest.mark.parametrize(("page", "lang", "built", "returned"), HOURS, ids=["en", "fr"])
def test_the_first_hour_prints_and_writes_what_its_commands_do(
    page, lang, built, returned, tmp_path, monkeypatch, capsys
):
    """Of the answers that it does not show, the right ones came back."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("LANG", lang)
    Path("classe.csv").write_text(sample(page, "student,lang"), "utf-8")
    Path("class.csv").write_text(sample(page, "student,lang"), "utf-8")
    accepted = sample(page, "student,exercise,seed,part,points,reason")
    (change,) = tables(sample(page, "date,"))
    shown = [tuple(cell.strip("` ") for cell in row) for row in ROW_OF_MARKS.findall(page.read_text("utf-8"))]
    typed = tables(sample(page, "student,exercise,seed,part,answer"))
    answers = {(row["student"], row["part"]): row["answer"] for row in [*typed, change]}
    for block in blocks(page, "console"):
        command, _, printed = block.removeprefix("$ coursework ").partition("\n")
        if not block.startswith("$ ") or " check " in block or not printed:
            continue
        if command.startswith("grade"):
            if "--accepted" in command:
                Path("decisions.csv").write_text(accepted, "utf-8")
            else:
                cell = dict(re.findall(r'^    "(\w+)": "(.*)",$', sample(page, "# Your answers"), re.M))
                hand_in(answers | {row[:2]: row[2] for row in shown}, cell, built, returned)
        run(shlex.split(command))
        assert NO_BREAK.sub(" ", "".join(capsys.readouterr())) == printed
        if "--accepted" not in command and command.startswith("grade"):
            marks = {(row["student"], row["part"]): row for row in table(Path(built, "marks/marks.csv"))}
    assert {(row["student"], row["seed"], row["part"]) for row in typed} <= {
        (row["student"], row["seed"], row["part"]) for row in table(Path(built, "answers.csv"))
    }
    columns = ("student", "part", "answer", "read_as", "verdict", "points", "feedback")
    assert len(shown) == 8
    assert shown == [tuple(marks[row[:2]][name] for name in columns) for row in shown]
    (changed,) = table(Path(built, "marks/changes.csv"))
    assert changed | {"date": change["date"]} == change
    listed = {
        f"{built}/{line.strip().split()[0].rstrip(',')}"
        for line in sample(page, f"{built}/").splitlines()[1:]
    }
    assert all((tmp_path / name).exists() for name in listed)


@each_row(("page", "lang", "built", "returned"), HOURS)
def test_the_statement_that_is_shown_is_the_one_printed(page, lang, built, returned, monkeypatch, capsys):
    monkeypatch.setenv("LANG", lang)
    assert run(["show", "slotted_mechanism", "--seed", "3", "--lang", lang[:2]]) == 0
    printed = capsys.readouterr().out
    start = "Slotted mechanism" if lang.startswith("en") else "Mécanisme à coulisse"
    pieces = [piece.strip("\n") for piece in sample(page, start).split("...\n")]
    places = [printed.find(piece) for piece in pieces]
    assert len(pieces) == 3
    assert -1 not in places
    assert places == sorted(places)


def test_the_new_course_that_is_shown_is_the_one_printed(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (shown,) = (
        b for b in blocks(DOCS / "writing.md", "console") if b.startswith("$ coursework new mine\nwrote")
    )
    monkeypatch.delenv("LANG", raising=False)
    assert run(["new", "mine"]) == 0
    assert shown.split("\n", 1)[1] == capsys.readouterr().out


OPTION_OR_KEY = re.compile(r"--[a-z][\w-]*|(?<=^\| )`[\w./]+`", re.MULTILINE)


@each_row(
    "name",
    [
        "first_hour",
        "build_and_mark",
        "after_the_exam",
        "assignments",
        "mechanism_files",
        "platforms/moodle",
        "platforms/gradebooks",
    ],
)
def test_a_french_page_tells_of_every_option_file_and_key_of_the_english_one(name):
    english, french = (
        {*OPTION_OR_KEY.findall((DOCS / f"{name}{end}").read_text("utf-8"))} for end in (".md", ".fr.md")
    )
    assert sorted((english ^ french) - {"--help"}) == []


def test_the_french_page_on_the_site_names_its_links_and_buttons():
    page = (DOCS / "site.fr.md").read_text("utf-8") + (DOCS / "scans.fr.md").read_text("utf-8")
    said = {
        text
        for of in ("", "site", "scan")
        for text in re.findall(r'= "(.*)"$', file_of("fr", of).read_text("utf-8"), re.MULTILINE)
    }
    named = set(re.findall(r"(?<!\*)\*\[?([^*\]]+)\]?[^*]*\*(?!\*)", page))
    known = {one.replace("'", "’") for one in said}
    assert {name for name in named if " ".join(name.split()) not in known} == set()


@each_row("page", ["build_and_mark.md", "build_and_mark.fr.md"])
def test_the_marking_that_is_shown_is_that_of_a_course_that_states_none(page):
    shown = blocks(DOCS / page, "toml")
    (stated,) = (tomllib.loads(b)["marking"] for b in shown if "[marking]" in b)
    slip = COURSE["slotted_mechanism"].variant(1).grade({"omega4": "1.96"})["omega4"]
    assert slip.verdict == "slip:sign"
    usual = {name: getattr(Rules(), name) for name in stated}
    assert stated == usual | {"slip": slip.points / slip.out_of}


# ------------------------------------------------------------------------- code


@every_page
def test_every_python_block_runs(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # a study keeps its answers beside itself
    for number, block in enumerate(blocks(page, "python")):
        exec(compile(block, f"{page.name}, block {number + 1}", "exec"), {"__name__": "shown"})


# ----------------------------------------------------------------- architecture


@pytest.mark.e2e
def test_the_page_on_architecture_tells_of_every_room_and_draws_it():
    graph = gallery("import_graph")
    page = (DOCS / "architecture.md").read_text("utf-8")
    rooms = graph.rooms()
    assert {f"`{room}`" for room in rooms} <= set(re.findall(r"`\w+`", page))
    plan = graph.floors(rooms)
    height = {room: floor for floor, row in enumerate(plan) for room in row}
    assert all(height[below] < height[room] for room, needs in rooms.items() for below in needs)
    drawn = graph.drawing().svg()
    assert all(f">{room}<" in drawn for room in rooms)


def test_every_formula_of_the_errata_can_be_set():
    text = re.sub(r"`[^`\n]*`", "", (DOCS / "errata.md").read_text("utf-8"))
    found = re.findall(r"(?<!\\)\$([^$\n]+)\$", text)
    assert len(found) > 100
    for formula in found:
        to_mathml(formula, "en")


# ---------------------------------------------------------------------- gallery


def test_the_gallery_shows_every_exercise():
    index = gallery().index(COURSE)
    for name in COURSE.names:
        assert f'href="{name}.html"' in index
        assert re.search(rf"^{name}$", index, re.MULTILINE), "in its table of contents"


@every_exercise
def test_a_page_of_the_gallery_tells_all_questions_in_every_language(name):
    exercise, page = COURSE[name], gallery().page(COURSE[name])
    for lang in exercise.languages:
        assert exercise.title(lang) in page
        assert f"{name}.{lang}.png" in page
    for part in exercise.variant(0).parts:
        assert page.count(f"<li><code>{part.id}</code>") == len(exercise.languages)
    for given in exercise.spec.given:
        assert f"<td><code>{given}</code></td>" in page


@pytest.mark.e2e
@pytest.mark.parametrize("name", ["slotted_mechanism", "vocabulary", "ball_reducer"])
def test_every_picture_and_page_that_the_gallery_points_to_is_made(name):
    exercise, made = COURSE[name], {file for file, _ in gallery().attached(COURSE[name])}
    made |= {f"{name}.svg"} | {f"{name}.{lang}.png" for lang in exercise.languages}
    made |= {
        f"whole/pages/workbook-{lang}/{one}.html"
        for lang in exercise.languages
        for one in COURSE.folder.lessons
    }
    page = gallery().page(exercise)
    shown = set(re.findall(r"!\[[^\]]*\]\(([^)]+)\)", page))
    led_to = {f"whole/{target}" for target in re.findall(r'href="\.\./([^"]+)"', page)}
    assert shown | led_to <= made
    assert (f"{name}.motion.svg" in shown) == (name != "vocabulary")
    assert {f"whole/pages/{name}.{lang}.solution.html" for lang in exercise.languages} <= led_to


@pytest.mark.slow
def test_the_pages_of_the_workbook_are_made_for_every_lesson_and_exercise():
    for lang in COURSE.folder.languages:
        made = {file for file, _ in gallery().workbook(COURSE, lang)}
        for one in (*COURSE.folder.lessons, *COURSE.names, "index"):
            assert f"whole/pages/workbook-{lang}/{one}.html" in made


def test_the_picture_of_a_sheet_is_one_page_as_png():
    handout = COURSE["slotted_mechanism"].variant(0, "en").handout()
    assert gallery().first_page(renderer_of(COURSE.folder).typst(handout)).startswith(b"\x89PNG")


@each_row("page", ["assignments.md", "assignments.fr.md"])
def test_the_assignment_that_is_shown_is_one_of_the_course(page, tmp_path):
    """Its secret is none, so that who copies it shares none with all who read the page."""
    (shown,) = blocks(DOCS / page, "toml")
    (tmp_path / "midterm.toml").write_text(shown, "utf-8")
    with pytest.raises(BadInput, match="a secret is 32 hexadecimal digits"):
        read_assignment(tmp_path / "midterm.toml", COURSE)
    shown = re.sub("(?m)^secret = .*\n", "", shown)
    (tmp_path / "midterm.toml").write_text(shown, "utf-8")
    assignment = read_assignment(tmp_path / "midterm.toml", COURSE)
    assert set(assignment.names) == {"slotted_mechanism", "vocabulary", "four_bar_motion", "grashof"}
    table = (DOCS / page).read_text("utf-8")
    for key in [
        *OPTIONS,
        *(f.name for f in fields(assignment) if f.name not in ("name", "exercises", "options")),
    ]:
        assert f"`{key}`" in table or f"`[{key}]`" in table or key == "practice", key
