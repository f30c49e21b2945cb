"""Tables of basins and gain maps, for people."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from rich.console import Console

    from carom.basins import Basin, GainChange, GainMap, SmallestKick
    from carom.disturbances import Coordinate
    from carom.parameters import Scales

__all__ = ["print_basin", "print_gains"]

_UNITS = {"velocity": "c_r Ω", "length": "c_r", "acceleration": "c_r Ω²", "time": "/Ω"}
_SHOWN = {"m/s": (1e3, "mm/s"), "m": (1e3, "mm"), "m/s^2": (1.0 / 9.80665, "g")}
_NAMES = {
    "kick": "velocity kicks out of levitation",
    "kick-plane": "velocity kicks out of levitation",
    "shock": "half-sine shocks of the base",
    "unbalance": "steps of the unbalance to what it is",
    "release": "releases from the wall",
    "slice": "positions at one velocity",
    "state": "positions and velocities",
}


def print_basin(screen: Console, basin: Basin, smallest: SmallestKick | None, harmless: float) -> None:
    """Print what was tried, where it ends, and how much it takes."""
    from rich import box
    from rich.table import Table

    screen.print(_tried(basin))
    table = Table(box=box.SIMPLE_HEAD)
    drawn = basin.share_recovered.drawn
    for heading in ("where they end", "starts", "share", *(["95 % interval"] if drawn else []), "known after (median)"):
        table.add_column(heading, justify="left" if heading == "where they end" else "right")
    index, times = basin.dataset["motion"].values, basin.dataset["time"].values
    for name in basin.fractions:
        share = basin.share_of(name)
        when = float(np.median(times[index == basin.motions.index(name)]))
        interval = [f"{100 * share.low:.3g} to {100 * share.high:.3g} %"] if drawn else []
        table.add_row(name, str(share.count), f"{100 * share.fraction:.4g} %", *interval, _time(when, basin.scales))
    screen.print(table)
    screen.print(f"Back to levitation: {basin.share_recovered.words}.")
    if basin.unresolved:
        screen.print(f"Given up before it was known where they end: {basin.unresolved} starts; they count as lost.")
    for line in (*_kicks(basin, smallest, harmless), *_shocks(basin), *_measures(basin)):
        screen.print(line)


def print_gains(screen: Console, found: GainMap, change: GainChange | None, wanted: float) -> None:
    """Print what a gain map says about the present machine."""
    share = found.dataset["recovered"].values
    able = found.dataset["levitates"].values > 0.0
    back = f"{100 * found.present_share.fraction:.4g} %"
    here = ", ".join(
        _value(axis.field.words, value, axis.field.unit) for axis, value in zip(found.axes, found.present, strict=True)
    )
    screen.print(f"Present machine: {here}; {back} of the disturbances come back.")
    shape = " x ".join(str(size) for size in share.shape)
    enough = float((share >= wanted).mean())
    screen.print(
        f"Of {shape} machines with other {found.axes[0].name} and {found.axes[1].name}, {100 * enough:.3g} % bring back "
        f"{100 * wanted:g} % of the disturbances; {100 * (1 - able.mean()):.3g} % cannot levitate without contact."
    )
    if not all(found.present):
        return
    if change is None:
        screen.print(f"No machine of the map brings back {100 * wanted:g} %{_for_sure(found, enough)}.")
    elif change.size == 0.0:
        screen.print("No change is needed.")
    else:
        parts = ", ".join(
            f"{_value(axis.field.words, value, axis.field.unit)} ({100 * part:+.3g} %)"
            for axis, value, part in zip(found.axes, change.values, change.changes, strict=True)
        )
        screen.print(
            f"Least change found for {100 * wanted:g} %: {parts}; {100 * change.share.fraction:.4g} % come back."
        )


def _for_sure(found: GainMap, enough: float) -> str:
    """What is asked of a sample, where some machines bring back enough of theirs."""
    if enough == 0.0 or not found.present_share.drawn:
        return ""
    return f" with 95 % confidence, as is asked of a sample: {found.present_share.total} starts may be too few"


def _tried(basin: Basin) -> str:
    plan = basin.plan
    size = plan.model.coordinates[0]
    cells = getattr(plan, "shape", None)
    how = f"a grid of {' x '.join(map(str, cells))}" if cells else f"a sample (seed {getattr(plan, 'seed', 0)})"
    text = f"{basin.starts} {_NAMES[plan.model.kind]}, {how}"
    if plan.model.kind in ("kick", "kick-plane", "shock", "unbalance"):
        text += f", {size.words} up to {_size(size, size.high, basin.scales)}"
    if plan.model.kind == "state":
        speed = plan.model.coordinates[2]
        text += f", {speed.words} up to {_size(speed, speed.high, basin.scales)}"
    if plan.model.kind == "shock":
        text += f" for {_time(getattr(plan.model, 'duration', math.nan), basin.scales)}"
    return text + "."


def _kicks(basin: Basin, smallest: SmallestKick | None, harmless: float) -> list[str]:
    scales = basin.scales
    if harmless <= 0.0:
        return ["No kick is proven harmless: the rotor has no stable levitation inside the wall."]
    proven = f"Kicks up to {_speed(harmless, scales)} provably never reach the wall."
    if smallest is None:
        return ["Every kick tried comes back.", proven]
    heavy = math.degrees(math.remainder(smallest.angle - basin.parameters.phi, 2.0 * math.pi))
    found = (
        f"Smallest kick found that does not come back: {_speed(smallest.speed, scales)} in direction "
        f"{smallest.angle:.4f} rad ({heavy:+.0f} deg from the heavy side); it ends in {smallest.outcome.label.replace('-', ' ')} "
        f"(bracketed to {100 * smallest.tolerance:g} %, {smallest.tried} kicks tried)."
    )
    return [found, proven]


def _shocks(basin: Basin) -> list[str]:
    from carom.basins import harmless_shock
    from carom.disturbances import BaseShock

    model = basin.plan.model
    if not isinstance(model, BaseShock):
        return []
    bound = _size(model.coordinates[0], harmless_shock(basin.rotor, model.duration), basin.scales)
    return [f"Shocks of this duration up to {bound} provably never bring the rotor to the wall."]


def _measures(basin: Basin) -> list[str]:
    from carom.basins import basin_entropy, integrity
    from carom.outcome import InputError

    lines = []
    try:
        found = integrity(basin)
    except InputError:
        pass
    else:
        reach = _size(basin.coordinates[0], found.local * found.whole, basin.scales)
        text = f"Integrity: all disturbances tried up to {reach} come back, {100 * found.local:.4g} % of the largest radius tried"
        more = f"; the largest ball anywhere {100 * found.largest:.4g} %" if math.isfinite(found.largest) else ""
        lines.append(f"{text}{more}.")
    try:
        entropy = basin_entropy(basin)
    except InputError:
        return lines
    if entropy.boxes:
        boundary = f"{entropy.boundary:.4g} at boundaries" if entropy.mixed else "no boundary"
        kind = "; above ln 2, which suggests a fractal boundary" if entropy.fractal else ""
        lines.append(f"Basin entropy: {entropy.whole:.4g}, {boundary} (boxes of {entropy.side} starts a side{kind}).")
    return lines


def _size(coordinate: Coordinate, value: float, scales: Scales | None) -> str:
    own = f"{value:.4g} {_UNITS[coordinate.scale]}"
    if scales is None:
        return own
    factor, unit = _SHOWN[coordinate.unit]
    return f"{value * coordinate.si(scales) * factor:.4g} {unit} ({own})"


def _speed(value: float, scales: Scales | None) -> str:
    own = f"{value:.5g} c_r Ω"
    return own if scales is None else f"{1e3 * value * scales.velocity:.4g} mm/s ({own})"


def _time(value: float, scales: Scales | None) -> str:
    return f"{value:.4g} /Ω" if scales is None else f"{value * scales.time:.3g} s"


def _value(words: str, value: float, unit: str) -> str:
    from carom.study.wording import number

    return f"{words} {number(value, 5)}{' ' + unit if unit else ''}"
