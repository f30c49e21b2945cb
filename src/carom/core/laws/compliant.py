"""What compliant laws have in common: no impulse at the impact, a force acts while the station is in the wall."""

from __future__ import annotations

from carom.core.compiling.decorators import formula


@formula
def no_impulse(speed, wall):
    """Impulse of an impact, and its derivatives."""
    return 0.0 * speed
