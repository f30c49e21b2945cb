"""What functions take, by their annotations: anything else is refused in one line, before it is used.

:func:`checked` reads the annotations of a public function, or of the fields of a dataclass, and compares with them what is
given.  A ``float`` is a finite real number and an ``int`` a whole one (``True`` is neither), an array holds finite numbers, and
classes, literals, sequences and mappings say themselves what they are.  Ranges are annotations too, such as :data:`Count`.
What depends on other values, such as a size with a unit on the scales of a machine, is checked where it is read.
"""

from __future__ import annotations

import builtins
import cmath
import inspect
import math
import types
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import wraps
from itertools import chain, repeat
from numbers import Complex, Integral, Real
from typing import (
    TYPE_CHECKING,
    Annotated,
    Any,
    ForwardRef,
    Literal,
    NamedTuple,
    TypeGuard,
    TypeVar,
    Union,
    cast,
    get_args,
    get_origin,
)

from carom.base.outcome import InputError

if TYPE_CHECKING:
    import numpy as np  # loaded where an array is read: the parameters of a machine do without it

_Checked = TypeVar("_Checked", bound=Callable[..., object])
_MOST = 10**15
"""Largest number of anything: far more than can be stored or awaited."""


class ArgumentKind(NamedTuple):
    """A kind of argument: whether a value is of it, and what it is in words.  Annotated to a type, a range of it."""

    holds: Callable[[Any], bool]
    words: str

    def __repr__(self) -> str:  # in signatures of the documentation
        return repr(self.words)


def whole(least: int, most: int = _MOST) -> ArgumentKind:
    """Whole numbers of a range."""
    words = f"of at least {least}" if most == _MOST else f"from {least} to {most}"
    return ArgumentKind(lambda number: least <= number <= most, f"a whole number {words}")


Whole = Annotated[int, whole(0)]
"""A whole number of at least 0."""
Count = Annotated[int, whole(1)]
"""A whole number of at least 1."""
Seed = Annotated[int, ArgumentKind(lambda number: number >= 0, "a whole number of at least 0")]
"""Seed of a generator of random numbers."""
Positive = Annotated[float, ArgumentKind(lambda number: number > 0.0, "a finite number above 0")]
NotNegative = Annotated[float, ArgumentKind(lambda number: number >= 0.0, "a finite number of at least 0")]
"""A finite number above 0."""
Infinity = Annotated[Any, ArgumentKind(lambda number: isinstance(number, float) and math.isinf(number), "infinity")]
"""Infinity, where a number may also be that: ``float | Infinity``."""
Reals = Annotated["np.ndarray", ArgumentKind(lambda values: kind_of_numbers(values) in "iuf", "finite real numbers")]
"""Array of finite real numbers."""
Truths = Annotated[
    Any, ArgumentKind(lambda values: str(getattr(values, "dtype", "")) == "bool", "an array of True and False")
]
"""Array of ``True`` and ``False``."""


def having(*names: str) -> ArgumentKind:
    """Mappings in which these names are."""
    return ArgumentKind(lambda given: all(name in given for name in names), f"a mapping with {', '.join(names)}")


def checked(target: _Checked) -> _Checked:
    """Let a function, or the constructor of a class, refuse what its annotations do not allow.

    It raises :class:`~carom.base.outcome.InputError`, which names the argument, the value and what is allowed.
    """
    if isinstance(target, type):
        target.__init__ = checked(target.__init__)  # type: ignore[misc]
        return target
    door: list[_Door] = []  # made at the first call: an annotation may name what is defined later

    @wraps(target)
    def wrapper(*args: object, **kwargs: object) -> object:
        if not door:
            door.append(_Door.of(target))
        door[0].check(args, kwargs)
        return target(*args, **kwargs)

    return cast("_Checked", wrapper)


