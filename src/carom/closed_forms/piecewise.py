"""Motion next to a point of a wall that levitation touches: pieces of linear motion, to first order in the distance.

Let ``y*`` be the place at rest of a plane, ``n = y*/|y*|`` and ``g = |y*| − 1`` the gap, below zero where the rotor levitates.  With the
amplitudes ``c`` of the free modes, ``ċ = Mc``, the row ``W`` of the plane and what an impulse there does, ``B``, a plane that is near
``y*`` is ``δ = g + Re(n̄Wc)`` deep in its wall, up to terms of second order, and slip is forward.

*Rigid wall.*  An impact at ``δ = 0`` with ``δ̇ > 0`` changes ``c`` by ``−Bqnδ̇`` with ``q = (1 + d)(1 + iμ)``.

*Wall with a linear spring.*  While the force ``N = κδ + ηδ̇`` per effective mass pushes, ``ċ = Mc − (1 + iμ)Bn N``.  Where contact begins
the rates jump by ``ηδ̇``; where it ends nothing does.

All of it is homogeneous in ``c`` and ``g``: only the sign of ``g`` matters, and motions are proportional to its size.  A wall whose force grows with a
higher power of the depth has no effect to first order.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import expm  # type: ignore[import-untyped]

from carom.base.outcome import InputError
from carom.core.friction import sliding_factor
from carom.models import System


@dataclass(frozen=True, eq=False)
class Pieces:
    """Motion next to a point of a wall, over real and imaginary parts of the amplitudes of the free modes.

    Attributes
    ----------
    flight : ndarray, shape (2N, 2N)
        Rates per state in flight.
    depth, speed : ndarray, shape (2N,)
        ``δ − g`` and ``δ̇`` per state.
    push : ndarray, shape (2N,)
        What changes the state with a normal force of one, per effective mass.
    impact_column : ndarray, shape (2N,)
        What changes it with an impact of speed one at a rigid wall.
    stiffness, loss : float
        ``κ`` and ``η``; zero for a rigid wall.
    """

    flight: np.ndarray
    depth: np.ndarray
    speed: np.ndarray
    push: np.ndarray
    impact_column: np.ndarray
    stiffness: float
    loss: float

    @classmethod
    def of(cls, system: System, plane: int) -> Pieces:
        """Pieces at a plane of a system, which is not at rest in the centre of it."""
        arrays, free = system.arrays, system.free
        rest = complex(arrays.offsets[plane])
        if rest == 0.0:
            raise InputError("plane", plane, "one that is off its centre at rest: otherwise there is no direction")
        normal = rest / abs(rest)
        generator = system.generator[np.ix_(free, free)]
        row, column = arrays.rows[plane, free] * normal.conjugate(), arrays.columns[free, plane] * normal
        friction, restitution = float(arrays.friction[plane]), float(arrays.restitution[plane])
        return cls(
            flight=np.block([[generator.real, -generator.imag], [generator.imag, generator.real]]),
            depth=_read(row),
            speed=_read(row @ generator),
            push=_written(-complex(1.0, friction) * column),
            impact_column=_written(-sliding_factor(friction, restitution) * column),
            stiffness=float(arrays.stiffness[plane]),
            # The dissipation of a Hunt–Crossley wall acts on what is small already.
            loss=0.0 if arrays.law_number[plane] else float(arrays.loss[plane]),
        )

    @property
    def rigid(self) -> bool:
        """Whether the wall is rigid."""
        return not self.stiffness

    @cached_property
    def force(self) -> np.ndarray:
        """Normal force per state, beside that of the gap."""
        return self.stiffness * self.depth + self.loss * self.speed

    @cached_property
    def contact(self) -> np.ndarray:
        """Rates per state in contact, shape (2N, 2N)."""
        return self.flight + np.outer(self.push, self.force)

    @cached_property
    def compliance(self) -> float:
        """Gap per normal force at rest in contact: ``Re h``, how far the force and its friction move the plane, and how far the wall is indented."""
        moved = float(self.depth @ np.linalg.solve(self.flight, self.push))
        return moved if self.rigid else moved + 1.0 / self.stiffness

    def in_flight(self, time: float) -> np.ndarray:
        """State after a flight per state before it."""
        return expm(self.flight * time)

    def before_impact(self, state: np.ndarray) -> np.ndarray:
        """Derivative of the state after an impact by that before it, as it happens earlier or later, shape (2N, 2N)."""
        unit, ahead = np.eye(len(state)), self.depth / (self.speed @ state)
        before = self.flight @ state
        reset = unit + np.outer(self.impact_column, self.speed)
        return reset + np.outer(self.flight @ reset @ state - reset @ before, ahead)


def _read(row: np.ndarray) -> np.ndarray:
    """``Re(row c)`` per real and imaginary parts of ``c``."""
    return np.concatenate([row.real, -row.imag])


def _written(column: np.ndarray) -> np.ndarray:
    return np.concatenate([column.real, column.imag])
