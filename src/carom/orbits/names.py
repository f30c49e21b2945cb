"""Names of orbits with one impact a period."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import Any, Literal

from carom.base.outcome import REGULAR_BOUNCING

Slip = Literal[1, -1]


class Name(str):
    """A text that is made from parts, which it carries: a frozen dataclass."""

    def __getnewargs__(self) -> tuple[Any, ...]:  # for copies and pickles
        return tuple(getattr(self, part.name) for part in fields(self))  # type: ignore[arg-type]


@dataclass(frozen=True, eq=False, repr=False)
class OrbitName(Name):
    """Name of a single-impact orbit, such as ``"B1,d"``: a text that also carries what it says.

    Parameters
    ----------
    pair : int
        Number of the pair of periods, from 1.
    longer : bool
        Whether the period is the longer one of the pair.
    faster : bool
        Whether the radial speed is the higher one of the two at this period.
    slip : {1, -1}
        Direction of the slip in the impact: forward (``B``) or backward (``R``).
    """

    pair: int
    longer: bool
    faster: bool
    slip: Slip = 1

    def __new__(cls, pair: int, longer: bool, faster: bool, slip: Slip = 1) -> OrbitName:
        """Make the text from the parts."""
        return super().__new__(cls, f"{'B' if slip > 0 else 'R'}{pair},{'abcd'[longer + 2 * faster]}")

    @property
    def letter(self) -> str:
        """``a`` and ``c`` have the shorter period, ``b`` and ``d`` the longer; ``a`` and ``b`` the lower speed."""
        return self[-1]

    @property
    def words(self) -> str:
        """What people call the motion: ``regular bouncing``; what sets it apart from ``B1,d`` stands in brackets.

        The shorter period of a pair is *quick*, the lower speed *soft*.
        """
        apart = [
            "" if self.pair == 1 else f"pair {self.pair}",
            "" if self.longer else "quick",
            "" if self.faster else "soft",
            "" if self.slip > 0 else "slipping backward",
        ]
        shown = ", ".join(filter(None, apart))
        return f"{REGULAR_BOUNCING} ({shown})" if shown else REGULAR_BOUNCING

    @property
    def place(self) -> tuple[int, int, str]:
        """Place in a list: forward slip first, then by the number of the pair and the letter."""
        return -self.slip, self.pair, self.letter


def in_order(names: Iterable[OrbitName]) -> tuple[OrbitName, ...]:
    """Names in the order of lists."""
    return tuple(sorted(names, key=lambda name: name.place))


def combined(names: Iterable[OrbitName]) -> str:
    """Names as one text with the letters of each pair combined, such as ``B1,a/b/c, B2,d``."""
    pairs: dict[tuple[int, int], list[OrbitName]] = {}
    for name in in_order(names):
        pairs.setdefault((name.slip, name.pair), []).append(name)
    return ", ".join("/".join([first, *(name.letter for name in others)]) for first, *others in pairs.values())


@dataclass(frozen=True, eq=False, repr=False)
class CountedName(Name):
    """Name of an orbit with several impacts a period or lasting contact, such as ``"P2,1"``: a text that also carries what it says.

    Parameters
    ----------
    impacts : int
        Impacts per period, without those of a chatter.
    number : int
        Number of the orbit among those of its search and its kind, by their periods, from 1.
    kind : str
        Without impacts: ``"rolling"`` or, sliding, ``"whirl"``, if it goes round backward in contact all the time, otherwise ``"rubbing"``;
        the name is ``"rolling 1"`` then.
    """

    impacts: int
    number: int
    kind: str = ""

    def __new__(cls, impacts: int, number: int, kind: str = "") -> CountedName:
        """Make the text from the parts."""
        return super().__new__(cls, f"{kind} {number}" if kind else f"P{impacts},{number}")

    @property
    def words(self) -> str:
        """What people call the motion: ``regular bouncing``, or with how many impacts it repeats."""
        return REGULAR_BOUNCING if self.impacts == 1 else f"bouncing with {self.impacts} impacts a period"
