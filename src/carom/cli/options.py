"""Options that several commands share, and how an option is declared: where values go, and what they are."""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum
from functools import wraps
from inspect import Parameter, signature
from typing import Any

import typer


class Purpose(StrEnum):
    """Format of figures."""

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
FOR = option(None, "Format of the figures: page (print) or slide (16:9, large type).", "--for", default="page")
AS_JSON = flag("--json", "Print one JSON object and nothing else.")

START = option(
    "RE,IM,VRE,VIM",
    "Start from this position and velocity in the co-rotating frame, in c_r and c_r Omega or with units.",
)
KICK = option(
    "SPEED[,ANGLE]",
    "Start with a velocity kick of the levitating rotor, such as '50 mm/s,30 deg'. The angle is measured in the sense of rotation from the x axis that "
    "turns with the shaft, like the unbalance phase.",
)
SHOCK = option(
    "PEAK[,DURATION[,ANGLE[,PULSES[,PAUSE]]]]",
    "Start with a half-sine base shock of the levitating rotor, such as '5 g, 11 ms, 30 deg', or with a series of them, such as '5 g, 11 ms, 0, 3, 20 ms'. The angle is measured from the same axis at the instant the "
    "shock begins; the log begins then.",
)
BLADE_LOSS = option(
    "CHANGE[,PHASE[,NODE]]",
    "Start with a blade loss of the levitating rotor, such as '5000 g mm,30 deg': the change of unbalance, its phase relative to the unbalance before, and "
    "for a flexible rotor the node.",
)
BASE_RECORD = option(
    "FILE.csv[,PEAK[,ANGLE]]",
    "Move the base of the levitating rotor as recorded, linear between samples: columns time, x and y (fixed frame) with units in the heading, such as "
    "'time (s),x (m/s^2),y (g)'; scaled to a peak acceleration and turned by an angle where these are given, such as 'quake.csv, 2 g, 30 deg'.",
)
BASE_RECORDS = option(
    "FILE.csv[,PEAK]",
    "Base motion of this record, scaled up to this peak acceleration (by default its own) and turned to all directions, such as 'quake.csv, 2 g'.",
    "--base-record",
)
KICKS = option(
    "SPEED",
    "Kicks up to this speed in all directions, such as '100 mm/s'; by default the one stated in [survive], or the impact speed of a free fall across "
    "the clearance.",
    "--kick",
)
SHOCKS = option(
    "PEAK[,DURATION]",
    "Half-sine base shocks with peaks up to this value in all directions, such as '5 g, 11 ms'; 11 ms is the default duration. carom basins takes a series "
    "too, such as '5 g, 11 ms, 0, 3, 20 ms'.",
    "--shock",
)
BLADE_LOSSES = option(
    "CHANGE[,0,NODE]",
    "Blade losses at any phase that change the unbalance by this value, such as '2000 g mm' or '0.1 mm'; for a flexible rotor with the node: "
    "'2000 g mm, 0, 7'.",
    "--blade-loss",
)
INSTANT = option(
    "ANGLE",
    "Shaft angle at the instant of the disturbance, such as '90 deg'. It matters under gravity, with limits of the magnetic bearings and with anisotropic "
    "bearings. Default: 0 for one motion (co-rotating and fixed axes coincide); random for many.",
)
REGAINED_AFTER = option("T", "Time after the release at which levitation returns, such as '50 ms'; by default never.")
UNTIL = option("T", "Simulate until this time, in 1/Omega or with a unit; by default until the outcome is certain.")
HISTORY = option(
    "FILE",
    "Write histories as sensors record them to a .csv, .mat or .nc file: displacements, contact forces, speeds of shaft and races, control currents; SI units, fixed frame.",
)
EVERY = option("T", "With --history: interval of the samples, such as '50 us'; by default a hundredth of a turn.")
NODES = option("N,N", "With --history: nodes of a flexible shaft, or stations of a rigid rotor, to be recorded too.")

ALONG = option("NAME", "Parameter to vary, such as gamma, speed, damping or stiffness.", default=...)
PLANE = option(
    "NAME,NAME",
    "Two parameters, such as speed,damping, or entries of the machine file, such as proportional_gain,derivative_gain. Default: "
    "stiffness,damping; gamma,omega for a dimensionless file; proportional,derivative for a flexible rotor.",
)
FIRST_RANGE = option("A,B", "Range of the first parameter; by default around its present value.", "--x")
SECOND_RANGE = option("C,D", "Range of the second parameter.", "--y")
SEED = option("S", "Seed of the random sample; 0 by default.", min=0)


def with_purpose(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command that writes figures the option ``--for``, after the option for the directory."""
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
