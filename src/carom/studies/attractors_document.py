"""Attractors with their kinds as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from carom.attractors import Attractor, AttractorSet, Character, document_of, exact_interval
from carom.basins import share_of_kicks
from carom.models import Rotor
from carom.results import fields_of


def attractors_document(
    rotor: Rotor, found: AttractorSet, characters: Sequence[Character], exponents: bool = True
) -> dict[str, Any]:
    """Return the document of attractors, with one character for each member of ``found``.

    ``exponents`` says whether to list the Lyapunov exponents.
    """
    total, share = len(found.disturbances), share_of_kicks(found)
    entries = [
        _attractor(entry, total, character, exponents) for entry, character in zip(found, characters, strict=True)
    ]
    return {
        **rotor.document(),
        "attractors": entries,
        "share": share.document if share else None,
        "disturbances": found.words(),
        "starts": total,
        "known_starts": len(found.endings) - total,
        "seed": getattr(found.sample, "seed", None),
        "irregular_transient": document_of(found.transient) if found.transient else None,
        "argument": found.argument,
    }


def _attractor(entry: Attractor, total: int, character: Character, exponents: bool) -> dict[str, Any]:
    orbit, rotation = character.orbit, character.rotation
    return {
        **fields_of(entry, outcome="name.outcome.label", name="name"),
        **fields_of(character, "kind", "words"),
        "word": str(orbit.word) if orbit else None,
        **({"turns": orbit.turns} if orbit and orbit.turns is not None else {}),
        "impacts": (orbit.impacts if orbit else entry.name.multiplicity) or None,
        "period": orbit.period if orbit else entry.period,
        "share": [entry.share_of_disturbances, *(exact_interval(entry.count, total) if total else (0.0, 1.0))],
        **fields_of(entry, count="count", known_starts="known"),
        "lasting": character.lasting,
        **(document_of(entry.survival) | {"transient": character.lasting == "transient"}),
        "rotation_number": rotation.number if rotation and character.kind == "torus" else None,
        **({"exponents": _exponents(character)} if exponents else {}),
    }


def _exponents(character: Character) -> dict[str, Any] | None:
    """Exponents with their errors; ``None`` where they are not known."""
    found, rates = character.exponents, character.rates
    if found is not None:
        per_time = fields_of(found, per_time="values", per_impact="per_impact", error_per_time="errors")
        return per_time | fields_of(found, "error_per_impact", "lost")
    if rates is None:
        return None
    nothing = {"per_impact": None, "error_per_impact": None}
    return {"per_time": rates.tolist(), "error_per_time": [0.0] * len(rates), **nothing}
