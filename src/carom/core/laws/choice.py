"""The law of a wall along its normal, by its number."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

from carom.core import laws
from carom.core.compiling.decorators import formula
from carom.core.laws.law import LAWS

Function = Callable[..., float]


def _chosen(name: str, one_of: Callable[[int, Function, Function], Function]) -> Function:
    """The function of this name of the law that a wall has, among the laws that have one."""
    modules = (import_module(f"{laws.__name__}.{law}") for law in LAWS)
    (_, function), *others = (
        (number, getattr(module, name)) for number, module in enumerate(modules) if hasattr(module, name)
    )
    for number, other in others:
        function = one_of(number, other, function)
    chosen: Function = function
    return chosen


def _by_number(number: int, mine: Function, others: Function) -> Function:
    """A function of a number and the wall."""

    @formula
    def function(of, wall):
        if wall.law == number:
            return mine(of, wall)
        return others(of, wall)

    return function


def _by_two(number: int, mine: Function, others: Function) -> Function:
    """A function of depth and rate, or of their rounding errors, and the wall."""

    @formula
    def function(depth, rate, wall):
        if wall.law == number:
            return mine(depth, rate, wall)
        return others(depth, rate, wall)

    return function


def _by_series(number: int, mine: Function, others: Function) -> Function:
    """A function of the Taylor series of depth and rate, and the wall."""

    @formula
    def function(k, depth, rate, wall):
        if wall.law == number:
            return mine(k, depth, rate, wall)
        return others(k, depth, rate, wall)

    return function


def _by_series_with_power(number: int, mine: Function, others: Function) -> Function:
    """The same with the series of a power of the depth, to be filled."""

    @formula
    def function(k, depth, rate, power, wall):
        if wall.law == number:
            return mine(k, depth, rate, power, wall)
        return others(k, depth, rate, power, wall)

    return function


def _by_changes(number: int, mine: Function, others: Function) -> Function:
    """A function of the series of depth, rate and power of the depth, of those of their changes, and the wall."""

    @formula
    def function(k, depth, rate, power, depth_change, rate_change, power_change, wall):
        if wall.law == number:
            return mine(k, depth, rate, power, depth_change, rate_change, power_change, wall)
        return others(k, depth, rate, power, depth_change, rate_change, power_change, wall)

    return function


impulse = _chosen("impulse", _by_number)
impulse_by_speed = _chosen("impulse_by_speed", _by_number)
impulse_by_restitution = _chosen("impulse_by_restitution", _by_number)
stored_energy = _chosen("stored_energy", _by_number)
edge = _chosen("edge", _by_two)
force = _chosen("force", _by_two)
force_rounding = _chosen("force_rounding", _by_two)
press_rounding = _chosen("press_rounding", _by_two)
press_coefficient = _chosen("press_coefficient", _by_series)
force_coefficient = _chosen("force_coefficient", _by_series_with_power)
force_change = _chosen("force_change", _by_changes)
