"""Limits of size: of input from outside, and of one command.

A class of a hundred thousand stays far below. Split larger input.
"""

from __future__ import annotations

from coursework.errors import BadInput
from coursework.messages import Message

# ----------------------------------------------------------------------------- read
MOST_BYTES = 1_000_000_000  #: of one file of answers, as CSV, JSON or XML
MOST_NOTEBOOK_BYTES = 50_000_000  #: of one notebook, its pictures with it
MOST_TABLE_BYTES = 200_000_000  #: of a roster, of accepted answers, of typed answers of a scan
MOST_ROWS = 2_000_000  #: of one file of answers
MOST_COLUMNS = 5_000  #: of one table
MOST_CELL = 100_000  #: characters of one answer in a Parquet file
MOST_PAGES = 5_000  #: of one file of a scan
MOST_PAGES_OF_TIFF = 500  #: of one TIFF; the reader starts at the first page for each page
LEAST_OF_PAGE = 500  #: bytes per page of a scan's file with more than a few pages
MOST_UNPACKED = 500_000_000  #: bytes of a Parquet file, unpacked

# -------------------------------------------------------------------------- commands
MOST_VARIANTS = 1_000_000  #: of one command
MOST_STEPS = 1_000_000  #: of a cycle
MOST_SEED = 10**18 - 1
MOST_PORT = 65_535
MOST_WORKERS = 256


def beyond(subject: str, count: int, most: int, unit: str) -> Message:
    """Return the message for too much: ``a file of 7,000,000 rows is not read; the limit is 2,000,000: part
    it into several``."""
    template = "{subject} of {count:,} {unit} is not read; the limit is {most:,}: split it into several"
    return Message(template, subject=Message(subject), count=count, unit=Message(unit), most=most)


def check_size(subject: str, size: int, most: int) -> None:
    """Raise if a file exceeds its limit.

    Raises
    ------
    BadInput
        It says the size and the limit.
    """
    if size > most:
        raise BadInput("{subject}: {problem}", subject=subject, problem=beyond("a file", size, most, "bytes"))
