"""What all tests share."""

import os
import signal

# A shell's background jobs ignore interruptions, and so would the processes that are interrupted here.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# The matrices of this package are tiny: the threads of linear algebra only wait for each other, and long on a busy machine.
for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")

# Tests run in terminals too, and compare what is written there.
os.environ.setdefault("CAROM_PROGRESS", "0")

import pkgutil  # noqa: E402
from pathlib import Path  # noqa: E402

import pytest  # noqa: E402
from browsing import BROWSER, MUST, NAMES, OPTIONS  # noqa: E402
from compilation import COMPILED, DEEP, compile_kernels, sized  # noqa: E402
from hypothesis import settings  # noqa: E402
from machines import PAPER  # noqa: E402

import carom.core  # noqa: E402

# Kernels compile on their first call, and a busy machine is slow: no test fails for the time it takes.
settings.register_profile("carom", deadline=None)
settings.load_profile("carom")


def pytest_configure(config):
    """Let kernels that run uncompiled divide by zero as compiled ones do: to infinity or no number, without a word."""
    if not COMPILED:
        for module in pkgutil.iter_modules(carom.core.__path__):
            config.addinivalue_line("filterwarnings", f"ignore::RuntimeWarning:carom.core.{module.name}")


@pytest.hookimpl(tryfirst=True)
def pytest_sessionstart(session):
    """Compile kernels before the workers of a parallel run start: else each of them would compile the same."""
    if session.config.getoption("numprocesses", None) and not hasattr(session.config, "workerinput"):
        compile_kernels()


@pytest.fixture(scope="module")
def browser():
    """Chromium without a window, closed after each file: while it runs, its loop of events is that of the process."""
    from playwright.sync_api import sync_playwright

    if BROWSER is None:
        (pytest.fail if MUST else pytest.skip)(f"none of {', '.join(NAMES)} is on the PATH")
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=BROWSER, args=list(OPTIONS))
        yield started
        started.close()


@pytest.fixture(scope="session")
def corner():
    """Map of a part of the source paper's plane: most of its curves pass no line through the machine."""
    plane = carom.bifurcations.Plane("gamma", "omega", (0.025, 0.1), (0.19, 0.765))
    return carom.map_regions(PAPER, plane, grid=sized(8, 6))


SLOWEST = (
    "studies/test_assembly.py",
    "sweeps/test_running.py",
    "explorer/test_browser.py",
    "explorer/test_stage.py",
    "cli/test_basins.py",
    "disturbances/test_blade_loss.py",
)
"""Files that take longest: if one began last, a worker would have nothing to do until it ends."""


def pytest_collection_modifyitems(config, items):
    """Put the slowest files first, and leave out the deep tests unless they are asked for."""
    slowest = [Path(__file__).parent / name for name in SLOWEST]
    items.sort(key=lambda item: slowest.index(item.path) if item.path in slowest else len(slowest))
    if not DEEP:
        left_out = {item for item in items if item.get_closest_marker("deep")}
        config.hook.pytest_deselected(items=[item for item in items if item in left_out])
        items[:] = [item for item in items if item not in left_out]
