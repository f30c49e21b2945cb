"""``carom sweep``: studies or basins on a grid of machines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import typer

from carom.base.outcome import InputError
from carom.cli import options
from carom.cli.options import flag, option
from carom.cli.terminal import InterruptionError, check_output, console, hand_over, progress

if TYPE_CHECKING:
    from carom.sweeps import SweepPlan, Tally

Failures = list[dict[str, Any]]
_SHOWN = 5
_DRAWN = ("recovered", "smallest_unrecovered_kick", "zone", "stable_orbits")
"""Variables that are drawn if there are any."""
_MOST_AXES = 2


FILE = typer.Argument(metavar="SWEEP.toml", help="The sweep file.")
OUT = option("STORE", "Directory of the results (Zarr); an existing sweep is resumed.", default=...)
WORKERS = option("N", "Processes on this computer; by default one per core.", min=1)
THREADS = flag("--threads", "Use threads of one process instead of processes.")
SCHEDULER = option("ADDRESS", "Compute on a Dask cluster: address or file of its scheduler.")
RETRY_FAILED = flag("--retry-failed", "Compute chunks with failed points again.")
FIGURES = option("DIR", "Draw maps of the results as SVG and PNG in the folder figures of this directory.")


def sweep(
    file: str = FILE,
    out: str = OUT,
    settings: list[str] | None = options.SETTINGS,
    workers: int | None = WORKERS,
    threads: bool = THREADS,
    scheduler: str | None = SCHEDULER,
    retry_failed: bool = RETRY_FAILED,
    figures: str | None = FIGURES,
    as_json: bool = options.AS_JSON,
) -> None:
    """Sweep a grid of machines: a study, or the basins of disturbances, at each point.

    Results are stored chunk by chunk. After any interruption the same command resumes the sweep. A point that fails is
    recorded with its parameters and error, and the other points are still computed. Python opens the store with
    carom.open_sweep or xarray.open_zarr.
    """
    from carom.sweeps import load_sweep, run_sweep
    from carom.sweeps.store import SweepStore

    check_output(figures, "--figures")
    plan = load_sweep(file, settings or ())
    if figures is not None and len(plan.axes) > _MOST_AXES:
        allowed = "a sweep over one or two axes; for more axes use carom.open_sweep and carom.plots.sweep_map"
        raise InputError("--figures", figures, allowed)
    with progress(f"{plan.points:,} points") as tell:
        try:
            tally = run_sweep(
                plan,
                out,
                workers=workers,
                threads=threads,
                scheduler=scheduler,
                retry_failed=retry_failed,
                progress=tell,
            )
        except KeyboardInterrupt:
            done = SweepStore(out, plan).done
            kept = f"{done:,} of {plan.points:,} points are stored; " if done else ""
            raise InterruptionError(f"interrupted; {kept}the same command resumes {out}") from None
        if figures is not None:
            tell(0.99, "drawing")
            _draw(plan, tally, figures)
    failures = tally.failures
    hand_over(lambda: _document(plan, tally, failures), as_json, lambda: _print(plan, tally, failures), None)


def _draw(plan: SweepPlan, tally: Tally, figures: str) -> None:
    """Draw the results over the axes of the sweep, with the machine as it is marked."""
    from carom import plots
    from carom.base.files import FIGURES, staged_directory
    from carom.models import axis, rotor_of
    from carom.parameters import Case
    from carom.studies.wording import machine_heading
    from carom.sweeps import open_sweep

    model = rotor_of(plan.case)
    present = {varied.name: float(axis(model, varied.name).value(model)) for varied in plan.axes}
    words = machine_heading(plan.case) if isinstance(plan.case, Case) else plan.name
    data = open_sweep(str(tally.store))
    with staged_directory(figures, "--figures") as directory, plots.heading(words):
        for name in (name for name in _DRAWN if name in data):
            drawn = f"{name}_si" if f"{name}_si" in data else name
            plots.save(plots.sweep_map(data, drawn, present=present), directory / FIGURES / name)


def _document(plan: SweepPlan, tally: Tally, failures: Failures) -> dict[str, object]:
    from carom.base.results import record

    return {
        "store": str(tally.store),
        "kind": plan.task.kind,
        "disturbances": plan.task.words,
        "axes": {axis.name: axis.count for axis in plan.axes},
        **record(tally, "points done failed waiting"),
        "chunks": plan.chunks,
        "starts": plan.points * plan.task.starts,
        **record(tally, "computed seconds rate"),
        "damaged": len(tally.damaged),
        "failures": failures,
    }


def _print(plan: SweepPlan, tally: Tally, failures: Failures) -> None:
    from carom.base.progress import duration_words
    from carom.studies.wording import counted
    from carom.sweeps.running import rate_words

    screen = console()
    grid = " x ".join(f"{axis.count} {axis.name}" for axis in plan.axes)
    screen.print(f"Sweep of {plan.name} ({plan.task.kind}): {grid}")
    seed = f" Seed {plan.seed}." if plan.task.starts else ""
    screen.print(f"Disturbances: {plan.task.words}.{seed}")
    screen.print(f"{tally.done:,} of {tally.points:,} points are done, {tally.failed:,} failed.")
    if tally.computed:
        rate = rate_words(tally.rate, "points")
        if plan.task.starts:
            rate += f" ({rate_words(tally.rate * plan.task.starts, 'starts')})"
        screen.print(f"This run: {tally.computed:,} points in {duration_words(tally.seconds)}, {rate}")
    else:
        screen.print("Nothing left to compute.")
    if tally.damaged:
        chunks = ", ".join(map(str, tally.damaged[:_SHOWN])) + (", ..." if len(tally.damaged) > _SHOWN else "")
        several = counted(len(tally.damaged), "chunk")
        screen.print(f"Files of {several} ({chunks}) were damaged or missing: computed again")
    for failure in failures[:_SHOWN]:
        place = ", ".join(f"{name} = {value:.6g}" for name, value in failure["values"].items())
        screen.print(f"Failed at {place}: {failure['error']}", soft_wrap=True)
    if tally.failed:
        screen.print(f"All failures: {tally.store}/records; try them again with --retry-failed", soft_wrap=True)
    screen.print(f"Results: {tally.store} (carom.open_sweep in Python)", soft_wrap=True)
