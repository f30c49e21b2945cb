"""The options by which ``carom simulate`` and ``carom drop`` say how a motion begins, and when levitation is lost."""

from __future__ import annotations

from typing import Annotated

import typer

_START = "Position and velocity {}, co-rotating frame; in c_r and c_r Omega, or with units."
_KICK = "velocity kick out of levitation, such as '50 mm/s,30 deg'"
_BACK = "ime after which levitation is back, such as '50 ms'; by default never."

Start = Annotated[str | None, typer.Option(metavar="RE,IM,VRE,VIM", help=_START.format("at the start"))]
Kick = Annotated[
    str | None,
    typer.Option(
        metavar="SPEED[,ANGLE]",
        help=f"Instead of --start: a {_KICK}; the angle counts in the sense of rotation from the x axis that turns with the shaft, as the "
        "phase of the unbalance does.",
    ),
]
Shock = Annotated[
    str | None,
    typer.Option(
        metavar="PEAK[,DURATION[,ANGLE]]",
        help="Instead of --start: a half-sine shock of the base at levitation, such as '5 g, 11 ms, 30 deg', the angle from "
        "the same axis as it lies when the shock begins; the motion is logged from then on.",
    ),
]
BladeLoss = Annotated[
    str | None,
    typer.Option(
        metavar="CHANGE[,PHASE[,NODE]]",
        help="Instead of --start: a blade is lost at levitation; by how much the unbalance changes, at which phase relative to that "
        "before it, and at which node of a flexible machine, such as '5000 g mm,30 deg'.",
    ),
]
Instant = Annotated[
    str | None,
    typer.Option(
        metavar="ANGLE",
        help="Angle by which the shaft has turned when it happens, such as '90 deg', by default 0: then the x axis that turns with the shaft "
        "passes that of the room. It matters under weight, with limits of the magnetic bearings and where bearings act differently in two directions.",
    ),
]
Dropped = Annotated[
    bool,
    typer.Option(
        "--drop",
        help="Levitation is lost at levitation, or at what --start or --kick gives, and the rotor falls, by 9.81 m/s² without [gravity].",
    ),
]
BackAfter = Annotated[str | None, typer.Option("--regained-after", metavar="T", help=f"With --drop: t{_BACK}")]
Until = Annotated[
    str | None,
    typer.Option(
        metavar="T",
        help="Follow the motion to this time, in 1/Omega or with a unit; by default until it is known where it ends.",
    ),
]

ReleaseStart = Annotated[
    str | None,
    typer.Option("--start", metavar="RE,IM,VRE,VIM", help=_START.format("at the release in place of levitation")),
]
ReleaseKick = Annotated[str | None, typer.Option("--kick", metavar="SPEED[,ANGLE]", help=f"Released by a {_KICK}.")]
ReleaseWhirl = Annotated[
    str | None,
    typer.Option(
        "--whirl",
        metavar="RADIUS,SPEED[,ANGLE]",
        help="Released from a whirl about the centre, such as '0.1 mm,-80 Hz,30 deg': its speed (below 0: backward) and where it "
        "is, in the fixed frame.",
    ),
]
Phase = Annotated[
    str | None,
    typer.Option(
        metavar="ANGLE",
        help="Angle from the direction of the fall to the unbalance at the release, in the sense of rotation, such as '90 deg'; "
        "by default that of the machine.",
    ),
]
RaceSpeed = Annotated[
    str | None,
    typer.Option(
        metavar="SPEED", help="Speed of the race at the release, such as '500 rpm'; by default it stands still."
    ),
]
RegainedAfter = Annotated[str | None, typer.Option(metavar="T", help=f"T{_BACK}")]
DropUntil = Annotated[
    str | None,
    typer.Option(
        "--until",
        metavar="T",
        help="Follow the drop to this time, such as '200 ms'; by default until it is known where it ends, at most for 1,500 turns of the shaft.",
    ),
]
Mapped = Annotated[
    str | None,
    typer.Option(
        "--map",
        metavar="NAME,NAME",
        help="Drop it at each point of a plane: phase, regained_after or race_speed of the release, or parameters of the machine, such "
        "as 'phase,speed'.",
    ),
]
Grid = Annotated[str | None, typer.Option(metavar="NxM", help="With --map: numbers of values, by default 24x16.")]
FirstRange = Annotated[
    str | None,
    typer.Option(
        "--x",
        metavar="A,B",
        help="With --map: range of the first; by default half to twice the value, of the phase a turn.",
    ),
]
SecondRange = Annotated[str | None, typer.Option("--y", metavar="C,D", help="With --map: range of the second.")]
