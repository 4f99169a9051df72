"""Shell completion of exercises, languages and formats; of a course it reads only the names of its folder's
files."""

from __future__ import annotations

from contextlib import suppress

import click

from coursework.errors import CourseworkError


def exercises(context: click.Context, parameter: click.Parameter, begun: str) -> list[str]:
    """Return the exercises whose names begin so; none where there is no course."""
    from coursework.course.folder import course_folder

    with suppress(CourseworkError):
        return [
            name
            for name in course_folder(context.find_root().params.get("folder")).names
            if name.startswith(begun)
        ]
    return []


def languages(context: click.Context, parameter: click.Parameter, begun: str) -> list[str]:
    """Return the languages that the course speaks; none where there is no course."""
    from coursework.course.folder import course_folder

    with suppress(CourseworkError):
        spoken = course_folder(context.find_root().params.get("folder")).languages
        return [lang for lang in sorted(spoken) if lang.startswith(begun)]
    return []
