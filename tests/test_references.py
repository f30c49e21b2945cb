"""What to cite for a result: the literature behind the methods that made it."""

from __future__ import annotations

import re
from dataclasses import fields

import pytest
from machines import PAPER

import carom as cm
from carom.base.outcome import InputError
from carom.base.references import REFERENCES, Reference
from carom.base.results import Result, citations


def subclasses(kind: type) -> set[type]:
    """All classes below one."""
    below = set(kind.__subclasses__())
    return below.union(*(subclasses(one) for one in below)) if below else set()


def keys(result: object) -> set[str]:
    """Keys of what is to be cited for a result."""
    return {reference.key for reference in citations(result).references}


def test_carom_and_the_source_paper_come_first():
    found = citations(cm.find_orbits(PAPER)).references
    assert [reference.key for reference in found] == ["carom", "mora2014"]
    assert cm.__version__ in found[0].title


def test_what_a_result_holds_counts():
    basin = cm.map_basins(PAPER, cm.Grid(cm.disturbances.VelocityKick(), (5, 5)))
    assert {"brent1980", "clopper1934"} <= keys(basin)
    diagram = cm.find_bifurcations(PAPER, "gamma", (0.09, 0.11))
    assert {"keller1977", "squire1998"} <= keys(diagram)
    motion = cm.simulate(PAPER, cm.kick(0.1), 1.0)
    assert keys(cm.attractors.find_attractors(PAPER, [motion.start], known=False)) >= keys(motion)


def test_every_reference_is_used_and_every_key_is_known():
    for package in ("attractors", "basins", "bifurcations", "motions", "orbits", "proofs", "studies"):
        getattr(cm, package).__all__  # noqa: B018  (loads the results of the package)
    kinds = [cm.basins.SmallestUnrecovered, cm.attractors.Survival]
    used = {key for kind in (*subclasses(Result), *kinds) for key in kind.rests_on}
    assert used == set(REFERENCES)


@pytest.mark.parametrize("reference", REFERENCES.values(), ids=REFERENCES)
def test_bibtex_names_all_fields_with_balanced_braces(reference):
    text = reference.bibtex
    assert text.count("{") == text.count("}")
    assert re.match(r"@(article|incollection|techreport)\{\w+,\n", text)
    written = dict(re.findall(r"^  (\w+) = \{(.*)\},$", text, flags=re.MULTILINE))
    given = {one.name: getattr(reference, one.name) for one in fields(Reference) if one.name not in ("key", "kind")}
    assert written == {name: value for name, value in given.items() if value}
    if reference.kind == "article":
        assert reference.journal
        assert reference.volume
        assert reference.pages


def test_text_reads_as_in_a_list_of_references():
    assert REFERENCES["clopper1934"].text == (
        "C. J. Clopper and E. S. Pearson, “The use of confidence or fiducial limits illustrated in the case of the binomial”, "
        "Biometrika 26, 404–413 (1934), doi:10.1093/biomet/26.4.404."
    )
    found = citations(cm.find_orbits(PAPER))
    assert str(found) == found.text
    assert found.bibtex.startswith("@software{carom,")
    assert found.text.startswith("The carom developers, ")


def test_anything_else_is_refused():
    with pytest.raises(InputError, match="result"):
        citations(3.0)
