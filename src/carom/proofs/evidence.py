"""Evidence: what a search has found, written down so that a check need not search."""

from __future__ import annotations

import math
import re
import time
from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any, TypeVar

from carom.base.outcome import CaromError
from carom.base.progress import Reporter

_Found = TypeVar("_Found")
_RATIONAL = re.compile(r"-?[0-9]{1,2000}(?:/[0-9]{1,2000})?")


class NotShownError(CaromError):
    """The evidence does not show what it should: a certificate that was changed, or is not complete."""


class Evidence:
    """Plain data by name: found by searches and recorded, or recorded before and only read.

    A theorem asks for what it needs with :meth:`take` and then verifies it, whether it was just found or read.  So a check
    runs the same inequalities and none of the searches.

    Parameters
    ----------
    recorded : mapping, optional
        What an earlier proof has recorded; without it searches are made.
    tell : Reporter, optional
        Receives the progress of those who search.
    seconds : float
        After which searches that can end early do.
    """

    def __init__(
        self, recorded: Mapping[str, Any] | None = None, tell: Reporter | None = None, seconds: float = math.inf
    ) -> None:
        self.tell = tell or Reporter(step="proving")
        self._end = time.monotonic() + seconds
        self._recorded = None if recorded is None else dict(recorded)
        self._used: dict[str, object] = {}

    @property
    def is_late(self) -> bool:
        """Whether searches that can end early should."""
        return time.monotonic() > self._end

    def take(self, name: str, search: Callable[[], _Found]) -> _Found:
        """What is known under a name: strings, numbers, ``None``, and lists of such.

        Raises :class:`NotShownError` if evidence is read and nothing is recorded under this name.
        """
        if self._recorded is None:
            found = search()
        elif name in self._recorded:
            found = self._recorded[name]
        else:
            raise NotShownError(f"the certificate lacks its evidence: {name}")
        self._used[name] = found
        return found

    def document(self) -> dict[str, Any]:
        """All that was taken, as plain data for JSON."""
        return dict(self._used)


def rational_of(text: object) -> Fraction:
    """Rational number of evidence, such as ``"3/4"``; :class:`NotShownError` for anything else."""
    if not (isinstance(text, str) and _RATIONAL.fullmatch(text)) or text.endswith("/0"):
        raise NotShownError("the certificate has a number that is no fraction of whole numbers")
    return Fraction(text)
