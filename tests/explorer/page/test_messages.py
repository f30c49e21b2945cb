"""Sentences about a picture, as far as it is filled in."""

from __future__ import annotations

import re

import pytest

from carom.basins import Share
from carom.explorer.page.messages import sentence, shown_share

KICKS = "kicks up to 20 mm/s"


@pytest.mark.parametrize(("back", "whole"), [(0, "None"), (113, "All")])
def test_a_coarse_picture_says_nothing_of_all_or_none(back, whole):
    share = Share.of(back, 113, drawn=False)
    assert not re.search("all |none |[%]", f"{sentence(share, KICKS, True)} {shown_share(share, True)}".lower())
    assert sentence(share, KICKS, False).startswith(f"{whole} of 113 kicks up to 20 mm/s that were tried come")
