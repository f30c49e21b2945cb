"""A flexible machine by a few vectors, as a model that all of carom takes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from carom.base.outcome import InputError
from carom.base.results import Result
from carom.models import Limit, Matrices, Rotor, Touchdown
from carom.models.planar import law_of, race_of
from carom.models.touchdown import FARTHEST
from carom.parameters import Scales
from carom.parameters.fields import RPM
from carom.parameters.restitution import damping_ratio_of
from carom.parameters.touchdown_bearing import OF_CATALOGUE
from carom.rotors.attachments import TouchdownPlane
from carom.rotors.bearing_limits import limited_currents, limits_of_bearings
from carom.rotors.controllers import PID
from carom.rotors.equations import RotorEquations, equations_of, loops_of
from carom.rotors.flexible_model import FlexibleDefinition
from carom.rotors.free_motions import slowest_of, stability_limits
from carom.rotors.part_tables import machine_toml
from carom.rotors.reduction import Basis, contact_error
from carom.rotors.shared_controller import loops_in

if TYPE_CHECKING:
    from carom.rotors.flexible_machine import FlexibleMachine

UNHELD = "levitation"
"""What errors name where nothing holds the rotor."""
SLOWEST = 3e-7
"""Rate of an integrator, in ``Ω``, up to which its motion and the steady one under weight are one mode but for rounding."""
DAMPING_RATIOS = (0.0, 0.01, 0.03, 0.1, 0.3, 1.0)
"""Of the vectors that are no modes; the first with which the reduced rotor comes back where the whole machine does is taken."""
SLOWER = 0.5
"""Rate at which the reduced rotor comes back, over that of the whole machine, that is enough."""
FALL = 9.81
"""Acceleration, m/s², of a fall through the clearance, whose energy gives the depth in a touchdown bearing."""
FINER = 2.0
"""Times as many vectors, by which a motion is followed again to see what the others change."""
SLOW, LOOKED = 0.05, 20
"""Lowest speed at which a machine that does not levitate is looked at, over its own, and the number of speeds."""
ROUNDED = 1e-6
"""Share of its stiffness up to which a bearing has none, and frequency in ``Ω`` up to which a motion is no whirl."""


@dataclass(frozen=True, eq=False, repr=False)
class ReducedMachine(Result):
    """A flexible machine by a few vectors: modes of the free rotor, and the compliance of all others where forces act (Rubin).

    Attributes
    ----------
    machine : FlexibleMachine
    basis : Basis
        The vectors.
    """

    machine: FlexibleMachine
    basis: Basis

    stored: ClassVar = ("machine", "modes")
    shown: ClassVar = ("vectors", "modes", "error", "states")

    @staticmethod
    def from_stored(machine: FlexibleMachine, modes: int) -> ReducedMachine:
        """Make it again from a machine and the number of modes."""
        return machine.with_modes(modes)

    @cached_property
    def error(self) -> float:
        """Change of the force in a touchdown bearing with half as many vectors more, relative to that force.

        It is the root of the means of the squares while the first contact lasts, when the free rotor, damped as its shaft is, comes straight with all
        its mass, tilting, or in its first bending mode; the largest of all planes; 0 of all modes.  Along a motion of the machine it may be more: that is stated with the motion.
        """
        at, loops = self.machine, loops_of(self.machine)
        finer = at.finer_than(self.basis)
        if finer is None:
            return 0.0
        weight = at.rotor.mass * FALL
        planes = zip(loops.touchdowns, at.touchdowns, at.clearances, strict=True)
        return max(
            contact_error(at.rotor, self.basis, finer, row, plane.stiffness(weight * room))
            for row, plane, room in planes
        )

    def to_toml(self) -> str:
        """Return the tables of a machine file that are read as this machine; empty if its rotor has matrices that are in no file."""
        return machine_toml(self.machine, self.modes)

    @property
    def vectors(self) -> int:
        """Number of vectors."""
        return len(self.basis.frequencies)

    @property
    def modes(self) -> int:
        """How many of them are modes of the free rotor, two of which are rigid."""
        return self.basis.modes

    @property
    def states(self) -> int:
        """Number of complex states: displacements and velocities of all vectors, and states of controllers; twice that if a support is anisotropic."""
        once = len(self.equations.mass) + int(self.equations.mass.any(axis=1).sum())
        return 2 * once if self.equations.is_anisotropic else once

    @cached_property
    def scales(self) -> Scales:
        """Mass of the rotor, clearance of the machine and speed: the units of the model."""
        machine = self.machine
        return Scales(machine.rotor.mass, machine.clearance, machine.speed)

    @cached_property
    def equations(self) -> RotorEquations:
        """Equations of motion in SI units."""
        return equations_of(self.machine, self.damped)

    @cached_property
    def damped(self) -> Basis:
        """The vectors, those that are no modes damped until their motion grows no more than those of the whole machine."""
        if self.modes == self.vectors or self.machine.slowest.grows:
            return self.basis
        ways = [self.basis._replace(damping_ratio=each) for each in DAMPING_RATIOS]
        return next((each for each in ways if self._comes_back(equations_of(self.machine, each))), self.basis)

    @property
    def comes_back(self) -> bool:
        """Whether the reduced rotor comes back where the whole machine does."""
        return self.machine.slowest.grows or self._comes_back(self.equations)

    def _comes_back(self, equations: RotorEquations) -> bool:
        whole = self.machine.slowest
        own = slowest_of(equations, self.machine.speed).exponents.real.max()
        return bool(own <= SLOWER * min(float(whole.exponents.real.max()), 0.0) + whole.rounding)

    @property
    def finer(self) -> ReducedMachine | None:
        """By twice as many vectors, and as many more as it takes to come back where the whole machine does; ``None`` of all modes."""
        basis = self.machine.finer_than(self.basis, FINER)
        while basis is not None:
            found = replace(self, basis=basis)
            if found.comes_back:
                return found
            basis = self.machine.finer_than(basis)
        return None

    def of(self, machine: FlexibleMachine) -> ReducedMachine:
        """By the same vectors, a machine with another value of a parameter, on none of which they depend but on numbers of a rigid rotor."""
        same = machine.rotor is self.machine.rotor
        return replace(self, machine=machine) if same else machine.with_modes(self.modes)

    @cached_property
    def linear(self) -> Rotor:
        """The levitating rotor without weight, in units of the equations; it knows the parameters of the machine by their names.

        Raises
        ------
        InputError
            There are magnetic bearings or supports, and a motion of the machine with all its modes grows, or of these vectors alone; or an
            integrator is so slow that under weight it cannot be distinguished from none.
        """
        rotor = self.unchecked
        if self.machine.bearings or self.machine.supports:
            self._check_levitation()
        if self.machine.gravity is not None and not self.machine.gravity.is_axial:
            self._check_integrators(rotor)
        return rotor

    def _check_levitation(self) -> None:
        """Refuse a machine of which a motion grows, of all its modes, and vectors that do not come back where it does."""
        slowest, speed = self.machine.slowest, self.machine.speed
        worst = complex(slowest.exponents[0])
        needed = f"controllers that hold the rotor at this speed{self._weak}"
        if slowest.grows:
            more = len(slowest.exponents) - 1
            others = f", {more} more slowly" if more else ""
            stated = f"unstable: {self._named(worst)} grows with {worst.real:.4g} 1/s{others}"
            raise InputError(UNHELD, stated, needed + self._slower)
        if abs(worst) <= slowest.rounding:
            raise InputError(UNHELD, "not stable: a displacement to one side does not come back", needed)
        if self.unchecked.system.decay < 0.0 and not self.comes_back:
            grown = complex(slowest_of(self.equations, speed).exponents[0])
            stated = f"{self.vectors} vectors, of which {self._named(grown)} grows that the machine does not have"
            raise InputError("reduction", stated, "more modes, or a smaller accuracy")

    @property
    def _slower(self) -> str:
        """Below which speed a machine levitates that does not at its own, in words; empty if it does not there either."""
        low, speed = self.machine.speed_range[0], self.machine.speed
        speeds = np.linspace(max(low, SLOW * speed), speed, LOOKED).tolist()
        found = stability_limits(self.machine.whole.equations, speeds)
        below = [each.speed for each in found if each.stable_below]
        return f"; it levitates below {below[-1] / RPM:.6g} rpm" if below else ""

    def _named(self, exponent: complex) -> str:
        """A motion that grows, by its exponent, 1/s."""
        # One that has gone far before it has turned by a tenth of a radian is no whirl to a reader.
        if abs(exponent.imag) <= max(ROUNDED * self.machine.speed, 0.1 * exponent.real):
            return "a displacement to one side"
        sense = "" if self.equations.is_anisotropic else "forward " if exponent.imag > 0.0 else "backward "
        return f"a {sense}whirl of {abs(exponent.imag) / (2.0 * math.pi):.4g} Hz"

    @property
    def _weak(self) -> str:
        """Which bearings push a steady displacement further, in words; empty if none does."""
        found = []
        for number, each in enumerate(self.machine.bearings, start=1):
            if each.controller is None:
                continue
            stiffness, of = each.static_stiffness, "ki C(0) + ks"
            if math.isinf(stiffness) and isinstance(each.controller, PID):
                # An integrator holds only what the proportional gain holds already.
                stiffness, of = each.ki * each.controller.proportional + each.ks, "ki P + ks"
            if stiffness <= ROUNDED * abs(each.ks):
                found.append(f"{of} of bearing {number}: {stiffness:.3g} N/m")
        return f"; static stiffness {', '.join(found)}, must be above 0" if found else ""

    def _check_integrators(self, rotor: Rotor) -> None:
        """Refuse an integrator so slow that what weight does to it has no digits left, and a rotor that nothing holds."""
        slowest = float(np.abs(rotor.system.exponents + 1j).min())
        if slowest > SLOWEST:
            return
        at = self.machine
        for loop in loops_in(at.rotor, at.bearings, at.shared_controllers):
            number, bearing = loop.bearings[0] + 1, at.bearings[loop.bearings[0]]
            if np.abs(np.linalg.eigvals(loop.both.A)).min(initial=1.0) <= SLOWEST * at.speed:
                gain = getattr(bearing.controller, "integral", None)
                name, stated, faster = "controller", "a slow integrator", SLOWEST / max(slowest, 1e-300)
                allowed = f"none, or one {faster:.2g} times as fast: this one acts as none under weight"
                if gain is not None:
                    name, stated = "integral", f"{gain:g} A/m/s"
                    allowed = f"0, or at least {faster * gain:.2g} A/m/s: less acts as none under weight"
                raise InputError(f"[[magnetic_bearing]] {number}: {name}", stated, allowed)
        if not self.machine.bearings:
            raise InputError(UNHELD, "no magnetic bearing, under weight", "one or more that hold the rotor")
        stated = f"none under weight: a motion comes back with {slowest * self.machine.speed:.2g} 1/s"
        raise InputError(UNHELD, stated, f"controllers that hold the rotor{self._weak}")

    @cached_property
    def limited(self) -> Rotor:
        """The levitating rotor without weight, with the limits of its magnetic bearings if these have any.

        Raises
        ------
        InputError
            As for :attr:`linear`.
        """
        return replace(self.linear, limits=self.limits) if self.limits else self.linear

    @cached_property
    def limits(self) -> tuple[Limit, ...]:
        """Limits of its magnetic bearings, in units of the equations, on the gains of which they depend."""
        return limits_of_bearings(
            self.equations, tuple(self.machine.bearings), self.equations.rows.bearings, self.scales
        )

    def held_by_bias(self, pull: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """What constant currents add to a constant push, N/√kg per coordinate, and these currents, A, shape (B,): those by which no sensor is displaced.

        Bearings whose controller integrates find theirs by themselves.
        """
        at, given = self.machine, self.equations
        controls = loops_in(at.rotor, at.bearings, at.shared_controllers)
        held = sorted(number for loop in controls if not loop.integrates for number in loop.bearings)
        n, currents = len(pull), np.zeros(len(at.bearings), complex)
        if not held:
            return np.zeros_like(pull), currents
        pushes, seen = given.rows.bearings[held], given.rows.sensors[held]
        twice = np.eye(1 + given.is_anisotropic)  # of anisotropic supports conjugates are unknowns too
        pushes, seen = np.kron(twice, pushes), np.kron(twice, seen)
        stiffness = given.both.stiffness if given.is_anisotropic else given.stiffness
        whole = np.append(pull, pull.conj())[: len(stiffness)]
        moved = seen @ np.linalg.solve(stiffness, np.column_stack([pushes.T, whole]))
        forces = -np.linalg.lstsq(moved[:, :-1], moved[:, -1])[0][: len(held)]
        currents[held] = -forces / np.array([at.bearings[place].ki for place in held])
        return forces @ pushes[: len(held), :n], currents

    @cached_property
    def model(self) -> Rotor:
        """The levitating rotor with its weight, if it has one, as all verbs take it; ``carom.drop`` takes its levitation away.

        The first coordinates are those of the vectors, the first of which is the translation of the whole rotor.

        Raises
        ------
        InputError
            As for :attr:`linear`.
        """
        gravity = self.machine.gravity
        return self.limited if gravity is None or not gravity.acceleration else self.limited.under_gravity(gravity)

    @cached_property
    def unchecked(self) -> Rotor:
        """The same, whether the motion on its magnetic bearings grows or not."""
        return Rotor(self.definition)

    @cached_property
    def definition(self) -> FlexibleDefinition:
        """Its equations of motion in their units, and its parameters."""
        given, scales, at, units = self.equations, self.scales, self.machine, self._units
        size = math.sqrt(scales.mass)
        # Cross-coupled damping of supports counts as gyroscopic, which stays when levitation is lost.
        left = 0.5 * (given.unlevitated[0] + given.unlevitated[0].conj().T)
        planes = zip(at.touchdowns, at.clearances, size * given.rows.touchdowns, strict=True)
        slowest = at.slowest
        damping, stiffness = units[0] * given.damping, units[1] * given.stiffness
        return FlexibleDefinition.in_fixed_frame(
            Matrices(given.mass, damping, given.gyroscopic, stiffness, given.forcing / (scales.length * size)),
            [self._touchdown(*each) for each in planes],
            reduced=self,
            growth=float(slowest.exponents.real.max()) / at.speed if slowest.grows else 0.0,
            translation=np.append(given.carried[: self.vectors] / size, np.zeros(len(given.mass) - self.vectors)),
            carried=given.carried / size,
            regained=given.regained,
            scales=scales,
            unlevitated=units * np.stack([left, given.unlevitated[1]]),
            conjugate=units * given.across if given.is_anisotropic else None,
            conjugate_unlevitated=units * given.across_unlevitated
            if (given.across_unlevitated != given.across).any()
            else None,
            magnets=self._magnets,
        )

    @property
    def _units(self) -> np.ndarray:
        """What damping and stiffness are multiplied by, shape (2, n, 1)."""
        has_mass, speed = np.asarray(self.equations.mass.any(axis=1))[:, None], self.machine.speed
        # Coordinates without mass have equations of first order, which have another unit.
        return np.stack([np.where(has_mass, 1.0 / speed, 1.0), np.where(has_mass, 1.0 / speed**2, 1.0 / speed)])

    def changes_at(self, speed: float) -> np.ndarray:
        """What another speed, in ``Ω``, adds to damping (with ``−iG``) and stiffness in the fixed frame without levitation, in units of the equations, shape (2, n, n)."""
        given = self.equations
        more = self._units * (given.at(speed * self.machine.speed).unlevitated - given.unlevitated) + 0j
        more[0] -= 1j * (speed - 1.0) * given.gyroscopic
        return np.asarray(more)

    @property
    def _magnets(self) -> np.ndarray | None:
        """Displacement at each magnet, in its air gap, per coordinate in units of the equations; ``None`` where no gap is known."""
        gaps = {number: each.air_gap for number, each in enumerate(self.machine.bearings) if each.air_gap is not None}
        if not gaps:
            return None
        unit = math.sqrt(self.scales.mass) * self.scales.length
        return np.asarray(unit / np.array([*gaps.values()])[:, None] * self.equations.rows.bearings[list(gaps)])

    def places(self, nodes: Sequence[int]) -> dict[str, np.ndarray]:
        """Displacement, in clearances of the machine, per coordinate in units of the equations: at magnetic bearings and the mean of the sensors of each, relative to housings; at nodes, and of housings."""
        for node in nodes:
            self.machine.rotor.check_node("nodes", node)
        named, size, n = dict[str, np.ndarray](), math.sqrt(self.scales.mass), len(self.equations.mass)
        rows = self.equations.rows
        for number, (pulls, seen) in enumerate(zip(rows.bearings, rows.sensors, strict=True), start=1):
            named |= {f"magnetic_bearing_{number}": size * pulls, f"magnetic_bearing_{number}_sensor": size * seen}
        for node in nodes:
            shown = size * self.machine.rotor.row_at(node) @ self.basis.shapes
            named[f"node_{node}"] = np.pad(shown, (0, n - self.vectors))
        seats = self.vectors + sum(bool(each.bearing.mount) for each in self.machine.touchdowns)
        for number, housing in enumerate(self.machine.housings):
            named[f"housing_{number + 1}"] = size / math.sqrt(housing.mass) * np.eye(n)[seats + number]
        return named

    def currents(self, coordinates: np.ndarray, rates: np.ndarray, weight: np.ndarray | None) -> np.ndarray:
        """Control currents (n, B), A, as their limits leave them, of coordinates and their rates (n, N) in the fixed frame, in units of the equations.

        Where bias currents carry a ``weight`` (N,), they count in the limits.
        """
        given, unit = self.equations, self.scales.length * math.sqrt(self.scales.mass)
        rates = rates * self.scales.speed
        alike = coordinates @ given.currents.T + rates @ given.current_rates.T
        across = coordinates.conj() @ given.currents_across[0].T + rates.conj() @ given.currents_across[1].T
        pull = np.zeros(coordinates.shape[1]) if weight is None else weight * (unit * self.scales.speed**2)
        return limited_currents(self.machine.bearings, unit * (alike + across), self.held_by_bias(pull)[1])

    def _touchdown(self, plane: TouchdownPlane, clearance: float, row: np.ndarray) -> Touchdown:
        """A touchdown bearing, in units in which its own clearance is the length and energies are those of the rotor."""
        whole, bearing = self.scales, plane.bearing
        if bearing.law == "kelvin-voigt" and bearing.restitution is not None:
            # That of the whole mass, which is not the unit of masses at a plane.
            ratio = damping_ratio_of(bearing.restitution)
            damper = 2.0 * ratio * math.sqrt((bearing.stiffness or 0.0) * whole.mass)
            bearing = bearing.replace(restitution=None, damping=damper)
        wide, ratio = clearance / whole.length, plane.rotor_radius / clearance
        scales = Scales(whole.mass / wide**2, clearance, whole.speed)
        law, race = law_of(bearing, scales, bearing.restitution or 0.0), race_of(bearing, ratio, scales)
        stated = None if plane.bearing.given.keys().isdisjoint(OF_CATALOGUE) else plane.bearing
        return Touchdown(row / wide, law, plane.friction, ratio + 1.0, race, wide, stated, plane.farthest or FARTHEST)
