"""The example machines as cases."""

import pytest

from carom.loading import load


@pytest.fixture
def source_paper():
    return load("examples/source-paper.toml")


@pytest.fixture
def keogh_cole():
    return load("examples/keogh-cole.toml")
