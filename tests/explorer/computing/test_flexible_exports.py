"""A flexible machine as options, as a command and as a program."""

from __future__ import annotations

import shlex

from flexible_pages import MACHINE, opened

import carom
from carom.explorer.computing.flexible_controls import controls_of_machine
from carom.explorer.computing.flexible_exports import as_program, as_set, as_simulate, settings_of

CONTROLS = {each.name: each for each in controls_of_machine(carom.rotors.load_machine(MACHINE))}


def test_settings_lead_from_the_file_to_the_machine_shown():
    changes = {"proportional": "6000", "proportional_2": "5.5 A/mm", "unbalance": "30"}
    found = settings_of(opened("speed=2000 rpm", "unbalance=10 g mm"), CONTROLS, changes)
    assert found == ("speed=2000 rpm", "proportional=6000 A/m", "proportional_2=5.5 A/mm", "unbalance=30 g mm")
    machine = carom.rotors.load_machine(MACHINE, found)
    assert [each.controller.proportional for each in machine.bearings] == [6000.0, 5500.0]
    assert machine.value("unbalance") == 30e-6
    assert shlex.split(as_set(found))[1::2] == list(found)


def test_the_command_follows_the_kick():
    words = shlex.split(as_simulate(opened(), ("speed=2000 rpm",), -3.0, 4.0, "mm/s"))
    assert words[:5] == ["carom", "simulate", MACHINE, "--set", "speed=2000 rpm"]
    assert words[5:] == ["--kick", "5 mm/s,126.869898 deg"]


def test_the_program_can_be_run(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    program = as_program(opened(), ("gravity=0",), 10.0, 0.0, "mm/s", 20.0)
    short = program.replace("(12, 24)", "(2, 2)")
    assert short != program
    exec(compile(short, "program", "exec"), {})
    said = capsys.readouterr().out
    assert "damping ratio" in said
    assert "touchdown bearing 2: 0 contacts, 0 N" in said
    assert (tmp_path / "basin.png").exists()
