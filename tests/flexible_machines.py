"""The magnetic-bearing rig of TU Munich with touchdown bearings, and smaller machines."""

import dataclasses
import itertools

from carom.parameters import Gravity, TouchdownBearing
from carom.rotors import (
    PID,
    Disc,
    FlexibleMachine,
    FlexibleRotor,
    MagneticBearing,
    Material,
    ModalDamping,
    ProportionalDamping,
    ShaftSection,
    TouchdownPlane,
    Unbalance,
)

STEEL = Material("211 GPa", 7860.0)
BOUNDARIES = (0, 71, 94, 113, 132, 155, 350, 363, 376, 581, 604, 623, 642, 665, 702)
"""Of the sections, mm."""
THICK = ((94, 132), (350, 376), (604, 642))
"""Where the shaft is 9.6 mm thick, mm."""
SOFT = TouchdownBearing("hunt-crossley", stiffness="1e7 N/m", dissipation="1 s/m")
CONTROLLER = PID("5000 A/m", "1500 A/m/s", "5 A s/m", "0.1 ms")


PRINTED = ProportionalDamping("10 1/s", "10 us")


def munich_rotor(longest_element=0.02, damping=PRINTED, material=STEEL):
    sections = [
        ShaftSection(f"{end - begin} mm", "9.6 mm" if any(a <= begin < b for a, b in THICK) else "8 mm", 0.0, material)
        for begin, end in itertools.pairwise(BOUNDARIES)
    ]
    discs = [
        Disc(3, 0.85074, 4.840066e-4, 4.036839e-4),
        Disc(7, 1.276499, 1.487212e-3, 2.832751e-3),
        Disc(11, 0.85074, 4.840066e-4, 4.036839e-4),
    ]
    return FlexibleRotor(sections, discs, damping, longest_element)


def munich(longest_element=0.02, touchdown=SOFT, **changes):
    """The rig at 3000 rpm; its touchdown bearings stand beside its magnetic bearings."""
    bearings = [
        MagneticBearing(node, 50.0, -1e5, CONTROLLER, sensors) for node, sensors in ((3, (1, 5)), (11, (9, 13)))
    ]
    given = {
        "rotor": munich_rotor(longest_element),
        "speed": "3000 rpm",
        "clearance": "0.2 mm",
        "bearings": bearings,
        "touchdowns": [TouchdownPlane(node, touchdown, "4.8 mm", 0.15) for node in (2, 12)],
        "unbalances": [Unbalance(7, "20 g mm")],
        "gravity": Gravity(),
    }
    return FlexibleMachine(**{**given, **changes})


def symmetric(stiffer=1.0, touchdown=None, **changes):
    """A uniform shaft on two bearings, without gyroscopic moments worth mentioning, on springs without damping and friction."""
    shaft = [ShaftSection(length, 0.03, 0.0, Material(2.1e11 * stiffer, 7800.0)) for length in (0.1, 0.4, 0.1)]
    spring = touchdown or TouchdownBearing("kelvin-voigt", stiffness=2e7, damping=0.0)
    given = {
        "rotor": FlexibleRotor(shaft, [], ModalDamping(0.0)),
        "speed": 300.0,
        "clearance": 0.2e-3,
        "bearings": [MagneticBearing(node, 50.0, -1e5, PID(9000.0, 0.0, 10.0, 1e-4)) for node in (1, 2)],
        "touchdowns": [TouchdownPlane(node, spring, 0.015, 0.0) for node in (1, 2)],
        "gravity": Gravity(carried_by="stiffness"),
    }
    return FlexibleMachine(**{**given, **changes})


def replaced(machine, **changes):
    return dataclasses.replace(machine, **changes)
