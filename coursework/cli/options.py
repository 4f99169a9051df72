"""Options and messages that the commands share."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from coursework.cli import completion
from coursework.cli.printing import warn
from coursework.errors import BadInput, WrongValue
from coursework.language.numbers import typed_number
from coursework.messages import Message, localised
from coursework.system.extras import libraries
from coursework.system.limits import MOST_SEED
from coursework.system.visible import one_line

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

    from coursework.course.course import Course


DONE, FOUND, BAD = 0, 1, 2  #: exit statuses


def print_notes(notes: Sequence[str]) -> None:
    """Say what is to be known and is not an error."""
    for note in notes[:10]:
        warn("note: {note}", note=one_line(localised(note)))
    if len(notes) > 10:
        warn("note: and {count} more such", count=len(notes) - 10)


def complain(message: str) -> int:
    click.echo(f"coursework: {' '.join(message.split())}", err=True)
    return BAD


SITE_DATABASE = "coursework.db"  #: file of a site whose database is not stated


class NeedingExtra(click.Command):
    """Command that needs the libraries of an extra, and complains of them before its arguments.

    ``ready`` raises :class:`~coursework.system.extras.NotAtHand` where one of them is missing.
    """

    def __init__(self, *args: Any, ready: Callable[[], None], **attributes: Any) -> None:
        super().__init__(*args, **attributes)
        self.ready = ready

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        if not ctx.resilient_parsing and not {*ctx.help_option_names} & {*args}:
            self.ready()
        return super().parse_args(ctx, args)


def needing_extra(ready: Callable[[], None]) -> Callable[[click.Context, click.Parameter, Any], Any]:
    """Return the callback of an eager option that needs the libraries of an extra."""

    def checked(context: click.Context, parameter: click.Parameter, value: Any) -> Any:
        if value and not context.resilient_parsing:
            ready()
        return value

    return checked


def _set_zone(context: click.Context, parameter: click.Parameter, name: str | None) -> None:
    if name and not context.resilient_parsing:
        from coursework.system.zone import set_zone

        set_zone(name)


zone_option = click.option(
    "--timezone",
    metavar="ZONE",
    callback=_set_zone,
    expose_value=False,
    help="Time zone of the school, in which times are read and written: Europe/Paris; by default the "
    "machine's.",
)


def database_ready() -> None:
    """Refuse a database where its libraries are missing."""
    libraries(("sqlalchemy",), "a database needs", "site")


def _cluster_ready() -> None:
    libraries(("distributed",), "--cluster needs", "cluster")


class WholeNumber(click.ParamType):
    """A whole number that is not less than the least, nor more than the most."""

    name = "whole number"

    def __init__(self, least: int, most: int):
        self.least, self.most = least, most

    def convert(self, value: Any, param: Any, ctx: Any) -> int:
        try:
            number = int(value)
        except ValueError:
            number = self.least - 1
        if not self.least <= number <= self.most:
            too_small = number < self.least
            bound = (
                Message("{least} or more", least=self.least)
                if too_small
                else Message("at most {most:,}", most=self.most)
            )
            message = Message(
                "takes a whole number, {bound}; found {found!r}", bound=bound, found=str(value)[:40]
            )
            self.fail(localised(message), param, ctx)
        return number


class DecimalNumber(click.ParamType):
    """A number with a decimal point or comma: above 0, or from the least to the most."""

    name = "number"

    def __init__(self, least: float = 0, most: float = math.inf):
        self.least, self.most = least, most

    def convert(self, value: Any, param: Any, ctx: Any) -> float:
        number, found = typed_number(str(value)), str(value)[:40]
        is_bounded = self.most < math.inf
        if not (self.least <= number <= self.most if is_bounded else self.least < number < math.inf):
            message = (
                Message(
                    "takes a number from {least:g} to {most:g}; found {found!r}",
                    least=self.least,
                    most=self.most,
                    found=found,
                )
                if is_bounded
                else Message("takes a number above {least:g}; found {found!r}", least=self.least, found=found)
            )
            self.fail(localised(message), param, ctx)
        return number


class FilePath(click.Path):
    """The path of a file or folder: a text that names one."""

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        text = os.fspath(value)
        if not text.strip():
            self.fail(localised(Message("names no file or folder; the current folder is ./")), param, ctx)
        if "\0" in text:
            self.fail(localised(Message("the name of a file contains no NUL")), param, ctx)
        if self.exists and not os.path.exists(text):
            missing = "there is no file {path!r}" if self.file_okay else "there is no folder {path!r}"
            self.fail(localised(Message(missing, path=text)), param, ctx)
        if not self.dir_okay and os.path.isdir(text):
            self.fail(localised(Message("{path!r} is a folder", path=text)), param, ctx)
        if not self.file_okay and os.path.isfile(text):
            self.fail(localised(Message("{path!r} is a file", path=text)), param, ctx)
        return super().convert(value, param, ctx)


PATH = FilePath(path_type=Path)
FILE, FOLDER = FilePath(path_type=Path, dir_okay=False), FilePath(path_type=Path, file_okay=False)
EXISTING_FILE = FilePath(path_type=Path, dir_okay=False, exists=True)
EXISTING_FOLDER = FilePath(path_type=Path, file_okay=False, exists=True)


class Lists(click.ParamType):
    """Comma-separated words, each among those known."""

    name = "list"

    def __init__(self, known: Callable[[], Iterable[str]], refusal: Callable[[str], str] | None = None):
        self.known = known
        #: What is said of an unknown word, where more is to be said than what there is.
        self.refusal = refusal

    def convert(self, value: Any, param: Any, ctx: Any) -> tuple[str, ...]:
        if isinstance(value, tuple):
            return value
        words = tuple(dict.fromkeys(w.strip() for w in value.split(",") if w.strip()))
        accepted = tuple(self.known())
        for word in words:
            if word not in accepted:
                message = (
                    self.refusal(word)
                    if self.refusal
                    else localised(
                        Message("no {word!r}; available: {known}", word=word, known=", ".join(accepted))
                    )
                )
                self.fail(message, param, ctx)
        if not words:
            self.fail(
                localised(Message("nothing named; available: {known}", known=", ".join(accepted))), param, ctx
            )
        return words

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        """Return the last of the words, after those that stand there."""
        from click.shell_completion import CompletionItem

        before, comma, begun = incomplete.rpartition(",")
        there = before.split(",")
        words = [word for word in self.known() if word.startswith(begun) and word not in there]
        return [CompletionItem(before + comma + word) for word in words]


def known_languages() -> tuple[str, ...]:
    from coursework.language.words import languages

    return languages()


def unknown_language(lang: str) -> str:
    from coursework.language.words import no_language

    return str(no_language(lang))


def known_formats() -> tuple[str, ...]:
    from coursework.issuing.formats import FORMATS

    return FORMATS


class Columns(click.ParamType):
    """Columns of a table by what they hold: ``name=3,first=4``, each by its place from 1 on or by its
    title."""

    name = "columns"

    def convert(self, value: Any, param: Any, ctx: Any) -> dict[str, str]:
        from coursework.issuing.roster import COLUMNS

        pairs = (
            value.items()
            if isinstance(value, dict)
            else (p.partition("=")[::2] for p in str(value).split(",") if p.strip())
        )
        columns = {str(key).strip().casefold(): str(which).strip() for key, which in pairs}
        if not columns or not all(columns.values()) or not columns.keys() <= COLUMNS.keys():
            self.fail(
                f"takes pairs such as name=3,first=4, of {', '.join(COLUMNS)}; found {str(value)[:60]!r}",
                param,
                ctx,
            )
        return columns


columns_option = click.option(
    "--columns",
    type=Columns(),
    metavar="WHAT=COLUMN,…",
    help=(
        "Columns of the roster that are not recognised by their titles, by position or title: "
        "name=3,first=4,number=1; also email and lang."
    ),
)
db_option = click.option(
    "--db",
    is_eager=True,
    callback=needing_extra(database_ready),
    metavar="URL",
    help=("A database: sqlite:///marks.db or the name of its file, or postgresql+psycopg://user@host/name."),
)
assignment_option = click.option(
    "--assignment",
    default="",
    metavar="NAME",
    help="Name of the assignment in the database; needed if there are several.",
)
cluster_option = click.option(
    "--cluster",
    is_eager=True,
    callback=needing_extra(_cluster_ready),
    metavar="ADDRESS",
    help=(
        "Share the work with a cluster: tcp://HOST:8786 of a Dask scheduler whose workers have this package, "
        "or local:N for N workers on this machine. A scheduler runs whatever it is sent: use it only on a "
        "network of your own."
    ),
)
json_option = click.option("--json", "as_json", is_flag=True, help="Print JSON.")


def spoken(context: click.Context, parameter: click.Parameter, value: Any) -> Any:
    """Return the given language, or languages; else the environment's where the course speaks
    it, else the course's."""
    from coursework.course.folder import course_folder
    from coursework.language.environment import language_of

    if context.resilient_parsing:
        return value
    folder = course_folder(context.obj)
    for lang in [value] if isinstance(value, str) else value or ():
        folder.check_speaks(lang)
    if value:
        return value
    around = language_of(os.environ)
    lang = around if around in folder.languages else folder.language
    return (lang,) if isinstance(parameter.type, Lists) else lang


