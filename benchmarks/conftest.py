"""Benchmarks: carom beside its peers in one run, told as cost per unit of work and as ratios."""

from __future__ import annotations

from collections import defaultdict

import numpy as np
import pytest


@pytest.fixture(scope="session")
def starts() -> np.ndarray:
    """10,000 starts, ``|U| < 0.95`` and ``|U̇| < 1.5`` uniform in the disc, shape (n, 2) complex."""
    rng = np.random.default_rng(12345)

    def disc(radius: float) -> np.ndarray:
        return radius * np.sqrt(rng.random(10_000)) * np.exp(2j * np.pi * rng.random(10_000))

    return np.stack([disc(0.95), disc(1.5)], axis=1)


@pytest.hookimpl(trylast=True)
def pytest_terminal_summary(terminalreporter, config):
    """Cost per unit of work, and how many times carom's."""
    session = getattr(config, "_benchmarksession", None)
    groups = defaultdict(list)
    for bench in session.benchmarks if session else []:
        if "units" in bench.extra_info:
            cost = bench.stats.median / bench.extra_info["units"]
            groups[bench.group].append((cost, bench.extra_info["who"], bench.extra_info["unit"]))
    for group, rows in groups.items():
        ours = next((cost for cost, who, _ in rows if who == "carom"), None)
        terminalreporter.section(f"{group}: cost per {rows[0][2]}")
        for cost, who, _ in sorted(rows):
            ratio = f"{cost / ours:12,.2f} x carom" if ours else ""
            terminalreporter.line(f"{who:<44}{1e6 * cost:14,.3f} us{ratio}")
