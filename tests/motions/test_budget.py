"""The budget of events: the same motions are followed by any number of threads, a question ends, and what is stated is of those followed."""

import numpy as np
import pytest
from machines import machine_text

import carom as cm
from carom.basins import smallest_unrecovered
from carom.disturbances import Sample, VelocityKick
from carom.disturbances.following import follow
from carom.models import rotor_of
from carom.motions.budget import LONGEST, NOT_FOLLOWED, START, Budget

pytestmark = pytest.mark.jit_only
MACHINE = machine_text("ten-kilograms")


@pytest.fixture(scope="module")
def rotor(tmp_path_factory):
    path = tmp_path_factory.mktemp("heavy") / "heavy.toml"
    path.write_text(MACHINE)
    return rotor_of(cm.load(path))


def test_the_same_motions_are_followed_by_any_number_of_threads(rotor):
    starts = Sample(VelocityKick(1.5), 300, 1).starts(rotor)
    whole = follow(rotor, starts, max_events=LONGEST)
    found, spent = [], []
    for threads in (1, 2):
        with Budget().question("kicks", 12_000) as question:
            found.append(follow(rotor, starts, threads=threads))
        assert question.unfinished
        spent.append(question.left)
    assert spent[0] == spent[1]
    for name, values in vars(found[0]).items():
        np.testing.assert_array_equal(values, getattr(found[1], name))
    followed = found[0].outcomes != NOT_FOLLOWED
    assert np.count_nonzero(followed) == question.followed
    # The last may cost more than is left.
    assert 12_000 <= 12_000 - question.left < 12_000 + LONGEST + START
    np.testing.assert_array_equal(found[0].outcomes[followed], whole.outcomes[followed])
    # What is followed is a part of all sizes, not the first of them.
    assert 50 < np.flatnonzero(followed).mean() < 250


def test_after_its_time_nothing_is_followed(rotor):
    with Budget(seconds=0.0).question("kicks", 10**6) as question:
        ends = follow(rotor, Sample(VelocityKick(1.5), 10, 1).starts(rotor))
    assert (ends.outcomes == NOT_FOLLOWED).all()
    assert (question.asked, question.followed) == (10, 0)


def test_an_unfinished_search_claims_no_more_than_it_tried(rotor):
    with Budget().question("kicks", 60_000):
        found = smallest_unrecovered(rotor, VelocityKick(1.5), directions=24, sizes=24)
    assert not found.complete
    assert "not finished" in found.words
    assert found.fresh == 0
    assert found.all_back is not None
    assert found.contact_free < found.all_back < found.largest
    assert found.size is None or found.all_back < found.size
