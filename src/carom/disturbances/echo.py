"""What was done to a rotor, in a sentence: sizes in the units of people, velocities in the fixed frame."""

from __future__ import annotations

import cmath
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.base.results import in_si
from carom.disturbances.plans import Grid, Plan
from carom.parameters import MACHINE_FIELDS, Scales
from carom.parameters.formats import format_angle, format_quantity, number

if TYPE_CHECKING:
    from carom.disturbances.single import Single
    from carom.models import Rotor
    from carom.motions.starts import State
    from carom.parameters import Gravity

_NAMES = {
    "kick": "velocity kicks out of levitation",
    "kick-plane": "velocity kicks out of levitation",
    "shock": "half-sine shocks of the base",
    "blade-loss": "losses of a blade at levitation",
    "release": "releases from the wall",
    "slice": "positions at one velocity",
    "state": "positions and velocities",
}


ANY_INSTANT = "at any instant of the turn"
ITS_INSTANT = "at an instant of its own"


@dataclass(frozen=True)
class Echo:
    """One disturbance as it was taken.

    Attributes
    ----------
    kind : {"kick", "shock", "blade-loss", "start", "drop", "unbalance"}
    words : str
        Such as ``"Kick: 60 mm/s at 30°"``, and from where its angles count.
    sizes : mapping of str to (float, str)
        Each size in units of the equations, with its property of :class:`~carom.parameters.Scales`; empty for angles.
    """

    kind: str
    words: str
    sizes: Mapping[str, tuple[float, str]]

    def document(self, scales: Scales | None) -> dict[str, Any]:
        """Return it as plain data, with sizes in SI units too where the scales are known."""
        document: dict[str, Any] = {"kind": self.kind, "words": self.words}
        for name, (value, scale) in self.sizes.items():
            document[name] = value
            if scale:
                document |= in_si(document, scales, **{name: scale})
        return document


def angles_words(phase: float, when: str = "") -> str:
    """From where angles count: the real axis of the co-rotating frame, from which the phase of the unbalance counts too."""
    return f"angles count from the x axis that turns with the shaft{when}, in the sense of rotation (the unbalance lies at {format_angle(phase)})"


def echo_of(single: Single, rotor: Rotor) -> Echo:
    """A single disturbance of a rotor as it was taken: its kind, its sizes, and from where its angles count."""
    told_by = {"kick": _echo_of_kick, "shock": _echo_of_shock, "blade-loss": _echo_of_blade_loss}
    found = told_by.get(single.model.kind, _echo_of_any)(single, rotor)
    return echo_at(found, rotor, single.instant)


def _echo_of_any(single: Single, rotor: Rotor) -> Echo:
    axes = single.model.coordinates
    sizes = {each.name: (value, each.scale) for each, value in zip(axes, single.values, strict=True)}
    told_sizes = (
        f"{each.words} {format_quantity(value, each.scale, rotor.scales) if each.scale else format_angle(value)}"
        for each, value in zip(axes, single.values, strict=True)
    )
    return Echo(single.model.kind, f"Disturbance, {single.model.kind}: {', '.join(told_sizes)}", sizes)


def _echo_of_kick(single: Single, rotor: Rotor) -> Echo:
    speed, angle = single.values
    words = f"Kick: {format_quantity(speed, 'velocity', rotor.scales)} at {format_angle(angle)}; {angles_words(rotor.unbalance_phase)}"
    return Echo("kick", words, {"speed": (speed, "velocity"), "angle": (angle, "")})


def echo_at(echo: Echo, rotor: Rotor, instant: float) -> Echo:
    """The same, with the instant of the turn where that matters."""
    if not rotor.depends_on_instant:
        return echo
    words = f"{echo.words}; the shaft has turned by {format_angle(instant)} since the x axis that turns with it passed that of the room"
    return replace(echo, words=words, sizes={**echo.sizes, "instant": (instant, "")})


