"""Torque, heat and growth of the ball bearing that a rotor lands on: their entries in a table ``[touchdown]``."""

from __future__ import annotations

from dataclasses import dataclass

from carom.parameters.tables import Table, entries_of, entry

OF_TORQUE = ("starting_torque", "running_torque", "torque_factor", "load_factor", "viscosity")
"""Entries of the torque of the balls, which changes no motion."""


@dataclass(frozen=True, kw_only=True)
class BallHeat(Table):
    """Entries of a touchdown bearing about torque and temperature; no motion depends on them.

    Parameters
    ----------
    starting_torque, running_torque : float or str, optional
        Torque of the unloaded bearing that starts its race, and torque that turns it at any speed, N m.  A motion has ``race_drag`` in their place.
    torque_factor, load_factor, viscosity : float or str, optional
        In place of a running torque: Palmgren's ``f_0`` and ``f_1``, and the kinematic viscosity of oil or of the oil in the grease, m²/s
        (:func:`carom.motions.ball_torque`).
    race_mass : float or str, optional
        Mass of the inner race, kg.  With it temperatures are computed (:class:`carom.motions.Temperatures`).
    outer_mass : float or str, optional
        Mass of the outer ring with what warms up with it, kg; by default that of a ring with the section of the inner one.
    shaft_mass : float or str, optional
        Mass of the sleeve on the shaft, kg; by default that of the inner race.
    specific_heat, ball_specific_heat : float or str, optional
        J/(kg K); 460 by default, that of bearing steel, and the balls' as that of the rings.
    expansion, ball_expansion : float or str, optional
        Linear thermal expansion, 1/K; 11.5e-6 by default, and the balls' as that of the rings.
    slip_share : float or str, optional
        Share of the heat of slip that goes into the race; the rest goes into the shaft.  One half by default, as between equal materials.
    shaft_conductance, landing_conductance, inner_conductance, outer_conductance, housing_conductance : float or str, optional
        Heat conducted per difference of temperature, W/K: from the sleeve into the shaft, from sleeve to race, race to balls, balls to outer ring, and from
        that into the housing; shaft and housing stay at the temperature of the beginning.  0 by default: a landing is short against such flows.
    temperature : float or str, optional
        Temperature of all parts before the landing, °C; 20 by default.
    """

    starting_torque: float | None = entry("", "torque that starts the race", "N m", 1e-12, 1e9, '"0.02 N m"', True)
    running_torque: float | None = entry("", "torque of the balls in running", "N m", 1e-12, 1e9, '"0.01 N m"', True)
    torque_factor: float | None = entry("f_0", "Palmgren's factor of the viscous torque", "", 0.01, 100.0, "2")
    load_factor: float | None = entry("f_1", "Palmgren's factor of the torque by load", "", 1e-6, 1.0, "0.0008")
    viscosity: float | None = entry(
        "ν", "kinematic viscosity of the oil", "m^2/s", 1e-7, 1.0, '"30 mm^2/s"', usual=("mm^2/s", 1e-6)
    )
    shaft_mass: float | None = entry("", "mass of the sleeve on the shaft", "kg", 1e-9, 1e9, '"0.1 kg"')
    race_mass: float | None = entry("", "mass of the inner race", "kg", 1e-9, 1e9, '"0.08 kg"')
    outer_mass: float | None = entry("", "mass of the outer ring", "kg", 1e-9, 1e9, '"0.12 kg"')
    shaft_conductance: float | None = entry("", "conductance of sleeve to shaft", "W/K", 1e-9, 1e6, '"2 W/K"', True)
    landing_conductance: float | None = entry("", "conductance of sleeve to race", "W/K", 1e-9, 1e6, '"1 W/K"', True)
    inner_conductance: float | None = entry("", "conductance of race to balls", "W/K", 1e-9, 1e6, '"0.5 W/K"', True)
    outer_conductance: float | None = entry(
        "", "conductance of balls to outer ring", "W/K", 1e-9, 1e6, '"0.5 W/K"', True
    )
    housing_conductance: float | None = entry(
        "", "conductance of outer ring to housing", "W/K", 1e-9, 1e6, '"5 W/K"', True
    )
    specific_heat: float | None = entry("", "specific heat of the rings", "J/(kg K)", 1.0, 1e5, '"460 J/(kg K)"')
    ball_specific_heat: float | None = entry("", "specific heat of the balls", "J/(kg K)", 1.0, 1e5, '"800 J/(kg K)"')
    expansion: float | None = entry("", "thermal expansion of the rings", "1/K", 1e-9, 1e-3, '"11.5e-6 1/K"')
    ball_expansion: float | None = entry("", "thermal expansion of the balls", "1/K", 1e-9, 1e-3, '"3.2e-6 1/K"', True)
    slip_share: float | None = entry("", "share of the heat of slip into the race", "", 0.0, 1.0, "0.5")
    temperature: float | None = entry("", "temperature before the landing", "°C", -273.15, 3000.0, '"20 °C"')

    @property
    def has_torque(self) -> bool:
        """Whether a torque in running is stated."""
        return any(each is not None for each in (self.running_torque, self.torque_factor, self.load_factor))


OF_HEAT = tuple(name for name in entries_of(BallHeat) if name not in OF_TORQUE)
"""Entries of temperatures."""
