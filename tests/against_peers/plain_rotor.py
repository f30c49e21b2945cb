"""
A second simulator of the planar rotor in a rigid round wall, written from the equations alone.

It shares nothing with carom, so that what carom proves can be tried on motions that carom did not compute.  In the fixed frame the
deviation ``u = z − Λ e^{it}`` from levitation obeys ``u'' + γ u' + ω² u = 0`` in flight, which is used in closed form.  The wall is reached
by steps that cannot pass it: along a flight ``|g''|``, ``g = |z|²``, has a bound by the energy of the deviation, which only falls.  Many motions
go side by side in arrays.  Bounces that accumulate end in lasting contact, followed by the rule of Runge and Kutta.
"""

import dataclasses

import numpy as np

FLIES, SLIDES, ROLLS, RETURNED, RUBS, WHIRLS, UNKNOWN = range(7)
TOUCH = 1e-13
"""Distance ``1 − |z|²`` that counts as touching."""
LOW = 1e-5
"""Radial speed below which bounces that the wall pushes together are taken to accumulate."""


@dataclasses.dataclass(frozen=True)
class Machine:
    """Numbers of the equations: damping, stiffness (squared frequency is ``omega²``), unbalance, friction, rebound, surface speed."""

    gamma: float
    omega: float
    rho: float
    mu: float
    d: float
    s: float

    @property
    def pull(self):
        """Force ``P`` per unit of levitation."""
        return self.omega**2 - 1 + 1j * self.gamma

    @property
    def levitation(self):
        """Radius of levitation."""
        return self.rho / abs(self.pull)

    def responses(self, times):
        """Free motion from a unit displacement and from a unit velocity, and the rates of both."""
        root = np.sqrt(complex(self.gamma**2 / 4 - self.omega**2))
        decay = np.exp(-self.gamma * times / 2)
        if abs(root) < 1e-7:
            even, odd = decay, decay * times
        else:
            up, down = np.exp((root - self.gamma / 2) * times), np.exp((-root - self.gamma / 2) * times)
            even, odd = ((up + down) / 2).real, ((up - down) / (2 * root)).real
        return even + self.gamma / 2 * odd, odd, -(self.omega**2) * odd, even - self.gamma / 2 * odd

    def contact_free(self):
        """Kick out of levitation below which nothing is touched, sampled."""
        times = np.linspace(0, 40 / self.omega, 200_001)
        return (1 - self.levitation) / np.max(np.abs(self.responses(times)[1]))

    def out_of_reach(self, u, w):
        """Whether free motion stays inside for ever, by either of two energies."""
        free = 1 - self.levitation
        damped = self.omega**2 - self.gamma**2 / 4
        calm = np.abs(w) ** 2 + self.omega**2 * np.abs(u) ** 2 < self.omega**2 * free**2
        if damped > 0:
            calm |= np.abs(w + self.gamma * u / 2) ** 2 + damped * np.abs(u) ** 2 < damped * free**2
        return calm & (self.gamma > 0)


