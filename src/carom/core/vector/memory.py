"""The compiled form of loading, storing and looking up lanes."""

from __future__ import annotations

from llvmlite import ir
from numba.core import types
from numba.extending import lower_builtin, type_callable

from carom.core.layout import LANE_NODES, LEVELS, OCTET, WIDE
from carom.core.records import CACHE_LINE
from carom.core.vector.kinds import COUNT, DOUBLES, REAL, Condition, RealLanes, are_numbers, common
from carom.core.vector.parts import all_of, each, parts, spread
from carom.core.vector.uncompiled import align_stack, choose, lanes_of, load, store, take

INTEGERS = ir.VectorType(ir.IntType(64), OCTET)
WORD = ir.IntType(64)


def register() -> None:
    """Register the operations with the compiler."""
    _register_load()
    _register_store()
    _register_look_up(take, _take_by_permutation, _take_one_by_one)
    _register_look_up(choose, _choose_by_permutation, _choose_by_comparison)
    _register_lanes_of()
    _register_align_stack()


def _holds_numbers(array):
    return isinstance(array, types.Array) and array.dtype == types.float64 and array.ndim == 1 and array.layout == "C"


def _address(context, build, kind, array):
    return context.make_array(kind)(context, build, array).data


def _after(build, address, number):
    return build.gep(address, [ir.Constant(ir.IntType(32), number)])


def _register_load():
    @type_callable(load)
    def kind_of(context):
        return lambda array, first: REAL if _holds_numbers(array) and isinstance(first, types.Integer) else None

    @lower_builtin(load, types.Array, types.Integer)
    def lower(context, build, signature, values):
        places = _places(context, build, signature.args[0], *values)
        return all_of(build, [build.load(place, align=8) for place in places])


def _places(context, build, kind, array, first):
    """Addresses of the vectors that hold the lanes from an entry of an array on."""
    address = build.gep(_address(context, build, kind, array), [first])
    return [_after(build, build.bitcast(address, DOUBLES.as_pointer()), i) for i in range(COUNT)]


def _register_store():
    @type_callable(store)
    def kind_of(context):
        def kind(array, first, values):
            fits = (
                _holds_numbers(array)
                and array.mutable
                and isinstance(first, types.Integer)
                and are_numbers(REAL, values)
            )
            return types.none if fits and common(values) == REAL else None

        return kind

    @lower_builtin(store, types.Array, types.Integer, types.Any)
    def lower(context, build, signature, values):
        real, _ = parts(context, build, signature.args[2], values[2])
        for i, place in enumerate(_places(context, build, signature.args[0], *values[:2])):
            build.store(build.extract_value(real, i), place, align=8)
        return context.get_dummy_value()


def _register_look_up(function, by_permutation, otherwise):
    """Register a look-up in a row: AVX-512 selects from registers that hold the row, far faster than from memory."""

    @type_callable(function)
    def kind_of(context):
        return lambda row, places: REAL if _holds_numbers(row) and places == REAL else None

    @lower_builtin(function, types.Array, RealLanes)
    def lower(context, build, signature, values):
        row = _address(context, build, signature.args[0], values[0])
        pick = by_permutation if WIDE else otherwise
        return each(build, pick(build, row), values[1])


def _take_by_permutation(build, row):
    """Select from pairs of registers, then repeatedly from pairs of the results, by one more bit of the index."""
    permute = _instruction(build, "llvm.x86.avx512.vpermi2var.pd.512", [DOUBLES, INTEGERS, DOUBLES])
    held = _registers(build, row, LANE_NODES // OCTET)

    def pick(places):
        whole = build.fptosi(places, INTEGERS)
        picked = [build.call(permute, [held[i], whole, held[i + 1]]) for i in range(0, len(held), 2)]
        bit = 2 * OCTET
        while len(picked) > 1:
            high = build.and_(whole, ir.Constant(INTEGERS, [bit] * OCTET))
            high = build.icmp_unsigned("!=", high, ir.Constant(INTEGERS, [0] * OCTET))
            picked = [build.select(high, picked[i + 1], picked[i]) for i in range(0, len(picked), 2)]
            bit *= 2
        return picked[0]

    return pick


def _take_one_by_one(build, row):
    def pick(places):
        whole, taken = build.fptosi(places, ir.VectorType(ir.IntType(32), OCTET)), ir.Constant(DOUBLES, ir.Undefined)
        for lane in range(OCTET):
            number = ir.Constant(ir.IntType(32), lane)
            entry = build.load(build.gep(row, [build.extract_element(whole, number)]))
            taken = build.insert_element(taken, entry, number)
        return taken

    return pick


def _choose_by_permutation(build, row):
    permute = _instruction(build, "llvm.x86.avx512.permvar.df.512", [DOUBLES, INTEGERS])
    (held,) = _registers(build, row, 1)
    return lambda places: build.call(permute, [held, build.fptosi(places, INTEGERS)])


def _choose_by_comparison(build, row):
    entries = [spread(build, build.load(_after(build, row, i))) for i in range(LEVELS)]

    def pick(places):
        chosen = build.extract_value(entries[0], 0)
        for i in range(1, LEVELS):
            here = build.fcmp_ordered("==", places, ir.Constant(DOUBLES, [float(i)] * OCTET))
            chosen = build.select(here, build.extract_value(entries[i], 0), chosen)
        return chosen

    return pick


def _instruction(build, name, kinds):
    return build.module.declare_intrinsic(name, (), ir.FunctionType(DOUBLES, kinds))


def _registers(build, row, count):
    vectors = build.bitcast(row, DOUBLES.as_pointer())
    return [build.load(_after(build, vectors, i), align=8) for i in range(count)]


def _register_lanes_of():
    @type_callable(lanes_of)
    def kind_of(context):
        return lambda condition: types.int64 if isinstance(condition, Condition) else None

    @lower_builtin(lanes_of, Condition)
    def lower(context, build, signature, values):
        bits = ir.Constant(WORD, 0)
        for i in range(COUNT):
            octet = build.zext(build.bitcast(build.extract_value(values[0], i), ir.IntType(OCTET)), WORD)
            bits = build.or_(bits, build.shl(octet, ir.Constant(WORD, i * OCTET)))
        return bits


def _register_align_stack():
    @type_callable(align_stack)
    def kind_of(context):
        return lambda: types.none

    @lower_builtin(align_stack)
    def lower(context, build, signature, values):
        build.function.attributes.alignstack = CACHE_LINE
        build.function.attributes.add("nounwind")  # llvmlite omits alignstack unless another attribute is set
        return context.get_dummy_value()
