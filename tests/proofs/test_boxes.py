"""Kicks that are proven to come back for all machines of a box do so for machines drawn from it; certificates of boxes stand alone."""

import json

import numpy as np
import pytest
from compilation import sized
from machines import machine_text

import carom
from carom.base.outcome import InputError
from carom.models import jeffcott
from carom.motions import settle
from carom.parameters import Parameters
from carom.proofs import check, hypotheses_of, prove_kicks
from carom.proofs.balls import at_precision
from carom.proofs.kick_cells import IMPACTS, box_of, leaves, read

SPINDLE = "examples/spindle.toml"
GAINS = machine_text("spindle-by-gains")
SLIP_STOPS = {
    "gamma": "0.6",
    "omega": "1.2",
    "rho": "0.02",
    "phi": "1",
    "mu": "0.4",
    "d": "0.5",
    "radius_ratio": "0.05",
}
CASES = {
    # What the machine is, the largest kick, the impacts allowed, and the box; nothing is left open of any.
    "damping": (SPINDLE, "111 mm/s", 1, {"damping": ("280 N s/m", "420 N s/m")}),
    "speed and clearance": (
        SPINDLE,
        "111 mm/s",
        1,
        {"speed": ("23900 rpm", "24000 rpm"), "clearance": ("0.249 mm", "0.25 mm")},
    ),
    "gains": (
        GAINS,
        "110 mm/s",
        1,
        {"derivative_gain": ("2.1 A s/m", "2.3 A s/m"), "proportional_gain": ("6200 A/m", "6300 A/m")},
    ),
    "friction and rebound": (SLIP_STOPS, "1.9", 2, {"mu": ("0.34", "0.46"), "d": ("0.4", "0.55")}),
    "unbalance from none, damping past critical": (
        {**SLIP_STOPS, "gamma": "2.4"},
        "3.4",
        1,
        {"gamma": ("2.38", "2.42"), "rho": ("0", "0.001")},
    ),
}


def file_of(machine, folder):
    """A path or numbers as they are, the text of a file as a file."""
    if not isinstance(machine, str) or "\n" not in machine:
        return machine
    (folder / "machine.toml").write_text(machine)
    return str(folder / "machine.toml")


@pytest.fixture(scope="module", params=CASES, ids=str)
def case(request, tmp_path_factory):
    machine, largest, most, along = CASES[request.param]
    machine = file_of(machine, tmp_path_factory.mktemp("machine"))
    proof = prove_kicks(machine, largest, along=along, most_impacts=most, time_limit=None, workers=1)
    return machine, proof


def rotor_at(machine, settings):
    """The rotor of a machine with other values of some parameters, by carom's own reading of files."""
    if isinstance(machine, dict):
        numbers = {name: float(value) for name, value in {**machine, **settings}.items()}
        return jeffcott(Parameters(**numbers)), 1.0
    loaded = carom.load(machine, [f"{name}={value}" for name, value in settings.items()])
    return jeffcott(loaded.parameters), loaded.parameters.scales.velocity


def test_everything_is_proven(case):
    _, proof = case
    assert proof["kicks all recover"].status == proof["kicks recover"].status == "proven"
    assert proof["kicks recover"].enclosures["share_proven"].low == "1"
    assert len(proof) == 2


def test_kicks_of_machines_drawn_from_the_box_return(case):
    machine, proof = case
    random, box = np.random.default_rng(5), proof.options["box"]
    cells = list(leaves(read(proof.evidence["cells"], len(box))))
    largest, most = float(proof.options["kicks_up_to"].split()[0]), proof.options["most_impacts"]
    hit = 0
    for _ in range(sized(200, 25, 2000)):
        cell, letter = cells[random.integers(len(cells))]
        shares = [[float(end) for end in ends] for ends in (*cell.ends, cell.speeds, cell.angles)]
        # Ends and corners are drawn too, inside by less than any width of a cell.
        drawn = random.random((len(shares), 4))
        drawn[:, ::2] = np.round(drawn[:, ::2])
        values = [low + (high - low) * share for (low, high), share in zip(shares, drawn, strict=True)]
        settings = {}
        for (name, start, stop), share in zip(box, values, strict=False):
            (low, unit), (high, _) = (end.partition(" ")[::2] for end in (start, stop))
            settings[name] = f"{float(low) + (float(high) - float(low)) * share[0]} {unit}".strip()
        rotor, velocity = rotor_at(machine, settings)
        ahead = rotor.equilibrium / abs(rotor.equilibrium) if rotor.equilibrium else 1.0
        size = largest / (1000 * velocity if isinstance(machine, str) else 1.0) * (1 - 1e-12)
        kicks = size * values[-2] * np.exp(2j * np.pi * values[-1]) * ahead
        endings = settle(rotor, carom.State(np.full(4, rotor.equilibrium), kicks), threads=1)
        assert endings.recovered.all(), (settings, kicks)
        assert (endings.impacts <= IMPACTS.index(letter)).all(), (settings, kicks)
        hit += int((endings.impacts > 0).sum())
    assert hit
    assert most >= max(IMPACTS.index(letter) for _, letter in cells)


