"""``carom drop``: loads of a drop for people, as JSON, and with figures and a page."""

import json
from pathlib import Path

import pytest

import carom as cm

pytestmark = pytest.mark.jit_only

MACHINE = "examples/touchdown-balls.toml"
SHORT = ("drop", MACHINE, "--until", "20 ms")


def test_a_drop_in_words(carom):
    code, out, err = carom(*SHORT)
    words = " ".join(out.split())
    assert (code, err) == (0, "")
    assert "Release: rotor centre 0.0986 mm from the bearing centre at -91.3°" in words
    assert "Not settled after 20 ms." in words
    assert "peak force 1,320 N, 5.99 ms after the release" in words
    assert "ball pressure: 2.24 GPa, limit 4.2 GPa: kept so far (not settled)" in words
    assert "add --out DIR" in words


def test_the_motion_is_that_of_simulate(carom):
    code, out, _ = carom(*SHORT, "--json")
    dropped = json.loads(out)
    assert code == 0
    _, out, _ = carom("simulate", MACHINE, "--drop", "--until", "20 ms", "--json")
    simulated = json.loads(out)
    (bearing,), (simulated_bearing,) = (each["touchdown_bearings"] for each in (dropped, simulated))
    assert dropped["disturbance"] == simulated["disturbance"]
    assert simulated_bearing.items() > bearing.items()
    assert bearing["contacts"] == len(simulated["contacts"])
    assert bearing["limits"]


def test_figures_and_a_page(carom, tmp_path):
    where = tmp_path / "drop"
    code, out, err = carom(*SHORT, "--out", str(where), "--json")
    assert code == 0
    assert err.strip() == f"Report: {where / 'drop.html'}"
    names = {path.name for path in (where / "figures").iterdir()}
    assert names == {f"drop-{name}.{kind}" for name in ("landing", "orbit", "loads") for kind in ("png", "svg")}
    written = json.loads((where / "drop.json").read_text(encoding="utf-8"))
    assert written.pop("figures") == [
        f"figures/drop-{name}.{kind}" for name in ("landing", "orbit", "loads") for kind in ("svg", "png")
    ]
    assert written == json.loads(out)
    assert "Report:" in carom(*SHORT, "--out", str(where))[1]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--whirl", "0.1 mm"), "--whirl = 0.1 mm: must be RADIUS,SPEED or RADIUS,SPEED,ANGLE such as"),
        (("--whirl", "0.3 mm,80 Hz"), "--whirl = 0.3 mm,80 Hz: whirl radius: must be from 0 to the clearance"),
        (("--phase", "90"), "--phase = 90: must be an angle in rad"),
        (("--race-speed", "500 rpm", "--set", "touchdown_race_inertia=0"), "touchdown_race_inertia = 0: must be"),
        (
            ("--whirl", "0.1 mm,80 Hz", "--kick", "5 mm/s"),
            "the release = with --kick 5 mm/s with --whirl 0.1 mm,80 Hz: allowed alone, or with one of --start, --kick, --whirl",
        ),
    ],
)
def test_bad_input_gets_one_line(refused, options, words):
    refused(f"carom: {words}", "drop", MACHINE, *options)


MAP = ("drop", "examples/dropped-rotor.toml", "--map", "phase,speed", "--grid", "3x2", "--y", "8000 rpm,9000 rpm")


def test_a_map_over_the_race_says_which_drops_whirl_backward(carom):
    over = ("--map", "friction,touchdown_race_inertia", "--x", "0.1,0.4", "--y", "1e-5 kg m^2,1e-4 kg m^2")
    where = ("examples/touchdown-balls.toml", "--whirl", "0.2 mm,-400 Hz", "--grid", "2x2", "--until", "20 ms")
    code, out, _ = carom("drop", *where, *over)
    assert code == 0
    assert "Backward whirl at the end: 4 of 4, all at friction 0.1 to 0.4, touchdown race inertia" in out
    assert "Force still growing at the end: " in out


