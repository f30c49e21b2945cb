"""The Zarr store of a sweep: written chunk by chunk, each once and whole, by one process; read by any.

Every variable is an array over the grid in the Zarr 3 format, uncompressed, so that a chunk of it is a file that holds
the bytes of the numbers and their checksum.  The file of ``status`` is written after all others: a chunk is finished as soon
as it is there, whatever happens next.  Failures are told in ``failures/<chunk>.json``, kinds of processors in
``processors.json``.  What is finished is compared with its checksums before a sweep goes on: a chunk of which a file is
damaged or missing is waiting again.
"""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, suppress
from dataclasses import asdict
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from filelock import FileLock, Timeout

from carom.files import sync_directory, write_whole
from carom.outcome import CaromWarning, InputError
from carom.sweeps.chunk import Chunk
from carom.sweeps.integrity import DamagedError, is_whole, read_record, record, seal, unseal
from carom.sweeps.layout import FAILURES, OPTION, PARTS, attributes_of, check_same, create, is_new
from carom.sweeps.plan import SweepPlan
from carom.sweeps.variables import STATUS, Status
from carom.sweeps.versions import PROCESSORS, differences, processors_of

if TYPE_CHECKING:
    import xarray

__all__ = ["SweepStore", "open_sweep"]

_LOCK = ".lock"
_WRITERS = 8
"""Files that are brought to the disk at the same time; the system gathers them."""


