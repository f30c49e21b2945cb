"""Compiled kernels on the disk: damage heals, what cannot be kept is done without, and never a wrong machine code runs."""

import random
import warnings

import numba
import pytest
from compilation import COMPILED, sized
from damage import spoilt
from numba.core import types
from numba.core.registry import cpu_target

from carom.base.outcome import CaromWarning
from carom.core.compiling import cache_directory
from carom.core.compiling.cache import KernelCache

pytestmark = [pytest.mark.jit_only, pytest.mark.skipif(not COMPILED, reason="the compiler is off")]

ONE_NUMBER = (types.float64,)


def cubed(x):
    return x * x * x


def fresh(directory, function=cubed):
    """The kernel as another process would have it."""
    kernel = numba.jit(nopython=True)(function)
    kernel._cache = KernelCache(function, directory)
    return kernel


def hits(kernel):
    return sum(kernel.stats.cache_hits.values())


@pytest.fixture
def kept(tmp_path):
    """File of the compiled kernel."""
    assert fresh(tmp_path)(3.0) == 27.0
    (file,) = tmp_path.iterdir()
    return file


def test_kernels_are_compiled_once(kept):
    again = fresh(kept.parent)
    assert again(3.0) == 27.0
    assert hits(again) == 1
    assert again.stats.cache_path == str(kept.parent)


def test_each_signature_has_a_file_of_its_own(kept):
    assert fresh(kept.parent)(3 + 0j) == 27.0
    assert len(list(kept.parent.iterdir())) == 2
    again = fresh(kept.parent)
    assert (again(3.0), again(3 + 0j), hits(again)) == (27.0, 27.0, 2)


def test_kernels_that_close_over_other_values_are_told_apart(tmp_path):
    def times(factor):
        def product(x):
            return factor * x

        return product

    assert [fresh(tmp_path, times(factor))(3.0) for factor in (2.0, 5.0, 2.0)] == [6.0, 15.0, 6.0]
    assert len(list(tmp_path.iterdir())) == 2


def test_a_damaged_file_is_never_loaded(kept):
    whole, chance = kept.read_bytes(), random.Random(9)
    cache = KernelCache(cubed, kept.parent)
    assert cache.load_overload(ONE_NUMBER, cpu_target.target_context) is not None
    for _ in range(sized(500, 0, 5000)):
        data = spoilt(whole, chance)
        kept.write_bytes(data)
        found = cache.load_overload(ONE_NUMBER, cpu_target.target_context)
        assert (found is None) == (data != whole)
        assert kept.exists() == (data == whole)


@pytest.mark.parametrize("spoil", [lambda data: b"", lambda data: data[:5000], lambda data: data[:-1] + b"x"])
def test_a_damaged_file_heals(kept, spoil):
    whole = kept.read_bytes()
    kept.write_bytes(spoil(whole))
    again = fresh(kept.parent)
    assert (again(3.0), hits(again)) == (27.0, 0)
    healed = fresh(kept.parent)
    assert (healed(3.0), hits(healed)) == (27.0, 1)


def test_a_file_under_the_name_of_another_is_not_taken(kept):
    fresh(kept.parent)(3 + 0j)
    other = next(file for file in kept.parent.iterdir() if file != kept)
    kept.write_bytes(other.read_bytes())  # whole, but not what its name says
    again = fresh(kept.parent)
    assert (again(2.0), hits(again)) == (8.0, 0)


def test_what_stands_in_the_place_of_a_file_does_no_harm(kept, monkeypatch):
    monkeypatch.setattr("carom.core.compiling.cache.warn_once", cache_directory.warn_once.__wrapped__)
    kept.unlink()
    kept.mkdir()
    with pytest.warns(CaromWarning, match="cannot be kept"):
        assert fresh(kept.parent)(3.0) == 27.0


def test_a_disk_that_refuses_is_told_of_and_done_without(tmp_path, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("carom.core.compiling.cache.write_whole", full)
    monkeypatch.setattr("carom.core.compiling.cache.warn_once", cache_directory.warn_once.__wrapped__)
    with pytest.warns(CaromWarning, match=r"make room, or set CAROM_CACHE_DIR to a directory that can be written$"):
        assert fresh(tmp_path)(3.0) == 27.0
    assert not list(tmp_path.iterdir())
    with pytest.warns(CaromWarning, match="cannot be kept"):
        assert fresh(None)(3.0) == 27.0


def test_it_is_told_of_once(tmp_path):
    cache_directory.warn_once.cache_clear()
    with warnings.catch_warnings(record=True) as shown:
        warnings.simplefilter("always")
        assert fresh(None)(3.0) == 27.0
        assert fresh(None)(3 + 0j) == 27.0
    assert len(shown) == 1


# ------------------------------------------------------------------------------------------------------- as a program
