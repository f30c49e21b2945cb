"""The plan of a sweep: a grid of machines, what is computed for each, and how the grid is divided into chunks."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from itertools import product
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from carom.base.arguments import Count, Whole, checked, whole
from carom.base.outcome import InputError, shown
from carom.disturbances import Grid, Plan, Sample
from carom.parameters import DIMENSIONLESS_FIELDS, HELPER_FIELDS, TERM_FIELDS, Case, Parameters, Zones
from carom.parameters.machine_file import GRAVITY_NAME, OF_TABLES, SETTINGS
from carom.parameters.terms import check_names
from carom.sweeps.axes import GridAxis
from carom.sweeps.basins import BasinsTask
from carom.sweeps.studies import StudyTask
from carom.sweeps.variables import STATUS

if TYPE_CHECKING:
    from carom.models import Axis, Rotor, Subject
    from carom.sweeps.variables import Variable
else:
    Rotor = Subject = object  # imported when a plan is made, and refused there

MOST_POINTS = 1_000_000_000
"""Largest number of points of a sweep: a point takes a thousandth of a second at least."""
MOST_CHUNKS = 1_000_000
"""Largest number of chunks of a sweep: each chunk is several files."""
SECONDS_A_CHUNK = 4.0
"""Estimated computing time of a chunk whose size is not given."""


Task = StudyTask | BasinsTask
"""What is computed at each point of a grid."""


@dataclass(frozen=True)
class SweepPlan:
    """What a sweep does.  Its memory use does not depend on the number of points or chunks.

    Attributes
    ----------
    case : Case or Rotor
        The machine whose parameters the axes vary.
    axes : tuple of GridAxis
    task : Task
    chunk_shape : tuple of int
        Points of a chunk along each axis.
    seed : int
        The random numbers of a point follow from this seed and the number of the point alone.
    fixed : mapping of str to float or str
        Dimensionless numbers, and terms such as ``damping_ratio``, that were set.  They keep their values when the axes
        change what they are related to.
    sources : mapping of str to str
        Texts of the sweep file and of the machine file, which the store keeps.
    """

    case: Case | Rotor
    axes: tuple[GridAxis, ...]
    task: Task
    chunk_shape: tuple[int, ...]
    seed: int = 0
    fixed: Mapping[str, float | str] = field(default_factory=dict)
    sources: Mapping[str, str] = field(default_factory=dict, compare=False)

    @property
    def variables(self) -> tuple[Variable, ...]:
        """What is stored for each point, the status last."""
        return *self.task.variables, STATUS

    @property
    def name(self) -> str:
        """Name of the machine."""
        return self.case.name if isinstance(self.case, Case) else type(self.case).__name__

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the grid."""
        return tuple(axis.count for axis in self.axes)

    @property
    def points(self) -> int:
        """Number of points of the grid."""
        return math.prod(self.shape)

    @property
    def chunk_grid(self) -> tuple[int, ...]:
        """Number of chunks along each axis."""
        return tuple(-(-count // chunk) for count, chunk in zip(self.shape, self.chunk_shape, strict=True))

    @property
    def chunks(self) -> int:
        """Number of chunks."""
        return math.prod(self.chunk_grid)

    @checked
    def place(self, number: Whole) -> tuple[int, ...]:
        """Return the index of a chunk in the grid of chunks."""
        return tuple(int(place) for place in np.unravel_index(number, self.chunk_grid))

    @checked
    def region(self, number: Whole) -> tuple[slice, ...]:
        """Return the part of the grid that a chunk covers."""
        return tuple(
            slice(place * chunk, min((place + 1) * chunk, count))
            for place, chunk, count in zip(self.place(number), self.chunk_shape, self.shape, strict=True)
        )

    @checked
    def size(self, number: Whole) -> int:
        """Return the number of points of a chunk."""
        return math.prod(part.stop - part.start for part in self.region(number))

    def points_of(self, number: int) -> Iterator[tuple[int, ...]]:
        """Return the indices of the points of a chunk in the grid; the last axis varies fastest."""
        return product(*(range(part.start, part.stop) for part in self.region(number)))

    @checked
    def values(self, point: tuple[int, ...]) -> dict[str, float]:
        """Return the values of the parameters that vary, at a point of the grid."""
        inside = [0 <= place < most for place, most in zip(point, self.shape, strict=False)]
        if len(point) != len(self.shape) or not all(inside):
            raise InputError("point", point, f"indices of the grid of shape {self.shape}")
        return {axis.name: float(axis.values[place]) for axis, place in zip(self.axes, point, strict=True)}

    @checked
    def case_at(self, point: tuple[int, ...]) -> Case | Rotor:
        """Return the machine at a point; a case is bit for bit the same as with ``--set``.

        Raises
        ------
        InputError
            The parameters of this point do not describe a machine.
        """
        return self.case.replace(**{**self.fixed, **self.values(point)})

    @checked
    def seed_of(self, point: tuple[int, ...]) -> np.random.SeedSequence:
        """Return the seed of a point, which does not depend on its chunk or worker."""
        self.values(point)  # refuses what is no point of the grid
        number = int(np.ravel_multi_index(point, self.shape))
        return np.random.SeedSequence(self.seed, spawn_key=(number,))

    def describe(self) -> dict[str, object]:
        """Return what identifies the plan: two plans with the same description have the same results."""
        machine: dict[str, Any] = {}
        if isinstance(self.case, Case):
            tables = {name: getattr(self.case, name) for name in ("gravity", "touchdown", "drive")}
            machine = {name: asdict(table) for name, table in tables.items() if table is not None}
            varied = {*self.fixed, *(axis.name for axis in self.axes)}
            if self.case.given and varied & {*TERM_FIELDS, *HELPER_FIELDS}:  # whose effect depends on how it was given
                machine["given"] = self.case.given_texts
        numbers = self.case.parameters if isinstance(self.case, Case) else self.case
        return (
            numbers.attributes()
            | machine
            | {
                "fixed": dict(self.fixed),
                "axes": [axis.describe() for axis in self.axes],
                "task": self.task.describe(),
                "chunk": list(self.chunk_shape),
                "seed": self.seed,
            }
        )

    @property
    def digest(self) -> str:
        """Hash of the description."""
        return hashlib.sha256(json.dumps(self.describe(), sort_keys=True).encode()).hexdigest()


def cut(shape: tuple[int, ...], task: Task, chunk: int | None) -> tuple[int, ...]:
    """Return the shape of the chunks of a grid; a chunk extends along the last axes first.

    ``chunk`` is its largest number of points.  By default a chunk takes some seconds, and there are fewer chunks than
    allowed; too many are refused.
    """
    points = math.prod(shape)
    if points > MOST_POINTS:
        allowed = f"at most {MOST_POINTS}: fewer values along an axis, or fewer axes"
        raise InputError("axes", f"{' x '.join(map(str, shape))} = {points} points", allowed)
    wanted = chunk or max(int(SECONDS_A_CHUNK / task.seconds), -(-points // (MOST_CHUNKS // 4)), 1)
    sizes = []
    for count in reversed(shape):
        size = min(count, wanted)
        sizes.append(size)
        wanted = max(wanted // size, 1)
    sizes.reverse()
    chunks = math.prod(-(-count // size) for count, size in zip(shape, sizes, strict=True))
    if chunks > MOST_CHUNKS:
        allowed = f"at most {MOST_CHUNKS} are allowed; {-(-points // MOST_CHUNKS)} or more points"
        raise InputError("chunk", chunk, f"gives {chunks} chunks, {allowed}")
    return tuple(sizes)


def parameter_of(case: Case | Rotor, name: str) -> Axis | str:
    """The parameter that an axis varies: that of a model, or the name of the planar rotor's; refuse one that the machine does not have."""
    if not isinstance(case, Case) or not isinstance(case.parameters, Parameters):
        from carom.models.axes import axis

        try:
            return axis(case, name)
        except InputError as problem:
            raise InputError(f"axes.{name}", shown(name), problem.allowed) from None
    allowed = ""
    if name not in DIMENSIONLESS_FIELDS and not case.si:
        allowed = "the machine is dimensionless; vary dimensionless parameters"
    elif name in OF_TABLES and name != GRAVITY_NAME and case.touchdown is None:
        allowed = "the machine has no table [touchdown]"
    elif name in ("d", "restitution") and case.touchdown is not None and case.touchdown.is_compliant:
        allowed = "the touchdown bearing is compliant: vary touchdown_restitution, or its damping or dissipation"
    if allowed:
        raise InputError(f"axes.{name}", shown(name), allowed)
    return name


@checked
def plan_sweep(
    machine: Subject,
    axes: Sequence[GridAxis],
    work: Plan | StudyTask,
    *,
    seed: Annotated[int, whole(0, 2**63 - 1)] | None = None,
    chunk: Count | None = None,
) -> SweepPlan:
    """Plan a sweep in Python; a sweep file is read by :func:`~carom.sweeps.load_sweep`.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        The machine whose parameters the axes vary.
    axes : sequence of GridAxis
        Such as ``GridAxis.between("damping", "700 N s/m", "2800 N s/m", 16)`` or ``GridAxis.of("friction", [0.1, 0.2])``.
    work : Sample, Grid or StudyTask
        What is done at each point: disturbances to follow, with models of carom or of your own, or a study.  Each point
        draws a sample of its own.  Sizes are those of this machine; where an axis changes its scales, they stay the
        same in SI units.
    seed : int, optional
        By default that of the sample; otherwise 0.
    chunk : int, optional
        Points that are computed and stored together, by default as many as take some seconds.

    Raises
    ------
    InputError
        There is no axis, or two of them vary the same, or a parameter that cannot be varied here.

    See Also
    --------
    carom.run_sweep : compute it
    carom.sweeps.load_sweep : a plan from a file

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> axes = [cm.sweeps.GridAxis.between("speed", "1000 rpm", "3000 rpm", 5)]
    >>> plan = cm.sweeps.plan_sweep(machine, axes, cm.sweeps.StudyTask(disturbances=0))
    >>> plan.shape
    (5,)
    """
    from carom.models import Rotor, case_of, rotor_of

    keeps = isinstance(machine, Rotor) and not isinstance(work, StudyTask)
    case: Case | Rotor = machine if isinstance(machine, Case) else rotor_of(machine) if keeps else case_of(machine)
    names = [axis.name for axis in axes]
    if not names or len(set(names)) < len(names):
        raise InputError("axes", ", ".join(names) or None, "must be one or more, each for another parameter")
    if isinstance(case, Case) and isinstance(case.parameters, Parameters):
        check_names(dict.fromkeys(names, "varied"), SETTINGS)
    for name in names:
        parameter_of(case, name)
    scales = rotor_of(case).scales
    if seed is None:
        seed = work.seed if isinstance(work, Sample) else 0
    task: Task
    if isinstance(work, Grid | Sample):
        tried = replace(work, seed=0) if isinstance(work, Sample) else work  # each point has a seed of its own
        task = BasinsTask(tried, tuple(work.model.measured_in), scales)
    else:
        limits = case.zones.limits if isinstance(case, Case) else Zones().limits
        task = replace(work, zone_limits=limits, has_scales=scales is not None)
    return SweepPlan(case, tuple(axes), task, cut(tuple(axis.count for axis in axes), task, chunk), seed)
