"""What is proven in figures of diagrams and planes: where it is drawn, and which proofs are refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from drawn_legends import fits, legend_words
from machines import PAPER

from carom import bifurcations
from carom.outcome import InputError
from carom.proofs.hypotheses import hypotheses_of
from carom.proofs.proven_lines import proven_of_diagram
from carom.proofs.proving import proof_of

EXACT = {
    "gamma": "0.1",
    "omega": "0.76",
    "rho": "3/7",
    "phi": "0.21",
    "mu": "0.15",
    "d": "0.95",
    "radius_ratio": "400/7",
}
DOUBLING = 0.0833814175124809


def proven(machine, along, low, high):
    options = {"along": along, "from": low, "to": high, "blocks": 60, "narrowest": "1/200"}
    return proof_of("along a parameter", hypotheses_of(machine), options)


@pytest.fixture(scope="module")
def proof():
    return proven(EXACT, "gamma", "0.0833", "0.0838")


@pytest.fixture(scope="module")
def diagram():
    return bifurcations.find_bifurcations(PAPER, "gamma", (0.07, 0.1))


def drawn(axes, meaning):
    return [line for line in axes.lines if line.get_gid() == meaning]


def test_diagram_shows_stretches_and_points(diagram, proof):
    figure = diagram.plot(proof=proof)
    below = figure.axes[2]
    bars = sorted(tuple(line.get_xdata()) for line in drawn(below, "proven"))
    # The period doubling leaves a gap.
    assert [bars[0][0], bars[-1][1]] == pytest.approx([0.0833, 0.0838], abs=1e-12)
    assert len(bars) == 2
    assert bars[0][1] < DOUBLING < bars[1][0]
    (points,) = drawn(below, "proven point")
    assert points.get_xdata() == pytest.approx(np.full(len(points.get_xdata()), DOUBLING), abs=1e-9)
    assert [text.get_text() for text in below.get_yticklabels()][-1] == "proven"
    assert "proven: these orbits with one impact a period and no others" in legend_words(figure)
    assert fits(figure)
    assert not drawn(diagram.plot().axes[2], "proven")


def test_orbits_that_may_stop_their_slip_are_excepted_in_words(diagram, proof):
    open_ = tuple(replace(claim, status="undecided") if claim.name == "machine slip" else claim for claim in proof)
    words = legend_words(diagram.plot(proof=replace(proof, claims=open_)))
    assert any(text.endswith("but where impacts stop the slip") for text in words)


def test_plane_shows_the_line_through_the_machine(corner, proof):
    figure = corner.plot(proof=proof)
    lines = drawn(figure.axes[0], "proven")
    assert all(line.get_ydata() == pytest.approx([0.76, 0.76]) for line in lines)
    assert lines[0].get_xdata()[0] == pytest.approx(0.0833)
    assert fits(figure)
    upright = corner.plot(proof=proven(EXACT, "omega", "0.7", "0.7001"))
    (line,) = drawn(upright.axes[0], "proven")
    assert line.get_xdata() == pytest.approx([0.1, 0.1])
    assert line.get_ydata() == pytest.approx([0.7, 0.7001])


@pytest.mark.parametrize(
    ("changes", "along", "words"),
    [
        ({}, "omega", "along omega.*a proof along gamma"),
        ({"mu": "0.1500001"}, "gamma", "its mu is 0.1500001"),
        ({"omega": "0.761"}, "gamma", "its omega_squared is"),
    ],
)
def test_proof_of_something_else_is_refused_in_one_line(diagram, proof, changes, along, words):
    other = replace(proof, hypotheses=hypotheses_of({**EXACT, **changes}), options={**proof.options, "along": along})
    with pytest.raises(InputError, match=words) as problem:
        diagram.plot(proof=other)
    assert "\n" not in str(problem.value)


def test_what_is_no_proof_along_a_parameter_is_refused(diagram, proof):
    with pytest.raises(InputError, match=r"proof = proof\.json: a Proof"):
        diagram.plot(proof="proof.json")
    with pytest.raises(InputError, match="of one machine"):
        diagram.plot(proof=replace(proof, options={}))


def test_diagram_and_proof_must_agree(diagram, proof):
    fewer = replace(diagram, orbits=tuple(branch for branch in diagram.orbits if "B1,d" not in branch.names))
    with pytest.raises(InputError, match=r"lacks orbits that are proven there: .*B1,d"):
        proven_of_diagram(proof, fewer)
    unknowns = diagram.orbits[0].unknowns.copy()
    unknowns[:, -1] += 1.0  # the durations of the only flight
    moved = replace(diagram.orbits[0], unknowns=unknowns)
    wide = proven(EXACT, "gamma", "0.09", "0.1")
    assert proven_of_diagram(wide, diagram).stretches
    with pytest.raises(InputError, match="proven not to exist"):
        proven_of_diagram(wide, replace(diagram, orbits=(moved, *diagram.orbits[1:])))
