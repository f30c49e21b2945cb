"""Which forms show that all states return, chosen in double precision; nothing rests on the choice."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from flint import arb

from carom.proofs.arrivals import all_trapped, limits_of, read_forms, traps_of
from carom.proofs.forms import Form, Surface

_SHARES = (*np.linspace(0.03, 0.97, 24), 0.99, 0.997)
"""Values of ``α/γ`` that are tried."""
_RADII, _DIRECTIONS = (0.33, 0.67, 0.999), 24
"""How much of the room for ``β`` and ``k`` is used, and in how many directions."""
_TURNS, _HEADINGS = 24, 49
_SPEEDS = (0.0, 0.5, 1.0)
_MARGIN = 0.01
"""By how much of its level a state must be inside of a trap, so that boxes around it are."""
_MOST_LIMITS, _HALVINGS, _TRIES, _LESS = 12, 7, 6, Fraction(49, 50)
_FINE = 2**40

Listed = list[list[str]]
"""Forms as evidence."""


class Candidates:
    """Forms that may be used for a rotor, with their levels.

    Parameters
    ----------
    wall : Surface
        In balls.
    """

    def __init__(self, wall: Surface) -> None:
        self.balls, self.wall = wall, wall.plain()
        self.forms = _forms(self.wall)
        turns = _turns(4 * _TURNS + 1)
        with np.errstate(over="ignore"):
            inward = np.maximum(-_spread(self.forms).centre(self.wall, *turns)[0], 0)
            levels = (_spread(self.forms).away(self.wall, turns[1]) + self.wall.hold * inward**2).min(axis=1)
        self.levels = levels

    def chosen(self, speed: float) -> tuple[Listed, Listed] | None:
        """Traps, and forms that bound what arrives, for all states up to a speed; ``None`` if there are none."""
        a, b, turns, limits = self._arrivals(speed)
        a, b = self.wall.after(a, b)
        sizes = _spread(self.forms).size(self.wall, turns, a, b)
        inside = sizes <= (1 - _MARGIN) * self.levels[:, None]
        left = np.ones(inside.shape[1], bool)
        traps = []
        while left.any():
            counts = inside[:, left].sum(axis=1)
            best = int(np.argmax(counts))
            if not counts[best]:
                return None
            traps.append(best)
            left &= ~inside[best]
        return _listed(self.forms, traps), _listed(self.forms, limits)

    def _arrivals(self, speed: float) -> tuple[np.ndarray, np.ndarray, tuple[np.ndarray, np.ndarray], list[int]]:
        """Velocities at the wall, sines and cosines of the angles of levitation, and the forms that bound them most."""
        turns = _turns(_TURNS + 1)
        forms = _joined(self.forms, Form(0.0, 0.0, self.wall.omega_squared))
        radial, along = _spread(forms).centre(self.wall, *turns)
        away = _spread(forms).away(self.wall, turns[1])
        bounds = ((speed + np.hypot(radial, along)) ** 2 + away).max(axis=1)
        heading = np.linspace(-np.pi / 2, np.pi / 2, _HEADINGS)
        # Along a ray the form is r² − 2 r (v₀·ray) + |v₀|² + …
        ray = radial[..., None] * np.cos(heading) + along[..., None] * np.sin(heading)
        rest = bounds[:, None] - away - radial**2 - along**2
        reach = ray + np.sqrt(np.maximum(ray**2 + rest[..., None], 0))
        names, counts = np.unique(reach.argmin(axis=0), return_counts=True)
        order = [int(name) for name in names[np.argsort(-counts)] if name < self.levels.size][:_MOST_LIMITS]
        longest = reach[[*order, self.levels.size]].min(axis=0)
        fast = longest[..., None] * np.array(_SPEEDS)
        a, b = (fast * wave(heading)[:, None] for wave in (np.cos, np.sin))
        places = np.broadcast_to(np.arange(turns[0].size)[:, None, None], fast.shape).ravel()
        return a.ravel(), b.ravel(), (turns[0][places], turns[1][places]), order


def _turns(count: int) -> tuple[np.ndarray, np.ndarray]:
    angle = np.linspace(0, 2 * np.pi, count)
    return np.sin(angle), np.cos(angle)


def _forms(wall: Surface) -> Form:
    """Forms that fall in flight."""
    alpha = np.array(_SHARES)[:, None] * wall.gamma
    direction = np.linspace(0, 2 * np.pi, _DIRECTIONS, endpoint=False)
    waves = np.concatenate([[0j], *(radius * np.exp(1j * direction) for radius in _RADII)])
    room = np.sqrt(4 * alpha * (wall.gamma - alpha) * wall.omega_squared)
    beta, more = room * waves.real / wall.gamma, room * waves.imag
    forms = Form(*(values.ravel() for values in np.broadcast_arrays(alpha, beta, more)))
    stiffness = wall.omega_squared + wall.gamma * forms.alpha + forms.stiffness
    forms = forms._replace(stiffness=stiffness)
    return Form(*(values[forms.rest > 0] for values in forms))


def _spread(forms: Form) -> Form:
    """Forms along a first axis, for states along others."""
    return Form(*(np.asarray(values)[:, None] for values in forms))


def _joined(forms: Form, last: Form) -> Form:
    return Form(*(np.append(values, value) for values, value in zip(forms, last, strict=True)))


def _listed(forms: Form, chosen: Sequence[int]) -> Listed:
    return [[str(Fraction(round(float(values[place]) * _FINE), _FINE)) for values in forms] for place in chosen]


def search(wall: Surface, speed: Any) -> list[Any] | None:
    """A share of a speed up to which all states return, the traps, and the forms that bound what arrives; ``None`` if none is found.

    Parameters are balls.
    """
    candidates, largest = Candidates(wall), float(speed.mid())
    share = _largest_share(candidates, largest)
    for _ in range(_TRIES if share else 0):
        found = candidates.chosen(float(share) * largest)
        if found is not None and shown(wall, speed * arb(share.numerator) / share.denominator, *found):
            return [str(share), *found]
        share *= _LESS
    return None


def _largest_share(candidates: Candidates, largest: float) -> Fraction:
    """The largest share of a speed for which there are forms, about."""
    if candidates.chosen(largest) is not None:
        return Fraction(1)
    low, high = Fraction(0), Fraction(1)
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if candidates.chosen(float(middle) * largest) is not None else (low, middle)
    return low


def shown(wall: Surface, speed: Any, traps: Any, limits: Any) -> bool:
    """Whether forms, as in evidence, show that all states up to a speed return."""
    trapping = traps_of(wall, read_forms(traps))
    arriving = limits_of(wall, speed, read_forms(limits))
    return trapping is not None and arriving is not None and all_trapped(wall, arriving, trapping)
