"""What compliant laws have in common: an arrival has no impulse, a force acts while the plane is in the wall."""

from __future__ import annotations

from carom.core.compiling.decorators import formula


@formula
def no_impulse(speed, wall):
    """Impulse of an arrival, and its derivatives."""
    return 0.0 * speed
