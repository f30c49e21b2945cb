"""What a setting, or an axis of a sweep, may change: the numbers of a machine, and entries of the other tables of its file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from carom.base.arguments import checked
from carom.parameters.fields import Field, unknown_name
from carom.parameters.tables import GRAVITY_FIELDS
from carom.parameters.terms import SETTABLE
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
        raise unknown_name(name, None, SETTINGS, "the parameters")
    return SETTINGS[name]
