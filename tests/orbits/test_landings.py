"""How far a chatter is from the onset of lasting contact, against bounces in a falling force computed one after another."""

from __future__ import annotations

import numpy as np
import pytest

from carom.orbits.landings import distance_from_onset, onset_of


def bounces(restitution: float, speed: float) -> tuple[float, int]:
    """Force at the landing of bounces under ``N = −t`` from ``t = −1``, or 0 if they do not end; and their number."""
    time, count = -1.0, 0
    while speed > 1e-17:
        # Height v τ − (−t) τ²/2 + τ³/6 over a bounce from the time t.
        inner = time**2 / 4.0 - 2.0 * speed / 3.0
        if inner < 0.0:
            return 0.0, count
        taken = 1.5 * (-time - 2.0 * np.sqrt(inner))
        speed = restitution * (-time * taken - taken**2 / 2.0 - speed)
        time, count = time + taken, count + 1
        if time >= 0.0:
            return 0.0, count
    return -time, count


@pytest.mark.parametrize("restitution", [0.1, 0.49, 0.8, 0.95])
def test_the_chatter_of_the_onset_lies_between_those_that_end_and_those_that_do_not(restitution):
    ratio = onset_of(restitution).ratio
    assert bounces(restitution, ratio * (1.0 - 1e-9))[0] > 0.0
    assert bounces(restitution, ratio * (1.0 + 1e-9))[0] == 0.0


@pytest.mark.parametrize("restitution", [0.1, 0.49, 0.8, 0.95])
def test_the_force_at_the_landing_is_a_power_of_the_distance(restitution):
    onset = onset_of(restitution)
    shifts = np.array([1e-5, 1e-6, 1e-7])
    forces = np.array([bounces(restitution, onset.ratio * (1.0 - shift))[0] for shift in shifts])
    # The force varies with the logarithm of the distance too, by a share of 1e-3 at d = 0.1 and less above.
    assert np.diff(np.log(forces)) * onset.power == pytest.approx(np.diff(np.log(shifts)), rel=2e-3)
    for shift, force in zip(shifts, forces, strict=True):
        told = distance_from_onset(restitution, 1.0, onset.ratio * (1.0 - shift))
        assert told == pytest.approx(force**onset.power, rel=2e-3)


@pytest.mark.parametrize("restitution", [0.1, 0.49, 0.8, 0.95])
def test_the_distance_is_the_same_from_each_bounce_and_smooth_through_zero(restitution):
    onset = onset_of(restitution)

    def following(force: float, ratio: float) -> tuple[float, float]:
        taken = 1.5 * (1.0 - np.sqrt(1.0 - 8.0 * ratio / 3.0))
        return force * (1.0 - taken), restitution * (taken / 2.0 - taken**2 / 3.0) / (1.0 - taken) ** 2

    for shift in (-0.01, -1e-6, 1e-6, 0.01):
        here = 1.0, onset.ratio * (1.0 + shift)
        after = following(*here)
        assert distance_from_onset(restitution, *after) == pytest.approx(
            distance_from_onset(restitution, *here), rel=2e-3
        )
    below, above = (distance_from_onset(restitution, 1.0, onset.ratio * (1.0 + shift)) for shift in (-1e-5, 1e-5))
    assert below > 0.0 > above
    assert below == pytest.approx(-above, rel=2e-3)


def test_without_rebound_it_is_the_force():
    assert distance_from_onset(0.0, -0.3, 0.0) == -0.3
    assert onset_of(0.0).power == 1.0
