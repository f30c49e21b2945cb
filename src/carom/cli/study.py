"""``carom study``: the study of a machine."""

from __future__ import annotations

from typing import Annotated

import typer

from carom.cli.terminal import AsJson, MachineFile, Settings, check_output, console, print_document, progress


def study(
    machine: MachineFile,
    settings: Settings = None,
    kick: Annotated[
        str | None,
        typer.Option(metavar="SPEED", help="A velocity kick that the machine must survive, such as '100 mm/s'."),
    ] = None,
    shock: Annotated[
        str | None,
        typer.Option(
            metavar="PEAK,DURATION",
            help="A half-sine shock of the base that it must survive, such as '5 g, 11 ms'; 11 ms if left out.",
        ),
    ] = None,
    blade_loss: Annotated[
        str | None,
        typer.Option(
            metavar="CHANGE",
            help="A loss of a blade that it must survive: by how much it changes the unbalance, such as '2000 g mm', or the eccentricity; "
            "at any phase.",
        ),
    ] = None,
    blade_loss_node: Annotated[
        int | None, typer.Option(metavar="NODE", help="The node of a flexible machine at which the blade is lost.")
    ] = None,
    out: Annotated[
        str | None, typer.Option(metavar="DIR", help="Write figures, study.json and report.html to this directory.")
    ] = None,
    prove: Annotated[
        bool,
        typer.Option(
            "--prove",
            help="Prove equilibria, orbits and which kicks and states come back too; needs the extra carom[proof].",
        ),
    ] = False,
    along: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="A parameter along which recovery is searched and a change is looked for, such as 'speed', 'friction' or 'derivative'; "
            "may be repeated. By default damping and stiffness, or the gains of the magnetic bearings.",
        ),
    ] = None,
    time_limit: Annotated[
        str | None,
        typer.Option(
            metavar="T",
            help="Follow no further motions after T, such as '2 min', and say what was not reached; with --prove it also ends the "
            "proof of kicks, by default after 30 s.",
        ),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Study a machine: the verdict in words and numbers, and a report.

    Finds every simple motion of the machine with its stability, the damping and stiffness at which each appears or
    vanishes, where 200 simulated disturbances end, what is survived, and what the touchdown bearings bear in it and in a drop.
    --kick, --shock and --blade-loss say what the machine must survive, in place of the table [survive] of its file. With
    --out it also writes figures, study.json and report.html.
    """
    from carom.cli.starts import with_requirement
    from carom.loading import load

    case = with_requirement(
        load(machine, settings or ()), kick=kick, shock=shock, blade_loss=blade_loss, blade_loss_node=blade_loss_node
    )
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
    if as_json:
        print_document(result.to_dict())
        if report is not None:
            console(errors=True).print(f"Report: {report}", soft_wrap=True)
        return
    from carom.cli.tables import print_study

    print_study(console(), result, report)
