"""Resonances between the whirls of a disc, against the eigenvalues of its equations of motion."""

import numpy as np
import pytest

from carom.closed_forms import internal_resonance
from carom.outcome import InputError


@pytest.mark.parametrize("polar_inertia", [0.0, 1e-9, 0.143, 0.3])
@pytest.mark.parametrize(("backward", "forward"), [(2, 1), (3, 1), (3, 2), (5, 2)])
def test_frequencies_are_in_the_ratio(polar_inertia, backward, forward):
    if polar_inertia * backward >= backward - forward:
        pytest.skip("such whirls are in no such ratio")
    speed = internal_resonance(polar_inertia, backward, forward)
    # z̈ − iJΩż + z = 0 with z = Ue^{iΩt}.
    damping = 2j * speed - 1j * polar_inertia * speed
    stiffness = 1.0 - speed**2 + polar_inertia * speed**2
    slow, fast = sorted(np.abs(np.roots([1.0, damping, stiffness])))

    assert fast / slow == pytest.approx(backward / forward, rel=1e-12)
    assert (np.roots([1.0, damping, stiffness]).imag < 0.0).all()


def test_a_ratio_that_is_none_is_refused():
    with pytest.raises(InputError, match="backward = 2: a whole number above 2"):
        internal_resonance(0.1, 2, 2)
    with pytest.raises(InputError, match=r"polar_inertia = 0\.5: below 1/2"):
        internal_resonance(0.5, 2)
    assert internal_resonance(0.5 - 1e-9, 2) > 1e4
