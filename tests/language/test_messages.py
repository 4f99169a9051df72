"""Every message for instructors and students is a template that stands in the French catalogue with the same
places."""

import ast
import pickle
import re
import string
import tomllib
from collections import Counter

import click
import pytest
from package_trees import FILES, all_nodes, nodes

from coursework.cli.commands import commands
from coursework.cli.help_pages import paragraphs
from coursework.cli.options import LANGUAGE_DEFAULT
from coursework.errors import BadInput, UnknownName, counted, unknown
from coursework.gradebook.book import rejected_rows
from coursework.gradebook.rows import Rejected
from coursework.issuing.formats import ADDITIONS
from coursework.language.words import languages
from coursework.messages import (
    CATALOGUES,
    Message,
    as_message,
    joined_notes,
    localised,
    messages_in,
    separate_notes,
    translations,
)

#: What takes a template first, and is read by those who use the product; errors in the code of a course stay
#: English.
FOR_USERS = {
    "BadInput",
    "Message",
    "UnplacedError",
    "Lost",
    "NotAtHand",
    "NotServed",
    "NoSolution",
    "BadPicture",
    "say",
    "warn",
}

#: What the numeric core, mechanics, scenes and figures refuse: read by those who solve, simulate, explore and
#: learn.
OF_NUMBERS = {
    "WrongValue",
    "WrongUnit",
    "CannotAssemble",
    "CannotTell",
    "Undefined",
    "Cycle",
    "Starved",
    "NotEvaluable",
}

#: Files whose errors only an author of exercises in Python reads.
FOR_AUTHORS = ("model.py", "kinds/")

#: Readers of TOML files, which refuse a key by a template.
REFUSING = (
    "scenes/scene_files",
    "issuing/assignment",
    "linkages/",
    "platforms/lti/settings",
    "system/toml_files",
)


def calls():
    for file, found in nodes(ast.Call).items():
        if file.rpartition("/")[2] in ("messages.py", "errors.py"):
            continue
        for node in found:
            name, arguments, keywords = getattr(node.func, "id", ""), node.args, node.keywords
            if getattr(node.func, "attr", "") in ("refused", "refused_key") and file.startswith(REFUSING):
                name, arguments = "Message", arguments[1:]  # behind the key of the file
                keywords = [word for word in keywords if word.arg != "exercise"]
            if (name in FOR_USERS or (name in OF_NUMBERS and not file.startswith(FOR_AUTHORS))) and arguments:
                first = arguments[0]
                for template in (first.body, first.orelse) if isinstance(first, ast.IfExp) else (first,):
                    yield f"{file}:{template.lineno}", template, keywords


def places(template):
    return sorted({field for _, field, _, _ in string.Formatter().parse(template) if field})


@pytest.mark.parametrize("lang", [lang for lang in languages() if lang != "en"])
def test_each_message_has_a_translation_with_the_same_places(lang):
    known = translations(lang)

    def fault(first, keywords):
        if not isinstance(first, ast.Constant):
            # A message passed on whole, a variable, or a text of words in the reader's language: never one
            # put together on the spot.
            return (
                None
                if isinstance(first, ast.Name | ast.Call | ast.Attribute | ast.Subscript)
                else "put together, not a template"
            )
        template, given = first.value, sorted(word.arg or "**" for word in keywords)
        if template not in known:
            return f"not translated: {template!r}"
        if "**" not in given and given and places(template) != given:
            return f"places {places(template)}, values {given}"
        return None

    found = {place: why for place, *call in calls() if (why := fault(*call))}
    assert found == {}


@pytest.mark.parametrize("lang", [lang for lang in languages() if lang != "en"])
def test_what_is_looked_up_in_vain_is_named_in_the_readers_language(lang):
    """And where it was looked for: a name alone, or a message."""
    known, found = translations(lang), {}
    for file, calls_ in nodes(ast.Call).items():
        for node in calls_:
            if getattr(node.func, "id", "") != "unknown":
                continue
            kind, where = node.args[0], node.args[3] if len(node.args) > 3 else None
            if (
                isinstance(kind, ast.Constant)
                and f"no {kind.value} {{name!r}}{{place}}{{nearest}}" not in known
            ):
                found[f"{file}:{node.lineno}"] = kind.value
            pieces = getattr(where, "values", [where])
            texts = [piece.value for piece in pieces if isinstance(piece, ast.Constant)]
            if any(text[:1].isalpha() or text[:2].lstrip(", ").isalpha() for text in texts):
                found[f"{file}:{node.lineno}, where"] = ast.unparse(where)
    assert found == {}


