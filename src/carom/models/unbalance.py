"""A rotor with another unbalance.

The change is a vector: a force ``Δ p e^{iβ}`` in the frame that turns with the shaft, where ``p`` is the force of an unbalance of one
with the phase of that before.  The rotor after it may be seen in a frame that has turned with the unbalance: there its phase is what it was, and many
changes lead to one machine, which differ by where the motion starts.
"""

from __future__ import annotations

import cmath
from dataclasses import replace

import numpy as np

from carom.models.jeffcott import Jeffcott
from carom.models.linear import LinearRotor
from carom.models.linear_parameters import refuse_node
from carom.models.model import Model
from carom.models.stages import Around, Staged
from carom.outcome import InputError, shown


def unbalance_push(model: Model, node: int | None = None) -> np.ndarray:
    """Force (n,) of an unbalance of one, as an eccentricity in ``c_r`` of the whole mass, that has the phase of the one before.

    It is distributed like the unbalance of the rotor; of a balanced one it is that of all masses off centre by the same.  Of a flexible machine it acts
    at a node.
    """
    if isinstance(model, Around):
        # Coordinates of what stands around a rotor, such as a mount, are not pushed.
        push = unbalance_push(model.rotor, node)
        return np.append(push, np.zeros(len(model.matrices.mass) - len(push)))
    if isinstance(model, LinearRotor):
        return model.unbalance_push(node)
    refuse_node(node)
    return np.array([cmath.rect(1.0, model.unbalance_phase)])


def unbalance_along(model: Model, node: int | None = None) -> float | None:
    """Unbalance that changes, as an eccentricity in ``c_r``; ``None`` where others stay, so that no change leads to the machine of another one."""
    if isinstance(model, Around):
        return unbalance_along(model.rotor, node)
    return model.unbalance_along(node) if isinstance(model, LinearRotor) else model.value("rho")


def with_changed_unbalance(model: Model, change: complex, node: int | None = None) -> tuple[Model, float]:
    """The rotor with another unbalance, and the angle by which its frame has turned, so that the phase stays what it was.

    Parameters
    ----------
    change : complex
        As an eccentricity in ``c_r``, relative to the direction of the unbalance before.
    node : int, optional
        Of a flexible machine.
    """
    if isinstance(model, Staged):
        moved = [with_changed_unbalance(each.rotor, change, node) for each in model.stages]
        stages = (replace(each, rotor=rotor) for each, (rotor, _) in zip(model.stages, moved, strict=True))
        return Staged(tuple(stages)), moved[0][1]
    if isinstance(model, Around):
        rotor, turned = with_changed_unbalance(model.rotor, change, node)
        around: Model = replace(model, rotor=rotor)  # type: ignore[type-var]  # all that is around a rotor is a dataclass
        return around, turned
    if isinstance(model, LinearRotor):
        return model.with_changed_unbalance(change, node)
    if not isinstance(model, Jeffcott):
        raise InputError(
            "machine", shown(model), "a rotor of carom.models: of no other is it known what its unbalance is"
        )
    refuse_node(node)
    after = model.value("rho") + change
    return model.replace(rho=abs(after)), cmath.phase(after) if after else 0.0
