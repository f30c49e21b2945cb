"""The example machines as cases."""

from pathlib import Path

import pytest

from carom.parameters import load_case

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture
def source_paper():
    return load_case(EXAMPLES / "source-paper.toml")


@pytest.fixture
def keogh_cole():
    return load_case(EXAMPLES / "keogh-cole.toml")
