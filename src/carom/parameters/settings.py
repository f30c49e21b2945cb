"""What a setting, or an axis of a sweep, may change: the numbers of a machine, and entries of the other tables of its file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from carom.base.arguments import checked
from carom.base.outcome import Problems
from carom.parameters.fields import Field, unknown_name, unknown_names
from carom.parameters.tables import GRAVITY_FIELDS
from carom.parameters.terms import SETTABLE, check_names
from carom.parameters.touchdown_bearing import PREFIX, TOUCHDOWN_FIELDS

GRAVITY_NAME = "gravity"
"""Name of the acceleration of ``[gravity]`` where it stands beside the entries of the machine."""
OF_TABLES: Mapping[str, Field] = {
    GRAVITY_NAME: replace(GRAVITY_FIELDS["acceleration"], name=GRAVITY_NAME),
    **{PREFIX + name: replace(field, name=PREFIX + name) for name, field in TOUCHDOWN_FIELDS.items()},
}
"""Entries of the tables ``[gravity]`` and ``[touchdown]``, by the names that they have beside those of the machine."""
SETTINGS: Mapping[str, Field] = {**SETTABLE, **OF_TABLES}
"""Everything that a setting, or an axis of a sweep, may change."""


@checked
def field_to_set(name: str) -> Field:
    """Field of anything that a setting, or an axis of a sweep, may change."""
    if name not in SETTINGS:
        raise unknown_name(name, "to vary", SETTINGS, "the parameters")
    return SETTINGS[name]


def check_settings(changes: Iterable[str] | Mapping[str, Any]) -> None:
    """Check that names can be set, and that no two set the same thing; with a mapping the errors show the values."""
    values = changes if isinstance(changes, Mapping) else dict.fromkeys(changes)
    problems = Problems()
    problems.errors += unknown_names(values, SETTINGS, "a machine or its parameters")
    problems.attempt(check_names, {name: value for name, value in values.items() if name in SETTABLE})
    problems.raise_all()
