"""Levitation, rubs and harmless kicks along a parameter, against closed forms in double precision at values drawn from the interval."""

import numpy as np
import pytest
from compilation import sized

import carom
from carom.closed_forms import contact_free_kick, find_equilibria
from carom.proofs import hypotheses_of
from carom.proofs.balls import at_precision
from carom.proofs.rotor import ProvenRotor
from carom.proofs.steady_lines import steady_line_claims

CASES = {
    "paper, levitation leaves the wall and rubs vanish": ("examples/source-paper.toml", "gamma", "0.05", "0.4", ""),
    "paper, unbalance from none": ("examples/source-paper.toml", "rho", "0", "0.6", ""),
    "spindle, damping": ("examples/spindle.toml", "damping", "280 N s/m", "420 N s/m", "N s/m"),
    "spindle, a term": ("examples/spindle.toml", "diametral_clearance", "0.4 mm", "0.6 mm", "m"),
}


@pytest.fixture(params=CASES, ids=str)
def case(request):
    path, name, start, stop, unit = CASES[request.param]
    options = {"along": name, "from": start, "to": stop}
    with at_precision(64):
        claims = steady_line_claims(ProvenRotor(hypotheses_of(path)), options)
    low, high = (float(value.partition(" ")[0]) * (1e-3 if value.endswith(" mm") else 1.0) for value in (start, stop))
    drawn = np.random.default_rng(2).uniform(low, high, sized(200, 30, 2000)).tolist()
    values = [low, *drawn, high]
    return (
        {claim.name: claim for claim in claims},
        [(x, carom.load(path, [f"{name}={x!r} {unit}".strip()])) for x in values],
    )


def parts(claim, value):
    """Whether a claim says that something holds at a value: on parts stated in its reason, else on all of it."""
    if claim.status == "proven":
        return True
    for heading, stated in (("shown on ", True), ("the contrary on ", False)):
        for entry in claim.reason.split("; "):
            if entry.startswith(heading):
                ends = [part.strip("[]").split(", ") for part in entry.removeprefix(heading).split("], [")]
                if any(float(low) < value < float(high) for low, high in ends):
                    return stated
    return None


def test_claims_are_what_closed_forms_say(case):
    claims, machines = case
    decided = 0
    for value, machine in machines:
        kinds = [(entry.kind, entry.status) for entry in find_equilibria(machine)]
        levitates = ("contact-free", "admissible") in kinds
        pressed = sum(kind != "contact-free" and status == "admissible" for kind, status in kinds)
        found = {name: parts(claims[name], value) for name in ("levitation inside", "rub 1 pressed", "rub 2 pressed")}
        for name, wanted in zip(found, (levitates, pressed > 0, pressed > 1), strict=True):
            if found[name] is not None:
                assert found[name] == wanted, (name, value)
                decided += 1
    assert decided > 2.5 * len(machines)


def test_harmless_speed_is_the_least_one(case):
    claims, machines = case
    claim = claims.get("kick harmless outside of gaps", claims["kick harmless"])
    name = "speed" if "speed" in claim.enclosures else "speed_si"
    low, high = (float(end) for end in (claim.enclosures[name].low, claim.enclosures[name].high))
    speeds = []
    for value, machine in machines:
        if parts(claims["kick harmless"], value):
            unit = machine.parameters.scales.velocity if name == "speed_si" else 1.0
            speeds.append(contact_free_kick(machine) * unit)
    # harmless_kick leaves 1e-9 for rounding.
    assert min(speeds) >= low * (1 - 2e-9)
    assert high <= min(speeds) * (1 + 2e-9)
