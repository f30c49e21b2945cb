"""Sweep of the constants of the crossing search: degree, number and lengths of its blocks.

    python benchmarks/sweep_blocks.py [degrees] [levels] [machines]

A degree and a number of levels need kernels of their own, so each pair has a process; the processes take turns, a round
after the other, and medians of the processor's time are stated.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from itertools import product
from math import exp, log
from pathlib import Path
from statistics import mean, median

from carom.models import jeffcott

ROUNDS = 9
GAMMAS = (0.1, 0.15)
DEGREES, LENGTHS = (5, 6, 7, 8, 9, 10, 12), (1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0)
DEGREE, LEVELS, LENGTH, PHASE, SHORTENING = 8, 3, 3.0, 5.3, 4.0
ANY = 100.0
MACHINES, STARTS, LEAST_IMPACTS = 150, 400, 10
NEAR_DEGREES, PHASES, LONGEST = (8, 9), (4.4, 5.3, 6.2, 7.0, 8.8), (2.5, 3.0, 3.5, 4.0)


def task(machine, longest=LENGTH, phase=ANY, shortening=SHORTENING):
    return {"machine": machine, "longest": longest, "phase": phase, "shortening": shortening}


# ------------------------------------------------------------------------------------------- the side that is timed


def work_on_tasks(degree: int, levels: int, counting: bool) -> None:
    """Answer tasks on the standard input: nanoseconds, or blocks of each level and safe searches, per impact."""
    from carom.core import layout

    layout.DEGREE, layout.LEVELS = degree, levels
    import numpy as np
    from workload import Bounces, random_starts, source_paper_machine

    from carom.core import table

    sys.path.append(str(Path(__file__).parent.parent / "tests"))
    from machines import random_parameters

    if counting:
        count_blocks(levels)
    starts, ready = random_starts(), {}
    for line in sys.stdin:
        if line not in ready:
            wish = json.loads(line)
            table.LONGEST_BLOCK, table.LARGEST_PHASE = wish["longest"], wish["phase"]
            table.SHORTENING = wish["shortening"]
            if "seed" in wish["machine"]:
                random = np.random.default_rng(wish["machine"]["seed"])
                ready[line] = Bounces(jeffcott(random_parameters(random)), starts[:STARTS])
            else:
                ready[line] = Bounces(source_paper_machine(**wish["machine"]), starts)
            if counting:
                memory, work, rub = ready[line].work
                fields = {name: work[name] for name in work.dtype.names}
                ready[line].work = memory, layout.record(**fields, counts=np.zeros(levels + 1)), rub
            ready[line]()
        run = ready[line]
        if counting:
            run.work[1].counts[:] = 0.0
        begin = time.process_time()
        impacts = run()
        spent = 1e9 * (time.process_time() - begin)
        answer = list(run.work[1].counts) if counting else spent
        print(json.dumps([impacts, answer]), flush=True)


def count_blocks(levels: int) -> None:
    """Make the search write down which blocks it looks at, and how often it goes on by safe steps."""
    from carom.core import events
    from carom.core.compiling.decorators import inlined

    look, step = events.load_polynomial, events._step_safely

    @inlined
    def load_polynomial(table, depth, level, work):
        work.counts[depth] += 1.0
        return look(table, depth, level, work)

    @inlined
    def step_safely(rotor, table, plane, origin, level, start, spread, block, bounds, work):
        work.counts[levels] += 1.0
        return step(rotor, table, plane, origin, level, start, spread, block, bounds, work)

    events.load_polynomial, events._step_safely = load_polynomial, step_safely


# ------------------------------------------------------------------------------------------- the side that tells


class Worker:
    def __init__(self, cache: str, degree: int, levels: int, counting: bool) -> None:
        command = [sys.executable, __file__, "--work", str(degree), str(levels), str(int(counting))]
        # The cache of kernels is keyed by their source, which these constants do not change.
        environment = os.environ | {"CAROM_CACHE_DIR": f"{cache}/{degree}-{levels}-{counting}"}
        self.process = subprocess.Popen(
            command, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def __call__(self, wish):
        self.process.stdin.write(json.dumps(wish) + "\n")
        self.process.stdin.flush()
        return json.loads(self.process.stdout.readline())


class Workers:
    def __init__(self, cache: str) -> None:
        self.cache, self.ready = cache, {}

    def __call__(self, degree, levels, wish, counting=False):
        key = degree, levels, counting
        if key not in self.ready:
            self.ready[key] = Worker(self.cache, *key)
        return self.ready[key](wish)

    def dismiss(self):
        for worker in self.ready.values():
            worker.process.stdin.close()
            worker.process.wait()


def tell(title, ask, rows):
    """Cost and blocks per impact of each row, ``label: (degree, levels, task)``."""
    counts = {label: ask(*row, counting=True) for label, row in rows.items()}
    rounds = [{label: ask(*row)[1] for label, row in rows.items()} for _ in range(ROUNDS)]
    print(f"\n{title}\n{'':<24}{'ns/impact':>10}{'impacts':>10}   blocks of each level, safe searches per impact")
    for label, (impacts, blocks) in counts.items():
        shares = "  ".join(f"{value / impacts:.4f}" for value in blocks)
        cost = median(row[label] for row in rounds) / impacts
        print(f"{label:<24}{cost:10.1f}{impacts:10d}   {shares}", flush=True)


def degrees(ask: Workers) -> None:
    for gamma in GAMMAS:
        rows = {
            f"degree {n}, block {length}": (n, LEVELS, task({"gamma": gamma}, length))
            for n, length in product(DEGREES, LENGTHS)
        }
        tell(f"gamma = {gamma}: degree and longest block", ask, rows)


def levels(ask: Workers) -> None:
    for gamma in GAMMAS:
        rows = {
            f"{count} levels, ratio {ratio}": (DEGREE, count, task({"gamma": gamma}, shortening=ratio))
            for count, ratio in product((1, 2, 3, 4), (2.0, 3.0, 4.0, 6.0))
        }
        tell(f"gamma = {gamma}: number of blocks and ratio of their lengths", ask, rows)


def machines(ask: Workers) -> None:
    """Cost on random machines relative to that of the constants in use: geometric mean, best and worst.

    Machines that bounce on, and those whose starts soon fly free or lie on the wall.
    """
    choices = list(product(NEAR_DEGREES, PHASES, LONGEST))
    ratios = {True: [], False: []}
    for seed in range(MACHINES):
        wishes = {choice: task({"seed": seed}, choice[2], choice[1]) for choice in choices}
        rounds = [{choice: ask(choice[0], LEVELS, wish) for choice, wish in wishes.items()} for _ in range(5)]
        costs = {choice: median(row[choice][1] for row in rounds) for choice in choices}
        bounces_on = rounds[0][choices[0]][0] > LEAST_IMPACTS * STARTS
        ratios[bounces_on].append({choice: costs[choice] / costs[DEGREE, PHASE, LENGTH] for choice in choices})
    print(f"\nrandom machines: cost relative to degree {DEGREE}, phase {PHASE}, block {LENGTH}; mean, best, worst")
    print(f"{'':<36}{len(ratios[True]):>12} that bounce on{len(ratios[False]):>12} others")
    for choice in choices:
        line = f"degree {choice[0]}, phase {choice[1]}, block {choice[2]}".ljust(36)
        for group in ratios.values():
            values = [row[choice] for row in group]
            line += f"   {exp(mean(log(value) for value in values)):8.3f}{min(values):8.3f}{max(values):8.3f}"
        print(line, flush=True)


def main(wanted: list[str]) -> None:
    with tempfile.TemporaryDirectory() as cache:
        ask = Workers(cache)
        for sweep in (degrees, levels, machines):
            if not wanted or sweep.__name__ in wanted:
                sweep(ask)
        ask.dismiss()


if __name__ == "__main__":
    if sys.argv[1:2] == ["--work"]:
        work_on_tasks(int(sys.argv[2]), int(sys.argv[3]), sys.argv[4] == "1")
    else:
        main(sys.argv[1:])
