"""The reproduction, computed once for all tests."""

from __future__ import annotations

import pytest

from carom.reproductions import mora2014


@pytest.fixture(scope="session")
def found() -> mora2014.Reproduction:
    return mora2014.reproduce()