#: Rooms of which every sentence is read by an instructor; the pages of the site are templates.
READ_BY_INSTRUCTORS = ("cli", "gradebook", "scanning", "issuing")

#: Words of sentences, not of names, patterns and keys.
ENGLISH = re.compile(
    r"\b(?:the|is|of|has|have|are|no|not|cannot|with|without|for|from|should|must|to|and|a|in|on|by)\b"
)

#: Sentences that only a programmer reads, and those that are part of the help of a command.
NOT_MESSAGES = {
    "only a header that has them comes here",
    "id of a part",
    "handed in by",
    "a number of very many digits",
}


def sentences(file):
    """Yield the English sentences in the code of a file that are neither documentation nor help of a
    command."""
    skipped = set()
    for node in all_nodes(file):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            skipped.add(id(node.value))
        elif isinstance(node, ast.keyword) and node.arg in ("help", "epilog"):
            skipped.update(map(id, ast.walk(node.value)))
        elif isinstance(node, ast.JoinedStr):
            skipped.update(map(id, node.values))
    for node in all_nodes(file):
        if id(node) in skipped:
            continue
        if isinstance(node, ast.JoinedStr):
            text = "".join(piece.value if isinstance(piece, ast.Constant) else "{}" for piece in node.values)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            text = node.value
        else:
            continue
        if len(ENGLISH.findall(text)) > 1:
            yield node.lineno, text


@pytest.mark.parametrize("lang", [lang for lang in languages() if lang != "en"])
def test_each_sentence_that_an_instructor_reads_stands_in_the_catalogue(lang):
    known = {*translations(lang), *NOT_MESSAGES, *ADDITIONS.values(), LANGUAGE_DEFAULT}
    found = {
        f"{file}:{line}": text
        for file in FILES
        if file.startswith(tuple(f"{room}/" for room in READ_BY_INSTRUCTORS))
        for line, text in sentences(file)
        if text not in known
    }
    assert found == {}


@pytest.mark.parametrize("lang", [lang for lang in languages() if lang != "en"])
def test_each_translation_has_the_places_of_its_template(lang):
    tables = tomllib.loads((CATALOGUES / f"{lang}.toml").read_text("utf-8"))
    twice = Counter(template for table in tables.values() for template in table)
    assert [template for template, count in twice.items() if count > 1] == []
    pairs = translations(lang).items()
    assert {template: text for template, text in pairs if places(text) != places(template)} == {}


def test_a_message_is_printed_in_the_language_of_its_reader():
    error = unknown("exercise", "cranck", ["crank"], where="exam.toml")
    assert str(error) == "no exercise 'cranck' in exam.toml; did you mean 'crank'?"
    with messages_in("fr"):
        assert str(error).replace("\u202f", " ") == (
            "aucun exercice « cranck » dans exam.toml ; vouliez-vous dire « crank » ?"
        )
    assert str(error).startswith("no exercise")
    assert isinstance(error, UnknownName)


def test_numbers_of_a_message_have_the_signs_of_its_language():
    table = [
        (Message("{share:.0f} of {size:.3g} mm", share=12.0, size=1.25), "12 of 1,25 mm"),
        (
            Message("{count:,} rows, at most {most:,}", count=1234567, most=20),
            "1\u202f234\u202f567 rows, at most 20",
        ),
        (Message('write "{number:g} {unit}"', number=0.5, unit="mm"), 'write "0.5 mm"'),
        (Message("{name:>4}", name="a.b"), " a.b"),
    ]
    assert [message.in_language("fr") for message, _ in table] == [text for _, text in table]
    assert str(table[0][0]) == "12 of 1.25 mm"


def test_a_quoted_text_has_the_quotes_of_the_language():
    """Numbers and lists are not quoted, and what cannot be printed is escaped, as in English."""
    table = [
        (Message("found {found!r}", found="hier"), "found «\u202fhier\u202f»", "found 'hier'"),
        (Message("found {found!r}", found="{0}\n"), "found «\u202f{0}\\n\u202f»", "found '{0}\\n'"),
        (Message("found {found!r}", found=["x", 2]), "found ['x', 2]", "found ['x', 2]"),
        (
            Message("found {found!r}", found=Message("{number} file{number:|s}", number=2)),
            "found «\u202f2 fichiers\u202f»",
            "found '2 files'",
        ),
    ]
    assert [message.in_language("fr") for message, _, _ in table] == [text for _, text, _ in table]
    assert [str(message) for message, _, _ in table] == [text for _, _, text in table]


