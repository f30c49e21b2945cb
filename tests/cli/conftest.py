"""Running commands in this process."""

from pathlib import Path

import pytest

from carom.cli import main

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture
def machine():
    return str(EXAMPLES / "keogh-cole.toml")


@pytest.fixture
def dimensionless():
    return str(EXAMPLES / "source-paper.toml")


@pytest.fixture
def carom(capsys):
    """Run a command: exit code, standard output, error output."""

    def run(*arguments):
        code = main([str(argument) for argument in arguments])
        out, err = capsys.readouterr()
        return code, out, err

    return run
