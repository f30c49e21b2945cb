"""Which kind of machine it is: the one place of the explorer that asks."""

from __future__ import annotations

from carom.explorer.computing.exports import Origin
from carom.explorer.page.flexible import FlexibleKind
from carom.explorer.page.kind import Kind
from carom.explorer.page.planar import PlanarKind
from carom.models import Subject, planar_case_of, rotor_of
from carom.parameters import Case, Zones


def kind_of(origin: Origin) -> Kind:
    """What the machine brings to the page.

    Raises
    ------
    InputError
        It is neither the planar rotor nor a flexible machine.
    """
    return PlanarKind(origin) if rotor_of(origin.case).finite_elements is None else FlexibleKind(origin)


def explored_case_of(subject: Subject) -> Case:
    """Case of a machine that the page opens: a flexible one, or the planar rotor.

    Raises
    ------
    InputError
        It is neither, or has what the page of its kind does not show.
    """
    reduced = rotor_of(subject).finite_elements
    if reduced is None:
        return planar_case_of(subject)
    if isinstance(subject, Case):
        return subject
    return Case("machine", reduced.limited, None, Zones(), gravity=reduced.machine.gravity)
