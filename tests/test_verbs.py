"""Every function on a rotor takes a machine, a case, parameters or a model, and gives the same for each of them."""

import dataclasses
import inspect
from collections.abc import Mapping, Sequence
from importlib import import_module

import numpy as np
import pytest
import xarray
from compilation import sized
from linear_rotors import tilting
from machines import PAPER, SCALES, machine_of

import carom as cm
from carom.base.outcome import CaromError, InputError
from carom.disturbances import Grid, Sample, VelocityKick
from carom.models import jeffcott
from carom.orbits.shooting import ShootingStart
from carom.parameters import Case, Zones
from carom.sweeps import GridAxis

MACHINE = machine_of(PAPER.replace(gamma=0.4), SCALES)
SUBJECTS = {
    "machine": MACHINE,
    "case": Case("name", MACHINE.parameters, MACHINE, Zones()),
    "parameters": MACHINE.parameters,
    "model": jeffcott(MACHINE.parameters),
}
KICKS = Grid(VelocityKick(fastest=0.5), (2, 2))
FEW = Sample(VelocityKick(fastest=0.5), 2)
DRIVE = cm.parameters.Drive("0.05 kg m^2")


def settled(machine):
    """Two starts next to levitation, followed."""
    system = cm.models.rotor_of(machine).system
    states = system.kicked(np.array([0.1, 0.2j]))
    return cm.settle(machine, cm.State(*(states if len(system.rest) > 1 else (part[:, 0] for part in states))))


def stated(call):
    """The result, or the reason why there is none."""
    try:
        return call()
    except CaromError as problem:
        return str(problem)


def case_explored(machine):
    """The case that a figure for notebooks shows, if there is what it needs."""
    figure = cm.explorer.explore(machine)
    figure.close()
    return figure.case


