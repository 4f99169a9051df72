"""The commands by name. What a command needs is loaded when it is called."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import click

from coursework.cli.help_pages import HelpfulGroup
from coursework.cli.options import FilePath, zone_option
from coursework.errors import unknown
from coursework.system.cache import cached_result
from coursework.system.distribution import VERSION

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

#: By name, the file of this room that holds the command, and what it is called there.
COMMANDS = {
    "accuracy": ("measure", "accuracy"),
    "after": ("after", "after"),
    "animate": ("move", "animate"),
    "build": ("make", "build"),
    "check": ("author", "check"),
    "database": ("database", "database"),
    "demo": ("make", "demo"),
    "export": ("platforms", "export"),
    "grade": ("mark", "grade"),
    "gradebook": ("gradebooks", "gradebook"),
    "lesson": ("teach", "lesson"),
    "list": ("look", "list_exercises"),
    "lti": ("lti", "lti"),
    "mechanism": ("author", "mechanism"),
    "new": ("author", "new"),
    "notebook": ("teach", "notebook"),
    "preview": ("site", "preview"),
    "progress": ("study", "progress"),
    "report": ("mark", "report"),
    "scan": ("scan", "scan"),
    "semester": ("semester", "semester"),
    "serve": ("site", "serve"),
    "show": ("look", "show"),
    "simulate": ("move", "simulate"),
    "solve": ("look", "solve"),
    "variant": ("look", "variant"),
    "workbook": ("teach", "workbook"),
}


class _Commands(HelpfulGroup):
    """A group that loads a command when it is asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return sorted(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        file, function = COMMANDS[cmd_name]
        self.add_command(getattr(import_module(f"coursework.cli.{file}"), function), cmd_name)
        return super().get_command(ctx, cmd_name)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Return the named command, as :mod:`click` does; refuse another name and offer the nearest one."""
        if args and args[0] not in COMMANDS and not args[0].startswith("-") and not ctx.resilient_parsing:
            ctx.fail(str(unknown("command", args[0], COMMANDS)))
        return super().resolve_command(ctx, args)

    def summaries(self, ctx: click.Context) -> Mapping[str, str]:
        """Return the help of each command by its name; their files are loaded where one has changed."""
        files = sorted(Path(__file__).parent.glob("*.py"))
        found: dict[str, str] = cached_result(
            files, "commands.json", lambda: dict(super(_Commands, self).summaries(ctx))
        )
        return found

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        """Return the commands by their names, which need not be loaded, and the options of them all."""
        from click.shell_completion import CompletionItem

        names = [CompletionItem(name) for name in self.list_commands(ctx) if name.startswith(incomplete)]
        return names + click.Command.shell_complete(self, ctx, incomplete)


@click.group(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.option("--course", "folder", type=FilePath(), help="Course folder; by default the built-in course.")
@zone_option
@click.version_option(VERSION, prog_name="coursework")
@click.pass_context
def commands(context: click.Context, folder: str | None) -> None:
    """Parameterised exercises in plane-mechanism kinematics: draw, solve, print and mark them."""
    context.obj = folder


def named_command(arguments: Sequence[str]) -> str:
    """Return the command that some arguments name, and a space; nothing where they name none."""
    named = [a for a in arguments if a in COMMANDS]
    return f"{named[0]} " if named else ""