class Flock:
    """Motions side by side, each with its time, phase of levitation and place."""

    def __init__(self, machine, phase, z, zdot):
        count = len(z)
        self.machine = machine
        self.lean = machine.levitation * np.exp(1j * np.asarray(phase, float))
        self.time = np.zeros(count)
        self.u0 = np.asarray(z, complex) - self.lean
        self.w0 = np.asarray(zdot, complex) - 1j * self.lean
        self.since = np.zeros(count)
        self.mode = np.full(count, FLIES)
        self.impacts = np.zeros(count, int)
        self.closest = np.full(count, np.inf)
        self.rising = np.zeros(count, bool)
        self.angle, self.rate = np.zeros(count), np.zeros(count)
        self.calm, self.turned = np.zeros(count, int), np.zeros(count)
        self.slip = np.ones(count)
        self.chattered = np.zeros(count, bool)

    def follow(self, steps=20_000, most_impacts=3000, until=5000.0):
        """Until each motion has ended; ``mode`` says how."""
        for _ in range(steps):
            for mode, move in ((FLIES, self.fly), (SLIDES, self.slide), (ROLLS, self.roll)):
                lanes = np.flatnonzero(self.mode == mode)
                if len(lanes):
                    move(lanes)
            late = (self.mode <= ROLLS) & ((self.time > until) | (self.impacts > most_impacts))
            self.mode[late] = UNKNOWN
            if np.all(self.mode > ROLLS):
                break
        self.mode[self.mode <= ROLLS] = UNKNOWN
        return self

    def fly(self, lanes):
        """One step that cannot pass the wall, or the impact at its end."""
        m = self.machine
        tau = self.since[lanes]
        h0, h1, h0dot, h1dot = m.responses(tau)
        u, w = self.u0[lanes] * h0 + self.w0[lanes] * h1, self.u0[lanes] * h0dot + self.w0[lanes] * h1dot
        ahead = self.lean[lanes] * np.exp(1j * (self.time[lanes] + tau))
        z, zdot = u + ahead, w + 1j * ahead
        gap, rate = 1 - np.abs(z) ** 2, 2 * np.real(np.conj(z) * zdot)
        energy = np.sqrt(np.abs(w) ** 2 + m.omega**2 * np.abs(u) ** 2)
        ell = m.levitation
        bend = 2 * ((energy + ell) ** 2 + np.hypot(m.gamma, m.omega) * energy + ell) * (1 + 1e-12) + 1e-300
        at_top = self.rising[lanes] & (rate <= 0)
        self.closest[lanes[at_top]] = np.minimum(self.closest[lanes[at_top]], gap[at_top])
        self.rising[lanes] = rate > 0
        # At rest on the wall the sign of the rate is rounding: a first short step tells whether the wall pushes.
        rests = (tau == 0) & (np.abs(rate) < 1e-12)
        touch = (gap < TOUCH) & (rate > 0) & ~rests
        free = ~touch
        self.mode[lanes[free & m.out_of_reach(u, w)]] = RETURNED
        room = np.maximum(gap, 0)
        root = np.sqrt(rate**2 + 2 * bend * room)
        step = np.where(rate > 0, 2 * room / np.maximum(np.abs(rate) + root, 1e-300), (root - rate) / bend)
        self.since[lanes[free]] += np.maximum(step[free], np.where(rests[free], 1e-9, 1e-12))
        if np.any(touch):
            self.strike(lanes[touch], tau[touch], z[touch], zdot[touch], ahead[touch])

    def strike(self, lanes, tau, z, zdot, ahead):
        """Newton's rebound with dry friction; low bounces that the wall pushes together become lasting contact."""
        m = self.machine
        out = z / np.abs(z)
        velocity = np.conj(out) * zdot
        a, b = np.maximum(velocity.real, 0), velocity.imag
        self.closest[lanes] = np.minimum(self.closest[lanes], a**2)
        self.time[lanes] += tau
        self.impacts[lanes] += 1
        cone = m.mu * (1 + m.d) * a
        after = b - np.clip(m.s + b, -cone, cone)
        normal = after**2 - m.omega**2 + np.real(m.pull * ahead * np.conj(out))
        # Where nearly all speed is left, a start at rest on the wall stays there too.
        stays = (normal > 0) & (a < LOW) & (a < np.maximum(1e-3 * (1 - m.d), 1e-7) * normal)
        landed = lanes[stays]
        self.mode[landed] = SLIDES
        self.chattered[landed] = True
        self.angle[landed], self.rate[landed] = np.angle(out[stays]), after[stays]
        self.slip[landed], self.calm[landed], self.turned[landed] = np.sign(m.s + after[stays]), 0, 0
        self.launch(lanes[~stays], out[~stays], -m.d * a[~stays] + 1j * after[~stays])

    def launch(self, lanes, out, velocity):
        """Begin a flight at the wall."""
        self.mode[lanes] = FLIES
        ahead = self.lean[lanes] * np.exp(1j * self.time[lanes])
        self.u0[lanes], self.w0[lanes] = out - ahead, out * velocity - 1j * ahead
        self.since[lanes], self.rising[lanes] = 0, False

    def forces(self, lanes, angle, rate, time):
        """Normal force and what turns the rotor without friction."""
        m = self.machine
        lean = m.pull * self.lean[lanes] * np.exp(1j * (time - angle))
        return rate**2 - m.omega**2 + lean.real, lean.imag - m.gamma * rate

    def along(self, lanes, h):
        """Angle and rate after a step ``h`` of the rule of Runge and Kutta along the wall, and the margins of contact and of slip there."""
        x, w, t, slip = self.angle[lanes], self.rate[lanes], self.time[lanes], self.slip[lanes]

        def pace(x, w, t):
            normal, turn = self.forces(lanes, x, w, t)
            return turn - slip * self.machine.mu * normal

        k1 = pace(x, w, t)
        k2 = pace(x + h / 2 * w, w + h / 2 * k1, t + h / 2)
        k3 = pace(x + h / 2 * (w + h / 2 * k1), w + h / 2 * k2, t + h / 2)
        k4 = pace(x + h * (w + h / 2 * k2), w + h * k3, t + h)
        x, w = x + h * w + h**2 / 6 * (k1 + k2 + k3), w + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        return x, w, (self.forces(lanes, x, w, t + h)[0], slip * (self.machine.s + w))

    def slide(self, lanes):
        """One step along the wall with slip; it ends early where contact or slip does."""
        self.slip[lanes] = np.where(self.slip[lanes] == 0, 1.0, self.slip[lanes])
        before = self.rate[lanes]
        begin = self.along(lanes, np.zeros(len(lanes)))[2]
        h = np.where(begin[0] > 0, 0.05 / (1 + np.abs(before)), 0.0)
        _, _, end = self.along(lanes, h)
        for which in (0, 1):
            passed = np.flatnonzero((end[which] < 0) & (begin[which] > 0))
            h[passed] = self.end_of(lanes[passed], which, begin[which][passed], end[which][passed], h[passed])
            if len(passed):
                _, _, end = self.along(lanes, h)
        x, w, end = self.along(lanes, h)
        still = (np.abs(w - 1) < 1e-5) & (np.abs(w - before) < 1e-5 * h)
        self.angle[lanes], self.rate[lanes] = x, w
        self.time[lanes] += h
        self.calm[lanes] = np.where(still, self.calm[lanes] + 1, 0)
        self.mode[lanes[self.calm[lanes] > 40]] = RUBS
        lifts = (begin[0] <= 0) | (end[0] < 0)
        self.stop(lanes[(end[1] < 0) & ~lifts])
        self.lift(lanes[lifts])

    def end_of(self, lanes, which, first, last, h):
        """Length of the step at whose end a margin has just fallen below zero, by false position as Illinois has it."""
        low, high = np.zeros(len(lanes)), h.copy()
        for _ in range(10 if len(lanes) else 0):
            middle = np.clip((low * last - high * first) / (last - first), low, high)
            margin = self.along(lanes, middle)[2][which]
            below = margin < 0
            low, high = np.where(below, low, middle), np.where(below, middle, high)
            first, last = np.where(below, first / 2, margin), np.where(below, margin, last / 2)
        return high

    def stop(self, lanes):
        """Where slip ends: rolling if friction suffices, else slip to the other side."""
        m = self.machine
        self.rate[lanes] = -m.s
        normal, turn = self.forces(lanes, self.angle[lanes], self.rate[lanes], self.time[lanes])
        holds = np.abs(turn) <= m.mu * normal
        self.mode[lanes] = np.where(holds, ROLLS, SLIDES)
        self.turned[lanes] = 0
        self.slip[lanes] = np.where(holds, 0, np.sign(turn))
        self.rate[lanes] += np.where(holds, 0, 1e-12 * np.sign(turn))

    def roll(self, lanes):
        """A step without slip; a whole turn with margin at all angles is whirl."""
        m = self.machine
        h = 0.02 / m.s
        self.angle[lanes] -= m.s * h
        self.time[lanes] += h
        self.turned[lanes] += m.s * h
        normal, turn = self.forces(lanes, self.angle[lanes], self.rate[lanes], self.time[lanes])
        slips = np.abs(turn) > m.mu * normal
        self.mode[lanes[slips]] = SLIDES
        self.slip[lanes[slips]] = np.sign(turn[slips])
        self.rate[lanes[slips]] += 1e-12 * np.sign(turn[slips])
        self.mode[lanes[(self.turned[lanes] > 13) & ~slips]] = WHIRLS

    def lift(self, lanes):
        """Leave the wall with the third power of time: a first step by hand."""
        out = np.exp(1j * self.angle[lanes])
        self.launch(lanes, out, 1j * self.rate[lanes])
        self.since[lanes] = 1e-3


def kicks(machine, speeds, angles):
    """Kicks out of levitation: angles count from the direction in which the rotor levitates then."""
    speeds, angles = np.asarray(speeds, float), np.asarray(angles, float)
    lean = machine.levitation * np.exp(-1j * angles)
    return Flock(machine, -angles, lean, speeds + 1j * lean)


def cells(letters):
    """Ends of the speeds and of the angles of all cells, as shares (n, 4), and their letters, of the tree of a certificate."""
    found, stack = [], [(0.0, 1.0, 0.0, 1.0)]
    for letter in letters:
        low, high, first, last = stack.pop()
        if letter == "v":
            middle = (low + high) / 2
            stack += [(middle, high, first, last), (low, middle, first, last)]
        elif letter == "a":
            middle = (first + last) / 2
            stack += [(low, high, middle, last), (low, high, first, middle)]
        else:
            found.append((low, high, first, last, letter))
    if stack:
        raise ValueError("the letters end before the disc is full")
    return np.array([cell[:4] for cell in found]), np.array([cell[4] for cell in found])
