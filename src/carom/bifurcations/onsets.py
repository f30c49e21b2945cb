"""Curves in two parameters along which lasting contact begins, or becomes permanent."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Literal

import numpy as np

from carom.bifurcations.lift_offs import DIFFERENCE, LiftOff, end_of_motions, next_lift_off
from carom.bifurcations.planes import EDGE, Plane
from carom.bifurcations.rubbing import RubbingPoint
from carom.continuation import Branch, Steps, continue_branch
from carom.models import Jeffcott
from carom.outcome import CaromError, InputError

ONSETS = ("contact-onset", "permanent-contact")
"""Kinds of ends of branches with lasting contact that can be followed as curves."""
NEARBY = 0.05
"""Largest relative change of the period between these motions and the curve."""
FINEST = 1e-9
"""Accuracy of the points of the curve, in sizes of the parameter."""
STEPS = Steps(first=0.02, largest=0.1, smallest=1e-6, sharpest_turn=0.3, tolerance=1e-9, most_points=300)


def follow_onset(point: RubbingPoint, plane: Plane) -> tuple[np.ndarray, tuple[str, str]]:
    """Follow the onset of lasting contact, or of permanent contact, in the plane of two parameters.

    The equations cease to hold on the curve itself.  So an auxiliary curve next to it is followed, on which the motion
    lands with a small normal force; derivatives are central differences of simulations.  From each of its points the end
    of the motions is searched along one parameter, as on a branch.

    Parameters
    ----------
    point : RubbingPoint
        ``"contact-onset"`` or ``"permanent-contact"`` at the end of a branch along one of the two parameters.

    Returns
    -------
    rows : ndarray, shape (m, 3)
        Place and period along the curve.
    stops : tuple of two str
        Reasons for its ends; ``"other contacts"`` if the sequence of contacts changes there.

    Raises
    ------
    InputError
        Another kind of point, or a plane without the branch's parameter.
    CaromError
        No such motion was found next to the point.
    """
    if point.beside is None:
        raise InputError("kind", f"{point.kind} of {point.name or 'bouncing with rub'}", f"one of: {', '.join(ONSETS)}")
    if point.parameter not in (plane.first, plane.second):
        raise InputError("plane", f"{plane.first},{plane.second}", f"a plane with {point.parameter}")
    base, whirl = point.numbers, point.whirl
    plane.axes(base.parameters)

    def lift_off(angle: float, x: float, y: float) -> LiftOff | None:
        try:
            return next_lift_off(Jeffcott(plane.numbers_at(base, x, y).parameters), whirl, angle)
        except InputError:
            return None

    force, angle, value = point.beside

    def residual(u: np.ndarray, y: float) -> np.ndarray:
        found = lift_off(float(u[0]), float(u[1]), y)
        if found is None or found.whirl != whirl:
            return np.full(2, math.nan)
        return np.array([math.remainder(found.angle - u[0], math.tau), found.landing_force - force])

    start = np.array(plane.place_of(base.moved(point.parameter, value)))
    widths = np.ptp([plane.first_range, plane.second_range], axis=1)
    sizes = np.maximum(np.abs(start), 0.1 * widths)
    beside = continue_branch(
        residual,
        np.array([angle, start[0]]),
        float(start[1]),
        plane.second_range,
        watches=[plane.edge],
        steps=STEPS,
        scales=np.array([1.0, *sizes]),
    )
    rows = _ends(beside, lift_off, plane, sizes)
    if not rows:
        raise CaromError(f"the {point.kind} leaves the plane at once")
    return np.array(rows), (_stop(beside, 0), _stop(beside, -1))


def _ends(
    beside: Branch, lift_off: Callable[[float, float, float], LiftOff | None], plane: Plane, sizes: np.ndarray
) -> list[tuple[float, float, float]]:
    """Place and period at the end of the motions, from each point of the auxiliary curve."""
    rows = []
    for (angle, x), y in zip(beside.unknowns.tolist(), beside.parameters.tolist(), strict=True):
        here = lift_off(angle, x, y)
        if here is None:
            continue

        def follow(angle: float, x: float, y: float, here: LiftOff = here) -> LiftOff | None:
            found = lift_off(angle, x, y)
            if found is None or found.whirl != here.whirl or abs(found.time - here.time) > NEARBY * here.time:
                return None
            return found

        # At an edge of the plane the end is searched along the edge.
        stays = 1 if y in plane.second_range else 0 if _on_edge(x, plane.first_range) else None
        end_angle, place = _end(follow, angle, np.array([x, y]), sizes, stays)
        last = follow(end_angle, *place)
        if last is not None and plane.holds(*place):
            rows.append((*place, last.time))
    return rows


def _end(
    follow: Callable[[float, float, float], LiftOff | None],
    angle: float,
    place: np.ndarray,
    sizes: np.ndarray,
    stays: int | None,
) -> tuple[float, tuple[float, float]]:
    """End of the motions, searched from a motion of small landing force along the parameter with more influence on it.

    A parameter given by ``stays`` is kept, unless the other has almost no influence.
    """

    def at(angle: float, moved: np.ndarray) -> np.ndarray:
        found = follow(angle, float(moved[0]), float(moved[1]))
        if found is None:
            return np.full(2, math.nan)
        return np.array([math.remainder(found.angle - angle, math.tau), found.landing_force])

    by_angle = (at(angle + DIFFERENCE, place) - at(angle - DIFFERENCE, place)) / (2.0 * DIFFERENCE)
    shifts = DIFFERENCE * np.diag(sizes)
    by_place = np.array(
        [(at(angle, place + shift) - at(angle, place - shift)) / (2.0 * DIFFERENCE) for shift in shifts]
    )
    slope = float(by_angle[0])
    leans = -by_place[:, 0] / slope
    falls = by_place[:, 1] + leans * by_angle[1]
    if not np.isfinite(falls).all():
        raise CaromError("the motion beside the onset has no derivative")
    steepest = int(np.argmax(np.abs(falls)))
    if stays is not None and abs(falls[1 - stays]) > 1e-3 * abs(falls[stays]):
        steepest = 1 - stays
    towards = -math.copysign(1.0, falls[steepest]) * sizes * np.eye(2)[steepest]

    def residual(angle: float, share: float) -> float:
        return float(at(angle, place + share * towards)[0])

    lean = -math.copysign(1.0, falls[steepest]) * float(leans[steepest])
    end_angle, share = end_of_motions(residual, (angle, 0.0), lean, 1e-4, slope, FINEST)
    end = place + share * towards
    return end_angle, (float(end[0]), float(end[1]))


def _on_edge(value: float, limits: tuple[float, float]) -> bool:
    return min(abs(value - limit) for limit in limits) < 1e-6 * (limits[1] - limits[0])


def _stop(beside: Branch, end: Literal[0, -1]) -> str:
    reason = beside.stops[end]
    if reason == "parameter limit":
        return EDGE
    return "other contacts" if reason in ("end of domain", "step too small") else reason
