"""Results draw themselves: each one that names a figure, as the function of carom.plots does."""

import pkgutil
from importlib import import_module

import numpy as np
import pytest
from flexible_machines import munich
from machines import PAPER
from studies import study_once
from touch_records import struck

import carom
from carom import Grid, map_basins, map_gains, plots
from carom.base.outcome import InputError
from carom.base.results import Result
from carom.disturbances import VelocityKick
from carom.fitting import Channel, Record, fit
from carom.motions import energy_ledger
from carom.proofs import ProvenKicks, prove_kicks

TOUCHED = {"friction": 0.2, "restitution": 0.7, "damping": 340.0, "stiffness": 4e5, "eccentricity": 1e-6}
KICKS = Grid(VelocityKick(0.5), (4, 6))


def motion():
    return carom.simulate(PAPER, carom.kick(0.35, angle=0.2), until=30.0)


def shaken():
    machine = carom.load("examples/spindle.toml")
    shock = carom.BaseShock.of(machine, "5 g", "1 ms")
    return carom.disturbances.shock_response(carom.simulate(*shock.apply(machine), 40.0), shock.course(shock.peak))


def slowed():
    drive = carom.parameters.Drive("2e-5 kg m^2", brake="0.5 N m")
    return carom.motions.spin_down(
        carom.load("examples/touchdown-balls.toml"), carom.drop(), steps=4, drive=drive, keep=2000
    )


def touched():
    times, places, _ = struck(TOUCHED, 0.35, 0.01, 20_000)
    channels = Channel.read("x [m]"), Channel.read("y [m]")
    record = Record("touch", times, np.column_stack([places.real, places.imag]), channels)
    return fit(carom.load("examples/spindle.toml"), record, ["damping"], starts=1)


EXAMPLES = {
    "ShockResponse": shaken,
    "SpinDown": slowed,
    "Fit": touched,
    "Trajectory": motion,
    "EnergyLedger": lambda: energy_ledger(motion()),
    "EquilibriumSet": lambda: carom.find_equilibria(PAPER),
    "AttractorSet": lambda: carom.find_attractors(PAPER, count=12),
    "Orbit": lambda: carom.find_orbits(PAPER)["B1,d"],
    "OrbitSet": lambda: carom.find_orbits(PAPER),
    "Basin": lambda: map_basins(PAPER, KICKS),
    "GainMap": lambda: map_gains(PAPER, KICKS, {"omega": 2, "gamma": 2}),
    "DropMap": lambda: carom.basins.map_drops(
        carom.load("examples/dropped-rotor.toml"), over={"phase": 2, "friction": 2}, until="20 ms"
    ),
    "Diagram": lambda: carom.find_bifurcations(PAPER, "gamma", (0.1, 0.12)),
    "RegionMap": lambda: carom.map_regions(
        PAPER, carom.bifurcations.Plane("gamma", "omega", (0.1, 0.12), (0.75, 0.77)), grid=2
    ),
    "UnbalanceResponse": lambda: carom.studies.unbalance_response(carom.load("examples/keogh-cole.toml")),
    "Campbell": lambda: carom.rotors.campbell(munich(0.06), [100.0, 300.0]),
    "Sensitivity": lambda: carom.rotors.sensitivity(munich(0.06), [100.0, 300.0, 900.0]),
    "ProvenKicks": lambda: ProvenKicks.of(prove_kicks("examples/spindle.toml", "100 mm/s", most_impacts=0, workers=1)),
    "Study": lambda: study_once(PAPER.replace(gamma=0.65, mu=0.0)),
}


def every_kind(kind=Result):
    for member in kind.__subclasses__():
        yield member
        yield from every_kind(member)


def drawn_kinds():
    for module in pkgutil.walk_packages(carom.__path__, "carom."):
        if not module.name.endswith("__main__"):
            import_module(module.name)
    return {kind.__name__: kind.figure for kind in every_kind() if kind.figure and kind.__module__.startswith("carom.")}


def test_every_result_with_a_figure_has_an_example_and_a_public_function():
    kinds = drawn_kinds()
    assert set(kinds) == set(EXAMPLES)
    assert set(kinds.values()) <= set(plots.__all__)


@pytest.mark.parametrize("kind", EXAMPLES)
def test_a_result_draws_itself_as_plots_does(kind, tmp_path):
    result = EXAMPLES[kind]()
    assert type(result).__name__ == kind
    one, other = result.plot(), getattr(plots, result.figure)(result)
    files = [plots.save(figure, tmp_path / name, ("svg",))[0] for name, figure in (("a", one), ("b", other))]
    assert files[0].read_bytes() == files[1].read_bytes()


def test_options_are_handed_on():
    assert motion().plot(title="a title").get_suptitle() == "a title"


def test_a_result_without_a_figure_says_so():
    with pytest.raises(
        InputError, match=r"^plot = PeriodRoots: a result with a figure; draw its arrays with matplotlib$"
    ):
        carom.closed_forms.periods.PeriodRoots.plot(object.__new__(carom.closed_forms.periods.PeriodRoots))
