"""The source paper: figure 6b, all its results, and all its figures on disk."""

from __future__ import annotations

import pytest

from carom.reproductions import mora2014
from carom.reproductions.mora2014.plane import damping_stiffness_plane


@pytest.fixture(scope="module")
def found() -> mora2014.Reproduction:
    """All results; the kernels are compiled and the drawing modules loaded afterwards."""
    return mora2014.reproduce()


def test_plane(benchmark, found):
    """From nothing: the branches on which the curves start, the curves, and the motions in each region."""
    benchmark.group = "figure 6b"
    plane = benchmark(lambda: damping_stiffness_plane(mora2014.first_pair()))
    points = sum(len(curve.points) for curve in plane.curves)
    benchmark.extra_info.update(who="carom", unit="point", units=points)


def test_results(benchmark, found):
    """Figures 2 to 6 and all numbers, computed."""
    benchmark.group = "all results of the source paper"
    benchmark(mora2014.reproduce)
    benchmark.extra_info.update(who="carom", unit="paper", units=1)


def test_figures(benchmark, found, tmp_path):
    """Drawn and written, vector and PNG."""
    benchmark.group = "all figures of the source paper, drawn and written"
    benchmark.pedantic(mora2014.write_paper, args=(found, str(tmp_path / "out")), rounds=3, warmup_rounds=1)
    benchmark.extra_info.update(who="carom", unit="paper", units=1)
