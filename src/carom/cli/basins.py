"""``carom basins``: where disturbances end, and which gains bring back more of them."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from carom.cli.basin_options import (
    Before,
    Cells,
    Duration,
    Fastest,
    FirstRange,
    Gains,
    GainsWanted,
    Kind,
    Out,
    Peak,
    Plane,
    Release,
    SecondRange,
    Seed,
    Starts,
    Threads,
    Wanted,
    read_gains,
    read_plan,
)
from carom.cli.terminal import AsJson, MachineFile, Settings, console, print_document, progress

if TYPE_CHECKING:
    from carom.basins import Basin, GainChange, GainMap, SmallestLoss
    from carom.disturbances import Plan
    from carom.parameters import Case
    from carom.progress import Reporter


def basins(
    machine: MachineFile,
    settings: Settings = None,
    disturbance: Kind = "kick",
    grid: Cells = None,
    starts: Starts = None,
    seed: Seed = None,
    fastest: Fastest = None,
    peak: Peak = None,
    duration: Duration = None,
    before: Before = None,
    release: Release = None,
    gains: GainsWanted = None,
    plane: Plane = None,
    x: FirstRange = None,
    y: SecondRange = None,
    wanted: Wanted = None,
    threads: Threads = None,
    out: Out = None,
    as_json: AsJson = False,
) -> None:
    """Find where disturbances go: what share comes back, the smallest that does not, and the gains that help.

    Every start is followed to where it settles. Values without a unit are dimensionless: lengths in clearances, times
    in 1/Omega; those of a parameter of the machine are in SI units. With --gains the share that comes back is mapped
    against P and D gain, or any two parameters.
    """
    from carom.parameters import load

    case = load(machine, settings or ())
    sizes = {"fastest": fastest, "peak": peak, "duration": duration, "before": before, "release": release}
    plan = read_plan(case.parameters, disturbance, sizes, grid, starts, seed)
    asked = read_gains(case.parameters, gains, plane, x, y, wanted)
    if out is not None:
        from carom.report.directory import check_directory

        check_directory(out, "--out")
    question = _Question(case, plan, asked, threads, _source(machine, settings))
    with progress("following starts (the kernels are compiled on first use)") as tell:
        answer = _follow(question, tell)
        if out is not None:
            tell(0.97, "drawing")
            _write(out, answer)
    if as_json:
        print_document(answer.document)
    else:
        _print(answer)
    if out is not None:
        console(errors=True).print(f"Written to {out}", soft_wrap=True)


@dataclass(frozen=True)
class _Question:
    case: Case
    plan: Plan
    gains: Gains | None
    threads: int | None
    source: dict[str, str]


@dataclass(frozen=True)
class _Answer:
    basin: Basin
    smallest: SmallestLoss | None
    harmless: float
    gains: GainMap | None
    change: GainChange | None
    asked: Gains | None

    @cached_property
    def document(self) -> dict[str, Any]:
        """Return the answer as plain data for JSON."""
        from carom.basins.document import basin_document

        wanted = {} if self.asked is None else {"wanted": self.asked.wanted}
        return basin_document(self.basin, self.smallest, self.harmless, self.gains, self.change, **wanted)


def _follow(question: _Question, tell: Reporter) -> _Answer:
    """Compute the basin, smallest loss and harmless speed of a machine, and the gain map if requested."""
    from carom.basins import map_basins as classify
    from carom.basins import smallest_loss
    from carom.basins.losses import has_sizes
    from carom.closed_forms import harmless_kick
    from carom.models import Jeffcott

    rotor, plan = Jeffcott(question.case.parameters), question.plan
    share = 0.9 if question.gains is None else 0.3
    basin = classify(
        rotor,
        plan,
        threads=question.threads,
        source=question.source,
        progress=tell.part(0.0, share, f"following {plan.count} starts"),
    )
    harmless, smallest = harmless_kick(rotor), None
    if harmless > 0.0 and has_sizes(plan.model):
        smallest = smallest_loss(rotor, plan.model, threads=question.threads, progress=tell.part(share, 1.1 * share))
    if question.gains is None:
        return _Answer(basin, smallest, harmless, None, None, None)
    return _Answer(basin, smallest, harmless, *_map(question, question.gains, tell), question.gains)


def _map(question: _Question, asked: Gains, tell: Reporter) -> tuple[GainMap, GainChange | None]:
    from carom.basins import least_gain_change, map_gains

    found = map_gains(
        question.case.parameters,
        question.plan,
        asked.names,
        ranges=asked.ranges,
        shape=asked.shape,
        threads=question.threads,
        source=question.source,
        progress=tell.part(0.33, 0.9),
    )
    if not all(found.present):
        return found, None
    return found, least_gain_change(found, asked.wanted, threads=question.threads, progress=tell.part(0.9, 0.97))


def _source(machine: str, settings: list[str] | None) -> dict[str, str]:
    """Describe where the machine comes from."""
    text = Path(machine).read_bytes()
    return {
        "machine_file": Path(machine).name,
        "machine_file_sha256": hashlib.sha256(text).hexdigest(),
        "machine_text": text.decode("utf-8", "replace"),
        "settings": "; ".join(settings or ()),
    }


def _print(answer: _Answer) -> None:
    from carom.cli.basin_tables import print_basin, print_gains

    print_basin(console(), answer.basin, answer.smallest, answer.harmless)
    if answer.gains is not None and answer.asked is not None:
        print_gains(console(), answer.gains, answer.change, answer.asked.wanted)


def _write(out: str, answer: _Answer) -> None:
    """Write all files to the directory, or none."""
    from carom.plots import save
    from carom.report.directory import filled_at_once
    from carom.studies import as_json

    with filled_at_once(out, "--out") as directory:
        save(answer.basin.plot(answer.smallest), directory / "figures" / "basins")
        answer.basin.save(directory / "basins.nc")
        if answer.gains is not None:
            save(answer.gains.plot(answer.change), directory / "figures" / "gain-map")
            answer.gains.save(directory / "gains.nc")
        (directory / "basins.json").write_text(as_json(answer.document) + "\n", encoding="utf-8")
