"""The example machines as cases."""

from pathlib import Path

import pytest

from carom.loading import load

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture
def source_paper():
    return load(EXAMPLES / "source-paper.toml")


@pytest.fixture
def keogh_cole():
    return load(EXAMPLES / "keogh-cole.toml")
