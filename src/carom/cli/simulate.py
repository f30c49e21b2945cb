"""``carom simulate``: one motion."""

from __future__ import annotations

from functools import cache, partial
from typing import TYPE_CHECKING

from carom.cli import options
from carom.cli.options import flag, option
from carom.cli.terminal import check_output, console, hand_over, progress, read_machine, write_output

if TYPE_CHECKING:
    from carom.cli.terminal import Drawings
    from carom.motions.trajectories import Trajectory
    from carom.parameters import Case

DROP = flag(
    "--drop",
    "Drop the rotor from levitation, or from the state of --start or --kick; gravity is 9.81 m/s² downward unless [gravity] states it.",
)
SRS = option(
    "Q",
    "Shock response spectra of the base and of the rotor at its touchdown bearings, of oscillators of this quality, such as 10; with --shock or --base-record.",
    "--srs",
    min=0.5,
)
CSV = option("FILE", "Write the contact log as CSV.", "--csv")
NETCDF = option("FILE", "Write the contact log as netCDF.", "--netcdf")


def simulate(
    machine: str = options.MACHINE,
    settings: list[str] | None = options.SETTINGS,
    start: str | None = options.START,
    kick: str | None = options.KICK,
    shock: str | None = options.SHOCK,
    blade_loss: str | None = options.BLADE_LOSS,
    base_record: str | None = options.BASE_RECORD,
    instant: str | None = options.INSTANT,
    srs: float | None = SRS,
    drop: bool = DROP,
    regained_after: str | None = options.REGAINED_AFTER,
    until: str | None = options.UNTIL,
    out: str | None = options.OUT,
    csv: str | None = CSV,
    netcdf: str | None = NETCDF,
    history: str | None = options.HISTORY,
    every: str | None = options.EVERY,
    nodes: str | None = options.NODES,
    as_json: bool = options.AS_JSON,
) -> None:
    """Simulate one motion and log its contacts.

    Flights, impacts and lasting contact are computed to rounding accuracy.
    """
    from carom.cli import logs
    from carom.cli.starts import by_option, one_of, read_time, refuse, released

    case = read_machine(machine, settings)
    check_output(out)
    for name, path in (("--csv", csv), ("--netcdf", netcdf)):
        if path is not None:
            logs.check_file(name, path)
    record = logs.history_writer(case, history, every, nodes)
    if drop:
        refuse("not allowed with --drop; carom drop --phase sets where the unbalance is", instant=instant)
    else:
        refuse("allowed only with --drop", regained_after=regained_after)
    if shock is None and base_record is None:
        refuse("allowed only with --shock or --base-record", srs=srs)
    ways = by_option(start=start, kick=kick, shock=shock, blade_loss=blade_loss, base_record=base_record)
    begins = released(case, ways, regained_after) if drop else one_of(ways, instant)
    with progress("simulating (the kernels are compiled on first use)") as tell:
        end = read_time(until, case.parameters.scales)
        rotor, state, echo = begins.apply(case)
        from carom.motions import drop_loads
        from carom.motions.simulation import simulate as follow

        motion = follow(rotor, state, end, progress=tell if out is None else tell.part(0.0, 0.4))
        if csv is not None:
            logs.write_csv(motion, csv)
        if netcdf is not None:
            logs.write_netcdf(motion, netcdf)
        if record is not None:
            record(motion)
        loads = drop_loads(motion)
        response = None if srs is None else begins.shock_response(case, motion, srs, tell)
        beside = {
            "magnets": loads.magnets,
            "reduction": begins.reduction_error(case, loads),
            "shock_response": response,
        }
        known = {name: found for name, found in beside.items() if found is not None}
        said = {name: found.document() for name, found in known.items()}
        beginning = {"disturbance": echo.document(case.parameters.scales)}
        document = cache(lambda: beginning | _document(case, motion) | said)
        if out is not None:
            figures = _figures(case, motion, decaying=end is None)
            if response is not None:
                figures["shock-response"] = response.plot
            write_output(out, case, "simulation", document, figures, tell=tell.part(0.4, 1.0, "drawing"))

    def show() -> None:
        from carom.cli.tables import print_parts

        console().print(f"{echo.words}.")
        print_parts(console(), case, motion, echo.kind)
        for words in filter(None, (found.words for found in known.values())):
            console().print()
            console().print(words)

    hand_over(document, as_json, show, out)


def _document(case: Case, motion: Trajectory) -> dict[str, object]:
    """The document of a motion: of all its stages if it has several, with times from its beginning."""
    from carom.models import rotor_of
    from carom.studies import trajectory_document

    document = trajectory_document(motion, case.limits)
    if case.gravity:
        gravity = {"acceleration_si": case.gravity.acceleration, "direction": case.gravity.direction}
        document |= rotor_of(case).document() | {"gravity": gravity}
    if case.touchdown:
        document["touchdown"] = case.touchdown.document()
    return document


def _figures(case: Case, motion: Trajectory, *, decaying: bool) -> Drawings:
    """The path of each stage at each touchdown bearing, and its touchdown over time if there is a contact, by their names.

    The figures of a motion that is followed until it is proven to return to levitation show it ``decaying`` further.
    """
    from carom import plots
    from carom.cli.tables import MOST_PARTS
    from carom.motions.ledger import energy_ledger
    from carom.plots.words import contacts_in_words

    figures: Drawings = {}
    parts = motion.parts if len(motion.parts) <= MOST_PARTS else motion.parts[-1:]
    for place, part in enumerate(parts):
        whole, ends = _shown(part) if decaying else (part, "")
        for shown in whole.at_each:
            mark = f"-{place + 1}" if place else ""
            mark += f"-bearing-{shown.plane + 1}" if len(whole.at_each) > 1 else ""
            title = f"{contacts_in_words(shown)} \N{EM DASH} {ends}" if ends else None
            figures[f"motion{mark}"] = partial(plots.motion, shown, title=title)
            if len(shown.contacts) or shown.lasting_contacts:
                ledger = None if shown.begins else energy_ledger(shown)  # of one stage
                figures[f"touchdown{mark}"] = partial(plots.touchdown, shown, ledger)
            else:
                figures[f"radius{mark}"] = partial(plots.radius, shown, case.zones)
    return figures


def _shown(motion: Trajectory) -> tuple[Trajectory, str]:
    """Return the motion to draw, and how it ends, if that of what is drawn does not say it."""
    from carom.base.outcome import Outcome
    from carom.motions.simulation import simulate as follow
    from carom.report.figures import until_decayed

    if motion.outcome is not Outcome.LEVITATED or motion.begins:
        return motion, ""
    rotor = motion.rotor
    return follow(rotor, motion.start, until_decayed(rotor, motion.time)), "returns to levitation"
