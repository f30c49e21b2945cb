"""Kernels that other kernels call are not compiled to machine code for that."""

import os
import subprocess
import sys

import numpy as np
import pytest

from carom.core.compiling.cache import KernelCache
from carom.core.compiling.decorators import inlined, kernel
from carom.core.records import record

pytestmark = pytest.mark.jit_only


@pytest.fixture
def caller_and_called(tmp_path):
    """A kernel that calls a kernel and a part, each with a cache in the directory of the test."""

    @kernel
    def doubled(x):
        return 2.0 * x

    @inlined
    def squared(x):
        return x * x

    @kernel
    def both(x):
        return doubled(x) + squared(x)

    for function in (doubled, squared, both):
        function._cache = KernelCache(function.py_func, tmp_path)
    return both, [doubled, squared]


def test_only_what_python_calls_becomes_machine_code(caller_and_called, tmp_path):
    both, called = caller_and_called

    assert both(3.0) == 15.0
    assert [function.signatures for function in called] == [[], []]
    assert len(list(tmp_path.iterdir())) == 1


def test_what_kernels_call_can_still_be_called_from_python(caller_and_called):
    both, (doubled, squared) = caller_and_called
    assert both(3.0) == 15.0

    assert (doubled(3.0), squared(3.0)) == (6.0, 9.0)
    assert (doubled(3), squared(2j)) == (6.0, -4.0)


def test_what_python_has_called_can_still_be_called_by_kernels(caller_and_called):
    both, (doubled, squared) = caller_and_called
    assert (doubled(3.0), squared(3.0)) == (6.0, 9.0)

    assert both(3.0) == 15.0


def test_a_kernel_is_linked_although_its_first_caller_never_calls_it(tmp_path):
    """The first caller's call is removed as dead code, the second one's is not."""

    @kernel
    def root(x):
        total = x
        for _ in range(10):
            total = 0.5 * (total + x / total)
        return total

    @kernel
    def first(values):
        return root(values[0]) if values.shape[0] > 1 else values[0]

    @kernel
    def outer(record):
        return first(record.values)

    @kernel
    def second(values):
        return root(values[0])

    @kernel
    def both(record):
        return outer(record) + second(record.values)

    for function in (root, first, outer, second, both):
        function._cache = KernelCache(function.py_func, tmp_path)
    assert both(record(values=np.array([4.0]))) == 6.0


MODULE = """
import numpy as np
from carom.core.compiling.decorators import kernel, separate
from carom.core.records import record

@separate
def length(values):
    return np.sqrt((values.numbers**2).sum())

@kernel
def twice(values):
    return 2.0 * length(values)

@kernel
def thrice(values):
    return 3.0 * length(values)
"""
CALLS = """
import sys
import kernels_for_test as kernels
for size in range(1, int(sys.argv[2]) + 1):  # others first: what Numba counts is then different
    kernels.length(kernels.record(numbers=kernels.np.zeros(size), other=kernels.np.zeros(size)))
values = kernels.record(numbers=kernels.np.array([3.0, 4.0]))
for name in sys.argv[1].split():
    print(getattr(kernels, name)(values), end=" ")
for name in ("length", "twice", "thrice"):
    print(sum(getattr(kernels, name).stats.cache_misses.values()), end=" ")
"""


@pytest.fixture
def in_another_process(tmp_path):
    """Call kernels of one module in another process; return what it prints: results, and how many of each were compiled."""
    (tmp_path / "kernels_for_test.py").write_text(MODULE)
    paths = {"PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path]), "CAROM_CACHE_DIR": str(tmp_path / "cache")}

    def run(names, others=0):
        command = [sys.executable, "-c", CALLS, names, str(others)]
        done = subprocess.run(command, env=os.environ | paths, capture_output=True, text=True, check=True)
        return done.stdout.split()

    return run


def test_machine_code_that_kernels_share_is_compiled_once_and_found_by_its_name_in_every_process(
    in_another_process, tmp_path
):
    assert in_another_process("twice length") == ["10.0", "5.0", "1", "1", "0"]
    assert in_another_process("thrice twice", others=2) == ["15.0", "10.0", "2", "0", "1"]
    assert in_another_process("twice thrice length") == ["10.0", "15.0", "5.0", "0", "0", "0"]
    for file in tmp_path.glob("cache/**/*.length.*"):
        file.unlink()
    assert in_another_process("twice thrice", others=3) == ["10.0", "15.0", "4", "0", "0"]
    assert len(list(tmp_path.glob("cache/**/*.length.*"))) == 4


TWO = """
import numpy as np
from carom.core.compiling.decorators import kernel
from carom.core.records import record

@kernel
def longest(values, n):
    total = 0.0
    for i in range(n):
        total += np.exp(-total * total) + np.tanh(total) + np.arctan(total + n)
        total -= np.log(1.0 + total * total) * np.tan(total / 100.0)
        for k in range(values.numbers.shape[0]):
            total += values.numbers[k] ** 3 + np.cos(total)
    return total

@kernel
def longer(values, n):
    total = 0.0
    for i in range(n):
        total += np.sqrt(values.numbers[0]) * np.sin(total) + np.exp(-total * total) + np.tanh(total) + np.arctan(total + n)
        total -= np.log(1.0 + total * total) * np.tan(total / 100.0)
        for k in range(values.numbers.shape[0]):
            total += values.numbers[k] ** 3 + np.cos(total)
    if n > 5:
        total += longest(values, n - 6)
    return total

@kernel
def both(values, n):
    return longer(values, n) + 2.0 * longer(values, n + 1) + 3.0 * longer(values, n + 2) * longer(values, n + 9)
"""
ONE_AFTER_ANOTHER = """
import sys
import two_for_test as kernels
for size in sys.argv[1:]:
    print(kernels.both(kernels.record(numbers=kernels.np.ones(int(size))), 3), sum(kernels.both.stats.cache_hits.values()))
"""


@pytest.mark.parametrize("compiler", ["", "plain"])
def test_code_from_several_processes_is_told_apart(tmp_path, compiler):
    """Each process counts types and functions from one, and the disk gives the code of both to a third."""
    (tmp_path / "two_for_test.py").write_text(TWO)
    more = {
        "PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path]),
        "CAROM_CACHE_DIR": str(tmp_path / "cache"),
        "CAROM_COMPILER": compiler,
        "PYTHONHASHSEED": "0",  # of which the order of Numba's flags depends, and with it the names
    }

    def results(*sizes):
        command = [sys.executable, "-c", ONE_AFTER_ANOTHER, *sizes]
        done = subprocess.run(command, env=os.environ | more, capture_output=True, text=True, check=True)
        return [line.split() for line in done.stdout.splitlines()]

    ((of_two, _),), ((of_three, _),) = results("2"), results("3")
    assert of_two != of_three
    assert results("2", "3") == [[of_two, "1"], [of_three, "2"]]
    assert results("3", "2") == [[of_three, "1"], [of_two, "2"]]
