"""Which compiler kernels go through: carom's where it has been tried, Numba's alone where it has not or where one asks for it."""

import os
import subprocess
import sys
import warnings

import numba
import pytest

from carom.base.outcome import CaromWarning, InputError
from carom.core.compiling import choice

MODULE = """
from carom.core.compiling.decorators import expanded, formula, inlined, kernel, separate

@formula
def squared(x):
    return x * x

@inlined
def halved(x):
    return 0.5 * x

@expanded
def increased(x):
    return x + 1.0

@separate
def combined(x):
    return halved(squared(x))

@kernel
def all_of_them(x):
    return increased(combined(x))
"""
CALL = """
import sys
import kernels_for_test as kernels
print(kernels.all_of_them(3.0), sum(kernels.all_of_them.stats.cache_hits.values()))
print("carom.core.compiling.intermediate" in sys.modules)
"""


@pytest.fixture
def in_another_process(tmp_path):
    """Call a kernel in another process: its result, whether it was in the cache, and whether Numba's internals were used."""
    (tmp_path / "kernels_for_test.py").write_text(MODULE)
    paths = {"PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path]), "CAROM_CACHE_DIR": str(tmp_path / "cache")}

    def run(compiler):
        command = [sys.executable, "-W", "error", "-c", CALL]
        environment = os.environ | paths | {choice.VARIABLE: compiler}
        return subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout.split()

    return run


@pytest.mark.jit_only
def test_both_ways_compile_the_same_kernels_and_keep_them_apart(in_another_process):
    for compiler, ours in (("", "True"), (choice.PLAIN, "False")):
        assert in_another_process(compiler) == ["5.5", "0", ours]
        assert in_another_process(compiler) == ["5.5", "1", ours]


@pytest.fixture
def chosen(monkeypatch):
    """Choose anew, with another version of Numba or another environment; return the choice and the warnings."""

    def choose(version, compiler=""):
        monkeypatch.setattr(numba, "__version__", version)
        monkeypatch.setenv(choice.VARIABLE, compiler)
        with warnings.catch_warnings(record=True) as shown:
            warnings.simplefilter("always")
            return choice.compiles_plainly.__wrapped__(), shown

    return choose


@pytest.mark.parametrize("version", ["0.62.1", "0.68.1", "0.68.0rc1"])
def test_a_version_that_has_been_tried_is_trusted(chosen, version):
    assert chosen(version) == (False, [])


@pytest.mark.parametrize("version", ["0.99.0", "1.0.0", "0.6.2"])
def test_any_other_version_compiles_plainly_with_a_warning(chosen, version):
    plain, (warning,) = chosen(version)
    assert plain
    assert warning.category is CaromWarning
    assert str(warning.message).startswith(f"Numba {version} has not been tried with carom")
    assert "\n" not in str(warning.message)


@pytest.mark.parametrize("version", ["0.68.1", "0.99.0"])
def test_who_asks_for_the_plain_way_gets_it_without_a_warning(chosen, version):
    assert chosen(version, choice.PLAIN) == (True, [])


def test_another_value_is_refused(chosen):
    with pytest.raises(InputError, match=r"^CAROM_COMPILER = fast: plain, or not set$"):
        chosen("0.68.1", "fast")