CALLS = {
    "attractors.exponents_of": lambda m: cm.attractors.exponents_of(
        m, next(iter(cm.find_attractors(m, FEW, known=False)))
    ),
    "attractors.find_attractors": lambda m: cm.find_attractors(m, FEW, known=False),
    "attractors.follow_until_settled": lambda m: cm.attractors.follow_until_settled(m, settled(m), impacts=100),
    "attractors.known_starts": lambda m: cm.attractors.known_starts(m, []),
    "basins.compare_recoveries": lambda m: stated(
        lambda: cm.basins.compare_recoveries(m, (cm.parameters.RecoveryAction("early", 0.1),), 2, until=5.0)
    ),
    "basins.map_basins": lambda m: cm.map_basins(m, KICKS),
    "basins.map_cells": lambda m: cm.basins.map_cells(m, KICKS),
    "basins.map_drops": lambda m: stated(lambda: cm.basins.map_drops(m, over={"phase": 2, "speed": 2})),
    "basins.map_gains": lambda m: cm.map_gains(m, KICKS, {"gamma": 2, "omega": 2}),
    "basins.smallest_unrecovered": lambda m: cm.basins.smallest_unrecovered(m, VelocityKick(fastest=0.5)),
    "bifurcations.boundary_equilibria": lambda m: cm.bifurcations.boundary_equilibria(m, "gamma"),
    "bifurcations.find_bifurcations": lambda m: cm.find_bifurcations(m, "gamma", (0.39, 0.41)),
    "bifurcations.map_regions": lambda m: cm.map_regions(
        m, cm.bifurcations.Plane("gamma", "omega", (0.39, 0.41), (0.75, 0.77)), grid=2
    ),
    "bifurcations.motions_at": cm.bifurcations.motions_at,
    "bifurcations.orbit_windows": lambda m: cm.bifurcations.orbit_windows(m, "damping", [3600.0, 3700.0]),
    "closed_forms.fading_speed": cm.closed_forms.fading_speed,
    "closed_forms.find_equilibria": cm.find_equilibria,
    "closed_forms.contact_free_blade_loss": cm.closed_forms.contact_free_blade_loss,
    "closed_forms.contact_free_kick": cm.closed_forms.contact_free_kick,
    "closed_forms.contact_free_shock": lambda m: cm.closed_forms.contact_free_shock(m, 0.5),
    "closed_forms.levitation": cm.closed_forms.levitation,
    "closed_forms.rolling": cm.closed_forms.rolling,
    "closed_forms.rub_limit": cm.closed_forms.rub_limit,
    "closed_forms.rub_neighbourhood": cm.closed_forms.rub_neighbourhood,
    "closed_forms.runaway_speed": cm.closed_forms.runaway_speed,
    "closed_forms.slipping_whirls": lambda m: cm.closed_forms.slipping_whirls(m, 1e4),
    "closed_forms.contact_changes": cm.closed_forms.contact_changes,
    "closed_forms.rub_angles": lambda m: cm.closed_forms.rub_angles(m, [100.0]),
    "rotors.synchronous_response": lambda m: cm.rotors.synchronous_response(m, [100.0]),
    "closed_forms.small_cycles": cm.closed_forms.small_cycles,
    "disturbances.outward_from": cm.disturbances.outward_from,
    "explorer.explore": lambda m: stated(lambda: case_explored(m)),
    "models.axis": lambda m: cm.models.axis(m, "gamma"),
    "models.case_of": lambda m: cm.models.rotor_of(cm.models.case_of(m)),
    "models.exact_rotor_of": cm.models.exact_rotor_of,
    "models.rotor_of": cm.models.rotor_of,
    "motions.follow_loads": lambda m: cm.motions.follow_loads(m, cm.kick(0.3), 5.0),
    "motions.settle": lambda m: settled(m),
    "motions.simulate": lambda m: cm.simulate(m, cm.kick(0.3), 5.0),
    "motions.spin_down": lambda m: stated(lambda: cm.motions.spin_down(m, cm.drop(), 1.0, steps=2, drive=DRIVE).turns),
    "orbits.find_orbits": lambda m: cm.find_orbits(m, 10.0),
    "orbits.lyapunov_exponents": lambda m: stated(lambda: cm.orbits.lyapunov_exponents(m, cm.kick(0.01), 10)),
    "orbits.orbit_near": lambda m: cm.orbits.orbit_near(
        m,
        cm.orbits.Word.of(cm.orbits.Kind.IMPACT_FORWARD),
        ShootingStart(np.repeat([1.0, 0.7 - 1.0j], len(cm.models.rotor_of(m).system.rest))[None], np.array([2.9])),
    ),
    "orbits.impact_map": lambda m: cm.orbits.impact_map(m, cm.orbits.Section(0.3, 0.7, -1.0)),
    "orbits.orbits_within_reach": cm.orbits.orbits_within_reach,
    "orbits.period_condition": lambda m: cm.orbits.period_condition(m, np.array([1.0, 2.0])),
    "studies.check_recovery": lambda m: cm.studies.check_recovery(m, [Sample(VelocityKick(0.5), 3)]),
    "studies.find_recovery": lambda m: cm.studies.find_recovery(
        m, "gamma", [Sample(VelocityKick(0.5), 3)], within=(0.5, 1.0)
    ),
    "studies.study": lambda m: dataclasses.replace(cm.study(m, FEW), case=None),
    "studies.unbalance_response": lambda m: dataclasses.replace(cm.studies.unbalance_response(m), case=None),
    "sweeps.plan_sweep": lambda m: cm.sweeps.plan_sweep(m, [GridAxis.of("gamma", [0.4])], KICKS).case_at((0,)),
}
"""A small call of each function that takes a rotor."""
PLANAR = {
    "bifurcations.boundary_equilibria",
    "bifurcations.orbit_windows",
    "closed_forms.fading_speed",
    "closed_forms.rolling",
    "closed_forms.rub_limit",
    "closed_forms.rub_neighbourhood",
    "closed_forms.runaway_speed",
    "closed_forms.contact_changes",
    "closed_forms.rub_angles",
    "rotors.synchronous_response",
    "models.exact_rotor_of",
    "orbits.find_orbits",
    "orbits.orbit_near",
    "orbits.impact_map",
    "orbits.orbits_within_reach",
    "orbits.period_condition",
    "studies.unbalance_response",
}
"""Those that need the planar rotor; the others take any linear one."""
SLOW = {"studies.study": sized(False, False, True)}
"""Those that take seconds, and whether they are called here."""
NAMES = [name for name in CALLS if SLOW.get(name, True)]
PACKAGES = [name for name, home in cm._HOMES.items() if home == "carom" and name != "proofs"]
"""Public packages; ``proofs`` needs a library that may be missing."""


