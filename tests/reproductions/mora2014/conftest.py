"""The reproduction, computed once for all tests."""

import pytest

from carom.reproductions import mora2014


@pytest.fixture(scope="session")
def found() -> mora2014.Reproduction:
    return mora2014.reproduce()
