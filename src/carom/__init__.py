"""Rotors that strike the wall of their clearance, and whether they come back.

The public names are loaded when they are first used, so ``import carom`` stays light. Each name lives in the module
that :data:`_HOMES` gives; everything listed there can be had as an attribute of the package:

>>> import carom as cm
>>> machine = cm.Machine.load("examples/keogh-cole.toml")
>>> orbits = cm.find_orbits(cm.Jeffcott(machine.parameters))

The functions :func:`basins`, :func:`disturbances`, :func:`equilibria` and :func:`study` carry the name of the module they
live in. The attribute of the package is always the function; the module is at hand as
``sys.modules["carom.equilibria"]`` and in ``from carom.equilibria import ...``.
"""

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from carom import plots as plots
    from carom import reproductions as reproductions
    from carom.absorbing import rub_neighbourhood as rub_neighbourhood
    from carom.attractors import Attractor as Attractor
    from carom.attractors import AttractorSet as AttractorSet
    from carom.attractors import Survival as Survival
    from carom.attractors import find_attractors as find_attractors
    from carom.basins import Basin as Basin
    from carom.basins import GainMap as GainMap
    from carom.basins import basin_entropy as basin_entropy
    from carom.basins import harmless_kick as harmless_kick
    from carom.basins import harmless_shock as harmless_shock
    from carom.basins import integrity as integrity
    from carom.basins import least_gain_change as least_gain_change
    from carom.basins import map_basins as map_basins
    from carom.basins import map_gains as map_gains
    from carom.basins import smallest_loss as smallest_loss
    from carom.basins import smallest_unrecovered_kick as smallest_unrecovered_kick
    from carom.bifurcations import Diagram as Diagram
    from carom.bifurcations import OrbitBranch as OrbitBranch
    from carom.bifurcations import Plane as Plane
    from carom.bifurcations import RegionMap as RegionMap
    from carom.bifurcations import continue_curve as continue_curve
    from carom.bifurcations import continue_orbit as continue_orbit
    from carom.bifurcations import find_bifurcations as find_bifurcations
    from carom.bifurcations import map_regions as map_regions
    from carom.boundary import BoundaryEquilibrium as BoundaryEquilibrium
    from carom.boundary import boundary_equilibria as boundary_equilibria
    from carom.disturbances import AnyState as AnyState
    from carom.disturbances import BaseShock as BaseShock
    from carom.disturbances import ContactRelease as ContactRelease
    from carom.disturbances import Grid as Grid
    from carom.disturbances import KickPlane as KickPlane
    from carom.disturbances import Sample as Sample
    from carom.disturbances import StateSlice as StateSlice
    from carom.disturbances import UnbalanceStep as UnbalanceStep
    from carom.disturbances import VelocityKick as VelocityKick
    from carom.disturbances import kick_grid as kick_grid
    from carom.ensembles import Endings as Endings
    from carom.ensembles import settle_all as settle_all
    from carom.equilibria import Equilibrium as Equilibrium
    from carom.equilibria import find_equilibria as find_equilibria
    from carom.ledger import EnergyLedger as EnergyLedger
    from carom.ledger import energy_ledger as energy_ledger
    from carom.maps import Section as Section
    from carom.maps import impact_map as impact_map
    from carom.models import Jeffcott as Jeffcott
    from carom.orbits import Orbit as Orbit
    from carom.orbits import OrbitSet as OrbitSet
    from carom.orbits import find_orbits as find_orbits
    from carom.orbits import period_condition as period_condition
    from carom.outcome import CaromError as CaromError
    from carom.outcome import CaromWarning as CaromWarning
    from carom.outcome import InputError as InputError
    from carom.outcome import MultipleInputError as MultipleInputError
    from carom.outcome import Outcome as Outcome
    from carom.outcome import Phase as Phase
    from carom.parameters import Case as Case
    from carom.parameters import Machine as Machine
    from carom.parameters import Parameters as Parameters
    from carom.parameters import Scales as Scales
    from carom.parameters import Zones as Zones
    from carom.parameters import load as load
    from carom.safety import SafeDamping as SafeDamping
    from carom.safety import least_safe_damping as least_safe_damping
    from carom.stability import multipliers as multipliers
    from carom.study import study as study
    from carom.sweeps import SweepPlan as SweepPlan
    from carom.sweeps import load_sweep as load_sweep
    from carom.sweeps import open_sweep as open_sweep
    from carom.sweeps import run_sweep as run_sweep
    from carom.trajectories import State as State
    from carom.trajectories import Trajectory as Trajectory
    from carom.trajectories import kick as kick
    from carom.trajectories import simulate as simulate
    from carom.whirl import Rolling as Rolling
    from carom.whirl import Runaway as Runaway
    from carom.whirl import rolling as rolling
    from carom.whirl import rub_limit as rub_limit
    from carom.whirl import runaway_speed as runaway_speed

    __version__: str