class _Door(NamedTuple):
    """What a function takes: its arguments by place, the names of further ones by place and by name, and the kind of each."""

    places: tuple[str, ...]
    others: str
    further: str
    kinds: Mapping[str, ArgumentKind]

    @classmethod
    def of(cls, function: Callable[..., object]) -> _Door:
        """Read the annotations of a function."""
        names, kinds = _Names(inspect.unwrap(function).__globals__), {"": _ANYTHING}
        places, others, further = list[str](), "", ""
        for name, parameter in inspect.signature(function).parameters.items():
            written = parameter.annotation
            if isinstance(written, str):
                written = eval(written, {}, names)
            kinds[name] = _ANYTHING if written is parameter.empty else _kind_of(written)
            if parameter.kind is parameter.VAR_POSITIONAL:
                others = name
            elif parameter.kind is parameter.VAR_KEYWORD:
                further = name
            elif parameter.kind is not parameter.KEYWORD_ONLY:
                places.append(name)
        return cls(tuple(places), others, further, kinds)

    def check(self, args: tuple[object, ...], kwargs: Mapping[str, object]) -> None:
        """Refuse the first argument that is not of its kind; Python itself refuses too many and too few."""
        for name, value in chain(zip(chain(self.places, repeat(self.others)), args, strict=False), kwargs.items()):
            kind = self.kinds.get(name) or self.kinds[self.further]
            if not kind.holds(value):
                raise InputError(name, value, kind.words)


class _ByName(type):
    """Stand-in for a class that only type checkers import: an instance is what has a class of this name."""

    def __instancecheck__(cls, value: object) -> bool:
        return any(base.__name__ == cls.__name__ for base in type(value).__mro__)

    def __getattr__(cls, name: str) -> type:
        if name.startswith("_"):
            raise AttributeError(name)
        return _ByName(name, (), {})


class _Names(dict[str, object]):
    """Names of a module, and those that only type checkers import."""

    def __missing__(self, name: str) -> object:
        return getattr(builtins, name) if hasattr(builtins, name) else _ByName(name, (), {})


def _is_whole(value: object) -> bool:
    """Whether a value is a whole number that a processor can hold."""
    return not isinstance(value, bool) and isinstance(value, Integral) and abs(int(value)) < 2**64


def _is_real(value: object) -> bool:
    """Whether a value is a finite real number that a double can hold."""
    try:
        return not isinstance(value, bool) and isinstance(value, Real) and math.isfinite(value)
    except OverflowError:
        return False


def is_number(value: object) -> bool:
    """Whether a value is a finite number, real or complex."""
    return _is_real(value) or (isinstance(value, Complex) and not isinstance(value, Real) and cmath.isfinite(value))


def kind_of_numbers(value: object) -> str:
    """Code of NumPy for the kind of a number or of an array of numbers, all finite and none masked; ``-`` for anything else."""
    import numpy as np

    if isinstance(value, np.ma.MaskedArray):
        return "-"
    try:
        values = np.asarray(value)
    except (TypeError, ValueError, OverflowError):
        return "-"
    return values.dtype.kind if values.dtype.kind in "iufc" and np.isfinite(values).all() else "-"


_NUMBERS = ArgumentKind(lambda value: kind_of_numbers(value) != "-", "finite numbers")
_ANYTHING = ArgumentKind(lambda value: True, "anything")
_PLAIN: Mapping[object, ArgumentKind] = {
    Any: _ANYTHING,
    object: _ANYTHING,
    type(None): ArgumentKind(lambda value: value is None, ""),
    bool: ArgumentKind(lambda value: type(value).__name__ in ("bool", "bool_"), "True or False"),
    int: ArgumentKind(_is_whole, "a whole number"),
    float: ArgumentKind(_is_real, "a finite number"),
    complex: ArgumentKind(is_number, "a finite number, real or complex"),
    str: ArgumentKind(lambda value: isinstance(value, str), "text"),
}


