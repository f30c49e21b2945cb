"""The models of carom by the names used in files and on the command line."""

from __future__ import annotations

from carom.disturbances.blade_loss import BladeLoss
from carom.disturbances.kicks_and_shocks import BaseShock, KickPlane, VelocityKick
from carom.disturbances.model import Disturbance
from carom.disturbances.states import AnyState, ContactRelease, StateSlice

MODELS: dict[str, type[Disturbance]] = {
    model.kind: model for model in (VelocityKick, KickPlane, BaseShock, BladeLoss, ContactRelease, StateSlice, AnyState)
}