def test_a_map_for_people_and_as_json(carom, tmp_path):
    code, out, err = carom(*MAP, "--out", str(tmp_path / "map"))
    assert code == 0
    assert not err
    assert f"Written to {tmp_path / 'map'}\n" in out
    words = " ".join(out.split())
    assert "Drops over phase 60 to 300°, speed 8,000 to 9,000 rpm: 3 x 2." in words
    assert "rest on the touchdown bearing 6 100 %" in words
    assert "Hardest: largest impulse 0.4" in words
    assert "Backward whirl at the end: none of 6." in words
    assert sorted(path.name for path in (tmp_path / "map").iterdir()) == ["drop-map.json", "drop-map.nc", "figures"]
    _, out, _ = carom(*MAP, "--json")
    document = json.loads(out)
    assert document == json.loads((tmp_path / "map" / "drop-map.json").read_text())
    assert document["outcomes"] == [["at-rest"] * 2] * 3
    phase, speed = document["plane"]["phase"][1], document["plane"]["speed"][1]
    machine = cm.load("examples/dropped-rotor.toml")
    assert speed == pytest.approx(machine.machine.speed)
    loads = cm.motions.drop_loads(cm.simulate(machine, cm.drop(phase=phase)))
    assert document["impulse_si"][1][1] == pytest.approx(loads.planes[0].si()["impulse"], rel=1e-9)
    assert document["force_si"] == [[None] * 2] * 3


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--grid", "3x2"), "--grid = 3x2: allowed only with --map NAME,NAME"),
        (("--map", "phase"), "--map = phase: must be two names with a comma between them"),
        (("--map", "phase,spede"), "did you mean speed?"),
        (("--map", "phase,speed", "--grid", "1x5"), "--grid = 1x5: must be 2 whole numbers of at least 2"),
        (("--map", "phase,speed", "--y", "8000,9000 rpm"), "--y = 8000: speed must be"),
    ],
)
def test_wrong_maps(refused, options, said):
    refused(said, "drop", "examples/dropped-rotor.toml", *options)


def test_until_the_shaft_stands(carom, tmp_path):
    drive = '\n[drive]\npolar_inertia = "4e-6 kg m^2"\nbrake = "0.05 N m"\n'
    path = tmp_path / "slow.toml"
    path.write_text(Path(MACHINE).read_text(encoding="utf-8") + drive, encoding="utf-8")
    command = ("drop", str(path), "--until", "standstill", "--steps", "20")
    code, out, _ = carom(*command, "--json")
    assert code == 0
    found = json.loads(out)["spin_down"]
    slowed = cm.motions.spin_down(cm.load(path), cm.drop(), steps=20)
    assert found["stands"]
    assert found["time"] == slowed.time
    assert found["course"]["time"] == slowed.course[:, 0].tolist()
    given = found["energy_into_bearings_si"][0] + found["braked_si"]
    assert 0.9 < given / (0.5 * 4e-6 * cm.load(path).parameters.scales.speed ** 2) < 1.1
    words = " ".join(carom(*command, "--out", str(tmp_path / "report"))[1].split())
    assert json.loads((tmp_path / "report" / "drop.json").read_text())["figures"][0] == "figures/drop-standstill.svg"
    assert "in 20 steps of speed down to standstill" in (tmp_path / "report" / "drop.html").read_text(encoding="utf-8")
    assert "The shaft stands" in words
    assert "by 20 steps of speed" in words
    (whirl,) = found["largest_whirl"]
    assert f"largest whirl {1e3 * whirl['radius_si']:.3f} mm 0-to-peak in the fixed frame, 1.06 of the" in words
    assert "torque of unbalance left out: up to" in words
    assert "limit 50 µm: kept ball pressure" in words
    code, _, err = carom(*command, "--map", "phase,speed")
    assert (code, "--until = standstill: a time beside --map" in err) == (2, True)


def test_histories_beside_a_drop_and_a_motion(carom, refused, tmp_path, monkeypatch):
    file = tmp_path / "drop.csv"
    for command in (SHORT, ("simulate", MACHINE, "--drop", "--until", "20 ms")):
        file.unlink(missing_ok=True)
        code, _, err = carom(*command, "--history", str(file), "--every", "0.1 ms")
        assert (code, err) == (0, "")
        heading, *rows = file.read_text().splitlines()
        assert heading.startswith("time [s],touchdown_1_x [m],touchdown_1_y [m],touchdown_1_normal_force [N]")
        assert len(rows) == 201
    monkeypatch.setattr("carom.cli.drop._DRAWN", 50)
    assert "s: the first 50 impacts and steps of contact" in carom(*SHORT, "--history", str(file))[2]
    refused("carom: --every = 1 ms: allowed only with --history FILE", *SHORT, "--every", "1 ms")
    refused("carom: --nodes = a: must be numbers of nodes", *SHORT, "--history", str(file), "--nodes", "a")
    refused(
        f"carom: --history = {tmp_path}/a.txt: must end in .csv, .mat, .nc", *SHORT, "--history", f"{tmp_path}/a.txt"
    )
