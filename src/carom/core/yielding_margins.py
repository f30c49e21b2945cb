"""How far contact in walls that give way is from a change of an orbit's word."""

from __future__ import annotations

import numpy as np

from carom.compiling.decorators import inlined, kernel
from carom.core.compliance import next_form
from carom.core.contact_series import rub_series
from carom.core.flow import copy
from carom.core.friction import BACKWARD, FORWARD, spare_grip
from carom.core.laws.choice import press_coefficient
from carom.core.layout import ORDER
from carom.core.margins import least_inside
from carom.core.phases import AWAY, ROLLING, sense_of_phase
from carom.core.segments import FREE, ROLL, in_wall, phase_of
from carom.core.taylor import margin_step, series_step, sum_series
from carom.core.wall import wall_of


@kernel
def margins_in_walls(rotor, kinds, planes, nodes, durations, rub):
    """Least distances of the segments in walls that give way from a change of the word.

    Parameters
    ----------
    rotor, kinds, planes, nodes, durations
        As for :func:`~carom.core.margins.least_margins`.
    rub : record of :func:`~carom.core.layout.rub_workspace`

    Returns
    -------
    tuple of float
        Radial speed of arrivals; normal force where it is least and the same sliding goes on; distance from the limits of friction where rolling begins, while it lasts, and where the slip passes
        through zero; slip at its minima while sliding; and normal force at its minima, or of a plane that has parted from its wall the
        force of the wall's spring at the least depth, and the pull by which it stays off.  Infinite where there is none of the kind.
    """
    approach, least, cone, slip, push = np.inf, np.inf, np.inf, np.inf, np.inf
    state, contact = np.empty(nodes.shape[1], np.complex128), np.empty(rotor.rows.shape[0], np.int64)
    for i in range(kinds.shape[0]):
        if not in_wall(rotor, kinds[i], planes[i]):
            continue
        plane, wall = planes[i], wall_of(rotor, planes[i])
        contact[:] = AWAY
        copy(nodes[i], state)
        entered = not in_wall(rotor, kinds[i - 1], planes[i - 1])
        turned = kinds[i] != kinds[i - 1] and kinds[i] != FREE and kinds[i - 1] != FREE and kinds[i - 1] != ROLL
        if not entered and turned:
            cone = min(cone, _cone_at_start(rotor, contact, plane, kinds[i], state, wall, rub))
        contact[plane] = phase_of(kinds[i])
        sense, elapsed, first = sense_of_phase(contact[plane]), 0.0, True
        while elapsed < durations[i]:
            rub_series(rotor, contact, state, rub)
            if first and entered:
                approach = min(approach, rub.rate[plane, 0])
            elif first and kinds[i] == kinds[i - 1]:
                least = min(least, rub.push[plane, 0])
            first = False
            largest = min(series_step(rub), margin_step(rub.depth[plane]))
            step = next_form(rotor, plane, min(largest, durations[i] - elapsed), rub)
            if not step > 0.0:
                return np.nan, np.nan, np.nan, np.nan, np.nan
            if kinds[i] == FREE:
                push = min(push, wall.stiffness * least_inside(rub.depth[plane], step))
                for k in range(ORDER + 1):
                    rub.first_margin[k] = -press_coefficient(k, rub.depth[plane], rub.rate[plane], wall)
                push = min(push, least_inside(rub.first_margin, step))
            else:
                push = min(push, least_inside(rub.push[plane], step))
                for k in range(ORDER + 1):
                    rub.first_margin[k] = sense * rub.slip[plane, k]
                if kinds[i] == ROLL:
                    cone = min(cone, _least_spare(plane, step, wall, rub))
                elif wall.friction > 0.0:
                    slip = min(slip, least_inside(rub.first_margin, step))
            sum_series(rub, step, state)
            elapsed = durations[i] if step == durations[i] - elapsed else elapsed + step
    return approach, least, cone, slip, push


@inlined
def _cone_at_start(rotor, contact, plane, kind, state, wall, rub):
    """Distance from the limits of friction where rolling begins, or beyond them where the slip passes through zero."""
    contact[plane] = ROLLING
    rub_series(rotor, contact, state, rub)
    push, grip = rub.push[plane, 0], rub.grip[plane, 0]
    if kind == ROLL:
        return min(spare_grip(push, grip, FORWARD, wall), spare_grip(push, grip, BACKWARD, wall))
    return -spare_grip(push, grip, sense_of_phase(phase_of(kind)), wall)


@inlined
def _least_spare(plane, step, wall, rub):
    """Least distance from the limits of friction at its minima inside a step of rolling."""
    for k in range(ORDER + 1):
        rub.first_margin[k] = spare_grip(rub.push[plane, k], rub.grip[plane, k], BACKWARD, wall)
        rub.second_margin[k] = spare_grip(rub.push[plane, k], rub.grip[plane, k], FORWARD, wall)
    return min(least_inside(rub.first_margin, step), least_inside(rub.second_margin, step))
