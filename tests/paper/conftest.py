"""The reproduction, computed once for all tests."""

from __future__ import annotations

import pytest

from carom import paper


@pytest.fixture(scope="session")
def found() -> paper.Reproduction:
    return paper.reproduce()
