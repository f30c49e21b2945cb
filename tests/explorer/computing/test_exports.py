"""What is copied from the page leads to the machine on the page."""

import json
import shlex
from pathlib import Path
from types import SimpleNamespace

import pytest
from compilation import sized

import carom
from carom.basins import Basin
from carom.bifurcations import Diagram
from carom.cli import main
from carom.explorer.computing import exports
from carom.explorer.computing.controls import controls_of, with_settings
from carom.explorer.computing.exports import Kick, Origin, as_command, as_options, as_python
from carom.explorer.computing.planes import planes_of
from carom.explorer.computing.rest import rest_of
from carom.models import jeffcott
from carom.motions import Trajectory
from carom.studies import UnbalanceResponse

EXAMPLES = Path(__file__).parents[3] / "examples"
KEOGH, PAPER, RIG = (str(EXAMPLES / name) for name in ("keogh-cole.toml", "source-paper.toml", "tum-test-rig.toml"))


def origin(path=KEOGH, *settings):
    return Origin(path, settings, carom.load(path, settings))


def shown(given, changes):
    return with_settings(given.case, changes)


@pytest.mark.parametrize(
    ("given", "changes"),
    [
        (origin(), {}),
        (origin(), {"damping": "2345", "speed": "1500", "eccentricity": "0.25 mm"}),
        (origin(KEOGH, "gamma=0.1", "mass=40 kg"), {"damping": "2000 N s/m", "friction": "0.2"}),
        (origin(KEOGH, "damping=900 N s/m"), {"damping": "2000"}),
        (origin(PAPER, "d=0.8"), {"gamma": "0.2", "mu": "0.1"}),
        (origin(KEOGH, "omega=0.8"), {"speed": "1500"}),
        (origin(KEOGH, "omega=0.8", "damping_ratio=10 %"), {}),
        (origin(KEOGH, "damping_ratio=10 %"), {"stiffness": "1234567"}),
        (origin(KEOGH, "unbalance=9000 g mm"), {"eccentricity": "0.2 mm"}),
        (origin(RIG), {"speed": "1500", "friction": "0.1"}),
        (origin(RIG), {"eccentricity": "90 g mm", "stiffness": "6000 A/m", "damping": "7 A s/m"}),
        (origin(RIG, "balance_grade=G 16", "force_current_factor=55 N/A"), {"speed": "1500", "damping": "700"}),
    ],
)
def test_options_and_file_lead_to_the_same_machine(given, changes, tmp_path):
    case = shown(given, changes)
    words = shlex.split(as_options(given, changes))
    assert words[::2] == ["--set"] * (len(words) // 2)
    assert carom.load(given.path, words[1::2]).parameters == case.parameters
    path = tmp_path / "machine.toml"
    path.write_text(case.to_toml(), encoding="utf-8")
    again = carom.load(path)
    assert again.machine == case.machine
    assert again.zones == case.zones
    if case.machine is None:
        assert again.parameters == case.parameters


def pictures(monkeypatch):
    """Have pictures written without being drawn; return what is written."""
    written: list[str] = []
    picture = SimpleNamespace(savefig=written.append)
    for result in (Basin, Trajectory, Diagram, UnbalanceResponse):
        monkeypatch.setattr(result, "plot", lambda self: picture)
    return written


@pytest.mark.jit_only
@pytest.mark.parametrize("changes", [{"damping": "2500"}, {"damping": "300"}])
def test_the_program_computes_what_is_shown(changes, capsys, monkeypatch, tmp_path):
    given = origin()
    case = shown(given, changes)
    rotor = jeffcott(case.parameters)
    (along,) = (one for one in controls_of(given.case) if one.name == "damping")
    program = as_python(given, changes, rotor, Kick(planes_of(given.case)[0], rest_of(rotor), 0.3, 0.1, 1.5), along)
    monkeypatch.chdir(tmp_path)
    written, names = pictures(monkeypatch), {}
    exec(program.replace("(120, 120)", str((sized(20, 4),) * 2)), names)
    motion = carom.simulate(rotor, rest_of(rotor).kicked(0.3, 0.1), settle=True)
    assert names["motion"].outcome == motion.outcome
    # The size and the angle of the kick are written with nine digits.
    assert complex(names["motion"].start.velocity) == pytest.approx(complex(motion.start.velocity), abs=1e-8)
    assert names["basin"].rotor.parameters == rotor.parameters
    assert names["diagram"].interval == pytest.approx((280.0, 7000.0))
    assert motion.outcome.meaning in capsys.readouterr().out
    assert written == [
        name
        for name in ("basin.png", "motion.png", "response.png", "diagram.png")
        if name != "basin.png" or rest_of(rotor).levitates
    ]


@pytest.mark.jit_only
@pytest.mark.parametrize(
    ("given", "changes"),
    [
        (origin(), {"damping": "2500"}),
        (origin(), {"damping": "300"}),
        (origin(PAPER), {"gamma": "0.3"}),
        (origin(), {"speed": "1500"}),
    ],
)
def test_the_command_follows_the_kick_that_is_shown(given, changes, capsys):
    rotor = jeffcott(shown(given, changes).parameters)
    kick = Kick(planes_of(given.case)[0], rest_of(rotor), 0.3, 0.1, 1.5)
    words = shlex.split(as_command(given, changes, rotor, kick))
    assert main([*words[1:], "--json"]) == 0
    start = json.loads(capsys.readouterr().out)["start"]
    found = complex(*start["V"])
    # Size and angle are written with nine digits.
    assert found == pytest.approx(complex(kick.state.velocity), abs=1e-8)


def test_paths_and_texts_are_quoted(tmp_path):
    path = tmp_path / 'my "new" machine.toml'
    path.write_text(Path(KEOGH).read_text(encoding="utf-8"), encoding="utf-8")
    given = origin(str(path))
    rotor = jeffcott(given.case.parameters)
    command = as_command(given, {}, rotor, Kick(planes_of(given.case)[0], rest_of(rotor), 0.1, 0.0, 1.0))
    assert shlex.split(command)[2] == str(path)
    assert "'" not in exports.as_options(given, {"friction": "0.2"})
