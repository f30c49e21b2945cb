"""Which forms show that all states return, chosen in double precision; nothing rests on the choice."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np
from flint import arb

from carom.proofs.forms import STEP, Form, Surface, all_trapped, limits_of, read_forms, traps_of

_SHARES, _RADII, _DIRECTIONS = 24, 3, 24
"""How many values of ``α/γ`` are tried, of the room for ``β`` and ``k``, and directions in it."""
_NEARLY = 0.99
_MOST_FORMS = 2000
_TURNS, _HEADINGS = 18, 37
_SPEEDS = (0.0, 0.5, 1.0)
_MARGIN = 0.01
"""By how much of its level a state must be inside of a trap, so that boxes around it are."""
_MOST_LIMITS, _HALVINGS, _TRIES, _LESS = 12, 7, 6, Fraction(49, 50)
_FINE, _BISECTIONS, _SLOWER = 2**40, 30, 0.99

Listed = list[list[str]]
"""Forms as evidence."""


class Candidates:
    """Forms that may be used for a rotor, with their levels.

    Parameters
    ----------
    wall : Surface
        In balls.
    finer : int
        How many times finer than usual the grid of forms is.
    """

    def __init__(self, wall: Surface[arb], finer: int = 1) -> None:
        self.wall = wall.plain()
        self.centred = _forms(self.wall, finer)
        self.forms, self.levels = self._best_shifts()

    def _best_shifts(self) -> tuple[Form[np.ndarray], np.ndarray]:
        """Of each form the share of levitation about which its trap holds the fastest states, of those from which motions return."""
        step = float(STEP)
        shifts = np.arange(0.0, 1.0 + step / 2, step)
        growth, turns = step * self.centred.step(self.wall), _turns(4 * _TURNS + 1)
        entries = [self._at(float(shift), turns) for shift in shifts]
        good = np.ones(self.centred.alpha.size, bool)
        fastest, best = np.full(good.size, -np.inf), np.full(good.size, len(shifts) - 1)
        for place in range(len(shifts) - 1, -1, -1):
            form, bound, speed = entries[place]
            core = form.core(self.wall)
            good &= (1 - _MARGIN) * np.sqrt(bound) > core
            if place < len(shifts) - 1:
                good &= core + growth < (1 - _MARGIN) * np.sqrt(entries[place + 1][1])
            better = good & (speed > fastest)
            fastest[better], best[better] = speed[better], place
        levels = np.array([bound for _, bound, _ in entries])[best, np.arange(good.size)]
        kept = np.argsort(-fastest)[:_MOST_FORMS]
        forms = replace(self.centred, shift=shifts[best])
        return Form(*(values[kept] for values in forms)), levels[kept]

    def _at(
        self, shift: float, turns: tuple[np.ndarray, np.ndarray]
    ) -> tuple[Form[np.ndarray], np.ndarray, np.ndarray]:
        """Forms about a share of levitation, their levels, and the speed up to which each holds all states."""
        forms = replace(self.centred, shift=np.full(self.centred.alpha.size, shift))
        radial, along = _spread(forms).centre(self.wall, *turns)
        away = _spread(forms).away(self.wall, turns[1])
        bound = (away + self.wall.hold * np.maximum(-radial, 0) ** 2).min(axis=1)
        room = np.sqrt(np.maximum(bound[:, None] - away, 0)) - np.hypot(radial, along)
        return forms, bound, room.min(axis=1)

    def chosen(self, speed: float) -> tuple[Listed, Listed] | None:
        """Traps, and forms that bound what arrives, for all states up to a speed; ``None`` if there are none."""
        a, b, turns, limits = self._impact_states(speed)
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

    def _impact_states(self, speed: float) -> tuple[np.ndarray, np.ndarray, tuple[np.ndarray, np.ndarray], list[int]]:
        """Velocities at the wall, sines and cosines of the angles of levitation, and the forms that bound them most."""
        turns = _turns(_TURNS + 1)
        forms = _joined(self.forms, (0.0, 0.0, self.wall.omega_squared, 1.0, np.inf))
        radial, along = _spread(forms).centre(self.wall, *turns)
        away = _spread(forms).away(self.wall, turns[1])
        bounds = ((speed + np.hypot(radial, along)) ** 2 + away).max(axis=1)
        bounds = np.maximum(bounds, forms.core(self.wall) ** 2)
        heading = np.linspace(-np.pi / 2, np.pi / 2, _HEADINGS)
        # Along a ray the form is r² − 2 r (v₀·ray) + |v₀|² + …
        ray = radial[..., None] * np.cos(heading) + along[..., None] * np.sin(heading)
        rest = bounds[:, None] - away - radial**2 - along**2
        reach = ray + np.sqrt(np.maximum(ray**2 + rest[..., None], 0))
        names, counts = np.unique(reach.argmin(axis=0), return_counts=True)
        order = [int(name) for name in names[np.argsort(-counts)] if name < self.levels.size][:_MOST_LIMITS]
        longest = np.maximum(reach[[*order, self.levels.size]].min(axis=0), 0)
        fast = longest[..., None] * np.array(_SPEEDS)
        a, b = (fast * wave(heading)[:, None] for wave in (np.cos, np.sin))
        places = np.broadcast_to(np.arange(turns[0].size)[:, None, None], fast.shape).ravel()
        return a.ravel(), b.ravel(), (turns[0][places], turns[1][places]), order


def _turns(count: int) -> tuple[np.ndarray, np.ndarray]:
    angle = np.linspace(0, 2 * np.pi, count)
    return np.sin(angle), np.cos(angle)


def _forms(wall: Surface[np.ndarray], finer: int) -> Form[np.ndarray]:
    """Forms about levitation that fall in flight, each at its largest rate."""
    alpha = np.array([*np.linspace(0.03, 0.97, finer * _SHARES), 0.99, 0.997])[:, None] * wall.gamma
    direction = np.linspace(0, 2 * np.pi, finer * _DIRECTIONS, endpoint=False)
    radii = np.linspace(0, _NEARLY, finer * _RADII + 1)[1:]
    waves = np.concatenate([[0j], *(radius * np.exp(1j * direction) for radius in radii)])
    room = np.sqrt(4 * alpha * (wall.gamma - alpha) * wall.omega_squared)
    beta, more = room * waves.real / wall.gamma, room * waves.imag
    stiffness = wall.omega_squared + wall.gamma * alpha + more
    forms = Form(*(values.ravel() for values in np.broadcast_arrays(alpha, beta, stiffness, 1.0, 0.0)))
    forms = Form(*(values[forms.rest > 0] for values in forms))
    low, high = forms.rate, np.full(forms.rate.size, wall.gamma / 2)
    for _ in range(_BISECTIONS):
        middle = (low + high) / 2
        falls = np.all([slack > 0 for slack in replace(forms, rate=middle).slacks(wall)], axis=0)
        low, high = np.where(falls, middle, low), np.where(falls, high, middle)
    return replace(forms, rate=_SLOWER * low)


def _spread(forms: Form[np.ndarray]) -> Form[np.ndarray]:
    """Forms along a first axis, for states along others."""
    return Form(*(np.asarray(values)[:, None] for values in forms))


def _joined(forms: Form[np.ndarray], last: Iterable[np.ndarray | float]) -> Form[np.ndarray]:
    return Form(*(np.append(values, value) for values, value in zip(forms, last, strict=True)))


def _listed(forms: Form[np.ndarray], chosen: Sequence[int]) -> Listed:
    return [[str(Fraction(round(float(values[place]) * _FINE), _FINE)) for values in forms] for place in chosen]


def search(wall: Surface[arb], speed: arb) -> list[str | Listed] | None:
    """A share of a speed up to which all states return, the traps, and the forms that bound what arrives; ``None`` if none is found.

    Parameters are balls.
    """
    largest = float(speed.mid())
    for finer in (1, 2):
        candidates = Candidates(wall, finer)
        share = _largest_share(candidates, largest)
        for _ in range(_TRIES if share else 0):
            found = candidates.chosen(float(share) * largest)
            if found is not None and shown(wall, speed * arb(share.numerator) / share.denominator, *found):
                return [str(share), *found]
            share *= _LESS
    return None


def _largest_share(candidates: Candidates, largest: float) -> Fraction:
    """The largest share of a speed for which there are forms, about; 0 if there are none for a small one."""
    if candidates.chosen(largest) is not None:
        return Fraction(1)
    low, high = Fraction(0), Fraction(1)
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if candidates.chosen(float(middle) * largest) is not None else (low, middle)
    return low


def shown(wall: Surface[arb], speed: arb, traps: Listed, limits: Listed) -> bool:
    """Whether forms, as in evidence, show that all states up to a speed return."""
    trapping = traps_of(wall, read_forms(traps))
    arriving = limits_of(wall, speed, read_forms(limits))
    return trapping is not None and arriving is not None and all_trapped(wall, arriving, trapping)
