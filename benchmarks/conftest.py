"""Benchmarks: carom beside its peers in one run, stated as cost per unit of work and as ratios."""

from __future__ import annotations

import sys
from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest

# The peers are those of the tests.
sys.path.append(str(Path(__file__).parent.parent / "tests"))


@pytest.fixture(scope="session")
def starts() -> np.ndarray:
    """The starts of all motions, shape (n, 2) complex."""
    from workload import random_starts

    return random_starts()


@pytest.hookimpl(trylast=True)
def pytest_terminal_summary(terminalreporter, config):
    """Cost per unit of work, and how many times carom's."""
    session = getattr(config, "_benchmarksession", None)
    groups = defaultdict(list)
    for bench in session.benchmarks if session else []:
        info = bench.extra_info
        if "units" in info:
            groups[bench.group].append((bench.stats.median / info["units"], info["who"], info["unit"]))
            # What a program tells of itself, in seconds per unit.
            groups[bench.group] += [(cost, who, info["unit"]) for who, cost in info.get("beside", {}).items()]
    for group, rows in groups.items():
        ours = next((cost for cost, who, _ in rows if who == "carom"), None)
        terminalreporter.section(f"{group}: cost per {rows[0][2]}")
        for cost, who, _ in sorted(rows):
            ratio = f"{cost / ours:12,.2f} x carom" if ours else ""
            terminalreporter.line(f"{who:<44}{1e6 * cost:14,.3f} us{ratio}")
