"""Lines of a log, in which texts of strangers act on no terminal."""

from __future__ import annotations

import logging
import time

from coursework.system.visible import one_line, visible


class VisibleLines(logging.Formatter):
    """Lines of a log, one a message, whatever its words hold; times are UTC."""

    converter = staticmethod(time.gmtime)
    default_time_format = "%Y-%m-%dT%H:%M:%S"
    default_msec_format = "%s.%03dZ"

    def formatMessage(self, record: logging.LogRecord) -> str:
        return one_line(super().formatMessage(record))

    def format(self, record: logging.LogRecord) -> str:
        return visible(super().format(record))
