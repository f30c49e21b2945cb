"""Where compiled kernels are kept."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import carom.core
from carom.core.compiling import cache_directory as place

fresh = place.cache_directory.__wrapped__
"""The directory as it would be found by another process."""

WHERE = """
import pathlib, sys
if "--nowhere" in sys.argv:
    def refuse(*_, **__):
        raise PermissionError("read-only file system")
    pathlib.Path.mkdir = refuse
from carom.core.compiling.cache_directory import cache_directory
print(cache_directory())
"""


def run(*arguments: str, **environment: str) -> Path:
    """Directory that a process of its own finds."""
    inherited = {
        name: value for name, value in os.environ.items() if name not in ("CAROM_CACHE_DIR", "NUMBA_CACHE_DIR")
    }
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", WHERE, *arguments],
        env=inherited | environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return Path(done.stdout.strip())


@pytest.mark.parametrize("variable", ["CAROM_CACHE_DIR", "NUMBA_CACHE_DIR"])
def test_the_directory_can_be_chosen(tmp_path, variable):
    assert run(**{variable: str(tmp_path)}).parent == tmp_path / "kernels"


def test_there_may_be_none():
    assert run("--nowhere") == Path("None")


def test_a_home_that_cannot_be_written_is_passed_over(tmp_path):
    """A home below a file cannot hold a directory, whoever asks."""
    blocked = tmp_path / "file"
    blocked.touch()
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    home = str(blocked / "home")
    places = {"HOME": home, "XDG_CACHE_HOME": home, "LOCALAPPDATA": home, "TMPDIR": str(temporary)}
    assert run(**places).is_relative_to(temporary)
    assert run(CAROM_CACHE_DIR=str(tmp_path / "chosen"), **places).is_relative_to(tmp_path / "chosen")


@pytest.fixture
def shared(tmp_path, monkeypatch):
    """The cache in a shared directory of temporary files, where the home cannot be written; not made yet."""
    blocked = tmp_path / "file"
    blocked.touch()
    monkeypatch.setattr(place, "user_cache_path", lambda _: blocked / "cache")
    monkeypatch.setattr(place.tempfile, "gettempdir", lambda: str(tmp_path))
    for variable in ("CAROM_CACHE_DIR", "NUMBA_CACHE_DIR"):
        monkeypatch.delenv(variable, raising=False)
    return tmp_path / f"carom-{place._user()}"


posix = pytest.mark.skipif(os.name != "posix", reason="owners and modes of POSIX")


@posix
def test_a_cache_among_temporary_files_is_for_its_owner_alone(shared):
    mask = os.umask(0)
    try:
        directory = fresh()
    finally:
        os.umask(mask)
    assert directory.is_relative_to(shared)
    assert shared.stat().st_mode & 0o777 == 0o700
    assert fresh() == directory


@posix
@pytest.mark.parametrize("mode", [0o777, 0o770, 0o701])
def test_a_cache_that_others_may_enter_is_not_used(shared, mode):
    shared.mkdir()
    shared.chmod(mode)
    assert fresh() is None
    assert list(shared.iterdir()) == []


def test_an_unusable_choice_falls_back(tmp_path):
    blocked = tmp_path / "file"
    blocked.touch()
    directory = run(CAROM_CACHE_DIR=str(blocked), XDG_CACHE_HOME=str(tmp_path / "cache"))
    assert not directory.is_relative_to(blocked)


def test_the_cache_is_keyed_by_the_sources(tmp_path, monkeypatch):
    core = tmp_path / "core"
    compiling = core.joinpath(*Path(place.__file__).parent.relative_to(Path(carom.core.__file__).parent).parts)
    compiling.mkdir(parents=True)
    for name in ("layout.py", "flow.py"):
        (core / name).write_text("x = 1\n")
    monkeypatch.setattr(place, "__file__", str(compiling / "cache_directory.py"))
    monkeypatch.setenv("CAROM_CACHE_DIR", str(tmp_path / "cache"))
    first = fresh()
    assert fresh() == first
    (core / "flow.py").write_text("x = 2\n")
    second = fresh()
    assert second != first
    assert {first.parent, second.parent} == {tmp_path / "cache" / "kernels"}
