"""Read starts, kicks, times, ranges and how a motion begins from text: with units where the machine is in SI units, otherwise dimensionless.

A bare number for a quantity with a dimension is refused for a machine in SI units: ``--kick 60`` may mean 60 mm/s, or 60 times
``c_r Ω``.  Starts and times to follow a motion may be either, for they are often those of another result.
What cannot be read raises an :class:`~carom.base.outcome.InputError` that names the option, the value and what is allowed.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple, TypeVar, cast

from carom.base.outcome import InputError, together
from carom.disturbances.single import Single, split_text
from carom.parameters import DIMENSIONLESS_FIELDS, Case, Field, Requirement, Scales, own_time, read_quantity, read_size
from carom.parameters.fields import unknown_name
from carom.parameters.requirement import SI
from carom.parameters.terms import HELPER_FIELDS, SETTABLE, TERMS, set_by

if TYPE_CHECKING:
    from carom.base.progress import Reporter
    from carom.basins.maps import Over
    from carom.disturbances import BaseRecord, Drop, ShockResponse
    from carom.disturbances.single import Echo
    from carom.models import Axis, Rotor
    from carom.motions.loads import DropLoads
    from carom.motions.starts import State
    from carom.motions.trajectories import Trajectory
    from carom.parameters import Case
    from carom.rotors.reduction_errors import ReductionError

Given = TypeVar("Given")


def read_one(option: str, text: str, scales: Scales | None) -> Single:
    """Read the single disturbance, or the state, of an option."""
    from carom.disturbances import Disturbance

    return Disturbance.of_kind(option.removeprefix("--")).single_of(text, scales, option)


def read_instant(text: str | None, rotor: Rotor) -> float:
    """Read the angle by which the shaft has turned at a disturbance, by default 0; refuse it where it says nothing."""
    if text is None:
        return 0.0
    if not rotor.depends_on_instant:
        allowed = "allowed only under weight, with limits of the magnetic bearings, or where bearings are anisotropic"
        raise InputError("--instant", text, allowed)
    return read_angle("--instant", text, rotor.scales)


def read_angle(option: str, text: str, scales: Scales | None) -> float:
    """Read an angle, in rad; zero needs no unit."""
    return _size(option, text, "angle", scales) if text.strip("0.") else 0.0


def read_speed(option: str, text: str, scales: Scales | None) -> float:
    """Read an angular speed, which may be negative, in ``Ω``."""
    return _size(option, text, "speed", scales)


def _size(option: str, text: str, kind: str, scales: Scales | None) -> float:
    """Read a size in units of the equations; where the scales are known, it needs a unit."""
    return read_size(option, text, kind, scales, bare=False).own(scales)


def read_all_around(option: str, text: str, scales: Scales | None) -> Single:
    """Read a kick, a shock or a loss of a blade of which all directions are meant, by its option."""
    single = read_one(option, text, scales)
    if single.values[-1]:
        raise InputError(option, text, "must be without an angle: all directions are tried")
    return single


def with_requirement(case: Case, base_record: str | None = None, **given: str | int | None) -> Case:
    """Return the case with what ``--kick``, ``--shock``, ``--blade-loss`` and ``--base-record`` state in place of what its file states."""
    if (loss := given.get("blade_loss")) is not None:
        node = getattr(read_all_around("--blade-loss", str(loss), case.parameters.scales).model, "node", None)
        given |= {"blade_loss": split_text("--blade-loss", str(loss), (1, 2, 3), "")[0], "blade_loss_node": node}
    try:
        stated = Requirement.of(case, **given)
        if base_record is not None:
            scales = case.parameters.scales
            motion = cast("BaseRecord", read_all_around("--base-record", base_record, scales).model)
            stated = replace(stated, base_record=motion.rescaled(scales, SI), source="option")
        return replace(case, requirement=case.requirement.changed_by(stated))
    except InputError as problem:
        named = [(f"--{error.field.replace('_', '-')}", error) for error in problem.errors]
        raise together([InputError(option, error.value, error.allowed) for option, error in named]) from None


def read_time(text: str | None, scales: Scales | None, option: str = "--until") -> float | None:
    """Read a time above 0, in ``1/Ω`` or with a unit of time, if one is given."""
    return None if text is None else own_time(option, text, scales)


def read_positive(option: str, text: str, kind: str, scales: Scales | None) -> float:
    """Read a length, velocity, acceleration or time above 0, in units of the equations."""
    size = _size(option, text, kind, scales)
    if not size > 0:
        raise InputError(option, text, f"must be {'an' if kind[0] in 'aeiou' else 'a'} {kind} above 0")
    return size


def read_value(option: str, text: str, varied: Axis) -> float:
    """Read a value of a parameter to vary; that of a physical one needs its unit."""
    try:
        return read_quantity(_of_command_line(varied.field), text)
    except InputError as problem:
        raise InputError(option, problem.value, f"{varied.name} {problem.allowed}") from None


def check_exact(option: str, text: str, name: str) -> None:
    """Refuse a value of a physical parameter without its unit, where it is read exactly."""
    if name in SETTABLE and name not in DIMENSIONLESS_FIELDS:
        from carom.parameters.quantities import read_exact

        try:
            read_exact(_of_command_line(SETTABLE[name]), text)
        except InputError as problem:
            raise InputError(option, problem.value, f"{name} {problem.allowed}") from None


def _of_command_line(field: Field) -> Field:
    return replace(field, needs_unit=bool(field.unit) and field.name not in DIMENSIONLESS_FIELDS)


def read_range(option: str, text: str, varied: Axis) -> tuple[float, float]:
    """Read ``A,B``, the ends of a range of a parameter in either order; return the smaller one first."""
    return _two(option, text, varied.name, lambda part: read_value(option, part, varied))


def read_ends(start: str, end: str, varied: Axis) -> tuple[float, float]:
    """Read ``--from`` and ``--to``, the ends of a range of a parameter in either order; return the smaller one first."""
    allowed = "must be another value than --from; which of the two is larger does not matter"
    return _ascending("--to", end, allowed, [read_value("--from", start, varied), read_value("--to", end, varied)])


def _two(option: str, text: str, name: str, read: Callable[[str], float]) -> tuple[float, float]:
    allowed = f"must be two different values of {name} with a comma between them"
    return _ascending(option, text, allowed, [read(part) for part in split_text(option, text, (2,), allowed)])


def _ascending(option: str, text: str, allowed: str, ends: list[float]) -> tuple[float, float]:
    if ends[0] == ends[1]:
        raise InputError(option, text, allowed)
    return min(ends), max(ends)


def by_option(**given: Given) -> dict[str, Given]:
    """Arguments of a command by the options that gave them: ``--blade-loss`` for ``blade_loss``."""
    return {f"--{name.replace('_', '-')}": value for name, value in given.items()}


def refuse(allowed: str, **given: object) -> None:
    """Refuse the first of these arguments that is given."""
    for option, value in by_option(**given).items():
        if value is not None:
            raise InputError(option, value, allowed)


def read_cells(option: str, text: str, dimensions: int, least: int, most: int) -> tuple[int, ...]:
    """Read a number of cells such as ``60x60``."""
    match = re.fullmatch("[x×X]".join([r"\s*([0-9]{1,30})\s*"] * dimensions), text)
    cells = tuple(int(number) for number in match.groups()) if match else ()
    if not match or min(cells) < least:
        words = f"{dimensions} whole number{'s'[: dimensions - 1]} of at least {least}"
        raise InputError(option, text, f"must be {words}, such as {'60x60' if dimensions == 2 else '360'}")
    if (total := math.prod(cells)) > most:
        raise InputError(option, text, f"makes {total} cells; at most {most} are allowed")
    return cells


class PlaneRead(NamedTuple):
    """Two parameters to vary, a range of each where one is given, and the machine that states them as the option does."""

    axes: tuple[Axis, Axis]
    ranges: tuple[tuple[float, float] | None, tuple[float, float] | None]
    in_terms_of: Case

    def over(self, shape: Sequence[int]) -> Over:
        """Both with their ranges and these numbers of values."""
        each = zip(self.axes, self.ranges, shape, strict=True)
        return {varied.name: (*ends, count) if ends else count for varied, ends, count in each}


def read_plane(
    case: Case, option: str, given: str, x: str | None, y: str | None, others: Mapping[str, Axis] = MappingProxyType({})
) -> PlaneRead:
    """Read two names, of parameters or of what a machine file states them by, with ``--x`` and ``--y``; ``others`` can be varied too."""
    entries = [name.strip() for name in given.split(",")]
    names = [set_by(entry) if entry in TERMS and entry not in case.parameters.varied else entry for entry in entries]
    if len(names) != 2 or names[0] == names[1]:
        raise InputError(option, given, "must be two names with a comma between them, such as stiffness,damping")
    pairs = zip(entries, names, strict=True)
    axes = [others.get(name) or _varied(case, option, given, entry, name, others) for entry, name in pairs]
    ranges, in_terms_of = [], case
    for end, text, entry, varied, other in zip(("--x", "--y"), (x, y), entries, axes, reversed(names), strict=True):
        if entry == varied.name:
            ranges.append(None if text is None else read_range(end, text, varied))
            continue
        if other in TERMS[entry].needs:
            allowed = f"{entry} changes with {other}, which is the other parameter; use {varied.name}"
            raise InputError(option, given, allowed)
        in_terms_of = _stated_by(in_terms_of, option, given, entry)
        ranges.append(None if text is None else _read_entry_range(end, text, in_terms_of, entry))
    return PlaneRead((axes[0], axes[1]), (ranges[0], ranges[1]), in_terms_of)


def _varied(case: Case, option: str, given: str, entry: str, name: str, others: Mapping[str, Axis]) -> Axis:
    """The parameter that an entry states; what states none alone is refused, with why."""
    from carom.models import axis, rotor_of

    model = rotor_of(case)  # it has the parameters of its touchdown bearing too
    varied = model.varied
    if name in varied:
        return axis(model, name)
    known = [*others, *varied, *(term for term, (sets, *_) in TERMS.items() if sets in varied)]
    if entry in HELPER_FIELDS:
        words = HELPER_FIELDS[entry].words
        allowed = f"{entry} ({words}) is no parameter of the rotor by itself; allowed: {', '.join(known)}"
    elif entry in TERMS:
        allowed = f"{entry} sets {name} of a machine in SI units; this one has {', '.join(varied)}"
    else:
        allowed = f"{entry}: {unknown_name(entry, None, dict.fromkeys(known), 'what can be varied').allowed}"
    raise InputError(option, given, allowed)


def _stated_by(case: Case, option: str, given: str, entry: str) -> Case:
    """The same machine with a field stated by this entry, as ``--set`` would; its value changes by rounding alone."""
    if set_by(entry) not in case.si or entry in case.given.get(set_by(entry), {}):
        return case
    needed = (set_by(entry), *TERMS[entry].needs)
    if missing := [name for name in needed if name not in case.si]:
        allowed = f"{entry} needs {' and '.join(missing)}, which the machine file does not state"
        raise InputError(option, given, allowed)
    exact = (Decimal(repr(case.si[name])) for name in needed)
    return case.replace(**{entry: float(TERMS[entry].entry(*exact))})


def _read_entry_range(option: str, text: str, case: Case, entry: str) -> tuple[float, float]:
    """Read a range of an entry of the machine file, in either order, as one of the parameter that it states."""

    def read(part: str) -> float:
        try:
            read_quantity(_of_command_line(SETTABLE[entry]), part)
            return float(case.replace(**{entry: part}).si[set_by(entry)])
        except InputError as problem:
            first = problem.errors[0]
            raise InputError(option, first.value, f"{entry} {first.allowed}") from None

    return _two(option, text, entry, read)


@dataclass(frozen=True)
class StatedBeginning:
    """One start or disturbance by its option, and the angle by which the shaft has turned then; or a release, when levitation is lost."""

    option: str = ""
    text: str = ""
    instant: str | None = None
    release: Drop | None = None

    def apply(self, case: Case) -> tuple[Rotor, State, Echo]:
        """The machine that moves, its start, and what was taken; wrong input is refused before the rotor is made."""
        from carom.models import rotor_of

        try:
            if self.release is not None:
                from carom.studies.drops import release

                return release(case, self.release)
            single, rotor = read_one(self.option, self.text, case.parameters.scales), rotor_of(case)
            single = replace(single, instant=read_instant(self.instant, rotor))
            return *single.stages(rotor), single.echo(rotor)
        except InputError as problem:
            if problem.field == "start":
                raise InputError("--start", self.text or problem.value, problem.allowed) from None
            if self.release is None and problem.field in ("kick", "disturbance"):
                raise InputError(self.option, self.text, f"{problem.allowed}; use --start") from None
            raise

    def shock_response(self, case: Case, motion: Trajectory, quality: float, tell: Reporter) -> ShockResponse:
        """Shock response spectra of a base that moves, and of the rotor."""
        from carom.disturbances.base_motion import BaseMotion
        from carom.disturbances.response_spectra import shock_response

        single = read_one(self.option, self.text, case.parameters.scales)
        size, angle, _ = single.model.whole(single.values)
        course = cast("BaseMotion", single.model).course(size, angle, motion.parts[0].begins)
        return shock_response(motion, course, quality, progress=tell)

    def reduction_error(self, case: Case, loads: DropLoads) -> ReductionError | None:
        """Error of the reduction of a flexible machine along the motion; ``None`` of other machines."""
        from carom.models import rotor_of
        from carom.rotors.reduction_errors import reduction_error

        if (reduced := rotor_of(case).finite_elements) is None:
            return None
        return reduction_error(reduced, loads, lambda finer: self.apply(replace(case, parameters=finer.limited))[:2])


def one_of(ways: dict[str, str | None], instant: str | None) -> StatedBeginning:
    """The one start or disturbance that is given."""
    chosen = {option: text for option, text in ways.items() if text is not None}
    if len(chosen) != 1:
        given = " with ".join(f"{option} {text}" for option, text in chosen.items()) or None
        raise InputError("--start", given, f"give one of {', '.join(ways)} and --drop")
    ((option, text),) = chosen.items()
    return StatedBeginning(option, text, instant)


def released(
    case: Case,
    ways: dict[str, str | None],
    regained_after: str | None,
    phase: str | None = None,
    race_speed: str | None = None,
    called: str = "--drop",
    regained_by: str | None = None,
    bases: Mapping[str, str | None] = MappingProxyType({}),
) -> StatedBeginning:
    """How levitation is lost, at the state that one of some ways gives; wrong input is refused before kernels are loaded."""
    from carom.disturbances import Drop

    scales = case.parameters.scales
    chosen = {option: text for option, text in ways.items() if text is not None}
    readers = ("--start", "--kick", "--whirl")
    if len(chosen) > 1 or not set(readers).issuperset(chosen):
        given = " with ".join(f"{option} {text}" for option, text in chosen.items())
        known = ", ".join(option for option in readers if option in ways)
        raise InputError(called, f"with {given}", f"allowed alone, or with one of {known}")
    regained = None if regained_after is None else read_positive("--regained-after", regained_after, "time", scales)
    turned = None if phase is None else read_angle("--phase", phase, scales)
    turning = None if race_speed is None else read_speed("--race-speed", race_speed, scales)
    at = next((read_one(option, text, scales) for option, text in chosen.items()), None)
    named = {each.name: each for each in case.recoveries}
    if regained_by is not None and regained_by not in named:
        known = (
            f"one of {', '.join(named)}"
            if named
            else "the name of a table [[recovery]], which the machine file has not"
        )
        raise InputError("--regained-by", regained_by, known)
    moves = [read_one(option, text, scales) for option, text in bases.items() if text is not None]
    if len(moves) > 1:
        raise InputError("--base-record", bases["--base-record"], "not allowed with --shock")
    recovery = named.get(regained_by or "")
    return StatedBeginning(release=Drop(at, turned, regained, turning, recovery, moves[0] if moves else None))
