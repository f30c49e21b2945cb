"""The orbit that a simulated motion repeats: its impacts are read from the events, and Newton's method closes it."""

from __future__ import annotations

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import Outcome
from carom.models import Rotor
from carom.motions.trajectories import Trajectory
from carom.orbits.happenings import begins_contact, first_of_period, impact_kinds
from carom.orbits.orbit import Orbit, orbit_near
from carom.orbits.shooting import ShootingStart
from carom.orbits.simulated import SimulatedOrbit
from carom.orbits.simulated_search import periodic_of
from carom.orbits.word import Kind, Word

PERIODIC = (Outcome.BOUNCING, Outcome.MIXED)
RECOGNITION_RTOL = 1e-3
"""Distance, relative to one plus the size of the nodes, within which the orbit of a settled motion is searched for."""


@checked
def orbit_of_motion(motion: Trajectory) -> Orbit | SimulatedOrbit | None:
    """Close the periodic orbit on which a motion has settled.

    Parameters
    ----------
    motion : Trajectory
        Settled to periodic bouncing, with or without lasting contact in the period, or to a whirl in contact (``settle=True``).

    Returns
    -------
    Orbit, SimulatedOrbit or None
        Bouncing of the planar rotor in a rigid bearing as a word of impacts.  ``None`` if the motion has not settled to such an orbit,
        or if Newton's method closes none next to it.

    See Also
    --------
    carom.find_orbits : all orbits with one impact a period
    carom.continue_orbit : follow it along a parameter

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> motion = cm.simulate(machine, cm.kick("60 mm/s"), settle=True)
    >>> print(f"{cm.orbits.orbit_of_motion(motion).period:.9f}")
    2.328416080
    """
    if not motion.rotor.has_closed_forms:
        return periodic_of(motion)
    count, begun_contacts = motion.multiplicity, np.flatnonzero(begins_contact(motion))
    if motion.outcome in PERIODIC and 0 < count <= len(begun_contacts):
        first = int(begun_contacts[first_of_period(motion, count)])
        if motion.is_impact[first:].all():
            return _near(motion.rotor, *impacts_between(motion, first, len(motion.event_amplitudes)))
    return periodic_of(motion)


def _near(rotor: Rotor, word: Word, start: ShootingStart) -> Orbit | None:
    """Orbit next to a start, if it is the one that the motion has settled on."""
    orbit, begun = orbit_near(rotor, word, start), start.nodes[0]
    if orbit is None or np.abs(orbit.nodes - begun).max(axis=1).min() > RECOGNITION_RTOL * (1.0 + np.abs(begun).max()):
        return None
    return orbit


def impacts_between(motion: Trajectory, first: int, last: int) -> tuple[Word, ShootingStart]:
    """Word, nodes and durations of a motion from one impact up to another, with nothing but impacts in between."""
    kinds = impact_kinds(motion)[first:last].tolist()
    times = np.append(motion.segment_starts[1:], motion.time)
    nodes = motion.rotor.system.nodes.of(motion.event_amplitudes[first:last])
    return Word(tuple(map(Kind, kinds))), ShootingStart(nodes, np.diff(times[first : last + 1]))


def with_impacts(motion: Trajectory, first: int, count: int) -> tuple[Word, ShootingStart] | None:
    """Word and start of some impacts in a row, from that of given number; ``None`` where the motion does else."""
    impacts = np.flatnonzero(motion.is_impact)
    if first + count >= len(impacts) or impacts[first + count] - impacts[first] != count:
        return None
    return impacts_between(motion, int(impacts[first]), int(impacts[first + count]))
