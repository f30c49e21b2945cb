"""``carom study``: the study of a machine."""

from __future__ import annotations

from carom.cli import options
from carom.cli.options import flag, option
from carom.cli.terminal import check_output, console, hand_over, progress, read_machine

OUT = option("DIR", "Write figures, study.json and report.html to this directory.")
PROVE = flag("--prove", "Also prove equilibria, orbits and which kicks come back; needs the extra carom[proof].")
ALONG = option(
    "NAME",
    "Parameter to vary in the search for recovery and for a recommended change, such as 'speed', 'friction' or 'derivative'; repeatable. "
    "Default: damping and stiffness, or the gains of the magnetic bearings.",
)
TIME_LIMIT = option(
    "T",
    "Stop simulating after T, such as '2 min', and list what was not completed; with --prove it also limits the proof of "
    "kicks, by default to 30 s.",
)
LONG = flag("--long", "Print all results and the table of motions, not only the verdict and the recommendation.")


def study(
    machine: str = options.MACHINE,
    settings: list[str] | None = options.SETTINGS,
    kick: str | None = options.KICKS,
    shock: str | None = options.SHOCKS,
    blade_loss: str | None = options.BLADE_LOSSES,
    base_record: str | None = options.BASE_RECORDS,
    out: str | None = OUT,
    prove: bool = PROVE,
    along: list[str] | None = ALONG,
    time_limit: str | None = TIME_LIMIT,
    long: bool = LONG,
    as_json: bool = options.AS_JSON,
) -> None:
    """Study a machine: the verdict in words and numbers, and a report.

    Finds the equilibria and the orbits with one impact a period with their stability, the damping and stiffness at which each
    appears or vanishes, the outcomes of 200 simulated disturbances, which disturbances are survived, and the touchdown loads in
    these and in a drop. --kick, --shock, --blade-loss and --base-record state what the machine must survive, instead of the table [survive] of
    its file. With --out it also writes figures, study.json and report.html.
    """
    from carom.cli.starts import with_requirement

    given = {"kick": kick, "shock": shock, "blade_loss": blade_loss}
    case = with_requirement(read_machine(machine, settings), base_record, **given)
    with progress("loading") as tell:
        check_output(out)
        from carom.studies import study as study_case

        share_of_study = 1.0 if out is None else 0.4
        limits = {} if time_limit is None else {"proof_time": time_limit, "time_limit": time_limit}
        result = study_case(case, along=along or None, proofs=prove, **limits, progress=tell.part(0.0, share_of_study))  # type: ignore[arg-type]
        report = None
        if out is not None:
            from carom.report import write_report

            report = write_report(result, out, progress=tell.part(share_of_study, 1.0))

    def show() -> None:
        from carom.cli.tables import print_study

        print_study(console(), result, out, long)

    hand_over(result.to_dict, as_json, show, out, f"Report: {report}")
