"""Maps of a plane explain every change of motions: tried along lines of which the maps know nothing."""

import numpy as np
import pytest
from machines import PAPER

from carom.base.outcome import CaromError
from carom.bifurcations import Motions, Plane, RegionMap, motions_at
from carom.bifurcations import survey as module
from carom.bifurcations.changes import PlanePoint
from carom.bifurcations.survey import Survey
from carom.parameters import Parameters

OF_ORBITS = {"fold", "speed-fold", "grazing", "slip-stop", "contact-onset", "non-smooth-hopf"}
CHANGES = {
    "contact_free": {"boundary-equilibrium"},
    "rub": {"rub-fold", "boundary-equilibrium"},
    "rolling": {"rolling-limit"},
    "orbits": OF_ORBITS,
    "stable_orbits": OF_ORBITS | {"period-doubling", "neimark-sacker"},
}
CLOSE = 3e-4
"""Distance from a curve, in widths of the plane; its points are so dense that straight lines between them keep within 5e-5."""


def line_changes(base: Parameters, plane: Plane, random: np.random.Generator, samples: int):
    """Place and motions on both sides of each change along a random line of the plane, by bisection."""
    low = np.array([plane.first_range[0], plane.second_range[0]])
    ends = random.uniform(size=(2, 2))

    def at(share: float) -> Motions:
        return motions_at(plane.at(base, *(low + plane.widths * (ends[0] + share * (ends[1] - ends[0])))))

    shares = np.linspace(0.0, 1.0, max(8, int(samples * np.linalg.norm(ends[1] - ends[0]))) + 1).tolist()
    known = [at(share) for share in shares]
    left = [(shares[i], shares[i + 1], known[i], known[i + 1]) for i in range(len(shares) - 1)]
    while left:
        start, stop, before, last = left.pop()
        if before == last:
            continue
        end, after = stop, last
        while end - start > 1e-8:
            middle = 0.5 * (start + end)
            here = at(middle)
            start, end, after = (middle, end, after) if here == before else (start, middle, here)
        left.append((end, stop, after, last))
        yield ends[0] + 0.5 * (start + end) * (ends[1] - ends[0]), before, after


def distance(found: RegionMap, share: np.ndarray, kinds: set[str]) -> float:
    """From a place, in widths of the plane, to the nearest curve of these kinds that motions of the machine have."""
    low = np.array([found.plane.first_range[0], found.plane.second_range[0]])
    nearest = np.inf
    for curve in (curve for curve in found.curves if curve.kind in kinds):
        points = (curve.points - low) / found.plane.widths
        ahead = np.diff(points, axis=0)
        along = ((share - points[:-1]) * ahead).sum(axis=1) / np.maximum((ahead**2).sum(axis=1), 1e-300)
        apart = np.linalg.norm(points[:-1] + np.clip(along, 0.0, 1.0)[:, None] * ahead - share, axis=1)
        real = curve.admissible[:-1] | curve.admissible[1:]
        nearest = min(nearest, float(apart[real].min(initial=np.inf)))
    return nearest


def tried(base: Parameters, plane: Plane, found: RegionMap, lines: int, samples: int) -> tuple[int, list]:
    """Number of changes along random lines, and those on no curve."""
    random, count, missed = np.random.default_rng(606), 0, []
    for _ in range(lines):
        for share, before, after in line_changes(base, plane, random, samples):
            count += 1
            changed = [name for name in CHANGES if getattr(before, name) != getattr(after, name)]
            if max(distance(found, share, CHANGES[name]) for name in changed) > CLOSE:
                missed.append((share, before.words, after.words))
    return count, missed


def test_curves_that_no_line_through_the_machine_meets(corner):
    assert corner.unexplained == ()
    found = {(curve.kind, curve.subject) for curve in corner.curves}
    assert ("neimark-sacker", "B1,d") in found
    assert any(kind == "grazing" and "B3,b" in subject for kind, subject in found)
    assert len({(curve.kind, *curve.points[[0, -1]].ravel(), curve.subject) for curve in corner.curves}) == len(
        corner.curves
    )


@pytest.mark.jit_only
def test_every_change_along_lines_lies_on_a_curve(corner):
    count, missed = tried(PAPER, corner.plane, corner, 6, 50)
    assert count > 8
    assert not missed


def surveyed(base: Parameters, plane: Plane, cells: int) -> tuple[Survey, list[list[PlanePoint]]]:
    """All curves from differences of neighbouring points, without any from diagrams."""
    survey = Survey(base, plane, [])
    xs, ys = survey.grid(cells)
    points = [[survey.examine(np.array([x, y])) for y in ys] for x in xs]
    survey.explain_all(points, lambda _: None)
    return survey, points


def test_what_cannot_be_followed_is_listed(monkeypatch):
    plane = Plane("gamma", "omega", (0.3, 0.45), (0.6, 0.8))
    known, _ = surveyed(PAPER, plane, 2)
    assert [curve.kind for curve in known.curves] == ["rub-fold"]
    assert known.unexplained == []

    def fails(*_):
        raise CaromError("not today")

    monkeypatch.setattr(module, "continue_curve", fails)
    found, _ = surveyed(PAPER, plane, 2)
    assert found.curves == []
    assert found.unexplained
    for change in found.unexplained:
        assert change.words in (
            "stable synchronous rub -> no stable rub",
            "no stable rub -> stable synchronous rub",
        )
        assert change.reason == "rub-fold: not today"
        gamma, omega = change.point
        assert gamma + PAPER.mu * (1.0 - omega**2) == pytest.approx(PAPER.rho * np.hypot(1.0, PAPER.mu), abs=1e-8)
