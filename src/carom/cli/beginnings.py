"""How a motion begins: what the options of a start, a disturbance or a release make of a machine."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from carom.base.outcome import InputError

if TYPE_CHECKING:
    from carom.disturbances import Drop
    from carom.disturbances.echo import Echo
    from carom.models import Rotor
    from carom.motions.loads import DropLoads
    from carom.parameters import Case
    from carom.rotors.reduction_errors import ReductionError


@dataclass(frozen=True)
class StatedBeginning:
    """One start or disturbance by its option, and the angle by which the shaft has turned then; or a release, when levitation is lost."""

    option: str = ""
    text: str = ""
    instant: str | None = None
    release: Drop | None = None

    def apply(self, case: Case) -> tuple[Rotor, Any, Echo]:
        """The machine that moves, its start, and what was taken; wrong input is refused before the rotor is made."""
        from carom.cli.starts import read_instant, read_one
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
) -> StatedBeginning:
    """How levitation is lost, at the state that one of some ways gives; wrong input is refused before kernels are loaded."""
    from carom.cli.starts import read_angle, read_one, read_positive, read_speed
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
    return StatedBeginning(release=Drop(at, turned, regained, turning))
