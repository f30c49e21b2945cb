"""Columns: a value that people see is declared once, where it is made, with its key in JSON, its heading and its text."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from operator import attrgetter
from typing import NamedTuple


class Column(NamedTuple):
    """A value of each entry of a result.

    Attributes
    ----------
    key : str
        Its key in JSON as :func:`carom.base.results.record` reads it: ``"branch=name"``, ``"period:"``; empty if it is not there.
    heading : str
        What heads it in tables; empty if it is in none.  Braces stand for attributes of the result: ``"{0.parameter}"``.
    text : callable, optional
        What stands in its cells, from the entry and the result; by default the attribute.
    """

    key: str
    heading: str = ""
    text: Callable[..., str] | None = None


def keys_of(columns: Iterable[Column]) -> str:
    """The declaration of the keys in JSON, for :func:`carom.base.results.record`."""
    return " ".join(column.key for column in columns if column.key)


def table_of(columns: Iterable[Column], entries: Iterable[object], result: object) -> tuple[list[str], list[list[str]]]:
    """Headings, and a row of texts for each entry of a result."""
    shown = [column for column in columns if column.heading]
    headings = [column.heading.format(result) for column in shown]
    return headings, [[_text(column, entry, result) for column in shown] for entry in entries]


def _text(column: Column, entry: object, result: object) -> str:
    if column.text is not None:
        return column.text(entry, result)
    return str(attrgetter(column.key.partition(":")[0].rpartition("=")[2])(entry))
