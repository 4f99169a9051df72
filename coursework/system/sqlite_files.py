"""Files of SQLite without what was deleted: in free pages, in gaps of pages, and in the write-ahead log."""

from __future__ import annotations

import sqlite3
import time
from contextlib import closing
from pathlib import Path

_TURN = 0.5  #: seconds for which one try waits: while it does, nobody else writes
_PAUSE = 0.1


def scrub(path: Path, patience: float = 5.0) -> bool:
    """Rewrite a file without what was deleted, and cut its write-ahead log to nothing.

    Other processes may have it open. One that reads an older state, or writes, keeps the log from being cut; it is waited for.

    Parameters
    ----------
    path
        Of the database; one that is not there needs nothing.
    patience
        Seconds to try.

    Returns
    -------
    bool
        True when nothing deleted is left in its files; False where another process, or a full disk, kept some of it.
    """
    if not path.exists():
        return True
    until = time.monotonic() + patience
    with closing(sqlite3.connect(path, timeout=_TURN, isolation_level=None)) as file:
        is_rewritten = False
        while True:
            try:
                if not is_rewritten:
                    file.execute("PRAGMA secure_delete = ON")
                    file.execute("VACUUM")
                    is_rewritten = True
                is_busy = bool(file.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()[0])
            except sqlite3.Error:
                is_busy = True
            if not is_busy:
                return True
            if time.monotonic() > until:
                return False
            time.sleep(_PAUSE)
