"""Command line: reads arguments, runs a command, reports its faults in a line."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence

import click

from coursework.cli.commands import commands, named_command
from coursework.cli.options import BAD, DONE, complain
from coursework.cli.printing import problem_of
from coursework.errors import CourseworkError, reason_of
from coursework.language.environment import language_of
from coursework.messages import Message, localised, messages_in, translations
from coursework.system.ending import Ended, end_cleanly, has_ended, leave
from coursework.system.visible import visible_streams


def main() -> None:
    """Run the command line; a user's mistake is one line on standard error, never a traceback."""
    # Matrices here are small: threads of the linear algebra would only wait, and use a processor for it.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    end_cleanly()
    leave(run(sys.argv[1:]))


def run(arguments: Sequence[str]) -> int:
    """Run one command and give its exit status."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(encoding="utf-8", errors="replace")
    lang = language_of(os.environ)
    with visible_streams(), messages_in(lang if translations(lang) else "en"):
        return _run(arguments)


def _run(arguments: Sequence[str]) -> int:
    try:
        return commands.main(list(arguments), prog_name="coursework", standalone_mode=False) or DONE
    except click.exceptions.NoArgsIsHelpError as fault:
        click.echo(fault.format_message(), err=True)
        return BAD
    except click.ClickException as fault:
        if not isinstance(fault, click.UsageError):
            return complain(fault.format_message())
        command = f"coursework {named_command(arguments)}--help"
        return complain(
            localised(Message("{problem}; see '{command}'", problem=problem_of(fault), command=command))
        )
    except click.exceptions.Exit as stop:
        return stop.exit_code
    except Ended as end:
        has_ended()
        complain(str(end))
        return int(str(end.code))
    except click.Abort:
        return complain(localised(Message("interrupted")))
    except CourseworkError as fault:
        return complain(str(fault))
    except BrokenPipeError:
        sys.stderr.close()
        return DONE
    except OSError as fault:
        file = fault.filename or Message("a file")
        return complain(localised(Message("{file}: {problem}", file=file, problem=reason_of(fault))))
