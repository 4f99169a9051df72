"""Pool of variants for practice: seeds found in advance. Issued variants are excluded from practice."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from sqlalchemy import Connection, select

from coursework.database.settings import put_value, value_of
from coursework.database.tables import setting, variant


class Pooled(NamedTuple):
    """Seeds of an exercise that were found so far."""

    seeds: tuple[int, ...] = ()
    are_all: bool = False  #: no more were found


def pooled(connection: Connection, exercise: str, version: int) -> Pooled:
    """Return the seeds found for a version of an exercise; none if nobody has searched."""
    pool = value_of(connection, _name(exercise, version))
    return _of_value(pool) if pool else Pooled()


def pools(connection: Connection, versions: Mapping[str, int]) -> dict[str, Pooled]:
    """Return the seeds found for exercises in their versions; exercises without a search are omitted."""
    names = {_name(exercise, version): exercise for exercise, version in versions.items()}
    rows = connection.execute(select(setting.c.name, setting.c.value).where(setting.c.name.in_(names)))
    return {names[row.name]: _of_value(json.loads(row.value)) for row in rows}


def _of_value(pool: Mapping[str, Any]) -> Pooled:
    return Pooled(tuple(pool["seeds"]), bool(pool["all"]))


def put_pooled(connection: Connection, exercise: str, version: int, seeds: Pooled) -> None:
    """Store the seeds found, in place of the earlier ones."""
    put_value(connection, _name(exercise, version), {"seeds": list(seeds.seeds), "all": seeds.are_all})


def issued_seeds(connection: Connection, exercise: str) -> frozenset[str]:
    """Return the seeds of an exercise in any assignment, as texts."""
    return frozenset(
        connection.execute(select(variant.c.seed).where(variant.c.exercise == exercise)).scalars()
    )


def issued_given(connection: Connection, exercise: str) -> Sequence[Mapping[str, Any]]:
    """Return the given values of an exercise in any assignment, as its records state them."""
    rows = connection.execute(select(variant.c.record).where(variant.c.exercise == exercise)).scalars()
    return [record["given"] for record in rows]


def _name(exercise: str, version: int) -> str:
    return f"pool {exercise}"[:90] + f" v{version}"
