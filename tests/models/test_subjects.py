"""The one door for rotors: every verb takes a machine, a case, parameters or a model."""

import pytest
from machines import PAPER, SCALES, machine_of

from carom.base.outcome import InputError
from carom.models import case_of, jeffcott, rotor_of
from carom.parameters import Case, Gravity, Zones

MACHINE = machine_of(PAPER, SCALES)


def test_whatever_describes_a_rotor_is_taken():
    rotor = jeffcott(PAPER)
    assert rotor_of(rotor) is rotor
    assert rotor_of(PAPER) == rotor
    assert rotor_of(Case("machine", PAPER, None, Zones())) == rotor
    assert rotor_of(MACHINE) == jeffcott(MACHINE.parameters)


@pytest.mark.parametrize("subject", [None, "machine.toml", 3, jeffcott(PAPER).system, {"gamma": 0.1}])
def test_anything_else_is_refused(subject):
    with pytest.raises(InputError, match=r"machine = .*: a Machine, a Case .*, Parameters or a model"):
        rotor_of(subject)


def test_a_case_keeps_the_machine_it_was_made_from():
    case = Case("mine", PAPER, None, Zones((0.1, 0.2, 0.3)))
    assert case_of(case) is case
    assert case_of(MACHINE) == Case("machine", MACHINE.parameters, MACHINE, Zones())
    assert case_of(jeffcott(PAPER)) == case_of(PAPER) == Case("machine", PAPER, None, Zones())
    with pytest.raises(InputError, match="machine = "):
        case_of("machine.toml")


def test_any_rotor_has_a_case():
    has_mass = rotor_of(MACHINE).under_gravity(Gravity())
    case = case_of(has_mass)
    assert case_of(case) is case
    assert rotor_of(case) is has_mass
