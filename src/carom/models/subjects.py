"""Conversion of any description of a rotor to its model or its case."""

from __future__ import annotations

import json
from collections.abc import Mapping
from importlib import import_module
from typing import Any, cast

import numpy as np

from carom.arguments import checked
from carom.models.forcing import Force
from carom.models.in_bearing import InBearing
from carom.models.jeffcott import Jeffcott
from carom.models.limited import Limited, limits_from
from carom.models.linear import LinearRotor
from carom.models.model import Model
from carom.models.stages import Forced, Stage, Staged, Trigger
from carom.models.weight import weighted
from carom.outcome import InputError, shown
from carom.parameters import Case, Drive, Machine, Parameters, TouchdownBearing, Zones

Subject = Machine | Case | Parameters | Model
"""Any description of a rotor."""
_ALLOWED = "a Machine, a Case (as carom.load reads it from a file), Parameters or a model"
_PLANAR = (
    "the planar rotor: this result is not known for other models, as of files with [rotor]; with these carom.simulate, carom.settle, "
    "carom.drop, carom.study, carom.find_attractors, carom.map_basins and carom.map_gains work, and the commands study, simulate, drop, attractors, basins, "
    "orbits, explore, and sweep with [basins]"
)


def model_of(subject: Subject) -> Model:
    """Model of a machine, a case or parameters; a model is returned as it is.

    Raises
    ------
    InputError
        It is none of these.
    """
    # Classes first: whether an object follows the protocol takes much longer to find out.
    if isinstance(subject, Jeffcott):
        return subject
    if isinstance(subject, Parameters):
        return Jeffcott(subject)
    if isinstance(subject, Machine | Case):
        model = model_of(subject.parameters)
        machine = subject.machine if isinstance(subject, Case) else subject
        if isinstance(subject, Case) and (subject.touchdown or subject.drive) and isinstance(model, Jeffcott):
            gap = None if machine is None else machine.air_gap
            model = InBearing(model, subject.touchdown or TouchdownBearing(), drive=subject.drive, air_gap=gap)
        if machine is not None and machine.control_limit is not None:
            model = Limited(model, machine.control_limit)
        return weighted(model, subject.gravity) if isinstance(subject, Case) and subject.gravity else model
    if isinstance(subject, Model):
        return subject
    raise InputError("machine", shown(subject), _ALLOWED)


def jeffcott_of(subject: Subject) -> Jeffcott:
    """Model of a machine, a case or parameters, for results in closed form that only the planar rotor has.

    Raises
    ------
    InputError
        It is none of these, another model, or has weight.
    """
    model = model_of(subject)
    if model.has_closed_forms:
        return cast("Jeffcott", model)
    refuse_other_rotors(subject)
    if isinstance(model, Limited):
        allowed = (
            "none: this result is known for magnetic bearings without limits alone, so leave force_limit and current_limit out for it; "
            "carom.simulate, carom.settle and others work"
        )
        raise InputError("limits", model.words_of_limits, allowed)
    if isinstance(model, Forced):
        model.refuse_forces()
    if isinstance(model, InBearing):
        allowed = "a rigid wall that stands still, and a shaft at constant speed: this result is known for these alone; carom.simulate, carom.settle and others work"
        raise InputError("touchdown", model.words_of_bearing, allowed)
    raise InputError("machine", shown(subject), _PLANAR)


def refuse_other_rotors(subject: Subject) -> None:
    """Refuse what is no planar rotor, whatever forces act on it."""
    if model_of(subject).planar is None:
        raise InputError("machine", shown(subject), _PLANAR)


@checked
def model_from(attributes: Mapping[str, Any]) -> Model:
    """Model whose :meth:`~carom.models.model.Model.attributes` these are.

    Raises
    ------
    InputError
        A value is not allowed.
    KeyError, TypeError, ValueError
        An attribute is missing, or is not such text.
    """
    if "flexible_machine" in attributes:
        # The layers forbid imports from above.
        read = import_module("carom.rotors.flexible_model").FlexibleModel.from_attributes
        return cast("Model", read(attributes))
    if "linear_rotor" in attributes:
        return LinearRotor.from_attributes(attributes)
    if "forces" in attributes:
        numbers = [[complex(*each) for each in force] for force in json.loads(attributes["forces"])]
        forces = tuple(Force(exponent, np.array(accelerations)) for exponent, *accelerations in numbers)
        return Forced(model_from(json.loads(attributes["rotor"])), forces)
    if "limits" in attributes:
        return Limited(model_from(json.loads(attributes["rotor"])), limits_from(attributes["limits"]))
    if "touchdown_bearing" in attributes:
        bearing = json.loads(attributes["touchdown_bearing"])
        levitates, drive, gap = bearing.pop("levitates"), bearing.pop("drive"), bearing.pop("air_gap", None)
        rotor = jeffcott_of(model_from(json.loads(attributes["rotor"])))
        return InBearing(rotor, TouchdownBearing(**bearing), levitates, Drive(**drive) if drive else None, gap)
    if "stages" in attributes:
        return Staged(tuple(map(_stage_from, json.loads(attributes["stages"]))))
    return Jeffcott(Parameters.from_attributes(attributes))


def _stage_from(given: Mapping[str, Any]) -> Stage:
    real, imaginary = map(np.array, given["carry"] or (0.0, 0.0))
    carry = None if given["carry"] is None else real + 1j * imaginary
    return Stage(model_from(given["rotor"]), Trigger(**given["trigger"]), carry)


def case_of(subject: Subject) -> Case:
    """Case of a machine, parameters or a model, with the default zones; a case is returned as it is.

    Raises
    ------
    InputError
        It is none of these, another model than the planar rotor, or has weight: no case would keep that.
    """
    if isinstance(subject, Case):
        jeffcott_of(subject)
        return subject
    machine = subject if isinstance(subject, Machine) else None
    return Case("machine", jeffcott_of(subject).parameters, machine, Zones())


def planar_case_of(subject: Subject) -> Case:
    """Case of the planar rotor in a touchdown bearing of any kind, with the default zones; a case is returned as it is.

    A machine and a case may state limits of their magnetic bearings.

    Raises
    ------
    InputError
        It is none of these, another model, has weight, or the centre of the touchdown bearing is off the place of levitation.
    """
    model = model_of(subject)
    if isinstance(model, Limited) and isinstance(subject, Machine | Case):
        model = model.rotor
        if isinstance(model, Jeffcott):
            return subject if isinstance(subject, Case) else Case("machine", model.parameters, subject, Zones())
    if not isinstance(model, InBearing) or not model.levitates:
        return case_of(subject)
    if model.bearing.centre:
        allowed = "must be 0 here: off that centre the rotor is never at rest in the frame that turns with the shaft; carom.simulate works"
        raise InputError("touchdown_offset", model.bearing.offset, allowed)
    if isinstance(subject, Case):
        return subject
    return Case("machine", model.parameters, None, Zones(), touchdown=model.bearing, drive=model.drive)
