"""Magnetic bearings: what pulls at the rotor, what measures it, and what is between both."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from carom.base.outcome import InputError, shown
from carom.parameters import Field
from carom.parameters.fields import by_name
from carom.parameters.tables import read_entries
from carom.parameters.terms import HELPER_FIELDS
from carom.rotors.controllers import PID, VoltagePID, controller_of, state_space_of
from carom.rotors.shaft_parts import read_node
from carom.rotors.state_spaces import PADE, SINGULAR, StateSpace, delay, in_series, lag

AT_REGAIN = ("reset", "hold", "running")
"""What the states of a controller are when levitation that was lost is regained."""
BEARING_FIELDS: Mapping[str, Field] = by_name(
    Field("ki", "k_i", "force of the bearing per current", "a force per current", "N/A", 1e-9, 1e12, '"50 N/A"'),
    Field("ks", "k_s", "stiffness of the bearing at constant current", "a stiffness", "N/m", -1e15, -1e-9, '"-1e5 N/m"', True),
    Field("ks_tilt", "", "moment of the bearing per tilt at constant current", "a tilt stiffness", "N m/rad", -1e15, 1e15, '"-50 N m/rad"', True),
    Field("gain_factor", "", "factor of the whole controller", "a number", "", 1e-6, 1e6, "1.2"),
    Field("sensor_gain", "", "voltage of the sensors per displacement; the controller then is one of voltages, V/V", "a gain", "V/m", 1e-6, 1e12, '"10 V/mm"'),
    Field("amplifier_gain", "", "current of the amplifier per voltage", "a gain", "A/V", 1e-9, 1e9, '"0.8 A/V"'),
    Field("sensor_bandwidth", "", "bandwidth of the sensors", "an angular frequency", "rad/s", 1e-3, 1e9, '"10 kHz"'),
    Field("delay", "", "delay of the controller", "a time", "s", 1e-9, 1.0, '"50 us"', True, usual="ms", usual_size=1e-3),
    Field("amplifier_bandwidth", "", "bandwidth of the amplifier", "an angular frequency", "rad/s", 1e-3, 1e9, '"1 kHz"'),
    Field("slew_rate_limit", "(di/dt)_max", "largest rate of the control current of a bearing: voltage over inductance", "a rate of current", "A/s", 1e-12, 1e15, '"5000 A/s"'),
    *(HELPER_FIELDS[name] for name in ("force_limit", "current_limit", "air_gap")),
    Field("axis_angle", "", "angle of one of its two axes in the fixed frame, for its limits", "an angle", "rad", -10.0, 10.0, '"45 deg"', True),
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class MagneticBearing:
    """An active magnetic bearing that acts in both directions alike, up to its limits along each of its two axes.

    With the displacements ``z`` at the bearing and ``y`` at the sensors it pulls with

        f = −ki i − ks z,      i = C(s) e^{−sT} ω_b/(s + ω_b) y;

    with the gains of sensors and amplifier the controller is what is between their voltages, ``i = k_a C(s) k_s e^{−sT} ω_b/(s + ω_b) y``.

    Along each axis the current that the controller asks for, the rate of the current of the amplifier and the force ``ki i`` are no larger than the limits;
    states of the controller, such as integrators, wind up then.  Every number is in the SI unit below, or text with a unit.

    Parameters
    ----------
    node : int
        Boundary of the sections of the shaft at which the force acts.
    ki : float or str
        Force per current, N/A.
    ks : float or str
        Stiffness at constant current, N/m: below zero, as a magnet pulls harder the nearer the rotor is.
    controller : PID, TransferFunction, ZerosPolesGain, SecondOrderSections, StateSpace, Series, or a system of SciPy or python-control
        ``C``: current per displacement, A/m, or V/V with the next but one gains; a gain above zero opposes a displacement.  One with a sample time has its hold.
        ``None`` where a :class:`SharedController` has the bearing.
    sensor_nodes : sequence of int, optional
        Where its sensors are, whose mean it takes; by default at the bearing.
    delay : float or str, optional
        ``T`` of computing, and of sampling where the controller has no sample time, s, by Padé's approximation.
    amplifier_bandwidth : float or str, optional
        ``ω_b``, rad/s or such as ``"1 kHz"``; by default the amplifier is not in the way.
    force_limit, current_limit, slew_rate_limit : float or str, optional
        Largest force by the current, N, control current, A, and rate of the current, A/s; that of the rate needs an amplifier.  By default there
        are none.
    air_gap : float or str, optional
        Radial air gap of its magnets, m: where the rotor reaches them a motion ends; by default it is not known.
    ks_tilt : float or str, optional
        Moment against a tilt at constant current, N m/rad, alike in both directions: below zero of a long magnet; 0 by default.
    axis_angle : float or str, optional
        Angle of one of its axes in the fixed frame, rad; 0 by default.
    gain_factor : float, optional
        Factor of the whole controller, 1 by default.
    sensor_gain, amplifier_gain : float or str, optional
        ``k_s``, V/m, and ``k_a``, A/V; both or none.
    sensor_bandwidth : float or str, optional
        rad/s or such as ``"10 kHz"``; by default the sensors are not in the way.
    y : MagneticBearing, optional
        What it is along its second axis, at a right angle to the first, with another controller, ``ks``, gains or limits; its ``ki`` and sensors are those of the first.  By default both axes are alike.
    at_regain : {"reset", "hold", "running"}
        The states of controller, delay and amplifier when levitation is regained: all at zero, as they were when it was lost, or, without integral
        gain, such as they are after measuring all the while.

    Raises
    ------
    InputError
        A value is not of this kind or out of range, the controller no such system, the rate is limited without an amplifier, or one of two gains is missing.
    """

    node: int
    ki: float
    ks: float
    controller: Any = None
    sensor_nodes: tuple[int, ...] = ()
    delay: float = 0.0
    amplifier_bandwidth: float | None = None
    force_limit: float | None = None
    current_limit: float | None = None
    slew_rate_limit: float | None = None
    air_gap: float | None = None
    axis_angle: float = 0.0
    at_regain: str = "reset"
    gain_factor: float = 1.0
    sensor_gain: float | None = None
    amplifier_gain: float | None = None
    sensor_bandwidth: float | None = None
    y: MagneticBearing | None = None
    ks_tilt: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "node", read_node("bearing node", self.node))
        read_entries(self, BEARING_FIELDS)
        given: object = self.sensor_nodes
        if not isinstance(given, Iterable) or isinstance(given, str):
            raise InputError("sensor_nodes", shown(given), "a sequence of numbers of nodes")
        nodes = tuple(read_node("sensor node", each) for each in given)
        object.__setattr__(self, "sensor_nodes", nodes or (self.node,))
        if self.slew_rate_limit is not None and self.amplifier_bandwidth is None:
            allowed = "none without amplifier_bandwidth: it is the amplifier whose current changes no faster"
            raise InputError("slew_rate_limit", self.slew_rate_limit, allowed)
        if self.controller is not None:
            object.__setattr__(self, "controller", controller_of(self.controller))
        self._check_gains()
        if self.at_regain not in AT_REGAIN:
            raise InputError("at_regain", shown(self.at_regain), f"one of {', '.join(AT_REGAIN)}")
        if self.y is not None:
            if (self.controller is None) != (self.y.controller is None) or self.y.y is not None:
                raise InputError("y", None, "a second axis with a controller of its own where the first has one")
            same = {name: getattr(self, name) for name in ("node", "sensor_nodes", "ki", "at_regain")}
            object.__setattr__(self, "y", replace(self.y, **same))

    def _check_gains(self) -> None:
        """Refuse one gain of the chain without the other, and gains of a controller in units that it does not have."""
        gains = {name: getattr(self, name) for name in ("sensor_gain", "amplifier_gain")}
        if None in gains.values():
            for name, other in zip(gains, reversed(gains), strict=True):
                if gains[name] is not None:
                    raise InputError(other, None, f"stated beside {name}: the controller then is one of voltages, V/V")
        if self.controller is None:
            return
        if not state_space_of(self.controller).is_single:
            raise InputError("controller", "several inputs or outputs", "one input and one output")
        own = getattr(self.controller, "controller", self.controller)
        if isinstance(own, PID) and isinstance(own, VoltagePID) != (self.sensor_gain is not None):
            allowed = "carom.rotors.VoltagePID with sensor_gain and amplifier_gain, and PID, in A/m, without them"
            raise InputError("controller", type(own).__name__, allowed)

    @property
    def stages(self) -> tuple[StateSpace, ...]:
        """What is before the controller, then delay, gains and amplifier behind it; factors of one where there is nothing."""
        none = StateSpace.constant(1.0)
        sensor = StateSpace.constant(self.sensor_gain or 1.0)
        return (
            sensor if self.sensor_bandwidth is None else lag(self.sensor_bandwidth).then(sensor),
            delay(self.delay, PADE) if self.delay else none,
            StateSpace.constant(self.gain_factor * (self.amplifier_gain or 1.0)),
            none if self.amplifier_bandwidth is None else lag(self.amplifier_bandwidth),
        )

    @cached_property
    def loop(self) -> StateSpace:
        """Current per displacement: sensors, controller of its own, delay and amplifier, one after the other."""
        before, *after = self.stages
        return in_series([before, state_space_of(self.controller), *after]).balanced()

    @property
    def axes(self) -> tuple[MagneticBearing, MagneticBearing]:
        """What it is along each of its axes."""
        return self, self if self.y is None else self.y

    @property
    def magnet(self) -> tuple[float, complex]:
        """Stiffness at constant current, N/m: of displacements, and of their conjugates."""
        one, other = (each.ks for each in self.axes)
        return 0.5 * (one + other), 0.5 * (one - other) * complex(np.exp(2j * self.axis_angle))

    @cached_property
    def static_stiffness(self) -> float:
        """Stiffness against a steady displacement at its sensors and itself, ``ki C(0) + ks``, N/m; infinite with an integrator."""
        if self.y is not None and self.y.static_stiffness < math.inf:
            return min(self.y.static_stiffness, replace(self, y=None).static_stiffness)
        if self.loop.states and np.linalg.cond(self.loop.A) > SINGULAR:
            return math.inf
        return self.ki * float(np.real(self.loop.at(np.array(0.0)))) + self.ks
