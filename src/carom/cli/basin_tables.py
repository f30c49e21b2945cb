"""Tables of basins and gain maps for the terminal."""

from __future__ import annotations

import math

import numpy as np
from rich.console import Console

from carom.base.outcome import IRREGULAR_BOUNCING, Outcome
from carom.basins import Basin, GainMap, SmallestLoss
from carom.basins.families import has_sizes, size_coordinate
from carom.basins.gains import WANTED
from carom.cli.fitting import fitted, plain_table
from carom.disturbances import Coordinate
from carom.disturbances.echo import plan_words
from carom.parameters import Case, InTerms, Scales, in_terms_of


def print_basin(screen: Console, basin: Basin, smallest: SmallestLoss | None, harmless: float) -> None:
    """Print the disturbances tried, where they end, and the smallest that is lost."""
    screen.print(f"Disturbances: {plan_words(basin.plan, basin.rotor.value('rho'), basin.scales, at=basin.instants)}.")
    drawn = basin.share_recovered.drawn
    numbers = ("starts", "share", *(["95 % interval"] if drawn else []), "known after (median)")
    table = plain_table("", "where they end", *numbers, right=numbers)
    index, times = basin.dataset["motion"].values, basin.dataset["time"].values
    for name in basin.fractions:
        share = basin.share_of(name)
        when = float(np.median(times[index == basin.motions.index(name)]))
        interval = [f"{100 * share.low:.3g} to {100 * share.high:.3g} %"] if drawn else []
        table.add_row(
            name.words, str(share.count), f"{100 * share.fraction:.4g} %", *interval, _time(when, basin.scales)
        )
    screen.print(fitted(screen, table))
    screen.print(
        "Known after: time from the start until it was known where the motion ends, by a proof or by the criterion of that outcome; "
        "the motion need not have arrived there. The table shows the median of the starts with this end."
    )
    screen.print(f"Back to levitation: {basin.share_recovered.words}.")
    if basin.irregular:
        screen.print(f"{IRREGULAR_BOUNCING.capitalize()}: {basin.irregular['survival']}.")
    screen.print(_touching(basin))
    if basin.beyond_model:
        screen.print(
            f"Beyond the model: {basin.beyond_model} of {basin.starts} starts; they count as lost. {Outcome.BEYOND_MODEL.meaning}"
        )
    if basin.unresolved:
        screen.print(f"Given up before it was known where they end: {basin.unresolved} starts; they count as lost.")
    for line in _losses(basin, smallest, harmless):
        screen.print(line)


def print_gains(screen: Console, found: GainMap, case: Case) -> None:
    """Print what a gain map says about the present machine, in the terms of its file."""
    share = found.dataset["recovered"].values
    able = found.dataset["levitates"].values > 0.0
    back, of_what = found.present_share, found.population.words
    names = [axis.name for axis in found.axes]
    here = ", ".join(_value(case, name, value) for name, value in zip(names, found.present, strict=True))
    ends = [found.dataset[name].values[[0, -1]].tolist() for name in names]
    told = [
        (_value(case, name, low), _value(case, name, high, named=False))
        for name, (low, high) in zip(names, ends, strict=True)
    ]
    screen.print(f"Map: {'; '.join(f'{low} to {high}' for low, high in told)}.")
    screen.print(f"Present machine: {here}; {back.words}.")
    shape = " x ".join(str(size) for size in share.shape)
    reach, sure = (int((found.dataset[name].values >= WANTED).sum()) for name in ("recovered", "recovered_low"))
    varied = " and ".join(
        _stated(case, name, value).entry.replace("_", " ") for name, value in zip(names, found.present, strict=True)
    )
    shown = f" ({back.total} drawn at each), shown with 95 % confidence for {sure or 'none'}" if back.drawn else ""
    screen.print(
        f"Of {shape} machines with other {varied}, {reach} of {share.size} bring back at least "
        f"{100 * WANTED:g} % of {of_what}{shown}; {100 * (1 - able.mean()):.3g} % cannot levitate."
    )


