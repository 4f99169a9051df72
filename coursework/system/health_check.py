"""Question to a site whether it is well: ``python -m coursework.system.health_check URL [SECONDS]``, with
status 0 if it is."""

from __future__ import annotations

import sys
import time
from urllib.request import ProxyHandler, build_opener


def check(url: str, seconds: float = 0.0) -> int:
    """Ask a site, for ``seconds`` until it answers well; return an exit status."""
    ask, end = build_opener(ProxyHandler({})).open, time.monotonic() + seconds
    while True:
        try:
            with ask(f"{url.rstrip('/')}/health", timeout=5):
                return 0
        except OSError:  # of which those of HTTP are some
            if time.monotonic() >= end:
                return 1
            time.sleep(0.5)


if __name__ == "__main__":
    sys.exit(check(sys.argv[1], *map(float, sys.argv[2:3])))
