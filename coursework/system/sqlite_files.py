"""SQLite files without remains of deleted rows: in free pages, in gaps of pages, and in the write-ahead
log."""

from __future__ import annotations

import sqlite3
import time
from contextlib import closing
from pathlib import Path

_TURN = 0.5  #: seconds for which one attempt waits; meanwhile nobody else can write
_PAUSE = 0.1


def scrub(path: Path, patience: float = 5.0) -> bool:
    """Rewrite a database without deleted content, and truncate its write-ahead log.

    Other processes may have it open. One that reads an older state, or writes, keeps the log from being cut;
    it is waited for.

    Parameters
    ----------
    path
        Database file; it may be missing.
    patience
        Seconds to try.

    Returns
    -------
    bool
        True if no deleted content is left in the files; False if another process or a full disk prevented it.
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
