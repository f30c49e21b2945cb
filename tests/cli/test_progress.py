"""Commands that take long report shares that grow from the beginning to the end."""

from __future__ import annotations

import importlib
from contextlib import contextmanager

import pytest

from carom.base.progress import Reporter
from carom.cli.app import main

MACHINE = "examples/keogh-cole.toml"
PAPER = "examples/source-paper.toml"
COMMANDS = {
    "simulate": ("simulate", MACHINE, "--kick", "51.576 mm/s,0.2 rad", "--until", "60", "--out", "OUT"),
    "orbits": ("orbits", PAPER, "--impacts", "2", "--guesses", "20"),
    "basins": ("basins", MACHINE, "--grid", "6x6"),
    "bifurcations": ("bifurcations", PAPER, "--along", "gamma", "--from", "0.1", "--to", "0.12"),
    "response": ("response", MACHINE, "--out", "OUT"),
    "prove": ("prove", PAPER),
    "prove along": ("prove", PAPER, "--along", "gamma", "--from", "0.1", "--to", "0.101"),
}

pytestmark = pytest.mark.jit_only


@pytest.mark.parametrize("command", COMMANDS)
def test_shares_grow_to_the_end(command, monkeypatch, tmp_path, capsys):
    words = [str(tmp_path / "out") if word == "OUT" else word for word in COMMANDS[command]]
    _shares_grow(words, monkeypatch, capsys)


def test_shares_of_a_check_grow_to_the_end(monkeypatch, tmp_path, capsys):
    assert main([*COMMANDS["prove"], "--out", str(tmp_path)]) == 0
    _shares_grow(["prove", "--check", str(tmp_path / "proof.json")], monkeypatch, capsys)


def _shares_grow(words, monkeypatch, capsys):
    told = []

    @contextmanager
    def shown(step):
        told.append((0.0, step))
        yield Reporter(lambda report: told.append((report.share, report.step)))

    module = importlib.import_module(f"carom.cli.{words[0]}")
    monkeypatch.setattr(module, "progress", shown)
    assert main(words) == 0
    shares = [share for share, _ in told]
    assert len(set(shares)) >= 3
    assert shares == sorted(shares)
    assert 0.7 <= shares[-1] <= 1.0
    assert all(step for _, step in told)
    assert "%" not in capsys.readouterr().err