def test_values_that_are_messages_are_translated_with_the_whole():
    error = BadInput("{cells} where the header has {most}", cells=counted(3, "cell"), most=5)
    assert str(error) == "3 cells where the header has 5"
    assert localised(pickle.loads(pickle.dumps(error)), "fr").startswith("3 cellules")
    assert localised(as_message(error).replacing("5", "7"), "en") == "3 cells where the header has 7"


def test_a_text_without_values_keeps_its_braces():
    assert str(BadInput("write {a} as it is")) == "write {a} as it is"
    assert Message("100 % {") == "100 % {"


def test_rejected_answers_state_their_place_and_reason_in_the_readers_language():
    rows = [
        Rejected("class.csv, line 12", Message("the file is empty")),
        Rejected("marks.parquet, row 3", "why"),
    ]
    with messages_in("fr"):
        places = [row["source"] for row in rejected_rows(rows)]
    assert places == ["class.csv, ligne 12", "marks.parquet, enregistrement 3"]
    assert [row["source"] for row in rejected_rows(rows)] == ["class.csv, line 12", "marks.parquet, row 3"]


def test_notes_put_together_are_translated_one_by_one_and_come_apart_again():
    notes = Message("it is damaged"), Message("{file}, line {line}", file="a.csv", line=3)
    both = joined_notes(["", *notes])
    assert both == "it is damaged; a.csv, line 3"
    assert localised(both, "fr") == "elle est endommagée; a.csv, ligne 3"
    assert separate_notes(both) == notes
    assert separate_notes(notes[1]) == (notes[1],)
    assert joined_notes([]) == ""


def helps(command, context):
    """Yield the texts of the help of a command, of its options and of its commands."""
    yield from paragraphs(command.help or "")
    for option in command.get_params(context):
        yield from paragraphs(getattr(option, "help", None) or "")
    if isinstance(command, click.Group):
        for name in command.list_commands(context):
            yield from helps(command.get_command(context, name), context)


@pytest.mark.parametrize("lang", [lang for lang in languages() if lang != "en"])
def test_the_help_of_every_command_and_option_is_translated(lang, capsys):
    """And no text is that no help has: what is written in capitals stands for what an option takes."""
    said = {*helps(commands, click.Context(commands))}
    table = tomllib.loads((CATALOGUES / f"{lang}.toml").read_text("utf-8"))["help"]
    assert said - {*table} == set()
    assert {one for one in {*table} - said if not one.isupper()} == {
        "Usage: ",
        "Options",
        "Commands",
        "default:",
        "required",
    }
    with messages_in(lang):
        for arguments in (["--help"], ["after", "--help"]):
            commands.main(arguments, prog_name="coursework", standalone_mode=False)
    shown = capsys.readouterr().out
    assert not re.search(r"Usage:|Commands|FILE|DIRECTORY|Show |Options:|\[default", shown)


def test_words_agree_with_a_number_by_the_rule_of_the_language():
    """French is singular below two, English at one only."""
    template = "{rows}: {marked} marked, {rejected} rejected{blanks}; see {out}"

    def french(number):
        values = {
            "rows": counted(number, "row"),
            "marked": number,
            "rejected": number,
            "blanks": "",
            "out": "m",
        }
        return localised(Message(template, **values), "fr").replace("\N{NARROW NO-BREAK SPACE}", " ")

    assert [french(number) for number in (0, 1, 2)] == [
        "0 ligne : 0 corrigée, 0 rejetée ; voir m",
        "1 ligne : 1 corrigée, 1 rejetée ; voir m",
        "2 lignes : 2 corrigées, 2 rejetées ; voir m",
    ]
    waits = "{count} place{count:|s} wait{count:s|} for a person: open {page}"
    assert [str(Message(waits, count=count, page="p"))[:15] for count in (0, 1, 2)] == [
        "0 places wait f",
        "1 place waits f",
        "2 places wait f",
    ]
    left_out = Message("{lines} without a student left out: {named}", lines=counted(1, "line"), named="x")
    assert localised(left_out, "fr").startswith("1 ligne sans étudiant écartée")
