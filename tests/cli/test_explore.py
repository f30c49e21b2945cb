"""``carom explore`` on the command line; the page itself is tested in ``tests/explorer``."""

import asyncio
import signal
import subprocess
import sys

import pytest

from carom.cli import explore as command

CAROM = [sys.executable, "-m", "carom", "explore"]


def test_without_bokeh_one_line_says_how_to_install_it(carom, monkeypatch):
    monkeypatch.setattr(command, "find_spec", lambda name: None)
    assert carom("explore") == (2, "", "carom: carom explore needs Bokeh: pip install 'carom[explore]'\n")


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["no.toml"], "machine file = no.toml: there is no such file"),
        (["--set", "damping=much"], "damping = much: must be a damping"),
        (["--port", "99999"], "--port = 99999: a whole number from 0 to 65535"),
        (["--port", "high"], "Invalid value for '--port'"),
    ],
)
def test_wrong_input_is_one_line(refused, given, said):
    pytest.importorskip("bokeh", reason="needs the extra carom[explore]")
    refused(f"carom: {said}", "explore", "--no-browser", *given)


def test_the_address_is_the_first_line_and_an_interrupt_ends_it():
    pytest.importorskip("bokeh", reason="needs the extra carom[explore]")
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    with subprocess.Popen([*CAROM, "--no-browser", "--port", "0"], **options) as process:
        assert process.stdout.readline().startswith("http://127.0.0.1:")
        said = process.stdout.readline() + process.stdout.readline()
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=120)
    assert (process.returncode, out, err) == (130, "", "carom: interrupted\n")
    assert " ".join(said.split()) == (
        "balanced-rotor: it must survive kicks up to 100 mm/s, which disturb levitation; angles are measured from the x axis that turns with the "
        "shaft, in the sense of rotation (unbalance at 12°)."
    )


def test_a_refused_port_leaves_no_event_loop_open(carom):
    pytest.importorskip("bokeh", reason="needs the extra carom[explore]")
    assert carom("explore", "--no-browser", "--port", "70000")[0] == 2
    with pytest.raises(RuntimeError, match="no current event loop"):
        asyncio.get_event_loop()
