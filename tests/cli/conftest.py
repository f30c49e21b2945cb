"""Running commands in this process."""

import sys
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


@pytest.fixture(autouse=True)
def output_is_wide(monkeypatch):
    """Let sentences and names of tables stay on one line; tests of the width set another one."""
    monkeypatch.setenv("COLUMNS", "140")


@pytest.fixture(autouse=True)
def studies_are_made_once(monkeypatch):
    """Let commands that study the same machine share the study."""
    from studies import study_once

    # As an attribute of the package the name is the function, not the module.
    package = sys.modules["carom.studies"]
    real = package.study

    def study(subject, *, along, proofs, progress):
        if along or proofs:
            return real(subject, along=along, proofs=proofs, progress=progress)
        return study_once(subject)

    monkeypatch.setattr(package, "study", study)


@pytest.fixture
def carom(capsys):
    """Run a command: exit code, standard output, error output."""

    def run(*arguments):
        code = main([str(argument) for argument in arguments])
        out, err = capsys.readouterr()
        return code, out, err

    return run


@pytest.fixture
def refused(carom):
    """Run a command that ends with one line of error, which has these words in it."""

    def run(words, *arguments):
        code, out, err = carom(*arguments)
        assert (code, out, err.count("\n")) == (2, "", 1)
        assert err.startswith("carom: ")
        assert words in err

    return run
