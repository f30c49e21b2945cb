"""Every public function refuses what it cannot use in one line that names the argument, before it does anything."""

import inspect
import math
from importlib import import_module

import numpy as np
import pytest
from machines import PAPER, SCALES, machine_of

import carom as cm
from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.disturbances import BladeLoss, ContactRelease, Sample, VelocityKick
from carom.models import LinearEquations, Rigid, Touchdown
from carom.parameters import MACHINE_FIELDS, Case, Machine
from carom.sweeps import plan_sweep

PACKAGES = [name for name, home in cm._HOMES.items() if home == "carom" and name != "proofs"]
"""Public packages; ``proofs`` needs a library that may be missing."""


class Nothing:
    """What no function takes."""


PLAIN = {
    "float": [math.nan, math.inf, True, 10**400, 1j, b"x", [0.1]],
    "int": [2.5, True, 10**400, "2", math.nan, [2]],
    "bool": ["x", 1, None, []],
    "str": [1, b"x", None, ["x"]],
    "array": ["x", math.nan, [None], 10**400, [[1.0], [1.0, 2.0]], {}],
}
"""Values that are none of a type, of arguments that may be of this type only."""
KINDS = {
    **dict.fromkeys(("float", "Positive", "Longest"), "float"),
    **dict.fromkeys(("int", "Count", "Whole", "Seed", "Impacts"), "int"),
    **dict.fromkeys(("np.ndarray", "Reals"), "array"),
    "bool": "bool",
    "str": "str",
}
ELSEWHERE = {
    "models.from_matrices",
    "parameters.own_size",
    "parameters.read_size",
    "parameters.read_quantity",
    "parameters.unknown_name",
    "parameters.in_terms_of",
}
"""Functions that name the argument as their caller wants, or have a test of their own."""


def functions():
    """Public functions by name, ``package.function``, and the methods of public classes that are checked."""
    for package in PACKAGES:
        module = import_module(f"carom.{package}")
        for name in getattr(module, "__all__", []):
            value = getattr(module, name)
            if inspect.isfunction(value):
                yield f"{package}.{name}", value
            for attribute, method in vars(value).items() if inspect.isclass(value) else ():
                plain = getattr(method, "__func__", method)
                if getattr(plain, "__code__", None) is CHECKED and attribute != "__init__":
                    yield f"{package}.{name}.{attribute}", plain


CHECKED = checked(lambda: None).__code__


def refused(call) -> InputError:
    """The error that a call raises, which must be one of input, of one line."""
    with pytest.raises(InputError) as caught:
        call()
    assert "\n" not in str(caught.value)
    return caught.value


def arguments():
    """Function and argument, and values that it cannot be."""
    free = ("Any", "object", "<class 'inspect._empty'>")
    for name, function in functions():
        for parameter in inspect.signature(function).parameters.values() if name not in ELSEWHERE else ():
            written = str(parameter.annotation)
            if written in free or parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD):
                continue
            values = [Nothing(), *PLAIN.get(KINDS.get(written, ""), [])]
            yield pytest.param(function, parameter.name, values, id=f"{name}-{parameter.name}")


ARGUMENTS = list(arguments())


@pytest.mark.parametrize(("function", "name", "values"), ARGUMENTS)
def test_what_an_argument_cannot_be_is_refused_before_all_else(function, name, values):
    if name == "machine" and function is plan_sweep:
        return  # models are loaded late there, and refuse it
    for value in values:
        problem = refused(lambda: function(**{name: value}))  # noqa: B023  (called at once)
        assert problem.field in (name, "machine")


def test_most_arguments_are_tried():
    assert sum(len(tried.values[2]) for tried in ARGUMENTS) > 800


@pytest.fixture(scope="module")
def motion():
    return cm.simulate(PAPER, cm.kick(0.3), 10.0)


AT_USE = {
    "simulate": ("machine", lambda motion: cm.simulate(0.1)),
    "load": ("settings", lambda motion: cm.load("x.toml", None)),
    "load text": ("settings", lambda motion: cm.load("x.toml", "gamma=0.1")),
    "at text": ("times", lambda motion: motion.at("x")),
    "at nan": ("times", lambda motion: motion.at(math.nan)),
    "until": ("until", lambda motion: cm.simulate(PAPER, cm.kick(0.3), True)),
    "impacts": ("impacts", lambda motion: cm.find_orbits(PAPER, impacts=2.5)),
    "kick": ("speed", lambda motion: cm.kick(10**400)),
    "state": ("start position", lambda motion: cm.simulate(PAPER, cm.State("x"), 1.0)),
    "scales": ("scales", lambda motion: LinearEquations(*LINEAR, scales="x")),
    "mass": ("mass", lambda motion: LinearEquations(10**400, *LINEAR[1:])),
    "sample": ("seed", lambda motion: Sample(VelocityKick(0.5), 3, True)),
    "grid": ("model", lambda motion: cm.Grid("x", (2, 2))),
    "kick model": ("fastest", lambda motion: VelocityKick([])),
    "complex kick": ("fastest", lambda motion: VelocityKick(1j)),
    "release": ("motion", lambda motion: ContactRelease(np.zeros(2))),
    "phase": ("blade-loss phase", lambda motion: BladeLoss(0.5).apply(PAPER, "x")),
    "direction": ("shock direction", lambda motion: cm.BaseShock(0.1, 1.0).release(PAPER, math.nan)),
    "case": ("zones", lambda motion: Case("name", PAPER, None, "x")),
    "plan of nothing": ("machine", lambda motion: Sample(VelocityKick(0.5), 3).starts("x")),
    "period": ("longest_period", lambda motion: cm.find_orbits(PAPER, math.inf)),
    "trials": ("count", lambda motion: cm.attractors.exact_interval(3, 2)),
    "jacobian": ("jacobian", lambda motion: cm.orbits.multipliers(np.zeros(3))),
    "place": ("position", lambda motion: cm.orbits.Section.from_state(0.0, 1.0)),
    "figure": ("path_stem", lambda motion: cm.plots.save(cm.plots.radius(motion), "")),
    "dataset": ("times", lambda motion: motion.to_dataset(np.zeros((2, 2)))),
}
"""What is read later than at the door, or was read wrongly: the field named, and a call."""
LINEAR = (np.eye(1), 0.4 * np.eye(1), np.eye(1), [0.1], [Touchdown([1.0], Rigid(0.9), 0.1, 50.0)])


@pytest.mark.parametrize("name", AT_USE)
def test_a_bad_value_is_named(motion, name):
    field, call = AT_USE[name]
    assert refused(lambda: call(motion)).field == field


def test_a_size_that_is_no_double_is_refused_by_machines():
    for value in (10**400, math.nan, True, None, [], "x"):
        assert "mass" in refused(lambda: Machine(**{**FIELDS, "mass": value})).field  # noqa: B023


FIELDS = {name: getattr(machine_of(PAPER, SCALES), name) for name in MACHINE_FIELDS}


def test_a_set_of_results_is_a_sequence_of_them():
    case = cm.load("examples/keogh-cole.toml")
    sets = cm.find_equilibria(case), cm.find_orbits(case)
    document = cm.studies.orbits_document(case.parameters, *sets, case)
    assert len(document["equilibria"]) == len(sets[0])
