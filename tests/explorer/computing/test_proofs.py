"""What is proven of the kicks of a picture lies where the picture has them."""

import numpy as np
import pytest

import carom
from carom.base.outcome import InputError
from carom.closed_forms import contact_free_kick
from carom.explorer.computing import proofs
from carom.explorer.computing.planes import planes_of
from carom.models import rotor_of

pytestmark = pytest.mark.jit_only

CASE = carom.load("examples/spindle.toml")
PLANES = {plane.name: plane for plane in planes_of(CASE)}


def test_kicks_that_never_touch_are_proven(monkeypatch):
    rotor = rotor_of(CASE)
    monkeypatch.setattr(proofs, "LIMIT", "1 s")
    largest = 1.5 * contact_free_kick(rotor)
    found = proofs.find_proven(rotor, PLANES["kick"], largest)
    line = largest * ((np.arange(proofs.CELLS) + 0.5) * 2.0 / proofs.CELLS - 1.0)
    size = np.hypot(*np.meshgrid(line, line))
    assert found["open"].shape == size.shape
    assert not found["open"][size < 0.8 * contact_free_kick(rotor)].any()
    assert found["open"][size > largest].all()
    assert found["words"].endswith(("mm/s", "impact", "impacts"))


def test_of_other_disturbances_nothing_is_proven():
    with pytest.raises(InputError, match="kicks: of other disturbances nothing is proven"):
        proofs.find_proven(rotor_of(CASE), PLANES["shock"], 1.0)
