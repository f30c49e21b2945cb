"""How small changes of a state travel through an impact, a flight and the next arrival at the wall."""

from __future__ import annotations

from carom.core.flow import displacement, flight_increments, velocity
from carom.core.impact import strike_variation
from carom.core.layout import kernel

__all__ = ["carry_through_impact", "carry_to_wall", "shift"]


@kernel
def carry_through_impact(rotor, plane, before, directions):
    """Replace changes of the amplitudes just before an impact by those just after it.

    Parameters
    ----------
    rotor : record of :func:`~carom.core.layout.rotor_record`
    plane : int
    before : complex array, shape (N,)
        Amplitudes just before the impact.
    directions : complex array, shape (D, N)
        Changes of the amplitudes, along the wall; overwritten.
    """
    position = displacement(rotor, plane, before)
    speed = velocity(rotor, plane, before)
    for i in range(directions.shape[0]):
        position_change = displacement(rotor, plane, directions[i]) - rotor.offsets[plane]
        velocity_change = velocity(rotor, plane, directions[i])
        change = strike_variation(
            position,
            speed,
            rotor.friction[plane],
            rotor.restitution[plane],
            rotor.drive[plane],
            position_change,
            velocity_change,
        )
        for k in range(before.shape[0]):
            directions[i, k] += rotor.columns[k, plane] * change


@kernel
def carry_to_wall(rotor, plane, duration, arrival, directions, delays, work):
    """Replace changes at the start of a flight by those where the changed flight meets the wall.

    A changed flight arrives earlier or later by ``δt = −Re(ȳ δy)/Re(ȳ ẏ)``, which moves its arrival by ``ċ δt``: the
    saltation term.

    Parameters
    ----------
    rotor : record of :func:`~carom.core.layout.rotor_record`
    plane : int
    duration : float
        Length of the unchanged flight.
    arrival : complex array, shape (N,)
        Amplitudes of the unchanged flight where it meets the wall.
    directions : complex array, shape (D, N)
        Changes of the amplitudes; overwritten.
    delays : array, shape (D,)
        On return ``δt`` of each.
    work : record of :func:`~carom.core.layout.workspace`
    """
    position = displacement(rotor, plane, arrival)
    outward = (position.conjugate() * velocity(rotor, plane, arrival)).real
    for i in range(directions.shape[0]):
        flight_increments(rotor, directions[i], duration, work.increments)
        for k in range(arrival.shape[0]):
            directions[i, k] += work.increments[k]
        position_change = displacement(rotor, plane, directions[i]) - rotor.offsets[plane]
        delays[i] = -(position.conjugate() * position_change).real / outward
    shift(rotor, arrival, directions, delays)


@kernel
def shift(rotor, amplitudes, directions, delays):
    """Add to each change what the motion does in its delay, ``ċ δt``."""
    for i in range(directions.shape[0]):
        for k in range(amplitudes.shape[0]):
            rate = rotor.exponents[k] * amplitudes[k]
            if rotor.driven[k]:
                rate += amplitudes[k - 1]
            directions[i, k] += rate * delays[i]
