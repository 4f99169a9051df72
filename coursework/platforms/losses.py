"""Losses of a platform: the features of our marking that it lacks, and its behaviour instead.

The table is in ``[platforms.lost.NAME]`` of each language; a feature without an entry is supported.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from coursework.errors import BadCourse
from coursework.language.words import words
from coursework.platforms.items import Item, Loss, Pool
from coursework.platforms.posed import COLLECTED

COLUMNS = ("exercise", "part", "feature", "instead")
#: Features of a question that stand behind another: a question that is collected is judged by nobody on the
#: platform.
_OF_JUDGED = (
    "comma",
    "unit_written",
    "unit_refused",
    "turns",
    "unreadable",
    "mistakes",
    "usual_errors",
    "partial",
    "counted_once",
)
#: Features of every pool: one variant per student with all of its questions; marks of a second attempt.
_OF_POOLS = ("one_variant", "corrected")


def loss_row(loss: Loss, lang: str) -> dict[str, str]:
    """Return the row of a loss in ``lost.csv``."""
    return {**loss._asdict(), "feature": feature_words(loss.feature, lang)}


def feature_words(feature: str, lang: str) -> str:
    """Return the name of a feature."""
    features = words(lang)["platforms"]["features"]
    if feature not in features:
        raise BadCourse(
            "no words for the feature {feature!r}; available: {names}",
            feature=feature,
            names=", ".join(features),
        )
    return str(features[feature])


def lost_words(platform: str, lang: str) -> Mapping[str, str]:
    """Return a platform's behaviour by feature; a platform may refer to another's."""
    texts: Mapping[str, str] | str = platform_words("lost", platform, lang)
    return platform_words("lost", texts, lang) if isinstance(texts, str) else texts


def platform_words(section: str, platform: str, lang: str) -> Any:
    """Return the words of a platform, of ``lost`` or ``steps``.

    Raises
    ------
    BadCourse
        There are none in this language.
    """
    table = words(lang)["platforms"][section]
    if platform not in table:
        raise BadCourse(
            "the platform {platform!r} has no words: language/{lang}.toml lacks "
            "platforms.{section}.{platform}; available: {names}",
            platform=platform,
            lang=lang,
            section=section,
            names=", ".join(table),
        )
    return table[platform]


def losses(pool: Pool, platform: str, more: Iterable[Loss] = ()) -> list[Loss]:
    """Return all losses of a pool, one per part and feature; ``more`` are those that the platform itself
    finds."""
    lost = lost_words(platform, pool.lang)
    by_feature = {
        (exercise, part, feature): Loss(exercise, part, feature, str(lost[feature]))
        for exercise, part, feature in _features(pool)
        if feature in lost
    }
    by_feature |= {(loss.exercise, loss.part, loss.feature): loss for loss in more}
    return list(by_feature.values())


def _features(pool: Pool) -> Iterator[tuple[str, str, str]]:
    for section in pool.sections:
        for feature in _OF_POOLS:
            yield section.exercise, "", feature
        found = dict.fromkeys(feature for item in section.items for feature in item.features)
        for part, feature in sorted(found, key=lambda feature: bool(feature[0])):
            yield section.exercise, part, feature


def features_of(item: Item) -> Iterator[tuple[str, str]]:
    """Yield the features of our marking of a variant, each with its part."""
    if item.handout.drawing_mm:
        yield "", "drawing_paper"
    for posed in item.questions:
        for feature in sorted(posed.features):
            if posed.kind != COLLECTED or feature not in _OF_JUDGED:
                yield posed.question.id, feature


def loss_lines(lost: Sequence[Loss], lang: str) -> Iterator[str]:
    """Yield one line per feature: the number of parts and exercises concerned, and the behaviour instead."""
    by_feature: dict[tuple[str, str], list[Loss]] = {}
    for loss in lost:
        by_feature.setdefault((loss.feature, loss.instead), []).append(loss)
    texts = words(lang)["platforms"]
    for (feature, instead), some in by_feature.items():
        exercises, parts = (
            {lost_part.exercise for lost_part in some},
            [lost_part for lost_part in some if lost_part.part],
        )
        where = texts["where_parts" if parts else "where"].format(parts=len(parts), exercises=len(exercises))
        yield texts["line"].format(feature=feature_words(feature, lang), where=where, instead=instead)
