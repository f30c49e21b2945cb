"""Options that several commands share, and how an option is declared: where values go, and what they are."""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum
from functools import wraps
from inspect import Parameter, signature
from typing import Any

import typer


class Purpose(StrEnum):
    """What figures are made for."""

    PAGE = "page"
    SLIDE = "slide"


def option(metavar: str | None, words: str, *names: str, default: object = None, **limits: Any) -> Any:
    """An option as the default of an argument of a command; its value is text, a number or a list as that argument is annotated."""
    return typer.Option(default, *names, metavar=metavar, help=words, **limits)


def flag(name: str, words: str) -> Any:
    """An option without a value."""
    return option(None, words, name, default=False)


MACHINE = typer.Argument(metavar="MACHINE.toml", help="The machine file.")
SETTINGS = option(
    "NAME=VALUE",
    "Set a parameter, with units or dimensionless, such as 'damping=2000 N s/m' or gamma=0.1; repeatable.",
    "--set",
)
OUT = option("DIR", "Write figures and numbers (JSON) to this directory.")
FOR = option(
    None, "What figures are made for: page (of print), or slide (16:9 with large type).", "--for", default="page"
)
AS_JSON = flag("--json", "Print one JSON object and nothing else.")

START = option(
    "RE,IM,VRE,VIM", "Begin at this position and velocity, co-rotating frame; in c_r and c_r Omega, or with units."
)
KICK = option(
    "SPEED[,ANGLE]",
    "Begin with a velocity kick out of levitation, such as '50 mm/s,30 deg'; the angle counts in the sense of rotation from the x axis that "
    "turns with the shaft, as the phase of the unbalance does.",
)
SHOCK = option(
    "PEAK[,DURATION[,ANGLE]]",
    "Begin with a half-sine shock of the base at levitation, such as '5 g, 11 ms, 30 deg', the angle from the same axis as it lies when the "
    "shock begins; the motion is logged from then on.",
)
BLADE_LOSS = option(
    "CHANGE[,PHASE[,NODE]]",
    "Begin with the loss of a blade at levitation: by how much the unbalance changes, at which phase relative to that before it, and at which "
    "node of a flexible machine, such as '5000 g mm,30 deg'.",
)
KICKS = option(
    "SPEED",
    "Kicks up to this speed in all directions, such as '100 mm/s'; by default the one stated in [survive], or the impact speed of a free fall across "
    "the clearance.",
    "--kick",
)
SHOCKS = option(
    "PEAK[,DURATION]",
    "Half-sine shocks of the base up to this peak in all directions, such as '5 g, 11 ms', the default duration.",
    "--shock",
)
BLADE_LOSSES = option(
    "CHANGE[,0,NODE]",
    "Losses of a blade at any phase that change the unbalance by this, such as '2000 g mm' or '0.1 mm'; of a flexible machine at a node: "
    "'2000 g mm, 0, 7'.",
    "--blade-loss",
)
INSTANT = option(
    "ANGLE",
    "Angle by which the shaft has turned when the disturbance comes, such as '90 deg'; it matters under gravity, with limits of the magnetic bearings "
    "and where bearings are anisotropic. Default: 0 for one motion (the co-rotating axes coincide with the fixed ones); random for many.",
)
REGAINED_AFTER = option("T", "Time after the release at which levitation returns, such as '50 ms'; by default never.")
UNTIL = option("T", "Follow a motion to this time, in 1/Omega or with a unit; by default until the outcome is certain.")

ALONG = option("NAME", "Parameter to vary, such as gamma, speed, damping or stiffness.", default=...)
PLANE = option(
    "NAME,NAME",
    "Two parameters, such as speed,damping, or what a machine file states them by, such as proportional_gain,derivative_gain; by default "
    "stiffness,damping, of a dimensionless file gamma,omega, of a flexible machine proportional,derivative.",
)
FIRST_RANGE = option("A,B", "Range of the first parameter, by default around its present value.", "--x")
SECOND_RANGE = option("C,D", "Range of the second parameter.", "--y")
SEED = option("S", "Seed of the sample, by default 0.", min=0)


def with_purpose(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command that writes figures the option ``--for``, behind that which says where."""
    known = list(signature(command).parameters.values())
    folders = (each.name == "figures" or (each.name == "out" and each.default.metavar == "DIR") for each in known)
    place = next((n for n, is_folder in enumerate(folders, start=1) if is_folder), None)
    if place is None:
        return command

    @wraps(command)
    def run(purpose: Purpose, **given: object) -> None:
        if purpose is Purpose.PAGE:
            return command(**given)
        from carom import plots

        with plots.figures_for("slide"):
            return command(**given)

    own = Parameter("purpose", Parameter.POSITIONAL_OR_KEYWORD, default=FOR, annotation=Purpose)
    run.__signature__ = signature(command).replace(parameters=[*known[:place], own, *known[place:]])  # type: ignore[attr-defined]
    run.__annotations__ = command.__annotations__ | {"purpose": Purpose}
    return run
