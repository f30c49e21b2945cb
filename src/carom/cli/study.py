"""``carom study``: the study of a machine."""

from __future__ import annotations

from carom.cli import options
from carom.cli.options import flag, option
from carom.cli.terminal import check_output, console, hand_over, progress, read_machine

OUT = option("DIR", "Write figures, study.json and report.html to this directory.")
PROVE = flag("--prove", "Prove equilibria, orbits and which kicks come back too; needs the extra carom[proof].")
ALONG = option(
    "NAME",
    "A parameter along which to search for recovery and for a change to advise, such as 'speed', 'friction' or 'derivative'; may be repeated. By "
    "default damping and stiffness, or the gains of the magnetic bearings.",
)
TIME_LIMIT = option(
    "T",
    "Stop simulating after T, such as '2 min', and report what was not reached; with --prove it also ends the proof of kicks, by "
    "default after 30 s.",
)
LONG = flag(
    "--long", "Print all that was found and the table of motions too, not the verdict and the recommendation alone."
)


def study(
    machine: str = options.MACHINE,
    settings: list[str] | None = options.SETTINGS,
    kick: str | None = options.KICKS,
    shock: str | None = options.SHOCKS,
    blade_loss: str | None = options.BLADE_LOSSES,
    out: str | None = OUT,
    prove: bool = PROVE,
    along: list[str] | None = ALONG,
    time_limit: str | None = TIME_LIMIT,
    long: bool = LONG,
    as_json: bool = options.AS_JSON,
) -> None:
    """Study a machine: the verdict in words and numbers, and a report.

    Finds every simple motion of the machine with its stability, the damping and stiffness at which each appears or
    vanishes, where 200 simulated disturbances end, what is survived, and what the touchdown bearings bear in it and in a drop.
    --kick, --shock and --blade-loss say what the machine must survive, in place of the table [survive] of its file. With
    --out it also writes figures, study.json and report.html.
    """
    from carom.cli.starts import with_requirement

    case = with_requirement(read_machine(machine, settings), kick=kick, shock=shock, blade_loss=blade_loss)
    with progress("loading") as tell:
        check_output(out)
        from carom.studies import study as study_case

        share_of_study = 1.0 if out is None else 0.4
        given = {} if time_limit is None else {"proof_time": time_limit, "time_limit": time_limit}
        result = study_case(case, along=along or None, proofs=prove, **given, progress=tell.part(0.0, share_of_study))  # type: ignore[arg-type]
        report = None
        if out is not None:
            from carom.report import write_report

            report = write_report(result, out, progress=tell.part(share_of_study, 1.0))

    def show() -> None:
        from carom.cli.tables import print_study

        print_study(console(), result, out, long)

    hand_over(result.to_dict, as_json, show, out, f"Report: {report}")
