"""Rolling, and the absence of backward whirl in lasting contact, for all values of a parameter between two.

The interval is halved until the signs of :mod:`carom.proofs.whirl` are decided for all values of a part, or the part is narrow.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from carom.proofs.claims import Claim
from carom.proofs.lines import Numbers, line_of
from carom.proofs.rotor import Rotor
from carom.proofs.runs import claim_of_runs, runs_along
from carom.proofs.whirl import BACKWARD, drag_sign, rolling_sign


def whirl_line_claims(rotor: Rotor, options: Mapping[str, Any]) -> list[Claim]:
    """Claims along a parameter: the options ``along``, ``from`` and ``to``, as texts.

    The rotor's own value of the parameter does not matter.
    """
    line = line_of(rotor.hypotheses, str(options["along"]), str(options["from"]), str(options["to"]))
    kinds: dict[str, tuple[str, Callable[[Numbers], bool | None]]] = {
        "rolls": ("the rotor can roll on the wall without slip, backward, for ever", _rolls),
        "absent": (BACKWARD, _absent),
    }
    return [
        claim_of_runs("whirl", kind, f"For all {line.words}, {words}.", runs_along(line, holds))
        for kind, (words, holds) in kinds.items()
    ]


def _rolls(n: Numbers) -> bool | None:
    sign = rolling_sign(n)
    return sign > 0 if sign else None


def _absent(n: Numbers) -> bool | None:
    if drag_sign(n) == 1:
        return True
    return False if rolling_sign(n) == 1 else None
