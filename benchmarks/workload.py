"""The machine and the work that all benchmarks share."""

from __future__ import annotations

import carom

UNTIL, MOST_IMPACTS = 200.0, 100


def source_paper_machine(gamma: float) -> carom.Rotor:
    """The machine of the source paper."""
    return carom.jeffcott(
        carom.Parameters(gamma=gamma, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=400 / 7)
    )
