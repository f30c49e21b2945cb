#!/usr/bin/env python3
"""Which question is answered for which machine, and in how many seconds of a processor: a table in Markdown.

    python tools/matrix.py                       # all of it, some eight minutes
    python tools/matrix.py --machine rigid,real --question orbits,study

Every cell is one command in a process of its own.  A cell has the seconds, ``refused`` where it still is, ``—`` where the command says that the question has no meaning
for the machine, ``late`` where it did not end in time, and ``FAILED`` where it failed otherwise.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).parents[1]
MACHINES = {
    **{file.stem: file for file in sorted((ROOT / "tests" / "machines").glob("*.toml"))},
    "four-degrees": ROOT / "src" / "carom" / "cli" / "templates" / "rigid.toml",
    **{name: ROOT / "examples" / f"{name}.toml" for name in ("tum-flexible-rotor", "uberlandia-flexible-rotor")},
}
FLEXIBLE = ("flexible-support", "tum-flexible-rotor", "uberlandia-flexible-rotor")
WITHOUT_MEANING = {("drive", question) for question in ("orbits", "two impacts", "bifurcations", "regions")}
"""A shaft that slows down never repeats itself."""


def questions(machine: str, small: bool = False) -> dict[str, list[str]]:
    """Arguments of the command of each question; small ones for a test."""
    flexible = machine in FLEXIBLE
    highest = 3000 if flexible else 20000 if machine == "four-degrees" else 36000
    speeds = (f"{highest * (0.99 if small else 0.9)} rpm", f"{highest} rpm")
    until, grid, starts = ("10 ms", "2x3", "10") if small else ("50 ms", "6x8", "40")
    few = ["--guesses", "20"] if small else []
    return {
        "kick": ["simulate", "--kick", "60 mm/s", "--until", until],
        "shock": ["simulate", "--shock", "10 g, 5 ms", "--until", until],
        "blade loss": ["simulate", "--blade-loss", f"200 g mm{',0 deg,7' if flexible else ''}", "--until", until],
        "drop": ["drop", "--until", until],
        "drop map": ["drop", "--map", "phase,speed", "--grid", "2x2" if small else "3x3", "--until", "10 ms"],
        "orbits": ["orbits"],
        "two impacts": ["orbits", "--impacts", "2", *few],
        "attractors": ["attractors", "--starts", starts],
        "bifurcations": ["bifurcations", "--along", "speed", "--from", speeds[0], "--to", speeds[1]],
        "regions": ["regions", "--plane", "speed,friction", "--grid", "2" if small else "4"],
        "kicks": ["basins", "--grid", grid],
        "shocks": ["basins", "--shock", f"{5 if small and flexible else 20} g, 5 ms", "--grid", grid],
        "gains": ["basins", "--gains", "2x2" if small else "3x3", "--starts", "5" if small else "20"],
        "response": ["response"],
        "proof": ["prove"],
        "proof of kicks": ["prove", "--kicks-up-to", "30 mm/s", "--time-limit", "2 s" if small else "20 s"],
        "study": ["study", *(["--time-limit", "1 s"] if small else [])],
    }


def answer(machine: str, question: str, limit: float) -> str:
    """One cell."""
    command, *options = questions(machine)[question]
    call = [sys.executable, "-m", "carom", command, str(MACHINES[machine]), *options, "--json"]
    before = time.monotonic()
    process = subprocess.Popen(call, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, cwd="/")
    while True:
        ended, status, used = os.wait4(process.pid, os.WNOHANG)
        if ended:
            break
        if time.monotonic() - before > 4.0 * limit:
            process.kill()
        time.sleep(0.05)
    code = os.waitstatus_to_exitcode(status)
    if code == 0:
        return f"{used.ru_utime + used.ru_stime:.0f}"
    cell = machine, question
    if code == 2 and cell in WITHOUT_MEANING:
        return "—"
    return "late" if code < 0 else "FAILED"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--machine", default=",".join(MACHINES))
    parser.add_argument("--question", default=",".join(questions("rigid")))
    parser.add_argument("--limit", type=float, default=60.0, help="seconds of a processor")
    given = parser.parse_args()
    machines, asked = given.machine.split(","), given.question.split(",")
    print("| machine |", " | ".join(asked), "|")
    print("|---|" + "---|" * len(asked))
    with ThreadPoolExecutor(max(1, (os.cpu_count() or 1) // 2)) as together:
        for machine in machines:
            cells = together.map(lambda question, at=machine: answer(at, question, given.limit), asked)
            print(f"| {machine} |", " | ".join(cells), "|", flush=True)


if __name__ == "__main__":
    main()
