"""``carom prove`` and ``carom prove --check``."""

import json
import subprocess
import sys

import pytest

from carom.cli import main

PAPER, SPINDLE = "examples/source-paper.toml", "examples/spindle.toml"


def test_proof_is_printed_written_and_verified(capsys, tmp_path):
    assert main(["prove", PAPER, "--set", "gamma=0.1", "--out", str(tmp_path / "new")]) == 0
    printed = capsys.readouterr().out
    assert "B1,d" in printed
    assert "0.73323053408263" in printed
    assert printed.startswith("Theorem: The machine has exactly these motions with one impact a period")
    assert "Not proven:" in printed

    assert main(["prove", "--check", str(tmp_path / "new" / "proof.json")]) == 0
    assert "Verified from the certificate alone" in capsys.readouterr().out


def test_json_is_the_certificate(capsys, tmp_path):
    assert main(["prove", PAPER, "--json"]) == 0
    (tmp_path / "proof.json").write_text(capsys.readouterr().out)
    assert main(["prove", "--check", str(tmp_path / "proof.json"), "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == json.loads((tmp_path / "proof.json").read_text())


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([], "give a machine file"),
        ([PAPER, "--along", "gamma", "--from", "[0.1, 0.2]", "--to", "0.3"], "must be one number"),
        ([PAPER, "--check", "proof.json"], "must be given alone"),
        ([PAPER, "--most-impacts", "3"], "cannot be combined"),
        ([PAPER, "--kicks-up-to", "0.2", "--most-impacts", "36"], "most_impacts"),
        ([PAPER, "--kicks-up-to", "0.2", "--time-limit", "soon"], "time_limit"),
        ([SPINDLE, "--kicks-up-to", "1 mm/s", "--shocks-up-to", "5 g, 1 ms"], "cannot be combined"),
        (["--check", "absent.json"], "cannot be read"),
        ([PAPER, "--set", "stiffness=1"], "unknown name in the settings; did you mean omega?"),
        (["examples/keogh-cole.toml", "--set", "gamma=1", "--set", "damping=2 N s/m"], "sets damping"),
    ],
)
def test_bad_input_is_one_line(refused, arguments, words):
    refused(words, "prove", *arguments)


def test_kicks_are_proven_and_verified(capsys, tmp_path):
    command = ["prove", SPINDLE, "--kicks-up-to", "105 mm/s", "--most-impacts", "1", "--out", str(tmp_path)]
    assert main([*command, "--time-limit", "1 ms"]) == 0
    assert "undecided" in capsys.readouterr().out
    assert main(command) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert printed.startswith("Theorem: ")
    assert "proven share 100 %," in printed
    assert "undecided" not in printed

    assert main(["prove", "--check", str(tmp_path / "proof.json"), "--json"]) == 0
    recover, _ = json.loads(capsys.readouterr().out)["claims"]
    assert (recover["about"], recover["kind"], recover["status"]) == ("kicks", "recover", "proven")
    assert recover["enclosures"]["speed_si"] == ["0.105", "0.105"]


def test_without_flint_one_line_names_the_extra():
    code = "import sys; sys.modules['flint'] = None; from carom.cli import main; sys.exit(main(['prove', 'examples/source-paper.toml']))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)

    assert done.returncode == 2
    assert done.stderr == 'carom: proofs need python-flint; install it with: pip install "carom[proof]"\n'


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--along", "damping", "--from", "300 N s/m"], "needs --from and --to"),
        (["--along", "damping", "--from", "300", "--to", "400 N s/m"], "has no unit"),
        (["--along", "mu", "--from", "0.1", "--to", "0.2"] * 2, "must name each parameter once"),
    ],
)
def test_bad_boxes_are_one_line(refused, arguments, words):
    refused(words, "prove", SPINDLE, "--kicks-up-to", "111 mm/s", *arguments)


def test_time_that_is_up_leaves_the_rest_of_an_interval_open(capsys):
    assert (
        main(["prove", PAPER, "--along", "gamma", "--from", "0.09", "--to", "0.12", "--time-limit", "1e-3", "--json"])
        == 0
    )
    claims = {f"{claim['about']} {claim['kind']}": claim for claim in json.loads(capsys.readouterr().out)["claims"]}
    assert "the search ended before" in claims["machine all-single-impact-orbits"]["reason"]
    assert claims["kick harmless"]["status"] == "proven"