def _touching(basin: Basin) -> str:
    """Say how many disturbances touched the wall, and how many of these came back."""
    met, back = int(basin.touched.sum()), int((basin.touched & basin.recovered).sum())
    if not met:
        return f"None of the {basin.starts} touched the wall."
    return f"Touched the wall: {met} of {basin.starts}; of these {back or 'none'} came back."


_LOSSES = {
    "kick": "kick",
    "shock": "shock of this duration",
    "blade-loss": "change of the unbalance by a loss of a blade",
}


def _losses(basin: Basin, smallest: SmallestLoss | None, harmless: float) -> list[str]:
    """Say from which size on disturbances are lost, if they have a size."""
    if not has_sizes(basin.plan.model):
        return []
    if smallest is None or harmless <= 0.0:
        system = basin.rotor.system
        if system.rest_radius < 1.0 and system.decay > 0.0:
            return [
                "No size is known up to which disturbances are harmless, so the smallest that is lost is not searched."
            ]
        return ["The rotor has no stable levitation inside the wall: no disturbance is proven harmless."]
    size = size_coordinate(basin.plan.model)

    def shown(value: float) -> str:
        return _size(size, value, basin.scales, 5)

    noun = _LOSSES[smallest.kind]
    lines = []
    if smallest.size is not None:
        ending = f"; {_ending(basin, smallest.outcome)}" if smallest.outcome else ""
        where = _where(basin, smallest)
        lines.append(
            f"Smallest {noun} found that does not come back: {shown(smallest.size)}, {where}{ending}{smallest.sensitivity and f'; {smallest.sensitivity}'}."
        )
    if smallest.all_back is None:
        lines.append("Disturbances of size zero are already lost.")
    elif smallest.fresh:
        said = (
            "lies between these two sizes"
            if smallest.size is not None
            else f"is larger than the largest tried, {shown(smallest.largest)}"
        )
        beyond = " beyond the proven size and" if smallest.harmless > 0.0 else ""
        lines.append(
            f"Up to {shown(smallest.all_back)} all that were tried came back, {smallest.fresh} of them fresh: with 95 % confidence "
            f"fewer than {100.0 * smallest.share_below:.2g} % of those{beyond} up to that size are lost. As far as {smallest.tried} trials "
            f"tell, the smallest that is lost{' in any direction, at any instant of the turn,' if basin.instants else ''} {said}."
        )
    elif smallest.size is not None:
        lines.append(
            f"Fresh trials kept finding smaller ones ({smallest.tried} trials in all): it is not the smallest."
        )
    if smallest.harmless > 0.0:
        proven = "provably never bring the rotor to the wall, in any direction"
        lines.append(f"Only those up to {shown(smallest.harmless)} {proven}.")
    return lines


def _where(basin: Basin, smallest: SmallestLoss) -> str:
    """Describe the direction of the smallest lost disturbance."""
    angle = smallest.angle or 0.0
    if smallest.kind == "blade-loss":
        return f"at {math.degrees(angle):+.0f} deg from the unbalance before it"
    heavy = math.degrees(math.remainder(angle - basin.rotor.unbalance_phase, 2.0 * math.pi))
    turned = (
        "" if smallest.instant is None else f" when the shaft has turned by {math.degrees(smallest.instant):.0f} deg"
    )
    return f"in direction {angle:.4f} rad ({heavy:+.0f} deg from the heavy side){turned}"


def _size(coordinate: Coordinate, value: float, scales: Scales | None, digits: int = 4) -> str:
    own = coordinate.told(value, None, digits)
    return own if scales is None else f"{coordinate.told(value, scales, digits)} ({own})"


def _ending(basin: Basin, outcome: Outcome) -> str:
    from carom.studies.endings import ending_words  # only here: it takes long to load

    return ending_words(outcome, basin.motions)


def _time(value: float, scales: Scales | None) -> str:
    return f"{value:.4g} /Ω" if scales is None else f"{value * scales.time:.3g} s"


def _value(case: Case, name: str, value: float, *, named: bool = True) -> str:
    stated = _stated(case, name, value)
    return f"{stated.field.words} {stated.text}" if named else stated.text


def _stated(case: Case, name: str, value: float) -> InTerms:
    return in_terms_of(case, name, value, digits=5)
