"""Exact results for the planar rotor.

==================  ===================================================
``equilibria``      contact-free and rubbing equilibria
``whirl``           backward whirl and the end of the rub
``absorbing``       neighbourhoods of the rub that sliding never leaves
``periods``         periods of all orbits with one impact a period
``local``           cycles that shrink into a boundary equilibrium
==================  ===================================================
"""

from carom.closed_forms.absorbing import RubNeighbourhood, rub_neighbourhood
from carom.closed_forms.equilibria import Equilibrium, find_equilibria
from carom.closed_forms.local import ContactSystem, LocalCycle, NonSmoothHopf, cycle_determinant, non_smooth_hopf
from carom.closed_forms.periods import PeriodCondition, PeriodRoots
from carom.closed_forms.whirl import Rolling, Runaway, rolling, rub_limit, runaway_speed

__all__ = [
    "ContactSystem",
    "Equilibrium",
    "LocalCycle",
    "NonSmoothHopf",
    "PeriodCondition",
    "PeriodRoots",
    "Rolling",
    "RubNeighbourhood",
    "Runaway",
    "cycle_determinant",
    "find_equilibria",
    "non_smooth_hopf",
    "rolling",
    "rub_limit",
    "rub_neighbourhood",
    "runaway_speed",
]
