"""The Zarr store of a sweep: one process writes it, each chunk completely or not at all; any process can read it.

Every variable is an uncompressed array over the grid in the Zarr 3 format.  A chunk of it is one file that holds the
bytes of the numbers and their checksum, as Zarr's codec ``crc32c`` writes and checks it.  ``records/<chunk>.json`` has the checksums of
the files of a chunk and its failures.  The file of ``status`` is written last: a chunk counts as finished as soon as
this file exists.  Before a sweep is resumed, finished chunks are compared with their records; a chunk of which a file is
damaged, missing or another's is computed again.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from functools import partial, reduce
from itertools import chain, islice
from pathlib import Path
from typing import TYPE_CHECKING, Self

import numpy as np
from filelock import FileLock, Timeout
from google_crc32c import value as crc32c

from carom.base.arguments import checked
from carom.base.files import sync_directory, write_whole
from carom.base.outcome import InputError
from carom.sweeps.chunk import MOST_FAILURES, Chunk
from carom.sweeps.chunk_record import RECORDS, ChunkRecord, checksum, record_file
from carom.sweeps.layout import OPTION, PARTS, attributes_of, check_same, create, is_new
from carom.sweeps.plan import SweepPlan
from carom.sweeps.variables import STATUS

if TYPE_CHECKING:
    import xarray

_LOCK = ".lock"
_WRITERS = 8
"""Files that are synchronized to the disk at the same time; the system combines these writes."""


class SweepStore:
    """The store of a plan; open it in a ``with`` statement to write.

    Parameters
    ----------
    path : path
        Directory; created if it does not exist.

    Attributes
    ----------
    damaged : list of int
        Finished chunks of which a file is damaged, missing or another's; they are waiting again.

    Raises
    ------
    InputError
        The directory cannot be written, holds something else, belongs to another plan, or is damaged outside its
        chunks.
    """

    def __init__(self, path: str | os.PathLike[str], plan: SweepPlan) -> None:
        self.path, self.plan = Path(path), plan
        self.damaged: list[int] = []
        self._finished, self._sizes = np.zeros(plan.chunks, bool), _sizes(plan)
        self._failed = np.zeros(plan.chunks, int)
        self._digest = plan.digest
        try:
            if is_new(self.path):
                create(self.path, plan)
            check_same(self.path, plan)
            self._scan()
        except OSError as problem:
            raise self._refusal(problem) from None
        self._lock = FileLock(self.path / _LOCK, timeout=0)
        self._writers: ThreadPoolExecutor | None = None

    # ------------------------------------------------------------------------------------------------- reading

    def _scan(self) -> None:
        """Find the finished chunks by their status files, and compare newly found ones with their records."""
        self.damaged = []
        there = _chunks_with_status(self.path / STATUS.name / "c", self.plan)
        for number in np.flatnonzero(there & ~self._finished).tolist():
            found = self._record(number)
            if found is None:
                self.damaged.append(number)
                continue
            self._finished[number] = True
            self._failed[number] = len(found.failures)

    def _record(self, number: int) -> ChunkRecord | None:
        """Return the record of a finished chunk, or None if it or a file of the chunk is damaged, missing or another's."""
        try:
            found = ChunkRecord.read(self.path, self._digest, number)
            sums = {name: checksum(file.read_bytes()) for name, file in self._files(number).items()}
        except FileNotFoundError:
            return None
        return found if found is not None and found.sums == sums else None

    def _files(self, number: int) -> dict[str, Path]:
        """Return the files of a chunk by variable name; that of the status, which is written last, comes last."""
        key = "/".join(("c", *map(str, self.plan.place(number))))
        return {
            variable.name: self.path / variable.name / key / "/".join("0" * len(variable.shape))
            for variable in self.plan.variables
        }

    @property
    def done(self) -> int:
        """Number of points that were computed without failure."""
        return int(self._sizes[self._finished].sum()) - self.failed

    @property
    def failed(self) -> int:
        """Number of points that failed."""
        return int(self._failed.sum())

    def waiting(self, retry_failed: bool = False) -> Iterator[int]:
        """Yield the chunks that are not finished, in order; then those with failures, if they are to be tried again."""
        again = np.flatnonzero(self._failed).tolist() if retry_failed else []
        yield from (*np.flatnonzero(~self._finished).tolist(), *again)

    def failures(self) -> list[dict[str, object]]:
        """Return the first failed points: index in the grid, parameters and error of each."""
        records = (self._record(number) for number in np.flatnonzero(self._failed).tolist())
        return list(islice(chain.from_iterable(each.failures for each in records if each), MOST_FAILURES))

    # ------------------------------------------------------------------------------------------------- writing

    def __enter__(self) -> Self:
        try:
            self._lock.acquire()
            with ExitStack() as stack:
                stack.callback(self._lock.release)
                for directory in (PARTS, RECORDS):
                    (self.path / directory).mkdir(exist_ok=True)
                for part in (self.path / PARTS).iterdir():  # left by a process that was killed
                    part.unlink()
                self._scan()  # again, as no other process can write now
                stack.pop_all()
        except Timeout:
            raise InputError(OPTION, self.path, "another sweep is writing to it; let it end, or stop it") from None
        except OSError as problem:
            raise self._refusal(problem) from None
        self._writers = ThreadPoolExecutor(_WRITERS, thread_name_prefix="carom-store")
        return self

    def __exit__(self, *problem: object) -> None:
        if self._writers is not None:
            self._writers.shutdown()
        self._writers = None
        self._lock.release()

    def write(self, chunk: Chunk) -> None:
        """Write a chunk: its arrays and record, then its status.  On return it is on the disk.

        If it cannot be written, an input error says so; chunks written before are kept.
        """
        if self._writers is None:
            raise RuntimeError("the store is not open for writing")
        plan, number = self.plan, chunk.number
        data = {each.name: _sealed(_padded(plan, chunk.arrays[each.name], each.fill)) for each in plan.variables}
        sums = {name: checksum(content) for name, content in data.items()}
        kept = ChunkRecord(self._digest, number, sums, chunk.failures)
        files = {file: data[name] for name, file in self._files(number).items()}
        status, status_data = files.popitem()
        files[record_file(self.path, number)] = kept.data
        write = partial(write_whole, parts=self.path / PARTS)
        try:
            self._let_wait(number)
            list(self._writers.map(write, files, files.values()))
            list(self._writers.map(sync_directory, {file.parent for file in files}))
            write(status, status_data)
            sync_directory(status.parent)
        except OSError as problem:
            raise self._refusal(problem, shown=True) from None
        self._finished[number] = True
        self._failed[number] = len(kept.failures)

    def _let_wait(self, number: int) -> None:
        """Make a chunk that is computed again wait until all its files are new, so that nobody reads a mixture."""
        list(self._files(number).values())[-1].unlink(missing_ok=True)
        self._finished[number] = False
        self._failed[number] = 0

    def _refusal(self, problem: OSError, shown: bool = False) -> InputError:
        reason = problem.strerror or str(problem)
        if shown:
            kept = f"{np.count_nonzero(self._finished)} of {self.plan.chunks} chunks are stored"
            allowed = f"cannot be written ({reason}); {kept}; fix this, and the same command resumes the sweep"
        else:
            place = f": {problem.filename}" if problem.filename and Path(problem.filename) != self.path else ""
            allowed = f"cannot be read or written ({reason}{place}); fix this or give another directory"
        return InputError(OPTION, self.path, allowed)


