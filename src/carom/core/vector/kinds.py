"""The types of lanes for the compiler: WIDTH numbers or truth values, as vectors of OCTET each."""

from __future__ import annotations

from llvmlite import ir
from numba.core import types
from numba.core.datamodel.models import PrimitiveModel, StructModel
from numba.extending import make_attribute_wrapper, overload_method, register_model

from carom.core.layout import OCTET, WIDTH
from carom.core.vector.uncompiled import join

COUNT = WIDTH // OCTET
DOUBLES, BITS = ir.VectorType(ir.DoubleType(), OCTET), ir.VectorType(ir.IntType(1), OCTET)


class RealLanes(types.Type):
    """WIDTH real numbers."""


class ComplexLanes(types.Type):
    """WIDTH complex numbers."""


class Condition(types.Type):
    """WIDTH truth values."""


REAL, COMPLEX = RealLanes(f"{WIDTH} reals"), ComplexLanes(f"{WIDTH} complex numbers")
CONDITION = Condition(f"{WIDTH} truth values")


@register_model(RealLanes)
class _RealModel(PrimitiveModel):  # type: ignore[misc]
    def __init__(self, manager, kind):
        super().__init__(manager, kind, ir.ArrayType(DOUBLES, COUNT))


@register_model(Condition)
class _ConditionModel(PrimitiveModel):  # type: ignore[misc]
    def __init__(self, manager, kind):
        super().__init__(manager, kind, ir.ArrayType(BITS, COUNT))


@register_model(ComplexLanes)
class _ComplexModel(StructModel):  # type: ignore[misc]
    def __init__(self, manager, kind):
        super().__init__(manager, kind, [("real", REAL), ("imag", REAL)])


make_attribute_wrapper(ComplexLanes, "real", "real")
make_attribute_wrapper(ComplexLanes, "imag", "imag")


@overload_method(ComplexLanes, "conjugate")
def _conjugate(values):
    return lambda values: join(values.real, -values.imag)


def are_numbers(*kinds):
    """Whether these are all types of numbers, and at least one of them is lanes."""
    lanes = (RealLanes, ComplexLanes)
    numbers = (*lanes, types.Float, types.Integer, types.Complex)
    return all(isinstance(kind, numbers) for kind in kinds) and any(isinstance(kind, lanes) for kind in kinds)


def common(*kinds):
    """The type of lanes that can hold all of these numbers."""
    return COMPLEX if any(isinstance(kind, types.Complex | ComplexLanes) for kind in kinds) else REAL