def _echo_of_shock(single: Single, rotor: Rotor) -> Echo:
    """A half-sine shock of the base, with which the motion begins."""
    (peak, angle), duration = single.values, float(single.model.describe()["duration"])  # type: ignore[arg-type]
    scales = rotor.scales
    size = f"{format_quantity(peak, 'acceleration', scales)} for {format_quantity(duration, 'time', scales)} at {format_angle(angle)}"
    words = (
        f"Shock of the base: half-sine, {size}; {angles_words(rotor.unbalance_phase, ', as it lies when the shock begins')}; "
        "times count from then"
    )
    sizes = {"peak": (peak, "acceleration"), "duration": (duration, "time"), "angle": (angle, "")}
    return Echo("shock", words, sizes)


def _echo_of_blade_loss(single: Single, rotor: Rotor) -> Echo:
    """A loss of a blade at a phase relative to the unbalance before, whose eccentricity is told for rotors with one unbalance alone."""
    loss: Any = single.model
    (phase,), scales = single.values, rotor.scales
    before = None if rotor.numbers is None else rotor.value("rho")
    kind, noun = ("unbalance", "unbalance") if scales else ("length", "eccentricity")
    where = "" if loss.node is None else f" at node {loss.node}"
    words = (
        f"Loss of a blade: the {noun}{where} changes by {format_quantity(loss.change, kind, scales)} at {format_angle(phase)} from that before it, "
        "in the sense of rotation"
    )
    sizes = {"change": (loss.change, kind), "phase": (phase, "")}
    if before is not None:
        after = before + cmath.rect(loss.change, phase)
        words += f": from {format_quantity(before, kind, scales)} to {format_quantity(abs(after), kind, scales)}, turned by {format_angle(cmath.phase(after))}"
        sizes |= {"before": (before, kind), "after": (abs(after), kind)}
    return Echo("blade-loss", words, sizes)


def echo_of_unbalance(eccentricity: float, interval: tuple[float, float], scales: Scales) -> Echo:
    """The unbalance at every speed of a range, by the eccentricity in clearances and speeds in rad/s."""
    shown = MACHINE_FIELDS["speed"]
    low, high = (f"{number(shown.in_usual_unit(speed), 6)} {shown.usual_unit}" for speed in interval)
    words = f"Unbalance: {format_quantity(eccentricity, 'unbalance', scales)}, eccentricity {format_quantity(eccentricity, 'length', scales)}, at speeds from {low} to {high}"
    sizes = {"unbalance": (eccentricity, "unbalance"), "eccentricity": (eccentricity, "length")}
    ends = zip(("lowest_speed", "highest_speed"), interval, strict=True)
    return Echo("unbalance", words, {**sizes, **{name: (speed / scales.speed, "speed") for name, speed in ends}})


def echo_of_drop(
    state: State,
    phase: float,
    regained: float | None,
    gravity: Gravity,
    scales: Scales,
    race_speed: float | None = None,
    planes: Sequence[tuple[complex, complex]] = (),
) -> Echo:
    """Levitation lost at a state, with the phase of the unbalance and a given speed of the race at the release.

    Of a rotor in several touchdown bearings ``planes`` are displacement and rate at each: its coordinates are no places.
    """
    begun = _moving_in_planes(planes, scales) if len(planes) > 1 else _moving(state, scales)
    back = f"; levitation returns after {format_quantity(regained, 'time', scales)}" if regained is not None else ""
    if race_speed is not None:
        shown = MACHINE_FIELDS["speed"]
        turning = number(shown.in_usual_unit(race_speed * scales.speed), 6)
        back = f"; the race turns at {turning} {shown.usual_unit}{back}"
    words = (
        f"Release: {'' if len(planes) > 1 else 'rotor centre '}{begun.words}, under {gravity.words}; angles count from the fixed x axis in the "
        f"sense of rotation (unbalance at the release: {format_angle(phase)}){back}"
    )
    sizes = {**begun.sizes, "unbalance_angle": (phase, "")}
    given = {"regained_after": (regained, "time"), "race_speed": (race_speed, "speed")}
    sizes |= {name: (value, kind) for name, (value, kind) in given.items() if value is not None}
    return Echo("drop", words, sizes)


def echo_of_start(state: State, phase: float, scales: Scales | None) -> Echo:
    """A start of the planar rotor at any state."""
    begun = _moving(state, scales)
    words = f"Start: {begun.words}; {angles_words(phase, ', as it lies at the start')}"
    return Echo("start", words, begun.sizes)


