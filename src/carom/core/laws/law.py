"""What every law of a touchdown bearing offers, and the laws there are."""

from __future__ import annotations

import pkgutil
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from types import MappingProxyType
from typing import Annotated, ClassVar, Self

from carom.base.arguments import ArgumentKind
from carom.core import laws
from carom.core.wall import Wall

_NO_LAWS = ("choice", "compliant", "law", "rigid")
LAWS = ("rigid", *sorted(module.name for module in pkgutil.iter_modules(laws.__path__) if module.name not in _NO_LAWS))
"""Names of the laws, those of their modules; each has its place as its number."""
FromZeroToOne = Annotated[float, ArgumentKind(lambda number: 0.0 <= number <= 1.0, "a number from 0 to 1")]
FromOneToTwo = Annotated[float, ArgumentKind(lambda number: 1.0 <= number <= 2.0, "a number from 1 to 2")]


@dataclass(frozen=True)
class Law(ABC):
    """What a touchdown bearing does along its normal to a rotor that arrives: a frozen value with the law's numbers.

    Attributes
    ----------
    law : str
        Name of the law's module, which has its functions for the kernels.
    parameters : dict
        Attributes that can be varied, by the names under which the rotor has them.
    is_compliant : bool
        Whether a force acts while the rotor is in the wall, instead of an impulse at the impact.
    """

    law: ClassVar[str]
    parameters: ClassVar[Mapping[str, str]] = MappingProxyType({})
    is_compliant: ClassVar[bool] = True

    @abstractmethod
    def numbers(self, mass: float) -> dict[str, float]:
        """``restitution``, ``stiffness``, ``loss`` and ``law_number`` of a :class:`~carom.core.wall.Wall`, those that are not zero, for this effective mass."""

    @abstractmethod
    def at_speed(self, factor: float) -> Self:
        """Return the same at a speed of the shaft that is larger by a factor: what is in its unit then has another number."""

    def wall(self, friction: float, surface_speed: float, mass: float) -> Wall:
        """The numbers of a wall at a place of the rotor that resists impulses with this effective mass."""
        numbers = {"restitution": 0.0, **self.numbers(mass)}
        return Wall(friction, surface_speed=surface_speed, law=LAWS.index(self.law), **numbers)


def law_of_name(name: str) -> type[Law]:
    """The class of a law, which stands in the module of its name.

    Raises
    ------
    ValueError
        There is no such law.
    """
    if name not in LAWS:
        raise ValueError(f"no law is named {name}: there are {', '.join(LAWS)}")
    import_module(f"{laws.__name__}.{name}")
    return next(each for each in Law.__subclasses__() if each.law == name)
