"""The verdict of a study in words: what the machine does, what may hold it, which changes help, what is unknown.

It never promises that a machine recovers.  Disturbances are samples, and motions that none of them reached may exist.
The best possible verdict is that every disturbance tried came back.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from carom.closed_forms.whirl import rolling
from carom.studies.actuator import actuator_words
from carom.studies.endings import came_back
from carom.studies.findings import FINDINGS, names_of, stable_rub
from carom.studies.proven import proven_words
from carom.studies.wording import listed

if TYPE_CHECKING:
    from carom.studies.assembly import Study

Level = Literal["no-contact-free-motion", "may-not-come-back", "all-tried-came-back"]

NOT_COVERED = (
    "Disturbances other than those simulated. They are samples: one between them, or a larger one, may end elsewhere.",
    (
        "Periodic motions with two or more impacts a period, bouncing that never repeats, and motions that alternate "
        "between bounces and lasting contact. They are named only if a simulated disturbance ended in one."
    ),
    "A touchdown bearing that moves, turns or gives way: the wall is rigid, so the load of an impact is an impulse.",
    "Changes of speed, gravity, a rotor that bends or tilts, and controllers that do more than a spring and a damper.",
)
"""What a study does not cover."""


@dataclass(frozen=True)
class Finding:
    """A topic of the verdict; each line of its text is a paragraph."""

    topic: str
    text: str


@dataclass(frozen=True)
class Verdict:
    """The conclusion of a study.

    Attributes
    ----------
    level : {"no-contact-free-motion", "may-not-come-back", "all-tried-came-back"}
        The verdict as a code for programs.
    outcome : str
        The verdict in a few words, with the zone of the vibration amplitude (ISO 14839-2).
    """

    level: Level
    outcome: str
    headline: str
    findings: tuple[Finding, ...]

    @property
    def text(self) -> str:
        """The whole verdict as plain text."""
        return "\n\n".join([self.headline, *(f"{finding.topic}: {finding.text}" for finding in self.findings)])


def verdict(study: Study) -> Verdict:
    """Write the verdict of a study."""
    findings = [Finding(topic, write(study)) for topic, write in FINDINGS.items()]
    if study.proof is not None:
        findings.append(Finding("Proven", proven_words(study.proof)))
    if study.bearing_demand is not None:
        findings.append(Finding("Magnetic bearings", actuator_words(study)))
    if study.loads is not None:
        findings.append(Finding("Touchdown loads", study.loads.words))
    findings.append(Finding("Not covered", "\n".join(NOT_COVERED)))
    level, outcome, headline = _headline(study)
    return Verdict(level, outcome, f"{outcome}: {headline}", tuple(findings))


def _headline(study: Study) -> tuple[Level, str, str]:
    levitation = study.equilibria[0]
    if levitation.status != "admissible":
        what = "just reaches" if levitation.status == "boundary" else "would lie beyond"
        return (
            "no-contact-free-motion",
            "Cannot run without contact",
            f"its whirl from unbalance {what} the wall of the touchdown bearing.",
        )
    if not levitation.stable:
        text = "its levitation is not damped, so that a disturbance does not die out."
        return "no-contact-free-motion", f"Does not stay in levitation, zone {study.zone}", text
    holds = _what_may_hold(study)
    if holds:
        return (
            "may-not-come-back",
            f"May not come back after a touch, zone {study.zone}",
            f"it levitates, but {listed(holds)}.",
        )
    fastest = study.wording.velocity(study.attractors.fastest)
    text = f"it came back from every disturbance tried, of up to {fastest}"
    if study.bearing_demand is not None and study.bearing_demand.doubtful:
        text += f"; {study.bearing_demand.doubtful} of them ask for more than its magnetic bearings can give"
    if rolling(study.rotor).holds:
        text += "; only rolling backward whirl is known to be able to hold it"
    return (
        "all-tried-came-back",
        f"Came back each time, zone {study.zone}",
        f"{text}. That is no guarantee: see what is not covered.",
    )


def _what_may_hold(study: Study) -> list[str]:
    holds = []
    if any(rub.status != "virtual" for rub in study.rubs):
        holds.append("a stable synchronous rub exists" if stable_rub(study) else "a synchronous rub exists")
    if study.stable_orbits:
        holds.append(f"it can bounce for ever ({names_of(list(study.stable_orbits))})")
    tried = study.attractors.disturbances
    lost = len(tried) - came_back(tried)
    upto = f"disturbances of up to {study.wording.velocity(study.attractors.fastest)}"
    if lost:
        share = f"{lost} of {len(tried)}" if lost < len(tried) else f"any of the {lost}"
        holds.append(f"it did not come back from {share} {upto}")
    elif study.fresh is not None and study.fresh.lost:
        holds.append(f"it did not come back from {study.fresh.lost} of {study.fresh.sample.count:,} {upto}")
    if not study.orbits.complete and not study.stable_orbits:
        holds.append("not all of its periodic motions could be searched")
    return holds
