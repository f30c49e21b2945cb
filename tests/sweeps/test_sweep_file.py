"""The sweep file: what it may say, and errors that name the entry, the value and what is allowed."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from carom.base.outcome import InputError
from carom.disturbances import MODELS
from carom.loading import load
from carom.sweeps import load_sweep

EXAMPLES = Path(__file__).parents[2] / "examples"
GOOD = {
    "top": 'machine = "machine.toml"\nseed = 3',
    "damping": '[axes.damping]\nfrom = "1000 N s/m"\nto = 4000\ncount = 4',
    "speed": '[axes.speed]\nvalues = ["1500 rpm", 184.2]',
    "do": '[basins]\nstarts = 10\ndisturbance = {kind = "kick", fastest = "0.1 m/s"}',
}


@pytest.fixture
def write(tmp_path):
    (tmp_path / "machine.toml").write_text((EXAMPLES / "keogh-cole.toml").read_text(encoding="utf-8"), encoding="utf-8")
    (tmp_path / "numbers.toml").write_text(
        (EXAMPLES / "source-paper.toml").read_text(encoding="utf-8"), encoding="utf-8"
    )

    def file(**changes):
        path = tmp_path / "sweep.toml"
        path.write_text("\n\n".join((GOOD | changes).values()), encoding="utf-8")
        return path

    return file


def test_axes_take_units_ends_and_lists(write):
    plan = load_sweep(write())

    assert plan.shape == (4, 2)
    assert plan.points == 8
    np.testing.assert_array_equal(plan.axes[0].values, [1000.0, 2000.0, 3000.0, 4000.0])
    np.testing.assert_allclose(plan.axes[1].values, [1500 * np.pi / 30, 184.2], rtol=1e-15)
    assert plan.seed == 3


def test_logarithmic_axis_keeps_its_ends(write):
    plan = load_sweep(write(damping='[axes.gamma]\nfrom = 0.1\nto = 0.7\ncount = 5\nspacing = "log"'))

    values = plan.axes[0].values
    assert (values[0], values[-1]) == (0.1, 0.7)
    np.testing.assert_allclose(values[1:] / values[:-1], 7**0.25, rtol=1e-14)


@pytest.mark.parametrize("settings", [[], ["gamma=0.1"], ["friction=0.3", "omega=0.8"]])
def test_point_is_the_machine_of_the_same_settings(write, settings):
    names = {setting.split("=")[0] for setting in settings}
    damping = "" if "gamma" in names else GOOD["damping"]
    plan = load_sweep(write(damping=damping), settings)
    point = tuple(count - 1 for count in plan.shape)
    here = [f"{name}={value!r}" for name, value in plan.values(point).items()]

    assert plan.case_at(point) == load(EXAMPLES.parent / write().with_name("machine.toml"), [*settings, *here])


def test_axes_and_settings_in_other_terms_are_the_machines_of_the_same_settings(write, tmp_path):
    machine = tmp_path / "machine.toml"
    text = machine.read_text(encoding="utf-8").replace(
        "stiffness =", "negative_stiffness = 2e5\nproportional_gain = 1e4 #"
    )
    machine.write_text(f"{text}".replace("[machine]", '[machine]\nforce_current_factor = "118 N/A"'), encoding="utf-8")
    gain = '[axes.proportional_gain]\nfrom = "5 A/mm"\nto = "20 A/mm"\ncount = 3'
    grade = '[axes.balance_grade]\nvalues = ["G 2.5", "G 6.3"]'
    plan = load_sweep(write(damping=gain, grade=grade), ["damping_ratio=7.7 %"])

    for point in np.ndindex(*plan.shape):
        here = [f"{name}={value!r}" for name, value in plan.values(point).items()]
        assert plan.case_at(point).parameters == load(machine, [*here, "damping_ratio=7.7 %"]).parameters
    assert [plan.case_at((place, 0, 0)).machine.stiffness for place in range(3)] == [390e3, 1275e3, 2160e3]
    assert plan.axes[2].field.unit == "mm/s"

    before = plan.digest
    machine.write_text(machine.read_text(encoding="utf-8").replace("118", "119").replace("1e4", "9915.96638655462185"))
    other = load_sweep(write(damping=gain, grade=grade), ["damping_ratio=7.7 %"])
    assert other.case.parameters == plan.case.parameters
    assert other.digest != before


def test_sizes_with_units_stay_and_plain_ones_scale(write):
    with_unit = load_sweep(write())
    plain = load_sweep(write(do=GOOD["do"].replace('"0.1 m/s"', "0.5")))
    scales = [with_unit.case_at((0, place)).parameters.scales for place in (0, 1)]

    speeds = [with_unit.task.model(scale).fastest * scale.velocity for scale in scales]
    np.testing.assert_allclose(speeds, 0.1, rtol=1e-15)
    assert [plain.task.model(scale).fastest for scale in scales] == [0.5, 0.5]


@pytest.mark.parametrize("name", ["sweep-contact.toml", "sweep-gains.toml", "sweep-speed.toml"])
def test_examples_are_plans(name):
    plan = load_sweep(EXAMPLES / name)

    assert plan.points > 100
    assert json.loads(json.dumps(plan.describe())) == plan.describe()


def test_description_changes_with_everything_but_the_texts(write):
    digests = {load_sweep(write()).digest, load_sweep(write(top=GOOD["top"] + " # a word")).digest}
    assert len(digests) == 1
    for change in (
        {"top": 'machine = "machine.toml"\nseed = 4'},
        {"top": GOOD["top"] + "\nchunk = 3"},
        {"top": GOOD["top"] + '\nset = ["friction=0.2"]'},
        {"speed": '[axes.speed]\nvalues = ["1500 rpm", 184.3]'},
        {"do": GOOD["do"].replace("10", "11")},
        {"do": "[study]\ndisturbances = 9"},
    ):
        digests.add(load_sweep(write(**change)).digest)
    assert len(digests) == 7


@pytest.mark.parametrize(
    ("change", "field", "words"),
    [
        ({"top": ""}, "machine", "nothing given: missing; must be the path of a machine file"),
        ({"top": 'machine = "machine.toml"\nsede = 3'}, "sede", "did you mean seed?"),
        ({"top": 'machine = "machine.toml"\nseed = -1'}, "seed", "-1: must be a whole number from 0"),
        ({"top": 'machine = "machine.toml"\nchunk = 0'}, "chunk", "0: must be a whole number of at least 1"),
        ({"top": 'machine = "machine.toml"\nset = ["speed=3"]'}, "axes.speed", "is set too"),
        ({"top": 'machine = "machine.toml"\nset = ["gamma=3"]'}, "gamma", "sets damping, which is set too"),
        ({"damping": "", "speed": ""}, "axes", "nothing given: must be tables [axes.NAME]"),
        ({"damping": '[axes.damping]\nvalues = ["1 kg"]'}, "axes.damping.values", "1 kg: must be a damping in N s/m"),
        ({"damping": "[axes.damping]\nvalues = []"}, "axes.damping.values", "must be a list of 1 to"),
        ({"damping": "[axes.damping]\nvalues = [1, 1.0]"}, "axes.damping.values", "must be different values"),
        ({"damping": "[axes.damping]\nvalues = [1]\nto = 2"}, "axes.damping.to", "not allowed beside values"),
        ({"damping": "[axes.damping]\nfrom = 1\nto = 2"}, "axes.damping.count", "missing; must be a whole number"),
        ({"damping": "[axes.damping]\nfrom = 1\nto = 1\ncount = 4"}, "axes.damping.to", "another value than from"),
        ({"damping": "[axes.damping]\nfrom = true\nto = 1\ncount = 4"}, "axes.damping.from", "true: must be the first"),
        (
            {"damping": '[axes.damping]\nfrom = 0\nto = 1\ncount = 4\nspacing = "log"'},
            "axes.damping.spacing",
            "ends above 0",
        ),
        (
            {"damping": '[axes.damping]\nfrom = 1\nto = 2\ncount = 4\nspacing = "lin"'},
            "axes.damping.spacing",
            '"linear"',
        ),
        ({"do": ""}, "sweep file", "must hold either a [study] or a [basins] table"),
        ({"do": GOOD["do"] + "\n[study]"}, "sweep file", "either a"),
        ({"do": "[study]"}, "seed", "3: allowed only with simulated disturbances"),
        ({"top": GOOD["top"] + "\n[axes.color]\nvalues = [1]"}, "color", "unknown name"),
        ({"speed": "[axes]\nspeed = 3"}, "axes.speed", "3: must be a table [axes.speed]"),
        ({"do": "[basins]\nstarts = 4"}, "basins.disturbance", "must be a table such as"),
        ({"do": GOOD["do"].replace("fastest", "fast")}, "fast", "did you mean fastest?"),
        ({"do": GOOD["do"].replace('"0.1 m/s"', "-1.0")}, "basins.disturbance.fastest", "a size, above 0"),
        ({"do": GOOD["do"].replace("10", '"ten"')}, "basins.starts", "ten: must be a whole number"),
    ],
)
def test_error_is_one_line_that_helps(write, change, field, words):
    with pytest.raises(InputError) as caught:
        load_sweep(write(**change))

    assert caught.value.field == field
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_all_errors_are_told_at_once(write):
    path = write(
        top='machine = "machine.toml"\nseed = -1\nset = ["restitution=2", "gama=1"]',
        damping='[axes.damping]\nform = 1\nto = "2 kg"\ncount = 4',
        speed='[axes.speed]\nvalues = ["1 m", 3, true]',
        do='[basins]\nstarts = 0\ndisturbance = {kind = "kick", fastest = "1 kg", peak = 3}',
    )
    with pytest.raises(InputError) as caught:
        load_sweep(path)

    fields = [error.field for error in caught.value.errors]
    axes = ["form", "axes.speed.values", "axes.speed.values"]
    assert fields == ["seed", *axes, "basins.starts", "peak", "basins.disturbance.fastest"]
    assert str(caught.value).split("\n") == [str(error) for error in caught.value.errors]


def test_errors_of_the_machine_file_and_of_settings_are_among_them(write):
    path = write(top='machine = "machine.toml"\nset = ["gama=1"]', damping="", do="")
    machine = path.with_name("machine.toml")
    machine.write_text(machine.read_text(encoding="utf-8").replace('"50 kg"', '"50 m"'), encoding="utf-8")
    with pytest.raises(InputError) as caught:
        load_sweep(path)

    assert [error.field for error in caught.value.errors] == ["mass", "gama", "sweep file"]


@pytest.mark.parametrize(
    ("text", "words"), [("", "it is empty"), ("machine = ", "must be valid TOML"), (None, "there is no such file")]
)
def test_file_that_is_none(tmp_path, text, words):
    path = tmp_path / "sweep.toml"
    if text is not None:
        path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=f"^sweep file = .*{words}"):
        load_sweep(path)


def test_physical_axis_needs_a_machine(write):
    with pytest.raises(InputError, match=r"axes\.damping.*dimensionless"):
        load_sweep(write(top='machine = "numbers.toml"', speed=""))


def test_sweeps_are_planned_and_laid_out_before_kernels_are_loaded(write, tmp_path):
    """Up to the workers, who have the kernels to themselves, the compiler would only hold up a sweep of any size."""
    (tmp_path / "quake.csv").write_text("time (s),x (g)\n0,0\n0.01,1\n0.02,0\n", encoding="utf-8")
    sizes = {
        "kick": 'fastest = "0.1 m/s"',
        "kick-plane": "fastest = 1",
        "shock": 'peak = "20 g"\nduration = "11 ms"',
        "blade-loss": 'change = "0.2 mm"',
        "base-record": f'file = "{tmp_path}/quake.csv, 2 g"',
        "release": 'motion = "rolling"',
        "slice": "",
        "state": "fastest = 1",
    }
    assert sizes.keys() == {name for name, model in MODELS.items() if model.__module__.startswith("carom")}
    tasks = [f'[basins]\nstarts = 10\n[basins.disturbance]\nkind = "{kind}"\n{size}' for kind, size in sizes.items()]
    files = [
        write(do=task).rename(tmp_path / f"{number}.toml")
        for number, task in enumerate(["[study]\ndisturbances = 9", *tasks])
    ]
    code = """if True:
        import sys
        import carom.sweeps.local
        from carom.sweeps import load_sweep, run_sweep
        carom.sweeps.local.on_processes = lambda *given: (chunk for chunk in ())
        for file in sys.argv[1:]:
            print(run_sweep(load_sweep(file), file + ".zarr").waiting)
        print([name for name in ("matplotlib", "numba", "xarray") if name in sys.modules])
    """
    done = subprocess.run([sys.executable, "-c", code, *files], capture_output=True, text=True, check=False)

    assert (done.stdout.splitlines(), done.stderr) == (["8"] * len(files) + ["[]"], "")


def test_more_points_than_any_computer_follows_are_refused_at_once(write):
    axis = "[axes.{}]\nfrom = 0.1\nto = 0.9\ncount = 1000000"
    with pytest.raises(
        InputError, match=r"^axes = 1000000 x 1000000 = 1000000000000 points: at most 1000000000: fewer"
    ):
        load_sweep(write(damping=axis.format("gamma"), speed=axis.format("mu")))
