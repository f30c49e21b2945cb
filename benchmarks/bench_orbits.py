"""All single-impact orbits of a machine, next to a search on a grid as one would write it by hand."""

from __future__ import annotations

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq
from workload import source_paper_machine

import carom


def orbits_by_grid(parameters, longest=30.0, step=0.02):
    """Periods by sign changes on a grid and ``brentq``, with SciPy's matrix exponential; no proof, no multipliers."""
    matrix = np.array(
        [[0.0, 1.0], [1.0 - parameters.omega**2 - 1j * parameters.gamma, -parameters.gamma - 2j]], complex
    )
    reset = (1.0 + parameters.d) * complex(1.0, parameters.mu)

    def closing(period):
        return 1.0 + (reset * np.linalg.inv(expm(-matrix * period) - np.eye(2))[1, 1]).real

    grid = np.arange(step, longest, step)
    values = [closing(period) for period in grid]
    return [brentq(closing, a, b) for a, b, u, v in zip(grid, grid[1:], values, values[1:], strict=False) if u * v < 0]


def test_orbits_carom(benchmark):
    rotor = source_paper_machine(0.1)
    benchmark.group = "all single-impact orbits, gamma = 0.1"
    benchmark(carom.find_orbits, rotor)
    benchmark.extra_info.update(who="carom", unit="machine", units=1)


def test_orbits_grid(benchmark):
    parameters = source_paper_machine(0.1).parameters
    benchmark.group = "all single-impact orbits, gamma = 0.1"
    benchmark.pedantic(orbits_by_grid, args=(parameters,), rounds=3)
    benchmark.extra_info.update(who="SciPy expm on a grid, periods only", unit="machine", units=1)