LANGUAGE_DEFAULT = "by default that of the environment (LANG) if the course has it, else that of the course"
lang_option = click.option(
    "--lang",
    callback=spoken,
    help=f"Language of the sheet; {LANGUAGE_DEFAULT}.",
    shell_complete=completion.languages,
)
decimal_option = click.option(
    "--decimal",
    type=click.Choice(["point", "comma"]),
    default="point",
    show_default=True,
    help=(
        "Decimal sign of the tables; 'comma' separates cells by semicolons, as a French spreadsheet expects."
    ),
)
exercise_argument = click.argument("exercise", shell_complete=completion.exercises)
exercises_argument = click.argument("exercises", nargs=-1, shell_complete=completion.exercises)
parts_option = click.option(
    "--parts",
    default="",
    metavar="P,P",
    help="Parts to ask: their ids, 'usual' for the default ones, 'all' for every one.",
)
given_option = click.option(
    "--given",
    multiple=True,
    metavar="NAME=VALUE",
    help="State a given value instead of drawing it: r1=228.6mm.",
)
replace_option = click.option(
    "--overwrite", is_flag=True, help="Replace existing notebooks, with all that was written in them."
)
seed_option = click.option(
    "--seed",
    type=WholeNumber(0, MOST_SEED),
    default=0,
    show_default=True,
    help="Seed of the variant, or of the first one.",
)


