"""A spin-down to standstill in words, rows and as JSON."""

from __future__ import annotations

import math
from collections.abc import Iterator

from carom.base.outcome import InputError
from carom.base.results import record
from carom.disturbances import drop
from carom.motions import SpinDown, spin_down
from carom.parameters import Case
from carom.parameters.formats import number
from carom.studies.questions import Fact
from carom.studies.wording import Wording

STEPS = 50
"""Steps of speed of a spin-down in a study."""
SPIN_DOWN = (
    "stands time: turns speed_at_end:speed braked:energy steps error energy_into_bearings:energy criticals:speed"
)


def spin_down_of(case: Case) -> SpinDown | None:
    """Levitation lost, followed until the shaft stands; ``None`` of a machine that cannot fall, or whose file has no table ``[drive]``."""
    if case.drive is None:
        return None
    try:
        return spin_down(case, drop(), steps=STEPS)
    except InputError:
        return None


def spin_down_facts(slowed: SpinDown | None) -> Iterator[Fact]:
    """All of a spin-down as one list: time and turns, energies, the largest whirl with its speed, what is passed, and the error."""
    if slowed is not None:
        yield Fact("Spin-down", standstill_words(slowed), evidence="sampled", values=spin_down_entries(slowed))
        rows = "; ".join(f"{label}: {words}" for label, words in spin_down_rows(slowed))
        yield Fact("Spin-down", f"{rows[0].upper()}{rows[1:]}.")


def standstill_words(slowed: SpinDown) -> str:
    """When the shaft stands, or what was not reached."""
    say = Wording(slowed.scales)
    turns = number(slowed.turns, 4)
    if slowed.stands:
        return f"The shaft stands {say.time(slowed.time)} after the release, after {turns} turns."
    left = say.time(slowed.remaining) if math.isfinite(slowed.remaining) else ""
    more = (
        f"; it would stand {left} later if it slowed down as it did last"
        if left
        else "; it does not slow down any more"
    )
    why = slowed.loads.outcome.words
    return f"Standstill not reached: {say.write(slowed.speed_at_end, 'speed')} after {say.time(slowed.time)} and {turns} turns ({why}){more}."


def spin_down_rows(slowed: SpinDown) -> list[tuple[str, str]]:
    """What is said of a spin-down beside loads: energies, the largest whirl, and speeds that are passed."""
    say, planes = Wording(slowed.scales), slowed.loads.planes
    names = [f" {each.plane + 1}" if len(planes) > 1 else "" for each in planes]
    rows = [
        (f"energy into bearing{name}", say.write(energy, "energy"))
        for name, energy in zip(names, slowed.energy_into_bearings, strict=True)
    ]
    rows.append(("windage, drag, drive", f"{say.write(slowed.braked, 'energy')} taken from the shaft"))
    for name, plane, (radius, speed) in zip(names, planes, slowed.largest, strict=True):
        size = f"{Wording(plane.scales).length(radius)} 0-to-peak in the fixed frame"
        share = f"{number(radius, 3)} of the clearance, " if plane.scales else ""
        rows.append((f"largest whirl{name}", f"{size}, {share}at {say.write(speed, 'speed')}"))
    if slowed.criticals:
        passed = ", ".join(say.write(each, "speed") for each in slowed.criticals)
        rows.append(("critical speeds", f"of the free rotor, passed on the way down: {passed}"))
    estimated = (
        "none by steps of speed"
        if slowed.error is None
        else f"estimated {number(100.0 * slowed.error, 2)} % of time, turns and energy by {slowed.steps} steps of speed"
    )
    torque, speed, energy = slowed.unbalance_torque
    if torque and slowed.scales:
        size = f"up to {number(abs(torque) * slowed.scales.energy, 3)} N m in the mean of a step, at {say.write(speed, 'speed')}"
        rows.append(("torque of unbalance", f"left out: {size}; it would take {say.write(energy, 'energy')} in all"))
    return [*rows, ("error", f"{estimated}; left out: rolling resistance")]


def spin_down_entries(slowed: SpinDown) -> dict[str, object]:
    """A spin-down as JSON."""
    radii = (f"largest_radius_{place + 1}" for place in range(len(slowed.loads.planes)))
    course = ("time", "speed", *radii, "unbalance_torque")
    return {
        **record(slowed, SPIN_DOWN, slowed.scales),
        "largest_whirl": [
            {"radius": radius, "radius_si": plane.scales and radius * plane.scales.length, "speed": speed}
            for plane, (radius, speed) in zip(slowed.loads.planes, slowed.largest, strict=True)
        ],
        "course": {name: values.tolist() for name, values in zip(course, slowed.course.T, strict=True)},
    }
