"""Log lines in which foreign text cannot control a terminal."""

from __future__ import annotations

import logging
import time

from coursework.system.visible import one_line, visible


class VisibleLines(logging.Formatter):
    """Formatter of log lines, one per message, with control characters made visible; times are UTC."""

    converter = staticmethod(time.gmtime)
    default_time_format = "%Y-%m-%dT%H:%M:%S"
    default_msec_format = "%s.%03dZ"

    def formatMessage(self, record: logging.LogRecord) -> str:
        return one_line(super().formatMessage(record))

    def format(self, record: logging.LogRecord) -> str:
        return visible(super().format(record))
