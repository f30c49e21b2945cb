"""Conversion of any description of a rotor to its model or its case."""

from __future__ import annotations

from carom.models.jeffcott import Jeffcott
from carom.outcome import InputError, shown
from carom.parameters import Case, Machine, Parameters, Zones

__all__ = ["Subject", "case_of", "model_of"]

Subject = Jeffcott | Parameters | Machine | Case
"""Any description of a rotor."""


def model_of(subject: Subject) -> Jeffcott:
    """Model of a machine, a case or parameters; a model is returned as it is.

    Raises
    ------
    InputError
        It is none of these.
    """
    if isinstance(subject, Jeffcott):
        return subject
    if isinstance(subject, Machine | Case):
        return Jeffcott(subject.parameters)
    if isinstance(subject, Parameters):
        return Jeffcott(subject)
    raise InputError(
        "machine", shown(subject), "a Machine, a Case (as carom.load reads it from a file), Parameters or a model"
    )


def case_of(subject: Subject) -> Case:
    """Case of a machine, parameters or a model, with the default zones; a case is returned as it is.

    Raises
    ------
    InputError
        It is none of these.
    """
    if isinstance(subject, Case):
        return subject
    return Case("machine", model_of(subject).parameters, subject if isinstance(subject, Machine) else None, Zones())
