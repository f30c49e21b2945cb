"""Rotors that strike the wall of their clearance, and whether they come back.

The public names are loaded when they are first used, so ``import carom`` stays light. Each name lives in the module
that :data:`_HOMES` gives; everything listed there can be had as an attribute of the package:

>>> import carom as cm
>>> machine = cm.Machine.load("examples/keogh-cole.toml")
>>> orbits = cm.find_orbits(cm.Jeffcott(machine.parameters))

The functions :func:`basins`, :func:`disturbances`, :func:`equilibria` and :func:`study` carry the name of the module they
live in. The attribute of the package is always the function; the module is at hand as
``sys.modules["carom.closed_forms.equilibria"]`` and in ``from carom.closed_forms.equilibria import ...``.
"""

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from carom import plots as plots
    from carom import reproductions as reproductions
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
    from carom.bifurcations.boundary import BoundaryEquilibrium as BoundaryEquilibrium
    from carom.bifurcations.boundary import boundary_equilibria as boundary_equilibria
    from carom.closed_forms.absorbing import rub_neighbourhood as rub_neighbourhood
    from carom.closed_forms.equilibria import Equilibrium as Equilibrium
    from carom.closed_forms.equilibria import find_equilibria as find_equilibria
    from carom.closed_forms.whirl import Rolling as Rolling
    from carom.closed_forms.whirl import Runaway as Runaway
    from carom.closed_forms.whirl import rolling as rolling
    from carom.closed_forms.whirl import rub_limit as rub_limit
    from carom.closed_forms.whirl import runaway_speed as runaway_speed
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
    from carom.models import Jeffcott as Jeffcott
    from carom.motions.ensembles import Endings as Endings
    from carom.motions.ensembles import settle as settle
    from carom.motions.ledger import EnergyLedger as EnergyLedger
    from carom.motions.ledger import energy_ledger as energy_ledger
    from carom.motions.trajectories import State as State
    from carom.motions.trajectories import Trajectory as Trajectory
    from carom.motions.trajectories import kick as kick
    from carom.motions.trajectories import simulate as simulate
    from carom.orbits.maps import Section as Section
    from carom.orbits.maps import impact_map as impact_map
    from carom.orbits.single_impact import Orbit as Orbit
    from carom.orbits.single_impact import OrbitSet as OrbitSet
    from carom.orbits.single_impact import find_orbits as find_orbits
    from carom.orbits.single_impact import period_condition as period_condition
    from carom.orbits.stability import multipliers as multipliers
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
    from carom.studies.safety import SafeDamping as SafeDamping
    from carom.studies.safety import least_safe_damping as least_safe_damping
    from carom.studies import study as study
    from carom.sweeps import SweepPlan as SweepPlan
    from carom.sweeps import load_sweep as load_sweep
    from carom.sweeps import open_sweep as open_sweep
    from carom.sweeps import run_sweep as run_sweep

    __version__: str

_HOMES = {
    "AnyState": "disturbances",
    "Attractor": "attractors",
    "AttractorSet": "attractors",
    "Survival": "attractors",
    "BaseShock": "disturbances",
    "Basin": "basins",
    "BoundaryEquilibrium": "bifurcations.boundary",
    "CaromError": "outcome",
    "CaromWarning": "outcome",
    "Case": "parameters",
    "ContactRelease": "disturbances",
    "Diagram": "bifurcations",
    "Endings": "motions.ensembles",
    "EnergyLedger": "motions.ledger",
    "Equilibrium": "closed_forms.equilibria",
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
    "Rolling": "closed_forms.whirl",
    "Jeffcott": "models",
    "Runaway": "closed_forms.whirl",
    "SafeDamping": "studies.safety",
    "Sample": "disturbances",
    "Scales": "parameters",
    "Section": "orbits.maps",
    "State": "motions.trajectories",
    "StateSlice": "disturbances",
    "SweepPlan": "sweeps",
    "Trajectory": "motions.trajectories",
    "UnbalanceStep": "disturbances",
    "VelocityKick": "disturbances",
    "Zones": "parameters",
    "basin_entropy": "basins",
    "map_basins": "basins",
    "find_bifurcations": "bifurcations",
    "boundary_equilibria": "bifurcations.boundary",
    "continue_curve": "bifurcations",
    "continue_orbit": "bifurcations",
    "kick_grid": "disturbances",
    "energy_ledger": "motions.ledger",
    "find_equilibria": "closed_forms.equilibria",
    "find_attractors": "attractors",
    "map_gains": "basins",
    "harmless_kick": "basins",
    "harmless_shock": "basins",
    "impact_map": "orbits.maps",
    "integrity": "basins",
    "kick": "motions.trajectories",
    "least_gain_change": "basins",
    "least_safe_damping": "studies.safety",
    "load": "parameters",
    "load_sweep": "sweeps",
    "multipliers": "orbits.stability",
    "open_sweep": "sweeps",
    "period_condition": "orbits",
    "map_regions": "bifurcations",
    "rolling": "closed_forms.whirl",
    "rub_limit": "closed_forms.whirl",
    "rub_neighbourhood": "closed_forms.absorbing",
    "run_sweep": "sweeps",
    "runaway_speed": "closed_forms.whirl",
    "settle": "motions.ensembles",
    "simulate": "motions.trajectories",
    "find_orbits": "orbits",
    "smallest_loss": "basins",
    "smallest_unrecovered_kick": "basins",
    "study": "studies",
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
