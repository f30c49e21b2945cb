"""The search for cells that are proven to return, the largest first, in several processes."""

from __future__ import annotations

import heapq
import signal
import time
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Future, wait
from contextlib import contextmanager
from typing import Any, TypeVar

from carom.outcome import CaromError
from carom.progress import Reporter
from carom.proofs.balls import at_precision
from carom.proofs.evidence import NotShownError
from carom.proofs.kick_cells import AHEAD, IMPACTS, LOST, OPEN, REFUTED, Cell, Tree, leaves, share_of
from carom.proofs.kick_discs import Disc, DiscData, Found, disc_of
from carom.proofs.passages import LeftOpenError

BITS = 64
"""Precision of the balls.  What is left open is so because cells are wide, not because digits are few."""
BATCH = 32
"""Cells that a process tests at a time."""
ALONE = 2.0
"""Seconds after which other processes are asked to help."""
PAUSE = 15.0
"""Seconds between two records of the search."""
_LAST = 2.0**-50
"""Share of the disc below which a cell is not halved."""
_LOST_COUNTS = 1 / 4
"""How much the area of a cell whose middle does not return counts beside others."""

_Result = TypeVar("_Result")
_Listed = TypeVar("_Listed")


def search(
    disc: Disc, tree: Tree, limit: float, workers: int, tell: Reporter, record: Callable[[Tree], None] | None = None
) -> None:
    """Halve and prove cells of a tree until none is open, or for so many seconds.

    What the tree says to be closed is shown again first, which the seconds leave out.  ``record`` receives the tree from time to time, also when
    the search is interrupted.
    """
    tell = _follow_again(disc, tree, workers, tell)
    heap: list[tuple[float, Cell]] = []
    for cell, letter in leaves(tree):
        _push(heap, cell, letter)
    known = {kind: share_of(cell for cell, letter in leaves(tree) if kind(letter)) for kind in (_returns, _ends)}
    began = recorded = time.monotonic()

    def batches() -> Iterator[list[Cell]]:
        while heap and time.monotonic() - began < limit:
            size = min(BATCH, max(1, len(heap) // (2 * workers)))
            yield [heapq.heappop(heap)[1] for _ in range(size)]

    try:
        for cells, found in _each(disc, _tried, batches, workers):
            for cell, (letter, by) in zip(cells, found, strict=True):
                tree[cell] = by or letter
                for kind in known:
                    known[kind] += cell.share if not by and kind(letter) else 0
                for half in cell.halves(by) if by else ():
                    tree[half] = letter
                    _push(heap, half, letter)
            now = time.monotonic()
            proven, refuted = (float(share) for share in known.values())
            words = f"{100 * proven:.4g} % of the area proven, {100 * refuted:.4g} % refuted, {len(heap)} cells open"
            tell(max(proven + refuted, min(1.0, (now - began) / limit)), words)
            if record is not None and now - recorded > PAUSE:
                record(tree)
                recorded = now
    finally:
        if record is not None:
            record(tree)


def _follow_again(disc: Disc, tree: Tree, workers: int, tell: Reporter) -> Reporter:
    """Follow again what a tree says to be closed, and open what is not; return who is told of the rest."""
    told = [cell for cell, letter in leaves(tree) if _is_closed(letter)]
    again, rest = tell.part(0.0, 0.5 if told else 0.0), tell.part(0.5 if told else 0.0, 1.0)
    done = 0
    for cells, found in _each(disc, _tried, _batches_of(told), workers):
        tree.update({cell: AHEAD if by else letter for cell, (letter, by) in zip(cells, found, strict=True)})
        done += len(cells)
        again(done / len(told), f"{done} of {len(told)} cells followed again")
    return rest


def _is_closed(letter: str) -> bool:
    return _returns(letter) or _ends(letter)


def _batches_of(listed: list[_Listed]) -> Callable[[], Iterator[list[_Listed]]]:
    """Batches of a list, which go on where those asked for before have ended."""
    ahead = iter([listed[first : first + BATCH] for first in range(0, len(listed), BATCH)])
    return lambda: ahead


def show_all(disc: Disc, tree: Tree, workers: int, tell: Reporter) -> None:
    """Show what is said of all cells that are proven; :class:`~carom.proofs.evidence.NotShownError` if it is not so."""
    told = [(cell, letter) for cell, letter in leaves(tree) if _is_closed(letter)]
    done = 0
    for cells, problem in _each(disc, _shown, _batches_of(told), workers):
        if problem:
            raise NotShownError(problem)
        done += len(cells)
        tell(done / len(told), f"{done} of {len(told)} cells verified")


def _returns(letter: str) -> bool:
    return letter in IMPACTS


def _ends(letter: str) -> bool:
    return letter == REFUTED


def _push(heap: list[tuple[float, Cell]], cell: Cell, letter: str) -> None:
    if letter in OPEN and cell.share > _LAST:
        heapq.heappush(heap, (-float(cell.share) * (_LOST_COUNTS if letter == LOST else 1.0), cell))


def _tried(data: DiscData, cells: list[Cell]) -> list[Found]:
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
                ends = "end in the rub" if letter == REFUTED else f"return with at most {IMPACTS.index(letter)} impacts"
                return f"not all {disc.family.about} of the cell {sides} {ends}: {problem}"
    return ""


def _each(
    disc: Disc,
    function: Callable[[Any, Any], _Result],
    batches: Callable[[], Iterator[Any]],
    workers: int,
) -> Iterator[tuple[Any, _Result]]:
    """Apply a function to batches of cells, as they are asked for: here at first, then in several processes."""
    data, ahead, began = disc.data(), batches(), time.monotonic()
    for batch in ahead:
        yield batch, function(data, batch)
        if workers > 1 and time.monotonic() - began > ALONE:
            break
    else:
        return
    with _processes(workers) as pool:
        waiting: dict[Future[_Result], Any] = {}
        while True:
            # Results make further cells: ask anew whenever some have come.
            ahead = batches()
            while len(waiting) < 2 * workers and (batch := next(ahead, None)) is not None:
                waiting[pool.submit(function, data, batch)] = batch
            if not waiting:
                return
            for future in wait(waiting, return_when=FIRST_COMPLETED).done:
                try:
                    result = future.result()
                except BrokenExecutor:
                    raise CaromError("a process that tested cells has ended; try again, with fewer workers") from None
                yield waiting.pop(future), result


@contextmanager
def _processes(workers: int) -> Iterator[Any]:
    """Processes that another program need not be written for, and that leave Ctrl-C to this one."""
    from loky import ProcessPoolExecutor

    pool = ProcessPoolExecutor(workers, initializer=signal.signal, initargs=(signal.SIGINT, signal.SIG_IGN))
    try:
        yield pool
    finally:
        pool.shutdown(wait=True, kill_workers=True)
