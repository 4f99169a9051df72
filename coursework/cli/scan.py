"""The command that reads paper back: scan."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from coursework.cli.options import (
    DONE,
    FILE,
    FOLDER,
    FOUND,
    PATH,
    DecimalNumber,
    NeedingExtra,
    decimal_option,
    opened,
    writes,
)
from coursework.cli.printing import by_reason, progress_bar, say, warn, warn_some
from coursework.errors import BadInput, counted
from coursework.messages import Message, localised
from coursework.system.extras import libraries

if TYPE_CHECKING:
    from coursework.scanning.scan import ScanBook


def _ready() -> None:
    from coursework.scanning.pictures import opencv

    opencv()
    libraries(("pypdfium2", "zxingcpp"), "reading scans needs", "scan")


@click.command(cls=NeedingExtra, ready=_ready)
@click.argument("scans", nargs=-1, type=PATH)
@click.option(
    "--issued", required=True, type=FILE, help="The issued.json of the build that printed the answer pages."
)
@click.option(
    "--out", type=FOLDER, help="Folder to write, or to continue with; by default read/ beside issued.json."
)
@click.option(
    "--typed",
    multiple=True,
    type=FILE,
    help="Readings typed on the page of the queue; by default typed.csv in the folder.",
)
@click.option(
    "--sure",
    type=DecimalNumber(0.9, 1.0),
    default=0.99,
    show_default=True,
    help=(
        "Confidence below which a box is left to a person. For black-and-white scans the doubt counts "
        "tenfold."
    ),
)
@decimal_option
@click.option(
    "--open",
    "opens",
    is_flag=True,
    help="Open the page of the queue in the browser, and take what is typed there, until Ctrl-C.",
)
@click.pass_context
def scan(
    context: click.Context,
    scans: Sequence[Path],
    issued: Path,
    out: Path | None,
    typed: Sequence[Path],
    sure: float,
    decimal: str,
    opens: bool,
) -> int:
    """Read scans of answer pages: PDFs, pictures, and zips or folders of them, in any order.

    The readings are in answers.csv, for 'coursework grade'; doubtful ones wait on the page queue/index.html;
    pages that do not belong to this paper are listed in rejected.csv. A second run with more scans adds to
    what is there.
    """
    if issued.is_dir():
        raise BadInput(
            "--issued takes a file, and {issued} is a folder: name the issued.json of the build",
            issued=issued,
        )
    from coursework.scanning import scan as scanning
    from coursework.system.tables import SPREADSHEETS

    out = out or issued.parent / "read"
    writes(context, out)
    with progress_bar("reading", None) as advance:
        book = scanning.scan(
            opened(context),
            scans,
            issued,
            out,
            typed=typed,
            least=sure,
            spreadsheet=SPREADSHEETS[decimal],
            progress=advance,
        )
    status = _print_scan_book(book, out)
    return (
        _typed_in_browser(opened(context), issued, out, sure, decimal) if opens and book.waiting else status
    )


def _typed_in_browser(course: Any, issued: Path, out: Path, sure: float, decimal: str) -> int:
    """Serve the page of the queue until Ctrl-C, or until nothing waits; give the status of what was typed
    last."""
    import tempfile
    import webbrowser
    from threading import Thread

    from coursework.scanning import scan as scanning
    from coursework.scanning.queue_server import QueueServer
    from coursework.system.tables import SPREADSHEETS

    status = FOUND

    def take(data: bytes) -> None:
        nonlocal status
        with tempfile.TemporaryDirectory(prefix="coursework-") as folder:
            path = Path(folder, "typed.csv")
            path.write_bytes(data)
            book = scanning.scan(
                course, (), issued, out, typed=[path], least=sure, spreadsheet=SPREADSHEETS[decimal]
            )
        status = _print_scan_book(book, out)
        if not book.waiting:
            Thread(target=server.shutdown, daemon=True).start()

    with QueueServer(out, take) as server:
        say("type at {url}; Ctrl-C ends it", url=server.url)
        webbrowser.open(server.url)
        try:
            server.serve_forever()
        except KeyboardInterrupt:
            return status
    return status


def _print_scan_book(book: ScanBook, out: Path) -> int:
    """Say what a folder of scans holds."""
    counts = [
        Message("{count} of statements", count=book.statements) if book.statements else "",
        Message("{count} blank", count=book.blank) if book.blank else "",
        Message("{count} copied", count=book.copies) if book.copies else "",
    ]
    say(
        "{pages}: {answers}; see {file}",
        pages=", ".join(localised(one) for one in (counted(book.pages, "page"), *counts) if one),
        answers=counted(book.answers, "answer"),
        file=out / "answers.csv",
    )
    if book.waiting:
        say(
            "{count} place{count:|s} wait{count:s|} for a person: open {page}",
            count=book.waiting,
            page=out / "queue" / "index.html",
        )
    if book.absent:
        say(
            "{papers} not scanned; see {file}", papers=counted(book.absent, "paper"), file=out / "missing.csv"
        )
    if book.unused:
        warn("note: {lines} of typed.csv match no scanned page", lines=counted(book.unused, "line"))
    warn_some([Message("{owner} missing", owner=owner) for owner in book.missing], out / "missing.csv")
    warn_some(by_reason(book.rejected), out / "rejected.csv")
    return FOUND if book.needs_a_look else DONE
