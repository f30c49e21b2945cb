"""Rotors that weigh something, on which periodic motions take whole turns of the shaft, and the reference of some of them."""

import numpy as np
from compliant_reference import HuntCrossley as ReferenceHuntCrossley
from compliant_reference import KelvinVoigt as ReferenceKelvinVoigt
from compliant_reference import Plane
from compliant_reference import Rotor as ReferenceRotor
from linear_rotors import planar_rotor

import carom as cm
from carom.models import Force, HuntCrossley, KelvinVoigt, Rigid, Touchdown, from_matrices, jeffcott
from carom.orbits import orbit_of_motion
from carom.parameters import Parameters

PHASE = 0.3
"""Phase of the unbalance at time zero, when weight points along the negative imaginary axis."""


def heavy(pull, gamma, omega, rho, mu, d, radius_ratio, phi=PHASE, direction=-1j):
    """A planar rotor in a rigid wall."""
    rotor = jeffcott(Parameters(gamma, omega, rho, phi, mu, d, radius_ratio))
    return rotor.under(Force(-1j, np.array([direction * pull])))


THREE = heavy(0.637, 0.324, 0.979, 0.464, 0.05, 0.5, 50.0)
ONE = heavy(0.123, 0.383, 0.388, 0.399, 0.05, 0.5, 3.0)
SIX = heavy(0.507, 0.337, 1.099, 0.856, 0.2, 0.9, 50.0)
LANDING = heavy(0.371, 0.37, 0.282, 0.659, 0.0, 0.5, 3.0)
PLASTIC = heavy(0.654, 0.104, 0.753, 0.829, 0.05, 0.0, 50.0)
RIGID = {"three": THREE, "one": ONE, "six": SIX, "landing": LANDING, "plastic": PLASTIC}


def soft(law, pull, gamma, omega, rho, mu, surface_speed):
    """A planar rotor in a compliant wall, and the same for the reference."""
    planar = planar_rotor(gamma, omega**2, rho * np.exp(1j * PHASE), [Touchdown([1.0], law, mu, surface_speed)])
    if isinstance(law, KelvinVoigt):
        same: ReferenceKelvinVoigt | ReferenceHuntCrossley = ReferenceKelvinVoigt(law.stiffness, law.damping)
    else:
        same = ReferenceHuntCrossley(law.stiffness, law.dissipation, law.exponent)
    # Its weight points along the negative real axis at time zero: its frame is ahead by a quarter of a turn.
    plane = Plane((1.0,), same, mu, surface_speed)
    reference = ReferenceRotor.planar(gamma, omega, rho, PHASE - 0.5 * np.pi, plane, weight=pull)
    return planar.under(Force(-1j, np.array([-1j * pull]))), reference


BOUNCING = soft(HuntCrossley(2e3, 0.6, 1.0), 0.5, 0.3, 0.6, 0.3, 0.1, 50.0)
PARTING = soft(KelvinVoigt(1.7e3, 6.0), 0.57, 0.2, 0.5, 0.3, 0.0, 1.5)
STICKING = soft(HuntCrossley(5.3e3, 0.64, 1.5), 1.11, 0.13, 1.06, 0.39, 0.3, 1.5)
SOFT = {"bouncing": BOUNCING, "parting": PARTING, "sticking": STICKING}


def of_two_coordinates(law, pull):
    """A rotor of two coordinates with two contact planes that are far apart in weight."""
    rotor = from_matrices(
        mass=np.diag([1.0, 1.4]),
        damping=0.4 * np.eye(2),
        stiffness=[[0.8, -0.1], [-0.1, 0.9]],
        forcing=[1.1 * 0.32, (1.4 + 0.2j) * 0.32],
        touchdowns=[
            Touchdown(plane, each, mu, 5.0)
            for plane, each, mu in (([1.0, 0.3], law, 0.1), ([0.4, 1.0], Rigid(0.5), 0.2))
        ],
    )
    return rotor.under(Force(-1j, -1j * pull * rotor.system.translated))


def settled(rotor, position=0.2 + 0.1j, velocity=1.0 + 0j):
    """The orbit on which a motion settles."""
    n = len(rotor.system.rest)
    places = (np.full(n, position), np.full(n, velocity)) if n > 1 else (position, velocity)
    return orbit_of_motion(cm.simulate(rotor, cm.State(*places), settle=True))
