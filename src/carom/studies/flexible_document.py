"""The study of a flexible machine as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from carom.attractors import exact_interval
from carom.studies.facts import Fact
from carom.studies.flexible_data import FlexibleData
from carom.studies.load_tables import load_entries
from carom.studies.questions import unfinished_document
from carom.studies.verdict import Verdict


def machine_document(study: FlexibleData, verdict: Verdict, facts: Sequence[Fact]) -> dict[str, Any]:
    """Return the document of a study; planes and bearings count from 1 unless a field says otherwise."""
    total = len(study.attractors.disturbances)
    reduced = study.reduced
    return {
        "name": study.case.name,
        **study.rotor.document(),
        "verdict": {"level": verdict.level, "outcome": verdict.outcome, "reason": verdict.reason, "headline": verdict.headline},
        "reduction": {"vectors": reduced.vectors, "modes": reduced.modes, "error": reduced.error, "error_is": "an estimate, no bound"},
        "levitating": study.levitation.document(),
        "attractors": [
            {
                "name": entry.name,
                "outcome": entry.name.outcome.label,
                "words": entry.words,
                "disturbances": entry.count,
                "known_starts": entry.known,
                "share": [entry.share_of_disturbances, *(exact_interval(entry.count, total) if total else (0.0, 1.0))],
            }
            for entry in study.attractors
        ],
        "complete": False,
        "trials": [each.document() for each in study.trials],
        "kicks_beyond": [{"times": times, "came_back": back.count, "tried": back.total} for times, back in study.beyond],
        "drop": None if study.fall_loads is None else {"touchdown_bearings": load_entries(study.fall_loads, study.case.limits)},
        "elsewhere": {"came_back": study.elsewhere.count, "tried": study.elsewhere.total},
        "not_reached": unfinished_document(study.unfinished),
        "facts": [fact.document() for fact in facts],
    }  # fmt: skip