def public():
    """Functions of the public packages, and the annotation of their first parameter."""
    for package in PACKAGES:
        module = import_module(f"carom.{package}")
        for name in getattr(module, "__all__", []):
            value = getattr(module, name)
            if inspect.isfunction(value) and inspect.signature(value).parameters:
                first = next(iter(inspect.signature(value).parameters.values()))
                yield f"{package}.{name}", first.name, str(first.annotation)


def alike(one, other) -> bool:
    """Whether two results are equal in all that they hold."""
    if isinstance(one, xarray.Dataset):
        return one.equals(other)
    if isinstance(one, np.ndarray):
        return one.dtype.names is not None or np.array_equal(one, other, equal_nan=one.dtype.kind in "fc")
    if isinstance(one, cm.models.Rotor | Case):
        return cm.models.rotor_of(one).parameters == cm.models.rotor_of(other).parameters
    if dataclasses.is_dataclass(one):
        fields = (field.name for field in dataclasses.fields(one))
        return type(one) is type(other) and all(alike(getattr(one, name), getattr(other, name)) for name in fields)
    if isinstance(one, Mapping):
        return one.keys() == other.keys() and all(alike(one[key], other[key]) for key in one)
    if isinstance(one, Sequence) and not isinstance(one, str):
        return len(one) == len(other) and all(map(alike, one, other))
    return bool(one == other or (one != one and other != other))


def test_every_function_on_a_rotor_takes_any_description():
    found = {name: (first, kind) for name, first, kind in public()}
    assert {name for name, (_, kind) in found.items() if kind.startswith("Subject")} == set(CALLS)
    others = {name for name, (first, _) in found.items() if first in ("machine", "rotor", "subject", "parameters")}
    others.discard("models.jeffcott")  # it makes one
    assert {name for name in others - set(CALLS) if not name.endswith("_document")} == set()


def test_results_that_differ_are_told_apart():
    one, other = (cm.find_orbits(MACHINE.replace(gamma=gamma), 10.0) for gamma in (0.1, 0.1000001))
    assert alike(one, one)
    assert not alike(one, other)


@pytest.mark.parametrize("name", NAMES)
def test_all_descriptions_give_the_same(name):
    results = {kind: CALLS[name](subject) for kind, subject in SUBJECTS.items()}
    for kind, result in results.items():
        assert alike(result, results["model"]), kind


@pytest.mark.jit_only
@pytest.mark.parametrize("name", sorted(set(CALLS) - PLANAR - set(SLOW)))
def test_general_functions_take_any_linear_rotor(name):
    CALLS[name](tilting().model)


@pytest.mark.parametrize("name", sorted(PLANAR))
def test_what_is_known_of_one_model_refuses_others_in_one_line(name):
    try:
        words = CALLS[name](tilting().model)  # no words: it has learned to take them, and belongs not to PLANAR
    except InputError as problem:
        words = str(problem)
    assert isinstance(words, str)
    assert "\n" not in words
    assert any(each in words for each in ("the planar rotor", "coordinate", "one mass", "scales"))
