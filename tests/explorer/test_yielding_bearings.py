"""The page of a machine whose touchdown bearing is compliant: controls, pictures, what is copied, and what is left out."""

import shlex

import pytest
from machines import machine_text

import carom
from carom.explorer.computing.controls import controls_of, values_of, with_settings
from carom.explorer.computing.exports import Origin, as_options

MACHINE = machine_text("page")
LINEAR = 'law = "kelvin-voigt"\nstiffness = "1e8 N/m"\n'
KINDS = {
    "restitution": LINEAR + "restitution = 0.8\n",
    "damping": LINEAR + 'damping = "500 N s/m"\n',
    "balls": 'law = "hunt-crossley"\nstiffness = "2e10 N/m^1.5"\nexponent = "3/2"\ndissipation = "0.5 s/m"\n',
    "ring": 'law = "hunt-crossley"\ndissipation = "0.5 s/m"\nballs = 12\nball_diameter = "6.35 mm"\nrace_diameter = "45 mm"\ninternal_clearance = "10 um"\n',
    "race": LINEAR + 'restitution = 0.8\nrace_inertia = "2e-4 kg m^2"\nrace_drag = "1e-5 N m s"\n',
    "mount": LINEAR
    + 'damping = "500 N s/m"\nmount_mass = "1.5 kg"\nmount_stiffness = "2e7 N/m"\nmount_damping = "3000 N s/m"\n',
    "rigid": 'law = "rigid"\nmount_mass = "1.5 kg"\nmount_stiffness = "2e7 N/m"\nmount_damping = "3000 N s/m"\n',
    "drive": LINEAR + 'restitution = 0.8\n\n[drive]\npolar_inertia = "0.02 kg m^2"\n',
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    where = tmp_path_factory.mktemp("machines")
    for kind, table in KINDS.items():
        machine = (
            MACHINE.replace("friction = 0.15", "friction = 0.15\nrestitution = 0.8") if kind == "rigid" else MACHINE
        )
        (where / f"{kind}.toml").write_text(machine + table, encoding="utf-8")
    return where


@pytest.fixture(scope="module")
def origin(folder):
    def of(kind):
        path = str(folder / f"{kind}.toml")
        return Origin(path, (), carom.load(path))

    return of


@pytest.mark.parametrize(
    ("kind", "names"),
    [
        ("restitution", {"touchdown_stiffness": "N/m", "touchdown_restitution": ""}),
        ("mount", {"touchdown_stiffness": "N/m", "touchdown_damping": "N s/m"}),
        ("ring", {"touchdown_internal_clearance": "um", "touchdown_dissipation": "s/m"}),
        ("balls", {"touchdown_stiffness": "N/m^1.5", "touchdown_dissipation": "s/m"}),
    ],
)
def test_the_bearing_has_sliders_for_what_its_file_states(origin, kind, names):
    case = origin(kind).case
    controls = {control.name: control for control in controls_of(case)}
    assert {name: controls[name].unit for name in controls if name.startswith("touchdown_")} == names
    assert "restitution" not in controls
    for control in controls.values():
        assert 0.0 < control.low <= control.value <= control.high or control.low == 0.0
        # Both ends of every slider are values of the machine.
        for end in (control.low, control.high):
            assert with_settings(case, {control.name: f"{float(f'{end:.4g}'):g} {control.unit}".strip()})


@pytest.mark.parametrize(
    ("kind", "changes"),
    [
        ("restitution", {"touchdown_stiffness": "2.5e8", "touchdown_restitution": "0.6", "damping": "2500"}),
        ("balls", {"touchdown_stiffness": "3e10", "touchdown_dissipation": "0.7"}),
        ("mount", {"touchdown_damping": "700 N s/m"}),
        ("race", {"speed": "1500"}),
        ("rigid", {"restitution": "0.7"}),
        ("drive", {"touchdown_stiffness": "200 MN/m"}),
    ],
)
def test_options_and_file_lead_to_the_same_machine(origin, kind, changes, tmp_path):
    given = origin(kind)
    case = with_settings(given.case, changes)
    assert carom.load(given.path, shlex.split(as_options(given, changes))[1::2]) == case
    (tmp_path / "machine.toml").write_text(case.to_toml(), encoding="utf-8")
    again = carom.load(tmp_path / "machine.toml")
    assert (again.machine, again.touchdown, again.drive) == (case.machine, case.touchdown, case.drive)
    assert again.limits == case.limits
    assert values_of(again) == values_of(case)