def is_typed(context: click.Context, option: str) -> bool:
    """Return whether an option was given, and does not merely hold its default."""
    return context.get_parameter_source(option) is click.core.ParameterSource.COMMANDLINE


def writes(context: click.Context, folder: Path) -> None:
    """Lock a folder, so that this command alone writes into it until it ends.

    Raises
    ------
    BadInput
        Another one does already.
    """
    from coursework.system.folder_lock import only_writer

    context.with_resource(only_writer(folder, context.info_name or ""))


def opened(context: click.Context) -> Course:
    from coursework.api import open_course

    return open_course(context.obj)


def shared_by_cluster(context: click.Context, address: str | None) -> None:
    """From here to the end of the command, large jobs are shared by the cluster that is named, if one is."""
    if address is None:
        return
    from coursework.course.course_transfer import Carried
    from coursework.system.cluster import cluster

    context.with_resource(cluster(address, Carried(opened(context).folder)))


def exercise_names(course: Course, names: Sequence[str]) -> tuple[str, ...]:
    for name in names:
        course[name]  # an unknown name stops here, with the nearest one
    if not course.names:
        raise BadInput(
            "the course {root} has no exercise; 'coursework new {root} NAME' writes one",
            root=course.folder.root,
        )
    return tuple(dict.fromkeys(names)) or course.names


def settings_given(settings: Sequence[str], option: str = "--set") -> dict[str, str]:
    """Return the given values of ``--set NAME=VALUE`` or ``--given NAME=VALUE``, as texts."""
    given: dict[str, str] = {}
    for setting in settings:
        name, equals, value = setting.partition("=")
        if not equals or not value.strip():
            raise WrongValue("{option} takes NAME=VALUE; found {found!r}", option=option, found=setting)
        given[name.strip()] = value.strip()
    return given


def split_list(text: str) -> tuple[str, ...]:
    return tuple(w.strip() for w in text.split(",") if w.strip())
