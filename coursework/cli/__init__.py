"""The command line: reads arguments, calls what does the work, says what became of it."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import click

from coursework.cli.make import build_files
from coursework.cli.mark import grade_with_bar
from coursework.cli.options import BAD, DONE, cli, complain, named_command
from coursework.cli.printing import print_table
from coursework.errors import CourseworkError


def main() -> None:
    """Run the command line; a user's mistake is one line on standard error, never a traceback."""
    sys.exit(run(sys.argv[1:]))


def run(arguments: Sequence[str]) -> int:
    """Run one command and give its exit status."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(encoding="utf-8", errors="replace")
    try:
        return cli.main(list(arguments), prog_name="coursework", standalone_mode=False) or DONE
    except click.exceptions.NoArgsIsHelpError as fault:
        click.echo(fault.format_message(), err=True)
        return BAD
    except click.ClickException as fault:
        hint = (
            f"; see 'coursework {named_command(arguments)}--help'" if isinstance(fault, click.UsageError) else ""
        )
        return complain(fault.format_message().rstrip(".") + hint)
    except click.exceptions.Exit as stop:
        return stop.exit_code
    except click.Abort:
        return complain("interrupted")
    except CourseworkError as fault:
        return complain(str(fault))
    except BrokenPipeError:
        sys.stderr.close()
        return DONE
    except OSError as fault:
        return complain(f"{fault.filename or 'a file'}: {fault.strerror or fault}")


# ------------------------------------------------------------------------- demo


@cli.command()
@click.option("--out", type=click.Path(path_type=Path, file_okay=False), default="demo", show_default=True)
def demo(out: Path) -> None:
    """Do the whole job on a small class: sheets, answers of all kinds, marks."""
    from coursework.cli.demo import class_of_twelve

    rows, report = class_of_twelve(out, build_files, grade_with_bar)
    print_table(rows, title="What became of the answers")
    for line in report:
        click.echo(line)