_HOMES = {
    "AnyState": "disturbances",
    "Attractor": "attractors",
    "AttractorSet": "attractors",
    "Survival": "attractors",
    "BaseShock": "disturbances",
    "Basin": "basins",
    "BoundaryEquilibrium": "boundary",
    "CaromError": "outcome",
    "CaromWarning": "outcome",
    "Case": "parameters",
    "ContactRelease": "disturbances",
    "Diagram": "bifurcations",
    "Endings": "ensembles",
    "EnergyLedger": "ledger",
    "Equilibrium": "equilibria",
    "GainMap": "basins",
    "Grid": "disturbances",
    "InputError": "outcome",
    "KickPlane": "disturbances",
    "Machine": "parameters",
    "MultipleInputError": "outcome",
    "Orbit": "orbits",
    "OrbitBranch": "bifurcations",
    "OrbitSet": "orbits",
    "Outcome": "outcome",
    "Parameters": "parameters",
    "Phase": "outcome",
    "Plane": "bifurcations",
    "RegionMap": "bifurcations",
    "Rolling": "whirl",
    "Jeffcott": "models",
    "Runaway": "whirl",
    "SafeDamping": "safety",
    "Sample": "disturbances",
    "Scales": "parameters",
    "Section": "maps",
    "State": "trajectories",
    "StateSlice": "disturbances",
    "SweepPlan": "sweeps",
    "Trajectory": "trajectories",
    "UnbalanceStep": "disturbances",
    "VelocityKick": "disturbances",
    "Zones": "parameters",
    "basin_entropy": "basins",
    "map_basins": "basins",
    "find_bifurcations": "bifurcations",
    "boundary_equilibria": "boundary",
    "continue_curve": "bifurcations",
    "continue_orbit": "bifurcations",
    "kick_grid": "disturbances",
    "energy_ledger": "ledger",
    "find_equilibria": "equilibria",
    "find_attractors": "attractors",
    "map_gains": "basins",
    "harmless_kick": "basins",
    "harmless_shock": "basins",
    "impact_map": "maps",
    "integrity": "basins",
    "kick": "trajectories",
    "least_gain_change": "basins",
    "least_safe_damping": "safety",
    "load": "parameters",
    "load_sweep": "sweeps",
    "multipliers": "stability",
    "open_sweep": "sweeps",
    "period_condition": "orbits",
    "map_regions": "bifurcations",
    "rolling": "whirl",
    "rub_limit": "whirl",
    "rub_neighbourhood": "absorbing",
    "run_sweep": "sweeps",
    "runaway_speed": "whirl",
    "settle_all": "ensembles",
    "simulate": "trajectories",
    "find_orbits": "orbits",
    "smallest_loss": "basins",
    "smallest_unrecovered_kick": "basins",
    "study": "study",
}
_SUBPACKAGES = ("plots", "reproductions")

__all__ = ["__version__", *_HOMES, *_SUBPACKAGES]  # noqa: PLE0604  (all of them are strings)


class _Package(ModuleType):
    """The package, whose public functions are not hidden by submodules of the same name.

    Once a submodule is loaded, the import system binds it to an attribute of its package. Where a public name and its
    home are called alike, the public name is bound instead, whoever imports the submodule and whenever.
    """

    def __setattr__(self, name: str, value: Any) -> None:
        if _HOMES.get(name) == name and isinstance(value, ModuleType):
            value = getattr(value, name)
        super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package


def __getattr__(name: str) -> Any:
    """Load a public name on first use (PEP 562) and keep it."""
    value: Any
    if name in _HOMES:
        value = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    elif name in _SUBPACKAGES:
        value = import_module(f"{__name__}.{name}")
    elif name == "__version__":
        from importlib.metadata import version

        value = version(__name__)
    else:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Name what is public, loaded or not."""
    return sorted(__all__)
