"""The Zarr store of a sweep: written chunk by chunk, each once and whole, by one process; read by any.

Every variable is an array over the grid in the Zarr 3 format, uncompressed, so that a chunk of it is a file that holds
the bytes of the numbers.  The file of ``status`` is written after all others: a chunk is finished as soon as it is there,
whatever happens next.  Failures are told in ``failures/<chunk>.json``.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from carom.files import lock, sync_directory, write_whole
from carom.outcome import InputError
from carom.sweeps.chunk import Chunk
from carom.sweeps.layout import FAILURES, OPTION, PARTS, attributes_of, check_same, create, is_new
from carom.sweeps.plan import SweepPlan
from carom.sweeps.variables import STATUS, Status

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

    Raises
    ------
    InputError
        The place cannot be written, holds something else, or belongs to another plan.
    """

    def __init__(self, path: str | os.PathLike[str], plan: SweepPlan) -> None:
        self.path, self.plan = Path(path), plan
        try:
            if is_new(self.path):
                create(self.path, plan)
            else:
                check_same(self.path, plan)
            self._look()
        except OSError as problem:
            raise self._refusal(problem) from None
        self._lock: int | None = None
        self._writers: ThreadPoolExecutor | None = None

    # ------------------------------------------------------------------------------------------- what is there

    def _look(self) -> None:
        self._finished = _finished(self.path / STATUS.name / "c", self.plan)
        self._failed = _failed_points(self.path / FAILURES, self._finished)
        self._failures = sum(self._failed.values())
        self._points = _points(self._finished, self.plan)

    @property
    def done(self) -> int:
        """Points that have been computed, failed ones left out."""
        return self._points - self.failed

    @property
    def failed(self) -> int:
        """Points that failed."""
        return self._failures

    def waiting(self, retry_failed: bool = False) -> Iterator[int]:
        """Chunks that are not finished, in order; then those with failures, if they are to be tried again."""
        again = sorted(self._failed) if retry_failed else []
        yield from (int(number) for number in np.flatnonzero(self._finished == 0))
        yield from again

    def failures(self, most: int = 20) -> list[dict[str, Any]]:
        """The first points that failed: place, parameters and error of each."""
        found: list[dict[str, Any]] = []
        for number in sorted(self._failed):
            found += json.loads(_failure_file(self.path, number).read_text(encoding="utf-8"))["points"]
            if len(found) >= most:
                break
        return found[:most]

    # ------------------------------------------------------------------------------------------------- writing

    def __enter__(self) -> Self:
        try:
            self._lock = lock(self.path / _LOCK)
            for directory in (PARTS, FAILURES):
                (self.path / directory).mkdir(exist_ok=True)
            for part in (self.path / PARTS).iterdir():  # of a process that was killed
                part.unlink()
            self._look()  # now that nobody else writes
        except BlockingIOError:
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
        if self._lock is not None:
            os.close(self._lock)
        self._writers = self._lock = None

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
        key = "/".join(("c", *map(str, plan.place(number))))
        files = {
            self.path / variable.name / key / "/".join("0" * len(variable.shape)): _padded(
                plan, chunk.arrays[variable.name], variable.fill
            )
            for variable in plan.task.variables
        }
        failures = _failure_file(self.path, number)
        if chunk.failures:
            points = [asdict(failure) for failure in chunk.failures]
            files[failures] = json.dumps({"chunk": number, "points": points}, indent=1).encode()
        status = self.path / STATUS.name / key
        try:
            list(self._writers.map(self._write_file, files, files.values()))
            list(self._writers.map(sync_directory, {file.parent for file in files}))
            self._write_file(status, _padded(plan, chunk.arrays[STATUS.name], Status.WAITING))
            sync_directory(status.parent)
            if not chunk.failures:
                failures.unlink(missing_ok=True)
        except OSError as problem:
            raise self._refusal(problem, told=True) from None
        if not self._finished[number]:
            self._finished[number] = True
            self._points += plan.size(number)
        self._failures += len(chunk.failures) - self._failed.pop(number, 0)
        if chunk.failures:
            self._failed[number] = len(chunk.failures)

    def _write_file(self, target: Path, data: bytes) -> None:
        write_whole(target, data, self.path / PARTS)

    def _refusal(self, problem: OSError, told: bool = False) -> InputError:
        reason = problem.strerror or str(problem)
        if not told:
            return InputError(
                OPTION, self.path, f"cannot be read or written ({reason}); mend that or give another directory"
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
        Over the axes of the sweep, read when needed; ``status`` tells which points were computed.

    Raises
    ------
    InputError
        There is no such store.
    """
    import xarray

    if attributes_of(Path(path)) is None:
        raise InputError("store", path, "must be a directory that a sweep was written to")
    return xarray.open_zarr(path, chunks=None, consolidated=True)


# ------------------------------------------------------------------------------------------------------------ chunks


def _finished(directory: Path, plan: SweepPlan) -> np.ndarray:
    """Which chunks are finished, by the names of the files of their status."""
    found = np.zeros(plan.chunk_grid, bool)
    last = len(plan.chunk_grid) - 1

    def look(place: Path, index: tuple[int, ...]) -> None:
        with suppress(FileNotFoundError), os.scandir(place) as entries:
            for entry in entries:
                if not entry.name.isdecimal():
                    continue
                if len(index) == last:
                    found[(*index, int(entry.name))] = True
                else:
                    look(Path(entry.path), (*index, int(entry.name)))

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


def _failed_points(directory: Path, finished: np.ndarray) -> dict[int, int]:
    """Numbers of failed points of the finished chunks that have any."""
    found = {}
    for file in directory.glob("*.json"):
        number = int(file.stem)
        if finished[number]:
            found[number] = len(json.loads(file.read_text(encoding="utf-8"))["points"])
    return found


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
