"""Conversion of any description of a rotor to its model or its case."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from carom.base.arguments import checked
from carom.base.outcome import InputError, shown
from carom.models.documents import part_from
from carom.models.forcing import ISOTROPIC_ALONE, WITHOUT_FORCES
from carom.models.planar import RIGID, jeffcott
from carom.models.rotor import PLANAR_ALONE, Rotor
from carom.parameters import Case, Machine, Parameters, Zones

Subject = Machine | Case | Parameters | Rotor
"""Any description of a rotor."""
_WITHOUT_LIMITS = (
    "none: this result is known for magnetic bearings without limits alone, so leave force_limit and current_limit out for it; "
    "carom.simulate, carom.settle and others work"
)
_RIGID = "a rigid wall that stands still, and a shaft at constant speed without internal damping: this result is known for these alone; carom.simulate, carom.settle and others work"
_ALLOWED = "a Machine, a Case (as carom.load reads it from a file), Parameters or a model"


def rotor_of(subject: Subject) -> Rotor:
    """Rotor of a machine, a case or parameters; a rotor is returned as it is.

    Raises
    ------
    InputError
        It is none of these.
    """
    if isinstance(subject, Rotor):
        return subject
    if isinstance(subject, Parameters):
        return jeffcott(subject)
    if not isinstance(subject, Machine | Case):
        raise InputError("machine", shown(subject), _ALLOWED)
    case = case_of(subject)
    rotor, limits = rotor_of(case.parameters), case.machine.control_limit if case.machine else None
    air_gap, internal = case.si.get("air_gap"), case.si.get("internal_damping", 0.0)
    if (case.touchdown or case.drive or internal) and rotor.has_closed_forms:
        touchdown = case.touchdown or RIGID
        rotor = jeffcott(rotor.parameters, touchdown, drive=case.drive, air_gap=air_gap, internal_damping=internal)
    if limits is not None:
        rotor = replace(rotor, limits=limits)
    return rotor.under_gravity(case.gravity) if case.gravity else rotor


def exact_rotor_of(subject: Subject) -> Rotor:
    """Rotor of a machine, a case or parameters, of which exact results are known.

    Raises
    ------
    InputError
        It is none of these, or a rotor without exact results: no planar one, or with weight, limits or a touchdown bearing of its own.
    """
    rotor = rotor_of(subject)
    if rotor.has_closed_forms:
        return rotor
    if rotor.planar is None:
        raise InputError("machine", shown(rotor), PLANAR_ALONE)
    if rotor.limits:
        raise InputError("limits", rotor.words_of_limits, _WITHOUT_LIMITS)
    if rotor.acting.forces:
        refuse_forces(rotor)
    raise InputError("touchdown", rotor.definition.words_of_bearing, _RIGID)


def refuse_forces(rotor: Rotor) -> None:
    """Refuse a rotor on which forces act that change with time in its frame: it never is at rest there."""
    if rotor.system.shaft is not None:
        rotor.system.refuse_non_stationary()
    if rotor.is_anisotropic:
        raise InputError("machine", "anisotropic bearings", ISOTROPIC_ALONE)
    if rotor.system.outer.any():
        acting = "forces that change with time" if rotor.acting.weight is None else "gravity"
        raise InputError("machine", f"a rotor under {acting}", WITHOUT_FORCES)


@checked
def rotor_from(attributes: Mapping[str, Any]) -> Rotor:
    """Rotor whose :meth:`~carom.models.Rotor.attributes` these are.

    Raises
    ------
    InputError
        A value is not allowed.
    KeyError, TypeError, ValueError
        An attribute is missing, or is not such text.
    """
    if "rotor" not in attributes:
        return jeffcott(Parameters.from_attributes(attributes))
    rotor = part_from(json.loads(attributes["rotor"]))
    if not isinstance(rotor, Rotor):
        raise ValueError("it holds no rotor")
    return rotor


def case_of(subject: Subject) -> Case:
    """Case of any description of a rotor, with the default zones; a case is returned as it is.

    A rotor of which exact results are known is described by its parameters, any other one stands for itself.

    Raises
    ------
    InputError
        It is none of these.
    """
    if isinstance(subject, Case):
        return subject
    if isinstance(subject, Machine):
        return Case("machine", subject.parameters, subject, Zones())
    rotor = rotor_of(subject)
    if rotor.has_closed_forms and not rotor.forces:
        return Case("machine", rotor.parameters, None, Zones())
    return Case("rotor", rotor, None, Zones())
