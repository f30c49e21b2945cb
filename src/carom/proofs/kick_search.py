"""The search for cells that are proven to return, the largest first, in several processes."""

from __future__ import annotations

import heapq
import signal
import time
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from contextlib import contextmanager
from typing import TypeVar

from carom.base.outcome import CaromError
from carom.base.progress import Reporter
from carom.proofs.balls import at_precision
from carom.proofs.claims import NotShownError
from carom.proofs.families import at_most
from carom.proofs.kick_cells import AHEAD, IMPACTS, LOST, OPEN, REFUTED, Cell, Tree, leaves
from carom.proofs.kick_discs import DiscData, DiscResult, KickDisc, disc_of
from carom.proofs.passages import LeftOpenError

BITS = 64
"""Precision of the balls.  What is left open is so because cells are wide, not because digits are few."""
BATCH = 32
"""Cells that a process tests at a time."""
ALONE = 2.0
"""Seconds after which other processes are asked to help."""
_LAST = 2.0**-50
"""Share of the disc below which a cell is not halved."""
_LOST_COUNTS = 1 / 4
"""How much the area of a cell whose middle does not return counts beside others."""

_Batch = TypeVar("_Batch")
_Result = TypeVar("_Result")


def search(disc: KickDisc, limit: float, workers: int, tell: Reporter) -> Tree:
    """Halve and prove cells of a disc until none is open, or for so many seconds."""
    tree = {disc.whole: AHEAD}
    heap: list[tuple[float, Cell]] = []
    _push(heap, disc.whole, AHEAD)
    proven = refuted = 0.0
    began = time.monotonic()

    def batches() -> Iterator[list[Cell]]:
        while heap and time.monotonic() - began < limit:
            size = min(BATCH, max(1, len(heap) // (2 * workers)))
            yield [heapq.heappop(heap)[1] for _ in range(size)]

    for cells, found in _each(disc, _tried, batches, workers):
        for cell, (letter, by) in zip(cells, found, strict=True):
            tree[cell] = by or letter
            if not by:
                proven += float(cell.share) * (letter in IMPACTS)
                refuted += float(cell.share) * (letter == REFUTED)
            for half in cell.halves(by) if by else ():
                tree[half] = letter
                _push(heap, half, letter)
        words = f"{100 * proven:.4g} % of the area proven, {100 * refuted:.4g} % refuted, {len(heap)} cells open"
        tell(min(1.0, max(proven + refuted, (time.monotonic() - began) / limit)), words)
    return tree


def show_all(disc: KickDisc, tree: Tree, workers: int, tell: Reporter) -> None:
    """Show what is said of all cells that are proven; :class:`~carom.proofs.claims.NotShownError` if it is not so."""
    shown = [(cell, letter) for cell, letter in leaves(tree) if letter in IMPACTS or letter == REFUTED]
    ahead, done = iter([shown[first : first + BATCH] for first in range(0, len(shown), BATCH)]), 0
    # The same batches go on where those asked for before have ended.
    for cells, problem in _each(disc, _shown, lambda: ahead, workers):
        if problem:
            raise NotShownError(problem)
        done += len(cells)
        tell(done / len(shown), f"{done} of {len(shown)} cells verified")


def _push(heap: list[tuple[float, Cell]], cell: Cell, letter: str) -> None:
    if letter in OPEN and cell.share > _LAST:
        heapq.heappush(heap, (-float(cell.share) * (_LOST_COUNTS if letter == LOST else 1.0), cell))


def _tried(data: DiscData, cells: list[Cell]) -> list[DiscResult]:
    with at_precision(BITS):
        return disc_of(data).tried(cells)


def _shown(data: DiscData, cells: list[tuple[Cell, str]]) -> str:
    """What is wrong with some cells; nothing if all is shown."""
    with at_precision(BITS):
        disc = disc_of(data)
        for cell, letter in cells:
            try:
                if letter == REFUTED:
                    disc.refute(cell)
                else:
                    disc.show(cell, IMPACTS.index(letter))
            except LeftOpenError as problem:
                sides = ", ".join("..".join(map(str, ends)) for ends in (cell.speeds, cell.angles, *cell.ends))
                ends = "end in the rub" if letter == REFUTED else f"return with {at_most(IMPACTS.index(letter))}"
                return f"not all {disc.family.about} of the cell {sides} {ends}: {problem}"
    return ""


def _each(
    disc: KickDisc,
    function: Callable[[DiscData, _Batch], _Result],
    batches: Callable[[], Iterator[_Batch]],
    workers: int,
) -> Iterator[tuple[_Batch, _Result]]:
    """Apply a function to batches of cells, as they are asked for: here at first, then in several processes."""
    data, ahead, began = disc.data(), batches(), time.monotonic()
    for batch in ahead:
        yield batch, function(data, batch)
        if workers > 1 and time.monotonic() - began > ALONE:
            break
    else:
        return
    with _processes(workers) as pool:
        waiting: dict[Future[_Result], _Batch] = {}
        while True:
            # Results make further cells: ask anew whenever some have come.
            ahead = batches()
            while len(waiting) < 2 * workers and (more := next(ahead, None)) is not None:
                waiting[pool.submit(function, data, more)] = more
            if not waiting:
                return
            for future in wait(waiting, return_when=FIRST_COMPLETED).done:
                try:
                    result = future.result()
                except BrokenExecutor:
                    raise CaromError("a process that tested cells has ended; try again, with fewer workers") from None
                yield waiting.pop(future), result


@contextmanager
def _processes(workers: int) -> Iterator[Executor]:
    """Processes that another program need not be written for, and that leave Ctrl-C to this one."""
    from loky import ProcessPoolExecutor

    pool = ProcessPoolExecutor(workers, initializer=signal.signal, initargs=(signal.SIGINT, signal.SIG_IGN))
    try:
        yield pool
    finally:
        pool.shutdown(wait=True, kill_workers=True)
