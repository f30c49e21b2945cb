"""A rotor that weighs something, and what is left of it when levitation is lost.

In the fixed frame weight is a constant force.  In the frame that turns with the shaft it turns backward once per turn, which is a
:class:`~carom.models.forcing.Force` with the exponent ``−i``.
"""

from __future__ import annotations

import numpy as np

from carom.base.outcome import InputError
from carom.models.rotor import Rotor


def levitation_of(model: Rotor) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates and their rates, both (n,), where the rotor levitates at time zero: its whirl about the static sag.

    Raises
    ------
    InputError
        The whirl reaches the wall, or nothing holds the rotor.
    """
    reach = model.system.rest_radius
    if reach >= 1.0:
        reaches = (
            "none, nothing holds the rotor" if reach == np.inf else f"up to {reach:.4g} clearances from the centre"
        )
        raise InputError("levitation", reaches, "static sag and whirl must stay inside the wall: below 1")
    return model.system.kicked(0.0)
