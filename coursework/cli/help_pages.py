"""Help of the commands in the language of messages. What is not in the catalogue stays English."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

import click

from coursework.messages import language_of_messages, translations

_PARAGRAPHS = re.compile(r"\n\s*\n")
_EXTRA = re.compile(r"(?P<text>.*?)(?P<extra>(?:^|  )\[[^\[\]]*\])?", re.DOTALL)  #: … [default: 0]
_PLACEHOLDER = re.compile(r"(?<![-\w%])(?:FLOAT RANGE|WHOLE NUMBER|[A-Z][A-Z]+)(?!\w)")
_WORD = re.compile(r"default:|required")


def paragraphs(text: str) -> list[str]:
    """Return the paragraphs of a help text, each on one line, as the catalogue has them."""
    return [" ".join(paragraph.split()) for paragraph in _PARAGRAPHS.split(text) if paragraph.strip()]


def translated(text: str) -> str:
    """Return a help text in the language of messages, paragraph by paragraph."""
    known = translations(language_of_messages())
    return "\n\n".join(known.get(one, one) for one in paragraphs(text)) if known else text


def placeholders_translated(text: str) -> str:
    """Return a text with its placeholders, such as FILE, in the language of messages."""
    return _by_words(text, _PLACEHOLDER, translations(language_of_messages()))


def _by_words(text: str, words: re.Pattern[str], known: Mapping[str, str]) -> str:
    return words.sub(lambda match: known.get(match[0], match[0]), text)


class _Formatter(click.HelpFormatter):
    """Layout of a help page, whose texts are translated as they come."""

    def write_usage(self, prog: str, args: str = "", prefix: str | None = None) -> None:
        known = translations(language_of_messages())
        super().write_usage(prog, placeholders_translated(args), known.get("Usage: ", prefix))

    def write_heading(self, heading: str) -> None:
        known = translations(language_of_messages())
        mark = known.get("Usage: ", "Usage: ").removeprefix("Usage").rstrip()
        self.write(f"{'':>{self.current_indent}}{known.get(heading, heading)}{mark}\n")

    def write_text(self, text: str) -> None:
        super().write_text(translated(text))

    def write_dl(self, rows: Iterable[tuple[str, str]], col_max: int = 30, col_spacing: int = 2) -> None:
        known = translations(language_of_messages())
        shown = []
        for first, second in rows:
            match = _EXTRA.fullmatch(second)
            text, extra = (match["text"], match["extra"] or "") if match else (second, "")
            shown.append((placeholders_translated(first), translated(text) + _by_words(extra, _WORD, known)))
        super().write_dl(shown, col_max, col_spacing)


class _Context(click.Context):
    """Context whose help pages are in the language of messages."""

    formatter_class = _Formatter


class HelpfulGroup(click.Group):
    """Group whose help, and that of its commands, is in the language of messages."""

    context_class = _Context

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return a command by its name."""
        command = super().get_command(ctx, cmd_name)
        if command is not None:
            command.context_class = _Context
        return command

    def summaries(self, ctx: click.Context) -> Mapping[str, str]:
        """Return the help of each command by its name."""
        named = {name: self.get_command(ctx, name) for name in self.list_commands(ctx)}
        return {name: command.help or "" for name, command in named.items() if command}

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the commands with what each does."""
        summaries = self.summaries(ctx)
        limit = formatter.width - 6 - max(map(len, summaries))
        with formatter.section("Commands"):
            formatter.write_dl(
                [
                    (name, click.Command(name, help=translated(text)).get_short_help_str(limit))
                    for name, text in sorted(summaries.items())
                ]
            )