def _kind_of(written: Any) -> ArgumentKind:
    """Kind of argument that an annotation stands for."""
    origin, parts = get_origin(written), get_args(written)
    if origin is Annotated:
        return _ranged(_kind_of(parts[0]), *parts[1:])
    if origin in (Union, types.UnionType):
        return _any_of([_kind_of(part) for part in parts])
    if origin is Literal:
        options = f"one of: {', '.join(map(str, parts))}"
        return ArgumentKind(lambda value: any(_is_same(value, one) for one in parts), options)
    if origin is tuple and parts[-1] is not ...:
        return _fixed([_kind_of(part) for part in parts])
    if origin in (tuple, list, Sequence, Iterable):
        return _several(_kind_of(parts[0]), Iterable if origin is Iterable else Sequence)
    if origin is Mapping:
        return _mapping(*(_kind_of(part) for part in parts))
    if origin is Callable:
        return ArgumentKind(callable, "a function")
    if isinstance(written, ForwardRef) or getattr(origin or written, "__name__", "") == "ndarray":
        return _NUMBERS
    return _PLAIN.get(written) or _instances(origin or written)


def _is_same(value: object, option: object) -> bool:
    return isinstance(value, type(option)) and not isinstance(value, bool) and value == option


def _ranged(whole: ArgumentKind, limits: ArgumentKind) -> ArgumentKind:
    return ArgumentKind(lambda value: whole.holds(value) and limits.holds(value), limits.words)


def _any_of(kinds: Sequence[ArgumentKind]) -> ArgumentKind:
    *words, last = dict.fromkeys(kind.words for kind in kinds if kind.words)
    allowed = f"{', '.join(words)} or {last}" if words else last
    return ArgumentKind(lambda value: any(kind.holds(value) for kind in kinds), allowed)


def _fixed(kinds: Sequence[ArgumentKind]) -> ArgumentKind:
    def holds(value: object) -> bool:
        if not _is_sequence(value) or len(value) != len(kinds):
            return False
        return all(kind.holds(part) for kind, part in zip(kinds, value, strict=True))

    words = list(dict.fromkeys(kind.words for kind in kinds))
    which = f"{'each' if len(words) == 1 else 'namely'} {', '.join(words)}"
    return ArgumentKind(holds, f"{len(kinds)} values in brackets, {which}")


def _several(one: ArgumentKind, container: object) -> ArgumentKind:
    def holds(value: Any) -> bool:
        several = _is_sequence(value)
        if container is Iterable:
            several = isinstance(value, Iterable) and not isinstance(value, str | bytes | Mapping)
        return several and (isinstance(value, Iterator) or all(map(one.holds, value)))  # an iterator would be used up

    return ArgumentKind(holds, f"a sequence, each entry {one.words}")


def _is_sequence(value: object) -> TypeGuard[Sequence[object]]:
    """Whether a value is a sequence of several, as carom's sets of results are too, or an array that can be read as one."""
    several = isinstance(value, Sequence) or hasattr(value, "__array__")
    several |= hasattr(value, "__getitem__") and hasattr(value, "__len__") and not isinstance(value, Mapping | set)
    return several and not isinstance(value, str | bytes) and getattr(value, "ndim", 1) > 0


def _mapping(key: ArgumentKind, entry: ArgumentKind) -> ArgumentKind:
    def holds(value: object) -> bool:
        return isinstance(value, Mapping) and all(key.holds(name) and entry.holds(one) for name, one in value.items())

    return ArgumentKind(holds, f"a mapping from {key.words} to {entry.words}")


def _instances(kind: type) -> ArgumentKind:
    """Instances of a class, or what follows a protocol: to find that out takes long, so types are remembered."""
    known: set[type] = set()

    def holds(value: object) -> bool:
        if type(value) in known:
            return True
        fits = isinstance(value, kind) and not isinstance(value, type)
        if fits:
            known.add(type(value))
        return fits

    return ArgumentKind(holds, f"{'an' if kind.__name__[0] in 'AEIO' else 'a'} {kind.__name__}")
