"""Which machines the page opens, and with what."""

from __future__ import annotations

from pathlib import Path

import pytest
from flexible_pages import opened

import carom
from carom.explorer.computing.exports import Origin
from carom.explorer.page.flexible import FlexibleKind
from carom.explorer.page.kinds import explored_case_of, kind_of
from carom.explorer.page.planar import PlanarKind
from carom.outcome import InputError

EXAMPLES = Path(__file__).parents[3] / "examples"


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("keogh-cole", PlanarKind),
        ("tum-test-rig", PlanarKind),
        ("tum-flexible-rotor", FlexibleKind),
        ("uberlandia-flexible-rotor", FlexibleKind),
    ],
)
def test_a_machine_has_the_page_of_its_kind(name, kind):
    path = EXAMPLES / f"{name}.toml"
    case = explored_case_of(carom.load(path))
    found = kind_of(Origin(str(path), (), case))
    assert isinstance(found, kind)
    assert found.words().startswith(f"{name}: it must survive kicks up to ")
    assert found.slots[0] in found.quick


def test_marks_differ_between_machines():
    assert len({kind_of(opened(*settings)).mark for settings in ((), ("speed=2999 rpm",), ("friction_2=0.2",))}) == 3


def test_a_planar_rotor_with_weight_is_refused():
    with pytest.raises(InputError, match="gravity"):
        explored_case_of(carom.load(EXAMPLES / "dropped-rotor.toml"))
