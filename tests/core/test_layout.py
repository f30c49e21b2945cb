"""Records that kernels take, and the disk cache they are compiled into."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from compilation import COMPILED
from numba.core import config

from carom.core import layout

compiled = pytest.mark.skipif(not COMPILED, reason="the compiler is off")

SQUARE = """
import pathlib, sys
if "--nowhere" in sys.argv:
    def refuse(*_, **__):
        raise PermissionError("read-only file system")
    pathlib.Path.mkdir = refuse
from carom.core import layout
from carom.core.flow import squared_modulus
assert squared_modulus(3.0 + 4.0j) == 25.0
print(layout._cache_directory())
print(sum(squared_modulus.stats.cache_hits.values()))
"""


def run(script: str, *arguments: str, **environment: str) -> list[str]:
    """Lines that a script prints in a process of its own."""
    inherited = {
        name: value for name, value in os.environ.items() if name not in ("CAROM_CACHE_DIR", "NUMBA_CACHE_DIR")
    }
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", script, *arguments],
        env=inherited | environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


@compiled
def test_kernels_are_compiled_once(tmp_path):
    directory, hits = run(SQUARE, CAROM_CACHE_DIR=str(tmp_path))
    assert Path(directory).parent == tmp_path / "kernels"
    assert hits == "0"
    assert list(Path(directory).rglob("*.nbc"))
    again, hits = run(SQUARE, CAROM_CACHE_DIR=str(tmp_path))
    assert again == directory
    assert hits == "1"


@compiled
def test_the_cache_of_numba_is_used_where_it_is_set(tmp_path):
    directory, _ = run(SQUARE, NUMBA_CACHE_DIR=str(tmp_path))
    assert Path(directory).parent == tmp_path / "kernels"


@compiled
def test_kernels_run_without_any_cache_directory():
    assert run(SQUARE, "--nowhere") == ["None", "0"]


@compiled
def test_kernels_run_where_the_home_cannot_be_written(tmp_path):
    """A home below a file cannot hold a directory, whoever asks."""
    blocked = tmp_path / "file"
    blocked.touch()
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    home = str(blocked / "home")
    places = {"HOME": home, "XDG_CACHE_HOME": home, "LOCALAPPDATA": home, "TMPDIR": str(temporary)}
    directory, _ = run(SQUARE, **places)
    assert Path(directory).is_relative_to(temporary)
    directory, _ = run(SQUARE, CAROM_CACHE_DIR=str(tmp_path / "chosen"), **places)
    assert Path(directory).is_relative_to(tmp_path / "chosen")


@pytest.fixture
def shared(tmp_path, monkeypatch):
    """The cache in a shared directory of temporary files, where the home cannot be written; not made yet."""
    blocked = tmp_path / "file"
    blocked.touch()
    monkeypatch.setattr(layout, "user_cache_path", lambda _: blocked / "cache")
    monkeypatch.setattr(layout.tempfile, "gettempdir", lambda: str(tmp_path))
    monkeypatch.setattr(config, "CACHE_DIR", "")
    monkeypatch.delenv("CAROM_CACHE_DIR", raising=False)
    return tmp_path / f"carom-{layout._user()}"


posix = pytest.mark.skipif(os.name != "posix", reason="owners and modes of POSIX")


@posix
def test_a_cache_among_temporary_files_is_for_its_owner_alone(shared):
    mask = os.umask(0)
    try:
        directory = layout._cache_directory.__wrapped__()
    finally:
        os.umask(mask)
    assert directory.is_relative_to(shared)
    assert shared.stat().st_mode & 0o777 == 0o700
    assert layout._cache_directory.__wrapped__() == directory


@posix
@pytest.mark.parametrize("mode", [0o777, 0o770, 0o701])
def test_a_cache_that_others_may_enter_is_not_used(shared, mode):
    shared.mkdir()
    shared.chmod(mode)
    assert layout._cache_directory.__wrapped__() is None
    assert list(shared.iterdir()) == []


@posix
def test_a_cache_that_others_own_is_not_used(shared, monkeypatch):
    shared.mkdir(mode=0o700)
    monkeypatch.setattr(layout.os, "getuid", lambda: shared.stat().st_uid + 1)
    monkeypatch.setattr(layout, "_user", lambda: shared.name.removeprefix("carom-"))
    assert layout._cache_directory.__wrapped__() is None


@posix
def test_a_link_is_no_cache(shared, tmp_path):
    (tmp_path / "elsewhere").mkdir(mode=0o700)
    shared.symlink_to(tmp_path / "elsewhere")
    assert layout._cache_directory.__wrapped__() is None
    assert list((tmp_path / "elsewhere").iterdir()) == []


@compiled
def test_an_unusable_choice_falls_back(tmp_path):
    blocked = tmp_path / "file"
    blocked.touch()
    directory, _ = run(SQUARE, CAROM_CACHE_DIR=str(blocked), XDG_CACHE_HOME=str(tmp_path / "cache"))
    assert not Path(directory).is_relative_to(blocked)


def test_the_cache_is_keyed_by_the_sources(tmp_path, monkeypatch):
    core = tmp_path / "core"
    core.mkdir()
    for name in ("layout.py", "flow.py"):
        (core / name).write_text("x = 1\n")
    monkeypatch.setattr(layout, "__file__", str(core / "layout.py"))
    monkeypatch.setenv("CAROM_CACHE_DIR", str(tmp_path / "cache"))
    fresh = layout._cache_directory.__wrapped__
    first = fresh()
    assert fresh() == first
    (core / "flow.py").write_text("x = 2\n")
    second = fresh()
    assert second != first
    assert {first.parent, second.parent} == {tmp_path / "cache" / "kernels"}


def test_a_directory_that_cannot_be_written_is_passed_over(tmp_path, monkeypatch):
    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(layout.tempfile, "TemporaryFile", full)
    monkeypatch.setenv("CAROM_CACHE_DIR", str(tmp_path))
    assert layout._cache_directory.__wrapped__() is None


def test_the_setting_of_numba_is_left_as_it_was():
    before = config.CACHE_DIR
    layout.kernel(lambda x: x)
    assert before == config.CACHE_DIR


def test_rotor_record():
    exponents = np.array([-0.5 - 1j, -0.2 + 0.3j, -0.1j])
    rows = np.array([[0.0, 1.0, 2.0], [1j, 0.5, 0.0]])
    arrays = layout.rotor_record(
        exponents=exponents,
        driven=np.array([False, True, False]),
        offsets=np.array([0.1, 0.2j]),
        rows=rows,
        columns=np.ones((3, 2)),
        friction=np.array([0.1, 0.2]),
        restitution=np.array([0.9, 0.8]),
        drive=np.array([50.0, 20.0]),
    )
    matrix = np.array([[exponents[0], 0, 0], [1, exponents[1], 0], [0, 0, exponents[2]]])
    assert np.array_equal(arrays.rate_rows, rows @ matrix)
    assert np.array_equal(arrays.acceleration_rows, rows @ matrix @ matrix)
    assert np.array_equal(arrays.gaps, [0, exponents[1] - exponents[0], 0])
    assert arrays.inverse_gaps[1] == 1.0 / (exponents[1] - exponents[0])
    assert np.array_equal(arrays.weights, [5.0, 1.25])
    assert arrays.columns.shape == (3, 2)


def test_largest_response_bounds_the_response():
    """``|φ(t)|`` of a pair over all later time, for pairs far apart, near and degenerate."""
    times = np.concatenate([np.linspace(0.0, 20.0, 4001), np.geomspace(20.0, 1e4, 400)])
    for lower, upper in ((-1.0, -0.2), (-0.5 - 1j, -0.5 + 1j), (-0.5, -0.5), (-0.5, -0.5 + 1e-9), (-0.3 + 5j, -0.1)):
        exponents = np.array([lower, upper], complex)
        gap = exponents[1] - exponents[0]
        bound = layout._largest_response(exponents, np.array([0.0, gap]))[1]
        lag = times if gap == 0 else -np.expm1(-gap * times) / gap
        response = np.abs(np.exp(exponents[1] * times) * lag)
        assert response.max() <= bound
        assert bound <= 4.0 * response.max()
    assert layout._largest_response(np.array([0.1, 0.2 + 0j]), np.array([0, 0.1 + 0j]))[1] == np.inf


def test_workspaces_hold_what_kernels_write():
    work = layout.workspace(3)
    assert work.products.shape == (15,)
    assert work.polynomial.shape == (layout.DEGREE,)
    rub = layout.rub_workspace(3)
    assert rub.series.shape == (layout.ORDER + 1, 3)
