"""Times as text and from text, in the time zone of the server, which the pages name."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

from markupsafe import Markup

from coursework.issuing.papers import date_text
from coursework.language.words import words
from coursework.messages import number_form

_FORM = "%Y-%m-%dT%H:%M"  #: format of a form field


def moment_text(at: datetime, lang: str) -> str:
    """Return a time such as ``4 décembre 2026, 14 h 05``; with seconds if they are not zero."""
    here = at.astimezone()
    texts = words(lang, "site")["moments"]
    form = texts["time_seconds"] if here.second or here.microsecond else texts["time"]
    return str(texts["moment"]).format(date_text(here.date(), lang), _time(here, str(form)))


def exact_text(at: datetime, lang: str) -> str:
    """Return a time with its seconds."""
    here, texts = at.astimezone(), words(lang, "site")["moments"]
    return str(texts["moment"]).format(date_text(here.date(), lang), _time(here, str(texts["time_seconds"])))


def _time(here: datetime, form: str) -> str:
    return form.format(hour=here.hour, minute=f"{here.minute:02}", second=f"{here.second:02}")


def time_element(at: datetime, lang: str, *, exact: bool = False) -> Markup:
    """Return a time as an element of a page; a script writes it in the reader's time zone, and names that.

    Parameters
    ----------
    exact
        With its seconds.
    """
    text = f"{exact_text(at, lang)} ({zone_name(at)})" if exact else moment_text(at, lang)
    stated = at.astimezone(UTC).isoformat(timespec="seconds")
    return Markup('<time datetime="{}" data-zone="{}"{}>{}</time>').format(
        stated, zone_name(at), Markup(" data-exact") if exact else "", text
    )


def zone_name(at: datetime) -> str:
    """Return the time zone of displayed times."""
    return at.astimezone().tzname() or "UTC"


def length_text(length: timedelta, lang: str) -> str:
    """Return a duration in its two greatest units, ``3 days 4 hours``; less than a minute in seconds."""
    texts = words(lang, "site")["moments"]
    seconds = max(0, int(length.total_seconds()))
    units = (("day", 86400), ("hour", 3600), ("minute", 60))
    counts = []
    for name, size in units:
        counts.append((name, seconds // size))
        seconds %= size
    largest = [(name, count) for name, count in counts if count][:2]
    if not largest:
        largest = [("second", seconds)]
    return " ".join(str(texts[name][number_form(count, lang)]).format(count) for name, count in largest)


def field_text(at: datetime | None) -> str:
    """Return a time in the format of a form field."""
    return "" if at is None else at.astimezone().strftime(_FORM)


def from_field(text: str) -> datetime | None:
    """Return the time in a form field; None if it is empty.

    Raises
    ------
    ValueError
        The text is not a time.
    """
    if not text.strip():
        return None
    moment = datetime.fromisoformat(text.strip())
    if not 2000 <= moment.year <= 2200:
        raise ValueError(f"no year for a course: {moment.year}")
    return moment.astimezone(UTC)
