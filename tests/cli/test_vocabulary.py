"""One name for each motion: what the commands print, draw and write as JSON keeps to docs/reference/motions.md."""

import re
from pathlib import Path

import pytest

from carom.attractors import MotionName
from carom.base.outcome import Outcome
from carom.cli.app import main
from carom.orbits.names import OrbitName
from carom.plots import OUTCOMES
from carom.studies.wording import ending_words

MACHINE = "examples/keogh-cole.toml"
PAGE = Path("docs/reference/motions.md").read_text(encoding="utf-8")
FORBIDDEN = re.findall(r'"([^"]+)"', PAGE[PAGE.index("Not written for people") :])
NAMES = re.findall(r"^\| ([^|`]+?) \|", PAGE, re.MULTILINE)[1:]
COMMANDS = {
    "study": ("study", MACHINE, "--long"),
    "orbits": ("orbits", MACHINE),
    "simulate": ("simulate", MACHINE, "--kick", "51.576 mm/s,0.2 rad", "--until", "100"),
    "basins": ("basins", MACHINE, "--grid", "14x14"),
    "bifurcations": ("bifurcations", MACHINE, "--along", "speed", "--from", "1500 rpm", "--to", "2000 rpm"),
    "attractors": ("attractors", MACHINE, "--starts", "4"),
    "response": ("response", MACHINE),
    "prove": ("prove", "examples/source-paper.toml"),
    "regions": ("regions", MACHINE, "--plane", "gamma,omega", "--x", "0.1,0.2", "--y", "0.7,0.8", "--grid", "6"),
}

pytestmark = pytest.mark.jit_only


def is_a_name(text):
    plain = re.sub(r"\d+-impact", "3-impact", text)
    return plain in NAMES or re.fullmatch(r"[BR]\d+,[a-d]", text) or text.startswith("unresolved: ")


def test_the_page_lists_what_names_can_be():
    assert len(FORBIDDEN) == 10
    orbit = OrbitName(1, True, True)
    made = [
        *(MotionName(outcome) for outcome in Outcome if outcome.settled),
        MotionName(Outcome.FORWARD_RUB, drifting=True),
        MotionName(Outcome.BOUNCING, 3),
        MotionName(Outcome.MIXED, 3),
        MotionName(Outcome.BOUNCING, 1, orbit=orbit),
    ]
    assert all(is_a_name(name) for name in made)
    assert {re.sub(r"B1,d", "B1,d and the like", str(name)) for name in made} == set(NAMES)


@pytest.mark.parametrize("command", COMMANDS)
def test_texts_of_commands_use_these_names_and_80_columns(command, capsys, monkeypatch):
    monkeypatch.delenv("COLUMNS", raising=False)
    assert main(COMMANDS[command]) == 0
    out = capsys.readouterr().out
    assert max(map(len, out.splitlines())) <= 80
    text = re.sub(r"\s+", " ", out)
    assert not [words for words in FORBIDDEN if words in text]
    assert "rad/s" not in text
    if command in ("study", "basins"):
        for name in ("levitation", "synchronous rub", "regular bouncing"):
            assert name in text
    if command == "study":
        assert "1,759 rpm" in text


@pytest.mark.parametrize("outcome", Outcome)
def test_each_outcome_has_one_name_on_every_surface(outcome):
    """Text, legend, end of a path and sentence take the words of the outcome; only rubs and periods are stated further apart."""
    assert outcome.label not in OUTCOMES or OUTCOMES[outcome.label].words == outcome.words
    assert outcome.words in ending_words(outcome)
    name = MotionName(outcome)
    if not outcome.settled:
        assert name == f"unresolved: {outcome.label}"
        assert name.words == outcome.words
        begins = "it goes" if outcome is Outcome.BEYOND_MODEL else "its end was not found"
        assert ending_words(outcome).startswith(begins)
        return
    assert outcome.label in OUTCOMES
    assert name.endswith("rub" if outcome is Outcome.FORWARD_RUB else outcome.words)
    assert outcome.words.split()[0] in outcome.meaning
    assert not [words for words in FORBIDDEN if words in outcome.meaning]
    if outcome is Outcome.FORWARD_RUB:
        assert f"a *{outcome.words}*" in PAGE
    else:
        assert outcome.words in " ".join(NAMES) or outcome.words == "bouncing"
