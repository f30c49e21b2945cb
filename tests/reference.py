"""High-precision reference for flights: the first crossing of ``|y| = 1``, certified in ball arithmetic.

It shares nothing with the kernels: its own exponents (from the parameters, to 57 digits), its own form of the flight and
its own search.  The search walks over times that are proven free of a crossing: with ``f = |y|² − 1`` and a bound
``M₃ ≥ |f'''|`` from the moduli of the modes,

    f(t + τ) ≤ f + f' τ + (f'' + M₃ h/3) τ²/2        for 0 ≤ τ ≤ h,

so a step that ends before the first root of the right side cannot pass a crossing.  The walk converges to a crossing from
below; the crossing is then enclosed between the last proven time and a time where ``f`` is proven positive.
"""

import math
from dataclasses import dataclass

from flint import acb, arb, ctx

ctx.prec = 192

SAFE = 1.0 - 1e-9
"""Share of a step that is taken: covers the rounding of the doubles in which steps are chosen."""
RESOLUTION = 1e-19
"""Width, relative to ``1 + t``, of the final enclosure of a crossing: far below the spacing of doubles."""
MOST_STEPS = 100_000


@dataclass(frozen=True)
class Crossing:
    """The first crossing of a flight, or the nearest pass that the reference cannot tell from one."""

    time: float
    slope: float
    exact_time: arb


class Flight:
    """A motion ``y(t) = offset + Σ a e^{λt} + Σ b (e^{λ₊t} − e^{λ₋t})/(λ₊ − λ₋)`` of one contact plane.

    Parameters
    ----------
    offset : acb
    modes : list of (amplitude, exponent)
        Free-standing terms.
    pairs : list of (amplitude, upper exponent, lower exponent)
        Divided differences; equal exponents give the confluent ``b t e^{λt}``.
    """

    def __init__(self, offset: acb, modes: list[tuple[acb, acb]], pairs: list[tuple[acb, acb, acb]]) -> None:
        self.offset = offset
        self.modes = modes
        self.pairs = pairs
        terms: list[tuple[acb, acb, acb]] = [(amplitude, acb(0), rate) for amplitude, rate in modes]
        for amplitude, upper, lower in pairs:
            if upper == lower:
                terms.append((acb(0), amplitude, upper))
            else:
                share = amplitude / (upper - lower)
                terms += [(share, acb(0), upper), (-share, acb(0), lower)]
        self._terms = _merged(terms)
        self._mode_sizes = [(_size(amplitude), complex(rate)) for amplitude, rate in modes]
        self._pair_sizes = [(_size(b), complex(p), complex(q), _size(p - q)) for b, p, q in pairs]

    def state(self, time: arb | float) -> tuple[acb, acb, acb]:
        """``y, ẏ, ÿ`` at a time."""
        position, velocity, acceleration = self.offset, acb(0), acb(0)
        for fixed, growing, rate in self._terms:
            power = (rate * time).exp()
            value = fixed * power
            if growing == 0:
                first = rate * value
                second = rate * first
            else:
                value += growing * time * power
                first = rate * value + growing * power
                second = rate * first + rate * growing * power
            position += value
            velocity += first
            acceleration += second
        return position, velocity, acceleration

    def level(self, time: arb | float) -> tuple[arb, arb, arb]:
        """``f, f', f''`` at a time."""
        position, velocity, acceleration = self.state(time)
        conjugate = position.conjugate()
        speed = (velocity * velocity.conjugate()).real
        return (
            (position * conjugate).real - 1,
            2 * (conjugate * velocity).real,
            2 * (speed + (conjugate * acceleration).real),
        )

    def derivative_bounds(self, time: float, span: float) -> tuple[float, float, float]:
        """Bounds of ``|ẏ|, |ÿ|, |y⃛|`` on ``time … time + span``."""
        bounds = [0.0, 0.0, 0.0]
        for amplitude, rate in self._mode_sizes:
            growth = amplitude * _growth(rate, time, span)
            for n in (1, 2, 3):
                bounds[n - 1] += growth * abs(rate) ** n
        for amplitude, upper, lower, gap in self._pair_sizes:
            high, low = _growth(upper, time, span), _growth(lower, time, span)
            largest, longest, peak = max(abs(upper), abs(lower)), time + span, _pair_growth(upper, lower, time, span)
            for n in (1, 2, 3):
                bound = (longest * largest**n + n * largest ** (n - 1)) * peak
                if gap > 0.0:
                    bound = min(bound, (abs(upper) ** n * high + abs(lower) ** n * low) / gap)
                bounds[n - 1] += amplitude * bound
        return bounds[0], bounds[1], bounds[2]

    def spread(self, time: float) -> float:
        """Sum of the moduli of the terms of ``y``, at their largest on ``0 … time``."""
        total = _size(self.offset) + sum(amplitude * _growth(rate, 0.0, time) for amplitude, rate in self._mode_sizes)
        for amplitude, upper, lower, gap in self._pair_sizes:
            response = min(time, 2.0 / gap) if gap > 0.0 else time
            total += amplitude * response * _pair_growth(upper, lower, 0.0, time)
        return total

    @property
    def fastest(self) -> float:
        """Largest modulus of an exponent."""
        return max([abs(rate) for _, rate in self._mode_sizes] + [abs(lower) for _, _, lower, _ in self._pair_sizes])

    @property
    def longest_step(self) -> float:
        """Step over which growing modes grow by no more than e."""
        rates = [rate.real for _, rate in self._mode_sizes]
        rates += [rate.real for _, upper, lower, _ in self._pair_sizes for rate in (upper, lower)]
        return 1.0 / max(1.0, *rates)

    def third_bound(self, time: float, span: float) -> float:
        """Bound of ``|f'''| = |2 Re(3 ẏ* ÿ + y* y⃛)|`` on ``time … time + span`` while ``|y| ≤ 1``."""
        first, second, third = self.derivative_bounds(time, span)
        return 2.0 * (3.0 * first * second + third) * (1.0 + 1e-12)

    def peak(self, time: float) -> tuple[float, float]:
        """Extremum of ``f`` next to a time: its time and its ``f``."""
        moment = arb(time)
        for _ in range(8):
            _, slope, bend = self.level(moment)
            moment = (moment - slope / bend).mid()
        return float(moment), float(self.level(moment)[0])