def _moving(state: State, scales: Scales | None) -> Echo:
    """A state of the planar rotor, its velocity in the fixed frame."""
    # On a mount the rotor is the first of two coordinates.
    place, rate = (complex(np.ravel(part)[0]) for part in (state.position, state.velocity))
    return _moving_at(place, rate, scales)


def _moving_in_planes(planes: Sequence[tuple[complex, complex]], scales: Scales | None) -> Echo:
    """Displacement and rate at several touchdown bearings, which are counted from 1."""
    found = [_moving_at(place, rate, scales) for place, rate in planes]
    words = "; ".join(f"at touchdown bearing {number} {each.words}" for number, each in enumerate(found, 1))
    sizes = {f"{name}_{number}": size for number, each in enumerate(found, 1) for name, size in each.sizes.items()}
    return Echo("start", words, sizes)


def _moving_at(place: complex, rate: complex, scales: Scales | None) -> Echo:
    """A displacement and its rate in the frame that turns with the shaft; the velocity is told in the fixed frame."""
    speed = rate + 1j * place
    at = f"{format_quantity(abs(place), 'length', scales)} from the middle at {format_angle(cmath.phase(place))}"
    moves = f"moving at {format_quantity(abs(speed), 'velocity', scales)} towards {format_angle(cmath.phase(speed))} in the fixed frame"
    return Echo(
        "start",
        f"{at}, {moves}",
        {
            "radius": (abs(place), "length"),
            "angle": (cmath.phase(place), ""),
            "speed": (abs(speed), "velocity"),
            "direction": (cmath.phase(speed), ""),
        },
    )


def instants_words(rotor: Rotor, plan: Plan | None = None) -> str:
    """At which instants of the turn disturbances come, where these matter, of a plan or of any sample; else nothing."""
    if not rotor.depends_on_instant:
        return ""
    if isinstance(plan, Grid) and plan.instant is not None:
        return f"at the instant at which the shaft has turned by {format_angle(plan.instant)}"
    return ANY_INSTANT


def plan_words(
    plan: Plan, before: float | None, scales: Scales | None, *, drawn: str | None = None, at: str = ""
) -> str:
    """Say which disturbances a plan tries on a machine with an eccentricity ``before`` them, in clearances, if there is one.

    ``drawn`` says how a sample is drawn where its own seed does not count, ``at`` at which instants they come.
    """
    model = plan.model
    if isinstance(plan, Grid):
        how = f"a grid of {' x '.join(map(str, plan.shape))}"
    else:
        how = drawn or f"a sample (seed {plan.seed})"
    parts = [f"{plan.count} {_NAMES.get(model.kind, model.noun)}", how]
    if at:
        parts[0] += f", {f'each {ITS_INSTANT}' if at == ANY_INSTANT else at}"
    if model.size is not None:
        size = model.size
        parts.append(f"{size.words} up to {_both(size.high, size.scale, scales)}")
    given = model.describe()
    if model.kind == "blade-loss":
        node = "" if given["node"] is None else f" at node {given['node']}"
        parts.append(f"{model.coordinates[0].words}: all around")
        start = "" if before is None else f" from {told_eccentricity(before, scales)}"
        change = told_eccentricity(float(str(given["change"])), scales)
        return f"{', '.join(parts)}; eccentricity{node} changes{start} by {change}"
    if model.kind == "shock":
        parts[-1] += f" for {format_quantity(float(str(given['duration'])), 'time', scales)}"
    return ", ".join(parts)


def _both(value: float, kind: str, scales: Scales | None) -> str:
    own = format_quantity(value, kind, None, 4)
    return own if scales is None else f"{format_quantity(value, kind, scales, 4)} ({own})"


def told_eccentricity(value: float, scales: Scales | None) -> str:
    """Write an eccentricity given in clearances, with the unbalance that it is if the mass is known."""
    own = format_quantity(value, "length", None, 5)
    if scales is None:
        return own
    return f"{format_quantity(value, 'length', scales, 5)} ({own}, {format_quantity(value, 'unbalance', scales, 5)})"
