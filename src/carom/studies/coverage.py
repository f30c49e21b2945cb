"""What a study does not cover, by what the rotor has."""

from __future__ import annotations

from carom.base.outcome import STEADY_WORDS
from carom.studies.study_data import StudyData

SAMPLED = "Disturbances other than those simulated{but}. They are samples: one between them, or a larger one, may end elsewhere."
PROVEN_KICKS = ", but for the kicks that are proven to come back"
LONGER_MOTIONS = (
    "Periodic motions with two or more impacts a period, bouncing that never repeats, and motions that alternate between bounces and lasting contact. "
    "They are named only if a simulated disturbance ended in one."
)
RIGID_WALL = (
    "A touchdown bearing that moves, turns or is compliant: the wall is rigid, so the load of an impact is an impulse."
)
COMPLIANT_WALL = "Wear, heat and axial motion of the touchdown bearing: its law is taken as it is stated."
PLANAR = (
    "Changes of speed, gravity, a rotor that bends or tilts, and controllers that do more than a spring and a damper."
)
LINEAR = "Changes of speed, coefficients of supports at other speeds, and limits of the magnetic bearings that the file does not state."
SYMMETRY = (
    f"What rests on the symmetry of a turn: {STEADY_WORDS['rub']}s, orbits in closed form, and that a kick does the same whatever the angle of the "
    "unbalance is as it acts. Here that is the angle in the machine file; with others some kicks may end elsewhere."
)
CLOSED_FORMS = (
    "What is known in closed form for the planar rotor alone: whether rolling lasts and from which speed whirl runs away to it, for which damping and "
    "stiffness each motion exists, and that no orbit is missing."
)
AT_LIMITS = (
    "Other angles of the unbalance to the axes of the magnetic bearings, along which their limits act, as a disturbance acts than that of the "
    "machine file. Saturation of the iron and limits of the voltage are not modelled."
)
NOT_COVERED = (SAMPLED.format(but=""), LONGER_MOTIONS, RIGID_WALL, PLANAR)
"""What the study of a planar rotor in a rigid wall does not cover."""


def not_covered(study: StudyData) -> tuple[str, ...]:
    """What the study does not cover, by what the rotor has."""
    rotor, exact = study.rotor, study.known.orbits
    shown = {
        SAMPLED.format(but=PROVEN_KICKS if study.kicks is not None and study.kicks.share else ""): True,
        LONGER_MOTIONS: True,
        COMPLIANT_WALL if (rotor.system.arrays["stiffness"] > 0.0).any() else RIGID_WALL: True,
        PLANAR if exact else LINEAR: True,
        SYMMETRY: study.under_gravity,
        CLOSED_FORMS: not exact,
        AT_LIMITS: bool(rotor.system.limits),
    }
    return tuple(text for text, holds in shown.items() if holds)
