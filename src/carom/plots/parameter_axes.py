"""Axes of parameters: of a machine in SI units in these units, with a dimensionless parameter on the opposite side."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from matplotlib.axes import Axes

from carom.parameters.fields import MACHINE_FIELDS, PHYSICAL_PARTNER, Field
from carom.parameters.formats import number as plain
from carom.parameters.scaling import CONVERSIONS
from carom.plots.words import number, parameter_label

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from carom.parameters import Scales


def label_parameter(axes: Axes, direction: Literal["x", "y"], field: Field, scales: Scales | None, own: Axes) -> bool:
    """Label the axis of a parameter at the bottom or left; return whether its dimensionless value is on the other side.

    `axes` have the label, `own` the dimensionless values of a machine in SI units; they share the axis, or are the same.
    """
    label = parameter_label(field)
    partner = _partner(field, scales)
    if partner is None or scales is None:
        axes.set(**{f"{direction}label": label})
        return False
    conversion, size = CONVERSIONS[field.name], partner.usual_size

    def to_machine(values: ArrayLike) -> Any:
        return conversion.value(np.asarray(values, float), scales) / size

    def from_machine(values: ArrayLike) -> object:
        # Matplotlib tries values beyond the axis.
        return (np.maximum(values, 0.0) * size / conversion.unit(scales)) ** (1.0 / conversion.power)

    near, far = ("bottom", "top") if direction == "x" else ("left", "right")
    axes.tick_params(axis=direction, which="both", **{near: False, f"label{near}": False})
    own.tick_params(axis=direction, which="both", **{far: True, f"label{far}": True})
    shown = getattr(axes, f"secondary_{direction}axis")(near, functions=(to_machine, from_machine))
    shown.set(**{f"{direction}label": parameter_label(partner)})
    getattr(shown, f"{direction}axis").set_major_formatter(lambda value, _: plain(value))
    getattr(own, f"{direction}axis").set_label_position(far)
    own.set(**{f"{direction}label": label})
    return True


def format_parameter(value: float, field: Field, scales: Scales | None) -> str:
    """Write a value of a parameter as its axis tells it, with its unit."""
    partner = _partner(field, scales)
    if partner is not None and scales is not None:
        value, field = float(CONVERSIONS[field.name].value(value, scales)), partner
    return f"{number(value / field.usual_size)} {field.usual_unit}".rstrip()


def _partner(field: Field, scales: Scales | None) -> Field | None:
    """The field of a machine that a dimensionless parameter stands for, if it has a unit."""
    partner = MACHINE_FIELDS.get(PHYSICAL_PARTNER.get(field.name, ""))
    return partner if scales is not None and partner is not None and partner.unit not in ("", "rad") else None