class SweepStore:
    """A store that belongs to a plan; use it in a ``with`` statement to write.

    Parameters
    ----------
    path : path
        Directory; made if it is not there.
    plan : SweepPlan

    Attributes
    ----------
    damaged : list of int
        Chunks that were finished and of which a file is damaged or missing: they are waiting again.

    Raises
    ------
    InputError
        The place cannot be written, holds something else, belongs to another plan, or is damaged beyond its chunks.
    """

    def __init__(self, path: str | os.PathLike[str], plan: SweepPlan) -> None:
        self.path, self.plan = Path(path), plan
        self.damaged: list[int] = []
        self._finished = np.zeros(plan.chunks, bool)
        self._failed: dict[int, int] = {}
        self._processors: list[str] = []
        points = math.prod(plan.chunk_shape)
        self._sizes = [points * math.prod(one.shape) * one.dtype.itemsize for one in plan.task.variables]
        self._sizes.append(points * STATUS.dtype.itemsize)
        try:
            if is_new(self.path):
                create(self.path, plan)
            check_same(self.path, plan)
            self._look()
        except OSError as problem:
            raise self._refusal(problem) from None
        self._lock = FileLock(self.path / _LOCK, timeout=0)
        self._writers: ThreadPoolExecutor | None = None

    # ------------------------------------------------------------------------------------------- what is there

    def _look(self) -> None:
        """Find out what is finished, by the files of the status, and compare with its checksums what is new."""
        self.damaged = []
        for number in np.flatnonzero(_there(self.path / STATUS.name / "c", self.plan) & ~self._finished).tolist():
            failed = self._failed_points(number)
            if failed is None:
                self.damaged.append(number)
                continue
            self._finished[number] = True
            if failed:
                self._failed[number] = failed
        self._processors = processors_of(self.path, OPTION)
        self._points = _points(self._finished, self.plan)

    def _failed_points(self, number: int) -> int | None:
        """Failed points of a finished chunk, or None if a file of it is damaged or missing."""
        try:
            data = [file.read_bytes() for file in self._files(number).values()]
            if not all(map(is_whole, data, self._sizes)):
                return None
            failed = unseal(data[-1]).count(Status.FAILED)
            if failed:
                self._record(number)
        except FileNotFoundError:
            return None
        return failed

    def _record(self, number: int) -> list[dict[str, Any]]:
        """What is told about the failed points of a chunk."""
        file = _failure_file(self.path, number)
        try:
            points: list[dict[str, Any]] = read_record(file)["points"]
        except DamagedError:
            remedy = f"delete it, and the same command computes chunk {number} again"
            raise InputError(OPTION, self.path, f"its file {FAILURES}/{file.name} is damaged; {remedy}") from None
        return points

    def _files(self, number: int) -> dict[str, Path]:
        """Files of a chunk by the names of the variables; the one of the status, which is written last, comes last."""
        key = "/".join(("c", *map(str, self.plan.place(number))))
        files = {
            variable.name: self.path / variable.name / key / "/".join("0" * len(variable.shape))
            for variable in self.plan.task.variables
        }
        return files | {STATUS.name: self.path / STATUS.name / key}

    @property
    def done(self) -> int:
        """Points that have been computed, failed ones left out."""
        return self._points - self.failed

    @property
    def failed(self) -> int:
        """Points that failed."""
        return sum(self._failed.values())

    def waiting(self, retry_failed: bool = False) -> Iterator[int]:
        """Chunks that are not finished, in order; then those with failures, if they are to be tried again."""
        again = sorted(self._failed) if retry_failed else []
        yield from (int(number) for number in np.flatnonzero(self._finished == 0))
        yield from again

    def failures(self, most: int = 20) -> list[dict[str, Any]]:
        """The first points that failed: place, parameters and error of each."""
        found: list[dict[str, Any]] = []
        for number in sorted(self._failed):
            found += self._record(number)
            if len(found) >= most:
                break
        return found[:most]

    # ------------------------------------------------------------------------------------------------- writing

    def __enter__(self) -> Self:
        try:
            self._lock.acquire()
            with ExitStack() as stack:
                stack.callback(self._lock.release)
                for directory in (PARTS, FAILURES):
                    (self.path / directory).mkdir(exist_ok=True)
                for part in (self.path / PARTS).iterdir():  # of a process that was killed
                    part.unlink()
                self._look()  # now that nobody else writes
                stack.pop_all()
        except Timeout:
            raise InputError(OPTION, self.path, "another sweep is writing to it; let it end, or stop it") from None
        except OSError as problem:
            raise self._refusal(problem) from None
        self._writers = ThreadPoolExecutor(_WRITERS, thread_name_prefix="carom-store")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._writers is not None:
            self._writers.shutdown()
        self._writers = None
        self._lock.release()

    def write(self, chunk: Chunk) -> None:
        """Write a chunk: its arrays, then what failed, then its status; on return it is on the disk.

        Raises
        ------
        InputError
            It cannot be written; nothing that was written before is lost.
        """
        if self._writers is None:
            raise RuntimeError("the store is not open for writing")
        plan, number = self.plan, chunk.number
        fills = {variable.name: variable.fill for variable in plan.task.variables} | {STATUS.name: Status.WAITING}
        files = {
            file: seal(_padded(plan, chunk.arrays[name], fills[name])) for name, file in self._files(number).items()
        }
        status = list(files)[-1]
        status_data = files.pop(status)
        failures = _failure_file(self.path, number)
        if chunk.failures:
            files[failures] = record({"chunk": number, "points": [asdict(failure) for failure in chunk.failures]})
        try:
            self._note(chunk.processor)
            list(self._writers.map(self._write_file, files, files.values()))
            list(self._writers.map(sync_directory, {file.parent for file in files}))
            self._write_file(status, status_data)
            sync_directory(status.parent)
            if not chunk.failures:
                failures.unlink(missing_ok=True)
        except OSError as problem:
            raise self._refusal(problem, told=True) from None
        if not self._finished[number]:
            self._finished[number] = True
            self._points += plan.size(number)
        self._failed.pop(number, None)
        if chunk.failures:
            self._failed[number] = len(chunk.failures)

    def _note(self, processor: str) -> None:
        """Write down a kind of processor that computed a chunk; warn if it is not the first."""
        if not processor or processor in self._processors:
            return
        if self._processors:
            others = differences(processor, self._processors[0])
            warnings.warn(
                f"{self.path} was begun on a processor of another kind ({others}): from here on numbers may differ in their last "
                "bits from what they would be there, and with them where irregular motions end; for the same bits everywhere, "
                "begin anew and go on with processors of one kind only",
                CaromWarning,
                stacklevel=2,
            )
        self._processors.append(processor)
        self._write_file(self.path / PROCESSORS, record(self._processors))

    def _write_file(self, target: Path, data: bytes) -> None:
        write_whole(target, data, self.path / PARTS)

    def _refusal(self, problem: OSError, told: bool = False) -> InputError:
        reason = problem.strerror or str(problem)
        if not told:
            place = f": {problem.filename}" if problem.filename and Path(problem.filename) != self.path else ""
            return InputError(
                OPTION, self.path, f"cannot be read or written ({reason}{place}); mend that or give another directory"
            )
        finished = int(np.count_nonzero(self._finished))
        kept = f"{finished} of {self.plan.chunks} chunks are there whole"
        return InputError(
            OPTION, self.path, f"cannot be written ({reason}); {kept}; mend that, and the same command goes on"
        )


