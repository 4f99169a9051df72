"""Run migrations on the given connection."""

from __future__ import annotations

from typing import Any, Literal

from alembic import context
from sqlalchemy import JSON

from coursework.database.tables import METADATA, SafeText, UTCDateTime


def _printed(kind: str, item: Any, autogenerate: Any) -> str | Literal[False]:
    """Return the name of a column's type, for a migration generated from the tables."""
    name = "Json" if isinstance(item, JSON) else type(item).__name__
    if kind != "type" or not isinstance(item, (JSON, UTCDateTime, SafeText)):
        return False
    autogenerate.imports.add(f"from coursework.database.tables import {name}")
    return "Json" if name == "Json" else f"{name}()"


context.configure(
    connection=context.config.attributes["connection"],
    target_metadata=METADATA,
    render_as_batch=True,
    render_item=_printed,
)
with context.begin_transaction():
    context.run_migrations()