def jeffcott_flight(gamma: float, omega: float, rho: float, phi: float, position: acb, velocity: acb) -> Flight:
    """Flight of the planar rotor, ``Ü + (γ + 2i)U̇ + (ω² − 1 + iγ)U = ρe^{iφ}``, from a state in the co-rotating frame."""
    upper, lower = jeffcott_exponents(gamma, omega)
    equilibrium = jeffcott_equilibrium(gamma, omega, rho, phi)
    away = position - equilibrium
    return Flight(equilibrium, [(away, upper)], [(velocity - upper * away, upper, lower)])


def jeffcott_exponents(gamma: float, omega: float) -> tuple[acb, acb]:
    """Exponents, the one that decays slower first."""
    g, w = acb(gamma), acb(omega)
    split = (g * g - 4 * w * w).sqrt() if gamma != 2.0 * omega else acb(0)
    return (-g - acb(0, 2) + split) / 2, (-g - acb(0, 2) - split) / 2


def jeffcott_equilibrium(gamma: float, omega: float, rho: float, phi: float) -> acb:
    """Contact-free equilibrium ``ρe^{iφ}/(ω² − 1 + iγ)``."""
    return acb(rho) * unit(phi) / (acb(omega) ** 2 - 1 + acb(0, gamma))


def unit(angle: float | arb) -> acb:
    """``e^{i·angle}``, exact for a double."""
    return acb(0, angle).exp()


def plane_flight(offset, row, exponents, driven, amplitudes) -> Flight:
    """Flight of one plane of a general rotor from the arrays that define it (see ``rotor_record``)."""
    modes, pairs = [], []
    for k, (weight, rate, amplitude) in enumerate(zip(row, exponents, amplitudes, strict=True)):
        modes.append((acb(weight) * acb(amplitude), acb(rate)))
        if driven[k]:
            pairs.append((acb(weight) * acb(amplitudes[k - 1]), acb(rate), acb(exponents[k - 1])))
    return Flight(acb(offset), modes, pairs)


