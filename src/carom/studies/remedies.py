"""Where levitation is the only motion found, and how an advised value was checked, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.studies.wording import counted, listed, number

if TYPE_CHECKING:
    from carom.closed_forms.thresholds import Gain
    from carom.studies.advice import Advice
    from carom.studies.alone import LevitationAlone
    from carom.studies.assembly import Study


def alone_sentences(study: Study, gain: Gain) -> list[str]:
    """Say where along a gain levitation is the only motion found, and on which evidence."""
    say, name = study.wording, study.wording.gain_name(gain)
    found, orbits = study.alone_along(gain), study.range_of("single-impact", gain)
    if found is None or orbits is None:
        return [f"Which {name} would leave only levitation was not determined."]
    met = _met(study, found)
    if not found.spans:
        return [f"No {name} in the range searched leaves only levitation{met}."]
    where = say.where(gain, found.spans, orbits.searched)
    rolling = study.range_of("rolling", gain)
    apart = ", apart from backward whirl," if rolling and rolling.spans else ""
    tried = f"{found.disturbances + found.rim:,} disturbances"
    rests = f"no rub and no orbit with one impact a period exists there{met}"
    simulated = f"simulated at each of {counted(len(found.values), 'value')} of {name} there"
    return [
        f"Levitation is the only motion found{apart} {where}: {rests}.",
        f"{tried} of up to {say.velocity(found.fastest)} were {simulated}: {_came_back(study, found)}.",
    ]


def _met(study: Study, found: LevitationAlone) -> str:
    """Say which other motions were found beyond the ends of the ranges."""
    say = study.wording
    ends = {(edge.motion, edge.value) for span in found.spans for edge in (span.low, span.high) if edge.motion}
    parts = [f"{motion.words} was met beyond {say.gain(found.gain, value)}" for motion, value in sorted(ends)]
    return f" ({listed(parts)}, where neither orbit nor rub is known)" if parts else ""


def _came_back(study: Study, found: LevitationAlone) -> str:
    if not found.whirl:
        return "all came back"
    if not found.without_whirl:
        return "some got into backward whirl, at every value; all others came back"
    whirl = study.wording.where(found.gain, found.whirl, None)
    return f"some got into backward whirl ({whirl}), all others came back"


def check_words(study: Study, advice: Advice) -> str:
    """Say how an advised value was checked: number and largest speed of the fresh disturbances, how many came back."""
    returned = advice.returned
    sample = f"{number(returned.total, 6)} fresh disturbances of up to {study.wording.velocity(advice.fastest)}"
    if returned.count == returned.total:
        return f"all of {sample} came back (so at least {number(100.0 * returned.low, 4)} % do, with 95 % confidence)"
    low, high = (number(100.0 * share, 4) for share in (returned.low, returned.high))
    return f"{number(returned.count, 6)} of {sample} came back ({low} to {high} % do, with 95 % confidence)"
