"""Unbalance response over the speed of the shaft, with contact where the rotor touches, and what it says about the machine, in sentences."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import groupby

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import STEADY_WORDS, InputError
from carom.base.results import Column
from carom.closed_forms import contact_changes, find_equilibria, rolling, rub_angles
from carom.closed_forms.exact_results import exact_results
from carom.models import Axis, Rotor, Subject, axis, case_of, rotor_of
from carom.models.axes import Ends, read_interval
from carom.parameters import read_quantity
from carom.parameters.formats import number
from carom.studies.critical_speeds import FULL_SPEED, response_curve, usual_range, vibration_limit
from carom.studies.levitating import WHIRLS, whirls_of
from carom.studies.recovery import changes
from carom.studies.response_data import Rubs, SpeedStretch, Steady, UnbalanceResponse, stretches_between
from carom.studies.wording import listed, micrometres, rpm

RUB = STEADY_WORDS["rub"]
_WHY_NO_RUBS = "they are found only with one touchdown bearing, at constant speed and without weight; carom attractors finds the motions in which disturbances end."
RUB_SPEEDS = 121
"""About as many speeds of the curve at which rubs are looked for."""
NARROWED = 1e-6
"""Relative width to which ends of stretches without a closed form are bisected."""


def _rubs_of(stretch: SpeedStretch, _: object) -> str:
    kinds = {"stable": stretch.what.stable_rubs, "unstable": stretch.what.unstable_rubs}
    found = ", ".join(f"{count} {kind}" for kind, count in kinds.items() if count) or "none"
    return "not known" if stretch.what.stable_rubs is None else found


def _rolls(stretch: SpeedStretch, _: object) -> str:
    rolls = stretch.what.rolls
    return "not known" if rolls is None else "holds" if rolls else "does not hold"


STRETCH = (
    Column("", "from", lambda stretch, _: rpm(stretch.low)),
    Column("", "to", lambda stretch, _: rpm(stretch.high)),
    Column("", STEADY_WORDS["contact-free"], lambda each, _: "possible" if each.what.contact_free else "it touches"),
    Column("", f"{RUB}s", _rubs_of),
    Column("", STEADY_WORDS["rolling"], _rolls),
)
"""Of each range of speeds the steady motions."""
BEARING = (
    Column("", "touchdown bearing", lambda at, _: str(at + 1)),
    Column("", "amplitude, 0-to-peak", lambda at, found: micrometres(float(found.now.touchdowns.major[0, at]))),
    Column("", "forward", lambda at, found: micrometres(float(np.abs(found.now.touchdowns.forward[0, at])))),
    Column("", "backward", lambda at, found: micrometres(float(np.abs(found.now.touchdowns.backward[0, at])))),
    Column("", "sag", lambda at, found: micrometres(float(found.now.sags[at]))),
    Column("", "share of clearance", lambda at, found: f"{number(100.0 * float(found.now.reach[0, at]), 3)} %"),
    Column("", "lag", lambda at, found: f"{number(float(np.degrees(found.lags_of(found.now)[at])), 3)}°"),
)
"""Of each touchdown bearing, by its place, the whirl at the present speed."""


def sentences(response: UnbalanceResponse) -> tuple[str, ...]:
    """Present speed, critical speeds with their separation, limits, and where the rotor touches."""
    peaks = [f"Critical speed: {each.words}" for each in response.criticals]
    none = f"The response has no peak between {rpm(response.interval[0])} and {rpm(response.interval[1])}."
    found = [_present(response), *(peaks or [none]), _limit(response), _saturation(response), *_contact(response)]
    return tuple(sentence for sentence in found if sentence)


def _present(response: UnbalanceResponse) -> str:
    speed, now, worst = response.present, response.now, response.worst
    sizes, allowed = now.touchdowns.major[0], float(vibration_limit(np.array(speed)))
    width, several = 2.0 * float(sizes[worst]), len(sizes) > 1
    where = f" at touchdown bearing {worst + 1}" if several else ""
    sagging = (
        f" and a static sag of {micrometres(float(now.sags[worst]))}"
        if now.sags[worst] > 1e-9 * now.clearances[worst]
        else ""
    )
    if not response.steady_at_present.contact_free:
        return (
            f"At {rpm(speed)}, the present speed, the unbalance would need a contact-free whirl of {micrometres(width)} peak to "
            f"peak{where}{sagging}; the clearance allows {micrometres(2.0 * float(now.clearances[worst]))}: the rotor touches."
        )
    over, lag = width / allowed, response.lags_of(now)[worst]
    ratio = f", exceeded by a factor of {number(over, 3)}" if over > 1.0 else ""
    return (
        f"At {rpm(speed)}, the present speed, the rotor whirls without contact at {micrometres(width)} peak to peak{where}{sagging} "
        f"({number(float(now.reach[0, worst]), 3)} of the clearance: zone {response.zone_at(speed)} of ISO 14839-2), "
        f"{number(float(np.degrees(lag)), 3)}° behind the unbalance. API 617 allows {micrometres(allowed)} there{ratio}."
    )


def _limit(response: UnbalanceResponse) -> str:
    over = [stretch for stretch in response.exceeds_api_617 if stretch.what]
    return f"The API 617 vibration limit is {f'exceeded {_from_to(over)}' if over else 'not exceeded in this range'}."


def _saturation(response: UnbalanceResponse) -> str:
    asking = response.saturating
    if not asking:
        return ""
    over = [stretch for stretch in asking if stretch.what]
    if over:
        return f"The magnetic bearings saturate {_from_to(over)}: the response calculated there does not apply."
    most = float(response.whirl.saturation.max())
    return (
        f"The magnetic bearings do not saturate in this range: at most {number(100.0 * most, 3)} % of a limit is used."
    )


def _contact(response: UnbalanceResponse) -> list[str]:
    """Where it touches, and which motions in contact are possible."""
    said: dict[str, Callable[..., object]] = {
        "Levitation is impossible {}: the response calculated there exceeds the clearance.": lambda free, *_: not free,
        f"In contact, a stable {RUB} can hold the rotor {{}}.": lambda free, stable, *_: not free and stable,
        f"In contact, no stable {RUB} exists {{}}: the rotor bounces or whirls backward.": lambda free, stable, *_: (
            not free and stable == 0
        ),
        f"Levitation and a stable {RUB} are both possible {{}}: which of them occurs depends on the history of the motion.": lambda free, stable, *_: (
            free and stable
        ),
        f"Once begun, {STEADY_WORDS['rolling']} persists {{}}.": lambda *steady: steady[-1],
    }
    found = []
    for text, holds in said.items():
        parts = groupby(response.stretches, lambda each, holds=holds: bool(holds(*each.what)))  # type: ignore[misc]
        joined = [[*part] for there, part in parts if there]
        if joined:
            found.append(text.format(_from_to([each[0]._replace(high=each[-1].high) for each in joined])))
    if all(each.what.contact_free for each in response.stretches):
        found.insert(0, "Without a disturbance the rotor does not touch anywhere in this range.")
    if response.rubs is None:
        found.append(f"{RUB.capitalize()}s are not included: {_WHY_NO_RUBS}")
    elif not response.exact:
        found.append(f"{RUB.capitalize()}s were searched at {len(response.rubs.speeds)} speeds; rolling was not.")
    return [*found, "Bouncing is not included: carom bifurcations --along speed finds it."]


def _from_to(stretches: list[SpeedStretch]) -> str:
    """Ranges of speeds in words."""
    return listed([f"from {rpm(each.low)} to {rpm(each.high)}" for each in stretches])


@checked
def unbalance_response(
    machine: Subject, interval: Ends | None = None, *, operating: Ends | None = None
) -> UnbalanceResponse:
    """Response to the unbalance over the speed of the shaft, with contact where the rotor touches.

    The contact-free response is linear (:func:`~carom.rotors.synchronous_response`).  Where it would leave the clearance it is virtual, and the rotor runs in contact.  The synchronous rubs in one
    touchdown bearing are given with their stability; bouncing is not, see :func:`~carom.find_bifurcations` along ``"speed"``.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        Any rotor with mass, clearance and speed.  Mass, damping, stiffness and unbalance stay the same in SI units at every speed.
    interval : tuple of float or str, optional
        Range of speeds in rad/s, or text such as ``("500 rpm", "12000 rpm")``.
    operating : tuple of float or str, optional
        Lowest and highest operating speed, for the separation margin; by default the present speed.

    Raises
    ------
    InputError
        A rotor without scales, or a range that cannot be read.

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> response = cm.studies.unbalance_response(machine, ("500 rpm", "4000 rpm"))
    >>> round(response.criticals[0].factor, 3)
    4.797
    """
    case = case_of(machine)
    model = rotor_of(case)
    if model.scales is None:
        allowed = "needed for a response over speed: use a file with a [machine] table, or parameters with scales"
        raise InputError("scales", None, allowed)
    along, present, whirls = axis(case, "speed"), model.scales.speed, whirls_of(model, 4 * WHIRLS)
    ends = [read_quantity(along.field, end) for end in operating or (present, present)]
    run = min(ends), max(ends)
    low, high = read_interval(along, interval or usual_range(model, whirls, run))
    whirl, criticals = response_curve(case, whirls, (low, high), run, (low, high, present, FULL_SPEED))
    found = UnbalanceResponse(case, whirl, (low, high), run, criticals, exact_results(model).rubs)
    found = replace(found, rubs=_rubs(found, model, along))
    found = replace(found, stretches=_stretches(found, model, along))
    return replace(found, words=sentences(found))


def _rubs(found: UnbalanceResponse, model: Rotor, along: Axis) -> Rubs | None:
    """Synchronous rubs over the speed in one touchdown bearing, where nothing stands in the fixed frame."""
    system = model.system
    if found.exact:
        angles = rub_angles(found.case, found.speeds)
        return Rubs(found.speeds, -angles % math.tau, np.where(np.isnan(angles), np.nan, 1.0))
    if len(system.contacts) > 1 or system.outer.any() or system.is_anisotropic or system.shaft is not None:
        return None
    speeds = found.speeds[:: max(1, len(found.speeds) // RUB_SPEEDS)]
    lags, radii = np.full((2, 2, len(speeds)), np.nan)
    for place, speed in enumerate(speeds.tolist()):
        moved = along.move(model, speed)
        for rub in find_equilibria(moved).members[1:]:
            if rub.status == "admissible":
                which = 0 if rub.stable else 1
                lags[which, place] = (moved.unbalance_phase - rub.angle) % math.tau
                radii[which, place] = rub.radius
    return Rubs(speeds, lags, radii)


def _stretches(found: UnbalanceResponse, model: Rotor, along: Axis) -> tuple[SpeedStretch, ...]:
    """Ranges of speeds with the same steady motions; their ends are exact, or bisected between the speeds at which rubs were looked for."""

    def steady(speed: float) -> Steady:
        clear = bool(found.at(speed).reach.max() < 1.0)
        if found.rubs is None:
            return Steady(clear, None, None, None)
        moved = along.move(model, speed)
        pushed = [rub.stable for rub in find_equilibria(moved).members[1:] if rub.status == "admissible"]
        rolls = rolling(moved).holds if found.exact and moved.has_closed_forms else None
        return Steady(clear, sum(pushed), len(pushed) - sum(pushed), rolls)

    if found.exact:
        return stretches_between(found.interval, contact_changes(found.case), steady)
    edges = found.reaching(1.0)
    if found.rubs is not None:
        pairs = changes(found.rubs.speeds.tolist(), lambda speed: steady(speed)[1:], NARROWED)
        edges += [0.5 * (low + high) for low, high in pairs]
    return stretches_between(found.interval, edges, steady)
