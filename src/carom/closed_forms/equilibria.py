"""Equilibria in the co-rotating frame of any linear rotor: levitation and synchronous rub.

*Whether a rub attracts sliding*: the motion next to it is linearised, for any modes and contact planes.  With the planes ``p`` of a set in forward slip, ``ċ = Mc − Σ B_p (1 + iμ_p) N_p y_p`` where the normal forces solve
``Σ_q A_pq N_q = w_p``, ``A_pq = Re(ȳ_p G_pq (1 + iμ_q) y_q)`` and ``w_p = Re(ȳ_p a_p) + |ẏ_p|²`` (see
:mod:`carom.core.contact_series`).  At rest ``ẏ = 0``, so

    A δN = Re(δȳ a + ȳ δa) − δA N,

and small motions keep ``Re(ȳ_p δy_p) = Re(ȳ_p δẏ_p) = 0``.

A plane in a compliant wall is free to move along its normal ``n = y/|y|``.  Its force ``−(1 + iμ) N n`` follows from the law, with
``δN = N_δ Re(n̄δy) + N_δ̇ Re(n̄δẏ)`` and ``δn = i n Im(n̄δy)/|y|``, and adds to the accelerations ``a`` of the others.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Literal

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import Phase
from carom.base.results import Members, Result, in_a_line
from carom.closed_forms.sag import Levitation, Status, levitation, status_of
from carom.closed_forms.statics import COUNTED, all_found, depths, exponent_of, rub_forces, static_state
from carom.core.friction import FORWARD, friction_ratio
from carom.core.laws.choice import force_change, force_coefficient
from carom.models import Rotor, Subject, System, rotor_of
from carom.models.limits import saturates
from carom.models.subjects import refuse_forces
from carom.parameters import Scales


def rub_attracts(system: System, amplitudes: np.ndarray, contact: np.ndarray) -> bool:
    """Whether sliding next to a synchronous rub approaches it."""
    return bool((sliding_rates(system, amplitudes, contact).real < 0.0).all())


def sliding_rates(system: System, amplitudes: np.ndarray, contact: np.ndarray) -> np.ndarray:
    """Exponents, in ``Ω``, of the sliding motions next to a synchronous rub; shape (4n − 2C,) for ``C`` rigid planes in contact.

    The amplitudes (N,) are those of the rub, at rest in the co-rotating frame.  The state of contact (P,) is
    ``FORWARD_SLIP`` at each plane that rubs.
    """
    stiffness, rubs = system.arrays["stiffness"], np.flatnonzero(contact == Phase.FORWARD_SLIP)
    pressed, rubs = rubs[stiffness[rubs] > 0.0], rubs[stiffness[rubs] == 0.0]
    # Real and imaginary parts of all free amplitudes are changed by one, in turn.
    free = np.eye(len(amplitudes))[system.free]
    changes = np.concatenate([free, 1j * free])
    forces, pulls = np.zeros(len(pressed), complex), np.zeros((len(changes), len(pressed)), complex)
    for place, plane in enumerate(pressed.tolist()):
        forces[place], pulls[:, place] = _in_wall(system, plane, amplitudes, changes)
    rates = changes @ system.generator.T
    if len(pressed):
        rates = rates + pulls @ system.arrays["columns"][:, pressed].T
    if len(rubs):
        beside = system.arrays["mobility"][np.ix_(rubs, pressed)]
        return _on_walls(system, rubs, amplitudes, changes, rates, beside @ forces, pulls @ beside.T)
    rates = rates[:, system.free]
    return np.linalg.eigvals(np.concatenate([rates.real, rates.imag], axis=1).T)


def _on_walls(
    system: System,
    rubs: np.ndarray,
    amplitudes: np.ndarray,
    changes: np.ndarray,
    rates: np.ndarray,
    pulled: np.ndarray,
    pulls: np.ndarray,
) -> np.ndarray:
    """Exponents of motions that slide on rigid walls at some planes (C,), from changes (M, N) and their rates without these forces.

    The other planes pull these ones with accelerations (C,), which change by (M, C).
    """
    arrays = system.arrays
    rows, columns = arrays["rows"][rubs], arrays["columns"][:, rubs]
    grip = 1.0 + 1j * arrays["friction"][rubs]
    y, a = rows @ amplitudes + arrays["offsets"][rubs], arrays["acceleration_rows"][rubs] @ amplitudes + pulled
    mobility = arrays["mobility"][np.ix_(rubs, rubs)] * grip
    matrix = (y.conj()[:, None] * mobility * y).real
    push = np.linalg.solve(matrix, (y.conj() * a).real)
    dy, da = changes @ rows.T, changes @ arrays["acceleration_rows"][rubs].T + pulls
    turned = dy.conj()[:, :, None] * mobility * y + y.conj()[:, None] * mobility * dy[:, None, :]
    right = (dy.conj() * a + y.conj() * da).real - turned.real @ push
    force = -grip * (np.linalg.solve(matrix, right.T).T * y + push * dy)
    rates = (rates + force @ columns.T)[:, system.free]
    jacobian = np.concatenate([rates.real, rates.imag], axis=1).T
    across = np.concatenate([(y.conj() * dy).real, (y.conj() * (changes @ arrays["rate_rows"][rubs].T)).real], axis=1)
    along = np.linalg.svd(across.T)[2][2 * len(rubs) :]
    return np.linalg.eigvals(along @ jacobian @ along.T)


def _in_wall(system: System, plane: int, amplitudes: np.ndarray, changes: np.ndarray) -> tuple[complex, np.ndarray]:
    """Contact force of a plane at rest in a compliant wall, and how changes (M, N) of the amplitudes change it, shape (M,)."""
    contact, arrays = system.contacts[plane], system.arrays
    y = complex(contact.row @ amplitudes) + contact.offset
    normal, radius, wall = y / abs(y), abs(y), contact.wall
    moved = (changes @ contact.row) * normal.conjugate()
    deeper, faster = moved.real, (normal.conjugate() * (changes @ arrays["rate_rows"][plane])).real
    depth, rest, power, power_change = np.array([radius - 1.0]), np.zeros(1), np.zeros(1), np.zeros(1)
    push = force_coefficient(0, depth, rest, power, wall)
    ratio = complex(-1.0, friction_ratio(FORWARD, wall))
    stiffness, damping = (
        force_change(0, depth, rest, power, np.array([by_depth]), np.array([by_rate]), power_change, wall)
        for by_depth, by_rate in ((1.0, 0.0), (0.0, 1.0))
    )
    turned = 1j * moved.imag / radius
    return ratio * push * normal, ratio * normal * (stiffness * deeper + damping * faster + push * turned)


Kind = Literal["contact-free", "rub"]
NEUTRAL = 64 * np.finfo(float).eps
"""Rounding error of the exponents, relative to the largest."""


@dataclass(frozen=True, eq=False, repr=False)
class Equilibrium(Result):
    """A synchronous motion: at rest in the co-rotating frame, a circle in the fixed one.

    Attributes
    ----------
    kind : {"contact-free", "rub"}
    position : complex, or ndarray of complex, shape (n,)
        Coordinates of the rotor, for the planar rotor ``U*`` in clearances.
    places : ndarray of complex, shape (P,)
        Displacement at each contact plane, in the clearance there.
    normal_forces : ndarray, shape (P,)
        ``N`` at each plane, in ``m c_r Ω²``; zero where it does not rub.
    planes : tuple of int
        Planes that rub.
    status : {"admissible", "boundary", "virtual"}
        Contact-free: inside, on or outside a wall.  Rub: pressed on its walls and inside the others; on the boundary of
        this; or only possible if a wall could pull, or outside another wall.
    eigenvalues : ndarray of complex
        Exponents of small disturbances; for a rub of those that maintain contact where it rubs.
    stable : bool
        Whether small disturbances die out, including those that lift a rotor that rubs at one plane off its wall.  Of a
        rub at several planes only disturbances that maintain contact are judged.
    scales : Scales or None
        Those of the rotor.
    """

    kind: Kind
    position: Any
    places: np.ndarray
    normal_forces: np.ndarray
    planes: tuple[int, ...]
    status: Status
    eigenvalues: np.ndarray
    stable: bool
    scales: Scales | None = None

    @property
    def plane(self) -> int:
        """Plane with the largest normal force; without contact the one nearest to its wall."""
        return int(np.argmax(self.normal_forces if self.planes else np.abs(self.places)))

    @property
    def normal_force(self) -> float:
        """Normal force there; zero without contact."""
        return float(self.normal_forces[list(self.planes)].max() if self.planes else 0.0)

    @property
    def radius(self) -> float:
        """``|y|`` there, in clearances."""
        return float(abs(self.places[self.plane]))

    @property
    def angle(self) -> float:
        """``arg y`` there, in rad."""
        return float(np.angle(self.places[self.plane]))

    @property
    def attracts_sliding(self) -> bool:
        """Whether a rub attracts, as long as nothing lifts the rotor off the wall."""
        return self.kind == "rub" and self.status == "admissible" and _dies_out(self.eigenvalues)


@dataclass(frozen=True, eq=False, repr=False)
class EquilibriumSet(Members[Equilibrium]):
    """The equilibria of a rotor: the contact-free one, then the synchronous rubs, stable ones first.

    Attributes
    ----------
    rotor : Model
    members : tuple of Equilibrium
    complete : bool
        Whether these are all isolated equilibria.
    """

    figure: ClassVar[str] = "equilibria"
    called: ClassVar[str] = "equilibrium"

    rotor: Rotor
    members: tuple[Equilibrium, ...]
    complete: bool

    def rows(self) -> list[tuple[str, str]]:
        """Each equilibrium in a line."""
        lines = []
        for at in self.members:
            stable, force = "stable" if at.stable else "not stable", self.line_of("normal_force", at.normal_force)
            lines.append((f"{at.kind}{_at_planes(at)}", f"{at.status}, {stable}, normal force {force}"))
        return [("rotor", in_a_line(self.rotor)), *lines, ("complete", in_a_line(self.complete))]

    @cached_property
    def argument(self) -> str:
        """Why there are no more, or what is not claimed."""
        planes, contacts = len(self.members[0].places), self.rotor.system.contacts
        curved = any(exponent_of(contact.wall) != 1.0 for contact in contacts)
        found = "A linear rotor has one contact-free equilibrium; rubs at one plane are the two roots of a quadratic"
        if curved:
            found += ", in a wall whose force is no multiple of the depth all positive roots of a sum of powers"
        if planes > 1:
            found += ", those at two planes the real roots of a polynomial of degree eight"
        if planes > COUNTED:
            found += "; rubs at more planes were searched by Newton's method from many starts, so there may be others"
        if planes > 1 and curved:
            found += "; rubs at several planes, one of them in such a wall, were not searched"
        if self.rotor.system.races is not None:
            found += "; rubs without slip, in which a race turns along, were not searched"
        return f"{found}. Rubs that are possible at every angle, such as those of a balanced rotor, are not listed."


@checked
def find_equilibria(machine: Subject) -> EquilibriumSet:
    """All equilibria: the contact-free one, then the synchronous rubs, the stable ones first.

    Contact-free: ``K U* = F`` with the matrices of the co-rotating frame; for the planar rotor
    ``U* = ρe^{iφ}/(ω² − 1 + iγ)``, source paper (3.7).

    Synchronous rub: the contact force ``−N(1 + iμ)e^{iθ}`` (slip is forward, ``s + 1 > 0``) acts through the static
    receptance of the planes (:mod:`carom.closed_forms.statics`).  Rubs at one plane and at two planes at once are all
    found; at three and more they are searched, and ``complete`` is false.  In a compliant wall the rotor is as deep as
    the force presses it: ``|y| = 1 + δ`` with the force of the law at rest, and ``normal_force`` pushes where it is above zero.
    For the planar rotor
    ``ρ sin x + μρ cos x = −γ − μ(1 − ω²)``, ``N = ρ cos x + 1 − ω²`` with ``x = θ − φ``: none or two.

    For a balanced rotor (``ρ = 0``) no rub is listed, because no angle is distinguished: if ``γ + μ(1 − ω²) = 0``, as
    without damping and friction, the planar rotor may rub at every angle, otherwise at none.  Rubs at two planes that
    always touch together are not listed either: statics does not determine their separate forces.

    Rubs that ask for more than the limits of magnetic bearings are no motions and are not listed; where levitation does, it does not count as
    stable.

    See Also
    --------
    carom.find_orbits : periodic motions
    carom.closed_forms.rub_limit : damping up to which a stable rub exists

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> [(one.kind, one.stable) for one in cm.find_equilibria(machine)]
    [('contact-free', True), ('rub', True), ('rub', False)]
    """
    model = rotor_of(machine)
    system = model.system
    refuse_forces(model)
    balances = (each for each in rub_forces(system) if not saturates(system, static_state(system, *each)))
    rubs = [_rub(model, *balance) for balance in balances]
    found = (_contact_free(model), *sorted(rubs, key=lambda rub: (not rub.stable, rub.status)))
    return EquilibriumSet(model, found, complete=all_found(system))


def _contact_free(model: Rotor) -> Equilibrium:
    system = model.system
    places, rates = np.asarray(system.arrays["offsets"]), system.exponents
    position = complex(system.rest[0]) if len(system.rest) == 1 else system.rest
    at = position, places, np.zeros(len(places)), (), status_of(1.0 - float(np.abs(places).max()))
    # The exponents of the planar rotor are exact, others have rounding errors.
    margin = 0.0 if model.has_closed_forms else NEUTRAL
    stable = _dies_out(rates, margin) and not saturates(system, np.zeros(system.modes))
    return Equilibrium("contact-free", *at, rates, stable, model.scales)


def _rub(model: Rotor, planes: tuple[int, ...], forces: np.ndarray, touching: np.ndarray) -> Equilibrium:
    system = model.system
    arrays, chosen = system.arrays, list(planes)
    amplitudes = static_state(system, planes, forces, touching)
    places, pushes = arrays["rows"] @ amplitudes + arrays["offsets"], np.zeros(len(arrays["rows"]))
    # The balance is that of unit effective masses.
    deep = depths(system, planes, forces)
    touching = np.where(deep == 0.0, touching, (1.0 + deep) * touching)
    places[chosen], pushes[chosen] = touching, forces * arrays["masses"][chosen]
    contact = np.full(len(places), Phase.FLIGHT)
    contact[chosen] = Phase.FORWARD_SLIP
    eigenvalues = sliding_rates(system, amplitudes, contact)
    position, _ = system.state(amplitudes)
    # At several planes bounces are not judged; a compliant wall has none at rest.
    lands = len(planes) > 1 or bool(arrays["restitution"][planes[0]] < 1.0)
    margin = min(forces.min(), *(1.0 - np.abs(np.delete(places, chosen))), np.inf)
    stable = _dies_out(eigenvalues) and bool(forces.min() > 0.0) and lands
    place = complex(touching[0]) if system.is_planar else position if len(system.rest) > 1 else complex(position)
    at = place, places, pushes, planes, status_of(float(margin))
    return Equilibrium("rub", *at, eigenvalues, stable, model.scales)


def _dies_out(eigenvalues: np.ndarray, margin: float = NEUTRAL) -> bool:
    """Whether disturbances die out, with a margin above the rounding errors."""
    return bool(eigenvalues.real.max() < -margin * np.abs(eigenvalues).max())


def _at_planes(at: Equilibrium) -> str:
    """At which of several planes it is, counted from 1."""
    if len(at.places) == 1 or not at.planes:
        return ""
    return f" at touchdown bearing {in_a_line(tuple(plane + 1 for plane in at.planes))}"


SteadyMotion = Equilibrium | Levitation
"""A motion that is the same in each turn of the shaft."""


def steady_motions(rotor: Rotor) -> tuple[SteadyMotion, ...]:
    """Levitation, then the synchronous rubs; levitation alone where something stands in the fixed frame or the speed of the shaft changes.

    Under weight nothing else is at rest in the frame that turns with the shaft: a rotor that lies on its bearing is found among the ends
    of simulated motions.
    """
    system = rotor.system
    alone = system.outer.any() or system.is_anisotropic or system.shaft is not None
    return (levitation(rotor),) if alone else find_equilibria(rotor).members
