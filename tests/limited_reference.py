"""Reference for limits of magnetic bearings: a general integrator in the fixed frame, with what is asked for clipped.

Nothing here shares a formula or a line with the package.  The right-hand side clips what each axis gets; DOP853 with tight tolerances and
short steps finds the kinks by itself.  Impacts end an integration, and the next one begins behind them.
"""

from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp

RELATIVE, ABSOLUTE = 1e-13, 1e-14


def clipped(asked: complex, bound: float, angle: float = 0.0) -> complex:
    """What two perpendicular axes give, the first of which points along an angle."""
    turned = asked * np.exp(-1j * angle)
    return complex(np.clip(turned.real, -bound, bound), np.clip(turned.imag, -bound, bound)) * np.exp(1j * angle)


def follow(
    rates: Callable[[float, np.ndarray], np.ndarray],
    start: np.ndarray,
    until: float,
    *,
    ends: Callable[[float, np.ndarray], float] | None = None,
    after: Callable[[float, np.ndarray], np.ndarray] | None = None,
    longest: float = 0.02,
) -> tuple[np.ndarray, list[float]]:
    """State at a time, and the times at which ``ends`` has risen through zero, from where ``after`` it the motion goes on."""
    time, state, events = 0.0, np.array(start, complex), list[float]()

    def stops(at: float, present: np.ndarray) -> float:
        return ends(at, present) if ends else -1.0

    stops.terminal, stops.direction = True, 1.0  # type: ignore[attr-defined]
    while time < until:
        found = solve_ivp(
            rates, (time, until), state, "DOP853", rtol=RELATIVE, atol=ABSOLUTE, max_step=longest, events=stops
        )
        time, state = float(found.t[-1]), found.y[:, -1]
        if found.status == 1 and after is not None:
            events.append(time)
            state = after(time, state)
    return state, events


def struck(position: complex, velocity: complex, restitution: float, friction: float, radius: float) -> complex:
    """Velocity after an impact on a rigid wall, all in the fixed frame and in units of the clearance and the speed."""
    normal = position / abs(position)
    local = velocity * normal.conjugate()
    normal_impulse = (1.0 + restitution) * local.real
    slip = local.imag + radius
    grip = min(friction * normal_impulse, abs(slip)) * np.sign(slip)
    return (local - normal_impulse - 1j * grip) * normal