def first_crossing(flight: Flight, horizon: float, radial_speed: float | None = None) -> Crossing | None:
    """First time in ``0 … horizon`` at which a flight leaves the disc, or ``None``.

    Parameters
    ----------
    flight : Flight
        Starts inside the wall, or on it.
    horizon : float
    radial_speed : float, optional
        Given for a start on the wall: its ``f`` is zero and its radial speed is this, not above zero, both exactly.

    Raises
    ------
    ArithmeticError
        The pass is so nearly tangential that 57 digits do not decide, or the start does not leave the wall.
    """
    time = arb(0)
    if radial_speed is not None:
        time = arb(_departure(flight, radial_speed))
    for _ in range(MOST_STEPS):
        now = float(time)
        if now >= horizon:
            return None
        value, slope, bend = flight.level(time)
        if not value < 0:
            raise ArithmeticError(f"undecided at t = {now}: f = {value}")
        height, rate = _upper(value), _upper(slope)
        if rate > 0.0 and -height < RESOLUTION * (1.0 + now) * rate:
            found = _enclosed(flight, time, 2.0 * height / -rate)
            if found is not None:
                return found
        step = _step(flight, now, height, rate, _upper(bend))
        if now + step >= horizon:
            return None
        time = (time + arb(step)).mid()
    raise ArithmeticError(f"no decision within {MOST_STEPS} steps")


def _departure(flight: Flight, radial_speed: float) -> float:
    """A time before which a start on the wall has certainly not come back.

    ``f/τ ≤ f' + (f'' + M₃ h/3) τ/2`` with ``f' = 2ṙ``, so it is half the root of that where there is one.
    """
    bend = _upper(flight.level(0.0)[2])
    span = flight.longest_step
    while span > 1e-30:
        steepest = bend + flight.third_bound(0.0, span) * span / 3.0
        root = math.inf if steepest <= 0.0 else -4.0 * radial_speed / steepest
        if root > 0.0 and (reach := 0.5 * min(span, root)) > 0.0 and root >= span / 4.0:
            return reach
        span *= 0.5
    raise ArithmeticError("the start does not leave the wall")


def _step(flight: Flight, now: float, height: float, rate: float, bend: float) -> float:
    """Longest step found that the bound allows: ``τ`` with first root of the quadratic for ``h = τ`` not below ``τ``."""
    span = flight.longest_step
    third = flight.third_bound(now, span) / 3.0
    reach = _root(height, rate, bend + third * span)
    if reach >= span:
        return span * SAFE
    low, high = reach, span
    for _ in range(12):
        middle = 0.5 * (low + high)
        if _root(height, rate, bend + third * middle) >= middle:
            low = middle
        else:
            high = middle
    return low * SAFE


def _root(height: float, rate: float, bend: float) -> float:
    """First positive root of ``height + rate τ + bend τ²/2`` with ``height < 0``."""
    square = rate * rate - 2.0 * bend * height
    if square < 0.0:
        return math.inf
    if rate >= 0.0:
        return -2.0 * height / (rate + math.sqrt(square))
    return (math.sqrt(square) - rate) / bend if bend > 0.0 else math.inf


def _enclosed(flight: Flight, time: arb, width: float) -> Crossing | None:
    after = (time + arb(width)).mid()
    value, slope, _ = flight.level(after)
    return Crossing(float(after), float(slope), after) if value > 0 else None


def _merged(terms: list[tuple[acb, acb, acb]]) -> list[tuple[acb, acb, acb]]:
    """Terms with the same exponent added up, so that each exponential is evaluated once."""
    merged: list[tuple[acb, acb, acb]] = []
    for fixed, growing, rate in terms:
        for i, (other_fixed, other_growing, other_rate) in enumerate(merged):
            if rate == other_rate:
                merged[i] = (fixed + other_fixed, growing + other_growing, rate)
                break
        else:
            merged.append((fixed, growing, rate))
    return merged


def _growth(rate: complex, time: float, span: float) -> float:
    """Largest ``|e^{λs}|`` on ``time … time + span``."""
    return math.exp(rate.real * (time + span if rate.real > 0.0 else time)) * (1.0 + 1e-12)


def _pair_growth(upper: complex, lower: complex, time: float, span: float) -> float:
    return max(_growth(upper, time, span), _growth(lower, time, span))


def _size(z: acb) -> float:
    return float(abs(z).upper()) * (1.0 + 1e-15)


def _upper(x: arb) -> float:
    """An upper bound of a ball, as a double."""
    value = float(x.upper())
    return value + abs(value) * 3e-16