@pytest.fixture(scope="module")
def document():
    machine, largest, most, along = CASES["friction and rebound"]
    proof = prove_kicks(machine, largest, along=along, most_impacts=most, time_limit=None, workers=1)
    return json.loads(json.dumps(proof.document()))


def test_certificate_is_verified_without_a_search(document, monkeypatch):
    monkeypatch.setattr("carom.proofs.kick_discs.settle", None)
    monkeypatch.setattr("carom.proofs.recovering.search", None)

    assert check(document)["kicks all recover"].status == "proven"


def test_forged_boxes_are_refused(document):
    """Intervals wider, missing, of another name or form, and twice; cells of another number of parameters, swapped or missing."""
    options, cells = document["options"], document["evidence"]["cells"]
    (first, low, high), second = options["box"]
    boxes = [
        [[first, low, "0.9"], second],
        [[first, "0.1", high], second],
        [[first, low, high]],
        [],
        [["gamma", low, high], second],
        [[first, low, high], [first, low, high]],
        [[first, low], second],
        [[first, low, 0.42], second],
        "mu",
        None,
        [[first, high, low], second],
    ]
    swapped = cells.replace("1", "x", 1).replace("0", "1", 1).replace("x", "0", 1)
    assert swapped != cells
    assert set(cells) & set("pq")
    forged = [{"options": {**options, "box": box}} for box in boxes]
    forged += [
        {"evidence": {"cells": text}}
        for text in (swapped, cells[:-1], cells + "0", cells.replace("1", "0"), "r" + cells + cells, "0")
    ]
    for change in forged:
        with pytest.raises(InputError, match="is refused"):
            check({**document, **change})


def test_a_box_is_not_passed_off_as_one_machine(document):
    options = {name: value for name, value in document["options"].items() if name != "box"}
    with pytest.raises(InputError, match="is refused"):
        check({**document, "theorem": "kicks", "options": options})


@pytest.mark.parametrize(
    ("along", "words"),
    [
        ({"damping": ("280 N/m", "420 N s/m")}, "damping"),
        ({"damping": ("420 N s/m", "280 N s/m")}, "must begin below"),
        ({"mass_": ("1 kg", "2 kg")}, "mass"),
        ({"unbalance_phase": ("0 rad", "1 rad")}, "only turns motions"),
        ({"damping": ("280 N s/m", "420 N s/m"), "damping_ratio": ("0.1", "0.2")}, "give one of the two"),
        ({"damping": ("280 N s/m", "420 N s/m"), "gamma": ("0.1", "0.2")}, "give one of the two"),
        ({"derivative_gain": ("1 A s/m", "2 A s/m")}, "gives no force_current_factor"),
        (dict.fromkeys(("gamma", "mu", "d", "rho"), ("0.1", "0.2")), "at most 3"),
    ],
)
def test_what_is_no_box_is_refused(along, words):
    with pytest.raises(InputError, match=words):
        prove_kicks(SPINDLE, "111 mm/s", along=along)


@pytest.mark.parametrize(
    "settings",
    [
        {"derivative_gain": "2.3 A s/m", "proportional_gain": "6300 A/m"},
        {"natural_frequency": "55 Hz", "damping_ratio": "0.2"},
        {"unbalance": "4 g mm", "diametral_clearance": "0.4 mm", "rotor_diameter": "31 mm"},
    ],
)
def test_terms_mean_what_they_do_in_a_file(tmp_path, settings):
    """Numbers of the equations along terms, against carom's own reading of the file with these settings."""
    path = file_of(GAINS, tmp_path)
    box = box_of(hypotheses_of(path, (), list(settings)), [(name, text, text) for name, text in settings.items()])
    with at_precision(96):
        numbers = box.machines.at(box.values([(0, 0)] * len(settings)))
    wanted = carom.load(path, [f"{name}={text}" for name, text in settings.items()]).parameters.as_dict()
    wanted["omega_squared"] = wanted["omega"] ** 2
    for name, ball in vars(numbers).items():
        # The file's values are rounded once or twice.
        assert float(ball.mid()) == pytest.approx(wanted[name], rel=1e-14)
