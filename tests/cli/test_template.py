"""``carom template``: a file that loads and drops as it is, whose entries are all there are."""

import re

import pytest

import carom as cm
from carom.cli.app import BAD_INPUT, main
from carom.parameters.ball_heat import OF_HEAT, OF_TORQUE
from carom.parameters.tables import DRIVE_FIELDS, GRAVITY_FIELDS, LIMIT_FIELDS, LoadLimits
from carom.parameters.terms import ENTRIES
from carom.rotors.part_tables import PARTS, ROTOR_ENTRIES
from carom.rotors.rigid_body import RIGID_FIELDS

SUPPORT = (
    "node",
    "kx",
    "ky",
    "cx",
    "cy",
    "rotating",
    "tilt",
    "speeds",
    "internal_damping",
    "mass",
    "stiffness",
    "bearings",
    "touchdowns",
    "supports",
)
"""How entries of a table begin that is left out as a whole."""


@pytest.fixture
def text(capsys):
    assert main(["template", "flexible"]) == 0
    return capsys.readouterr().out


@pytest.mark.jit_only
def test_it_loads_and_drops(tmp_path, text):
    path = tmp_path / "mine.toml"
    assert main(["template", "flexible", "--out", str(path)]) == 0
    assert path.read_text(encoding="utf-8") == text
    loads = cm.motions.drop_loads(cm.simulate(cm.load(path), cm.drop(), "20 ms"))
    assert all(plane.contacts > 0 for plane in loads.planes)


def named_in(text):
    """Entries in a line of their own or in one that begins with ``#``."""
    return set(re.findall(r"^(?:# )?(\w+) = ", text, flags=re.MULTILINE))


def test_it_explains_every_entry(text):
    of_rigid = {*RIGID_FIELDS, "position", "sensor_positions"} - {*PARTS["disc"].entries}
    own = {*ROTOR_ENTRIES, *(name for part in PARTS.values() for name in part.entries)}
    assert own - named_in(text) == {
        "filter",
        "translation",
        "tilt",
        "y",
        "restitution",
        "restitution_speed",
        "offset",
        "offset_direction",
        *of_rigid,
    }


@pytest.mark.parametrize(
    ("kind", "entries"),
    [
        ("rigid", {*RIGID_FIELDS, "position", "sensor_positions", "speed", "at_regain"}),
        ("planar", {*ENTRIES, *DRIVE_FIELDS, *GRAVITY_FIELDS, *LIMIT_FIELDS} - {"depth", *LoadLimits.needed}),
    ],
)
def test_the_other_kinds_load_and_explain_their_entries(tmp_path, kind, entries):
    path = tmp_path / "mine.toml"
    assert main(["template", kind, "--out", str(path)]) == 0
    text = path.read_text(encoding="utf-8")
    assert entries <= named_in(text)
    assert cm.load(path).parameters.scales.mass > 1.0
    # A table that is left out as a whole loads too, and what is in it.
    for block in re.findall(r"^# \[+\w+\]+.*?(?=\n\n|\Z)", text, flags=re.MULTILINE | re.DOTALL):
        used = text.replace(block, re.sub("^# ", "", block, flags=re.MULTILINE))
        path.write_text(used.replace("restitution =", "# ") if "[touchdown]" in block else used, encoding="utf-8")
        if "[drive]" not in block:  # it goes beside a compliant bearing only
            cm.load(path)


@pytest.mark.parametrize(
    "block",
    [
        ("damping_ratio = 0.005", 'damping_of_mass = "10 1/s"\ndamping_of_stiffness = "10 us"'),
        (
            "numerator = [13.2, 12000]\ndenominator = [1e-4, 1]\n",
            "A = [[-10000.0]]\nB = [[1.0]]\nC = [[-1.2e9]]\nD = [[132000.0]]\n",
        ),
        (
            "numerator = [13.2, 12000]\ndenominator = [1e-4, 1]\n",
            "zeros = [-900]\npoles = [-10000]\ngain = 132000\n[[magnetic_bearing.filter]]\nlead_zero = '3 kHz'\nlead_pole = '4 kHz'\n",
        ),
    ],
)
def test_what_stands_beside_as_another_way_works(tmp_path, text, block):
    path = tmp_path / "mine.toml"
    assert block[0] in text
    path.write_text(text.replace(*block, 1), encoding="utf-8")
    assert cm.load(path).parameters.system.decay > 0.0


def test_every_line_that_may_be_used_loads(tmp_path, text):
    """Entries that go with all others, by taking their mark away one by one."""
    path = tmp_path / "mine.toml"
    others = (
        "damping_of",
        "source",
        "A =",
        "B =",
        "C =",
        "D =",
        *(
            "sensor_gain",
            "amplifier_gain",
            "sample_time",
            "sampling",
            "zeros",
            "poles",
            "gain =",
            "sos",
            "notch",
            "lead",
            "low_pass",
        ),
        "damping =",
        "race",
        "ball",
        "conformity",
        "outer_conformity",
        "contact_angle",
        "internal_clearance",
        "preload",
        "dynamic",
        "rows",
        "mount",
        "exponent",
        "longest",
        "accuracy",
        *SUPPORT,
        *OF_TORQUE,
        *OF_HEAT,
    )
    parts = text.partition("# [survive]")[0]
    lines = [each for each in re.findall(r"^# (\w+ = .*)$", parts, flags=re.MULTILINE) if not each.startswith(others)]
    assert len(lines) > 8
    for line in lines:
        path.write_text(text.replace(f"# {line}", line, 1), encoding="utf-8")
        cm.rotors.load_machine(path)


def test_all_of_a_ball_bearing_loads(tmp_path, text):
    path, begin = tmp_path / "mine.toml", text.index("# balls = 12")
    block = text[begin : text.index("[[touchdown]]", begin)]
    stated = re.sub("^# (?!mount_damping|preload|running)", "", block, flags=re.MULTILINE)
    path.write_text(text.replace(block, stated, 1), encoding="utf-8")
    bearing = cm.load(path).parameters.definition.bearing_at(0)
    assert {*OF_HEAT, "starting_torque", "viscosity", "mount_loss_factor"} <= bearing.given.keys()
    assert cm.motions.thermal_network(bearing).conductances.diagonal() == pytest.approx([3.0, 1.5, 1.0, 5.5], rel=1e-15)


def test_nothing_is_overwritten_and_other_kinds_are_refused(tmp_path, capsys):
    path = tmp_path / "mine.toml"
    path.write_text("mine")
    assert main(["template", "flexible", "--out", str(path)]) == BAD_INPUT
    assert "a file that does not exist yet" in capsys.readouterr().err
    assert path.read_text() == "mine"
    assert main(["template", "stiff"]) == BAD_INPUT
    assert "KIND = stiff: one of planar, rigid, flexible" in capsys.readouterr().err
