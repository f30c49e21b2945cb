"""Limits of magnetic bearings, along each of two perpendicular axes of the fixed frame, in the motion (:mod:`carom.core.limits`)."""

from __future__ import annotations

import cmath
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import Any, cast

import numpy as np

from carom.core.layout import rotor_record
from carom.core.wall import Wall
from carom.models.in_bearing import InBearing
from carom.models.jeffcott import Jeffcott
from carom.models.linear import LinearRotor
from carom.models.model import Model
from carom.models.stages import Around
from carom.models.system import System
from carom.outcome import InputError, shown
from carom.parameters import ControlLimit, Field

_KEPT = (
    "exponents",
    "driven",
    "offsets",
    "rows",
    "columns",
    *Wall._fields,
    "race",
    "race_gain",
    "masses",
    "free",
    "gap_rows",
    "gap_offsets",
)
_VECTORS = ("displacement", "velocity", "accelerations", "rates")


@dataclass(frozen=True, eq=False)
class Limit:
    """A quantity of a controller, such as a control current, that has a largest size along each of two perpendicular axes.

    In the fixed frame, with the coordinates ``Z`` and their rates, it is ``displacement·Z + velocity·Ż``, of which along each axis no
    more than the bound is given.  What is asked for beyond the bound acts back: it changes the accelerations of the coordinates, and the rates of those
    without mass, such as the states of a controller.

    Attributes
    ----------
    bound : float
        Above 0.
    displacement, velocity : array_like, shape (n,)
        The quantity per coordinate and per rate of a coordinate.
    accelerations : array_like, shape (n,)
        Accelerations of the coordinates per unit of what is not given; zero for those without mass.
    rates : array_like, shape (n,), optional
        Rates of the coordinates without mass per unit of that; zeros by default.
    angle : float
        Of the first axis in the fixed frame, rad.
    follows : tuple of float
        What is not given of the limits before it in a list adds to this quantity by these factors; those left out are zero.
    """

    bound: float
    displacement: np.ndarray
    velocity: np.ndarray
    accelerations: np.ndarray
    rates: np.ndarray | None = None
    angle: float = 0.0
    follows: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if not 0.0 < self.bound < np.inf:
            raise InputError("bound", shown(self.bound), "a finite number above 0")
        if self.rates is None:
            object.__setattr__(self, "rates", np.zeros_like(np.asarray(self.displacement, float)))
        for name in _VECTORS:
            values = np.array(getattr(self, name), float)
            if values.ndim != 1 or not np.isfinite(values).all():
                raise InputError(name, shown(getattr(self, name)), "finite numbers, one for each coordinate")
            object.__setattr__(self, name, values)

    def at_speed(self, slower: float) -> Limit:
        """Return the same where the unit of time, the inverse of the nominal speed, is shorter by a factor."""
        return replace(
            self,
            velocity=self.velocity / slower,
            accelerations=self.accelerations * slower**2,
            rates=np.asarray(self.rates) * slower,
        )


def with_limits(system: System, limits: Sequence[Limit]) -> System:
    """The system with limits of its controllers.

    Raises
    ------
    InputError
        The speed of its shaft changes, or a limit is of another number of coordinates.
    """
    n, arrays = len(system.rest), system.arrays
    if system.shaft is not None:
        raise InputError("limits", f"{len(limits)} limit(s)", "none where the speed of the shaft changes")
    for each in limits:
        if {len(getattr(each, name)) for name in _VECTORS} != {n}:
            raise InputError("limits", f"of {len(each.displacement)} coordinates", f"limits of {n} coordinates")
    turns = np.array([cmath.exp(-1j * each.angle) for each in limits])
    shown_by = np.array([each.displacement + 1j * each.velocity for each in limits]) * turns[:, None]
    rates = np.array([each.velocity for each in limits]) * turns[:, None]
    pushes = np.array([np.concatenate([each.rates, each.accelerations]) for each in limits]).T / turns
    couplings = np.zeros((len(limits), len(limits)), complex)
    for place, each in enumerate(limits):
        couplings[place, : len(each.follows)] = each.follows
    own = {
        "limit_rows": shown_by @ system.shapes + rates @ system.rates,
        "limit_offsets": shown_by @ system.rest,
        "limit_bounds": np.array([each.bound for each in limits], float),
        "limit_columns": system.to_modes @ pushes,
        "limit_couplings": couplings * turns[:, None] / turns,
    }
    kept = {name: arrays[name] for name in _KEPT}
    if system.mirrored is not None:
        own["limit_mirrors"] = system.mirrored @ pushes.conj()
        kept |= {name: arrays[name] for name in ("mirror", "mirror_columns")}
    return replace(system, arrays=rotor_record(**kept, limits=own))