@checked
def open_sweep(path: str | os.PathLike[str]) -> xarray.Dataset:
    """Open the store of a sweep, finished or not.

    Returns
    -------
    xarray.Dataset
        Variables over the axes of the sweep; data are read when needed.  ``status`` says which points were computed.
        Zarr refuses to read a damaged file; :func:`run_sweep` compares all files with their records before it goes on.

    Raises
    ------
    InputError
        There is no such store, or it is damaged outside its chunks.

    See Also
    --------
    carom.run_sweep : compute or resume it
    carom.plots.sweep_map : draw it

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> axes = [cm.sweeps.GridAxis.between("damping", "1000 N s/m", "4000 N s/m", 3)]
    >>> plan = cm.sweeps.plan_sweep(machine, axes, cm.sweeps.StudyTask(disturbances=0))
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     done = cm.run_sweep(plan, folder + "/damping.zarr", threads=True)
    ...     print(cm.open_sweep(folder + "/damping.zarr").status.values)
    [1 1 1]
    """
    import xarray

    path = Path(path)
    try:
        attributes_of(path, "store")
        return xarray.open_zarr(path, chunks=None, consolidated=True)
    except OSError as problem:
        raise InputError("store", path, f"cannot be read ({problem.strerror or problem}: {problem.filename})") from None


# ------------------------------------------------------------------------------------------------------------ chunks


def _chunks_with_status(directory: Path, plan: SweepPlan) -> np.ndarray:
    """Return which chunks have a status file, shape (chunks,); only the names of files are read."""
    found = np.zeros(plan.chunk_grid, bool)
    names = [{str(place) for place in range(count)} for count in plan.chunk_grid]
    for file in directory.glob("/".join("*" * len(names))):
        places = file.parts[-len(names) :]
        if all(place in known for place, known in zip(places, names, strict=True)):
            found[tuple(map(int, places))] = True
    return found.ravel()


def _sizes(plan: SweepPlan) -> np.ndarray:
    """Return the number of points of each chunk, shape (chunks,); the last chunks along an axis may be smaller."""
    along = zip(plan.shape, plan.chunk_shape, plan.chunk_grid, strict=True)
    sizes = [np.minimum(chunk, count - chunk * np.arange(chunks)) for count, chunk, chunks in along]
    return reduce(np.multiply.outer, sizes).ravel()


def _sealed(data: bytes) -> bytes:
    """Data with their checksum, as Zarr's codec appends it."""
    return data + crc32c(data).to_bytes(4, "little")


def _padded(plan: SweepPlan, values: np.ndarray, fill: float) -> bytes:
    """Return the bytes of a Zarr chunk; all have the same size, so chunks at the ends of the grid are padded."""
    whole = plan.chunk_shape + values.shape[len(plan.shape) :]
    missing = [(0, most - size) for most, size in zip(whole, values.shape, strict=True)]
    return np.pad(values, missing, constant_values=fill).tobytes()