def open_sweep(path: str | os.PathLike[str]) -> xarray.Dataset:
    """Open the store of a sweep, finished or not.

    Parameters
    ----------
    path : path

    Returns
    -------
    xarray.Dataset
        Over the axes of the sweep, read when needed; ``status`` tells which points were computed.  A chunk of which a file is
        damaged or missing raises an :class:`~carom.outcome.InputError` that names it when it is read.

    Raises
    ------
    InputError
        There is no such store, or it is damaged beyond its chunks.
    """
    import xarray

    from carom.sweeps.checked_store import CheckedStore

    path = Path(path)
    try:
        attributes_of(path, "store")
        processors = processors_of(path, "store")
        data = xarray.open_zarr(CheckedStore.at(path), chunks=None, consolidated=True)
    except OSError as problem:
        raise InputError("store", path, f"cannot be read ({problem.strerror or problem}: {problem.filename})") from None
    data.attrs["versions"] = data.attrs["versions"] | {"processors": processors}
    return data


# ------------------------------------------------------------------------------------------------------------ chunks


def _there(directory: Path, plan: SweepPlan) -> np.ndarray:
    """Which chunks have a file of their status, by the names of these files."""
    found = np.zeros(plan.chunk_grid, bool)
    names = [{str(place) for place in range(count)} for count in plan.chunk_grid]

    def look(place: Path, index: tuple[int, ...]) -> None:
        with suppress(FileNotFoundError), os.scandir(place) as entries:
            for entry in entries:
                if entry.name not in names[len(index)]:
                    continue
                inner = (*index, int(entry.name))
                if len(inner) == len(names):
                    found[inner] = True
                else:
                    look(Path(entry.path), inner)

    look(directory, ())
    return found.ravel()


def _points(finished: np.ndarray, plan: SweepPlan) -> int:
    """Points of the finished chunks; those at the ends of the grid are smaller."""
    weights = finished.reshape(plan.chunk_grid).astype(np.int64)
    for count, chunk, chunks in reversed(list(zip(plan.shape, plan.chunk_shape, plan.chunk_grid, strict=True))):
        sizes = np.full(chunks, chunk)
        sizes[-1] = count - chunk * (chunks - 1)
        weights = weights @ sizes
    return int(weights)


def _failure_file(path: Path, number: int) -> Path:
    return path / FAILURES / f"{number:07d}.json"


def _padded(plan: SweepPlan, values: np.ndarray, fill: float) -> bytes:
    """Bytes of a Zarr chunk: at the ends of the grid it reaches beyond, and is as large as all others."""
    whole = plan.chunk_shape + values.shape[len(plan.shape) :]
    if values.shape == whole:
        return np.ascontiguousarray(values).tobytes()
    padded = np.full(whole, fill, values.dtype)
    padded[tuple(slice(size) for size in values.shape)] = values
    return padded.tobytes()