@dataclass(frozen=True)
class Limited(Around):
    """A rotor on magnetic bearings that have limits, in the motion: beyond them they give no more, and the states of controllers wind up.

    Its matrices are those without the limits.

    Attributes
    ----------
    rotor : Jeffcott, InBearing or LinearRotor
    limits : carom.parameters.ControlLimit, or sequence of Limit
        Of the planar rotor in SI units; of any other rotor in units of its equations.

    Raises
    ------
    InputError
        The rotor or the limits are of another kind, the speed of its shaft changes, or its touchdown bearing is off the place of levitation.
    """

    rotor: Model
    limits: ControlLimit | tuple[Limit, ...] = ()

    def without_levitation(self) -> Model:
        """The rotor alone, without what its bearings give."""
        return self.rotor.without_levitation()

    def __post_init__(self) -> None:
        rotor, given = self.rotor, cast("Any", self.limits)
        if isinstance(given, ControlLimit):
            if not isinstance(rotor, Jeffcott | InBearing) or rotor.scales is None:
                raise InputError("rotor", shown(rotor), "the planar rotor with mass, clearance and speed")
            if isinstance(rotor, InBearing) and rotor.bearing.centre:
                allowed = (
                    "0 where the magnetic bearings have limits, whose force is counted from the place of levitation"
                )
                raise InputError("touchdown_offset", rotor.bearing.offset, allowed)
        else:
            listed: Any = tuple(given) if isinstance(given, Iterable) else ()
            if not listed or not all(isinstance(each, Limit) for each in listed):
                raise InputError("limits", shown(given), "carom.models.Limit, one or more")
            if not isinstance(rotor, LinearRotor):
                raise InputError("rotor", shown(rotor), "a carom.models.LinearRotor")
            object.__setattr__(self, "limits", listed)

    @cached_property
    def listed_limits(self) -> tuple[Limit, ...]:
        """The limits in units of the equations."""
        if not isinstance(self.limits, ControlLimit):
            return self.limits
        scales: Any = self.rotor.scales
        stiffness, damping = self.rotor.matrices.stiffness.real, self.rotor.matrices.damping.real
        n = len(self.rotor.system.rest)
        along = np.eye(n)[0]
        return (
            Limit(
                self.limits.force / scales.force,
                (stiffness[0, 0] + self.limits.pull / scales.stiffness) * along,
                damping[0, 0] * along,
                along,
            ),
        )

    @cached_property
    def system(self) -> System:
        """Modes, contact planes, contact law and limits."""
        return with_limits(self.rotor.system, self.listed_limits)

    @property
    def words(self) -> str:
        """Its parameters and its limits in a line."""
        own: Any = self.rotor
        words = self.words_of_limits
        return f"{own.words}; {words}" if hasattr(own, "words") else words

    @property
    def words_of_limits(self) -> str:
        """The limits in words."""
        return self.limits.words if isinstance(self.limits, ControlLimit) else f"{len(self.limits)} limits"

    @property
    def varied(self) -> Mapping[str, Field]:
        """Named parameters that can be varied: of a rotor of matrices not those of the levitation, with which its limits would change."""
        if isinstance(self.limits, ControlLimit):
            return self.rotor.varied
        return {name: field for name, field in self.rotor.varied.items() if name not in ("gamma", "omega")}

    def replace(self, **changes: Any) -> Limited:
        """Return the rotor with other values of its parameters; its limits stay what they are in SI units, or are those that its parameters state."""
        for name in changes.keys() & {"gamma", "omega"} - self.varied.keys():
            raise InputError(name, shown(changes[name]), "not to be set beside limits of the controllers")
        rotor: Any = self.rotor.replace(**changes)
        if isinstance(self.limits, ControlLimit):
            return Limited(rotor, self.limits)
        if rotor.stated_limits:  # what a controller asks for changes with its gains
            return Limited(rotor, rotor.stated_limits)
        before, after = self.rotor.scales, rotor.scales
        if before is None or after is None or before == after:
            return Limited(rotor, self.limits)
        return Limited(rotor, tuple(each.at_speed(before.speed / after.speed) for each in self.limits))

    def attributes(self) -> dict[str, Any]:
        """Return the rotor and the limits as attributes of a dataset, exact to the last bit."""
        if isinstance(self.limits, ControlLimit):
            limits: Any = asdict(self.limits)
        else:
            limits = [asdict(each) | {name: getattr(each, name).tolist() for name in _VECTORS} for each in self.limits]
        return {"limits": json.dumps(limits), "rotor": json.dumps(self.rotor.attributes())}


def limits_from(text: str) -> ControlLimit | tuple[Limit, ...]:
    """The limits of :meth:`Limited.attributes`."""
    given = json.loads(text)
    if isinstance(given, dict):
        return ControlLimit(**given)
    return tuple(Limit(**each | {"follows": tuple(each["follows"])}) for each in given)
