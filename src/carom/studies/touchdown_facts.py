"""What touchdown bearings bear in what must be survived and in a drop, and how accurate that is, as facts."""

from __future__ import annotations

from collections.abc import Iterator

from carom.base.outcome import Outcome
from carom.parameters.formats import number
from carom.rotors import ReducedMachine
from carom.studies.facts import Fact
from carom.studies.kinds import LABELS
from carom.studies.study_data import StudyData
from carom.studies.wording import Wording, listed

REDUCTION = (
    "Whether it levitates and all linear results are of all modes. Motions with contact are of {vectors} vectors, {modes} of them modes of the free rotor: "
    "when the free rotor comes to a touchdown bearing straight, tilting or bending, half as many vectors more change the force of the first contact by {error} %.{damped}"
)
DAMPED = " The vectors that are no modes have a damping ratio of {ratio}, without which one of them would grow, as no mode does."
ASSUMED = "; no weight is stated, so that of 9.81 m/s² downward is taken"
BORNE = {
    True: (
        ("orbit", "orbit up to {radius} from the centre"),
        ("contacts", "{contacts:contact}, {force}, {contact_time} in contact"),
    ),
    False: (
        ("orbit", "orbit up to {radius} from the centre"),
        ("impacts", "{contacts:impact}, impulse {impulse}"),
        ("lasting", "{force} in {contact_time} of lasting contact"),
    ),
}
"""What is stated of a compliant touchdown bearing, and of a rigid one."""
HEADLINE = ("peak force", "depth", "hardest impact", "lasting contact", "whirl at the end")
NO_DROP = "No drop is followed: without scales nothing is in m/s², and of matrices it is not known what is left without levitation."


def load_facts(study: StudyData) -> Iterator[Fact]:
    """What each kind that must be survived asks of the bearings at its full size, and the worst of all against limits."""
    for each in study.full_size:
        label = LABELS[each.kind]
        size = study.wording.size_of(each.kind)(each.size)
        lines = [f"{label} of {size}, the worst of {each.back.total} all around, of which {each.back.count} came back:"]
        several = len(each.bearings) > 1
        for bearing in each.bearings:
            borne = Wording(bearing.scales).rows(BORNE[bearing.is_compliant], bearing)
            at = f"touchdown bearing {bearing.touchdown_bearing}: " if several else ""
            lines.append(f"{at}{', '.join(text for _, text in borne)}{'' if bearing.contacts else ', no contact'}")
        if each.whirls:
            lines.append(f"those that do not come back go round {listed(list(each.whirls))}")
        yield Fact("Touchdown loads", f"{lines[0]} {'; '.join(lines[1:])}.", label, values=each.document())
        yield from (Fact("Touchdown loads", f"{label}, {check.words}.", label) for check in each.checks)


def drop_headline(study: StudyData) -> Iterator[Fact]:
    """The drop with its loads, as it belongs to the verdict."""
    drop = study.drop
    if drop is None:
        return
    shown = [
        f"{title and f'{title.lower()} '}{', '.join(f'{label} {words}' for label, words in rows if label in HEADLINE) or 'no contact'}"
        for title, rows in drop.tables
    ]
    limits = "" if study.case.limits.given else "; no limit of a touchdown bearing is stated to compare them with"
    loads = drop.loads
    ending = "not settled" if loads.outcome is Outcome.TIME_REACHED else loads.outcome.words
    text = f"{ending} after {study.wording.time(loads.time)}; {'; '.join(shown)}{limits}"
    yield Fact("Verdict", f"{text}{ASSUMED if drop.assumed else ''}", "Drop", "sampled")


def drop_facts(study: StudyData) -> Iterator[Fact]:
    """How the drop ends, and its loads against limits; the verdict has what each bearing bears."""
    drop = study.drop
    if drop is None:
        yield Fact("Drop", NO_DROP if study.levitates else "It does not levitate, so there is no drop.")
        return
    yield Fact("Drop", f"{drop.echo.words}. {drop.headline}")
    for check in drop.checks:
        yield Fact("Drop", f"{check.words}.")


def accuracy_facts(study: StudyData) -> Iterator[Fact]:
    """What the reduction of a flexible machine leaves out, and how far the linear law of magnets holds."""
    reduced = study.reduced
    if reduced is not None:
        values = {"error": reduced.error, "vectors": reduced.vectors, "modes": reduced.modes}
        yield Fact("Accuracy", reduction_words(reduced), values=values)
    along = [(LABELS[each.kind], found) for each in study.full_size for found in (each.magnets, each.reduction)]
    if study.drop is not None:
        along.append(("Drop", study.drop.reduction))
    for kind, found in along:
        if found is not None and found.words:
            yield Fact("Accuracy", f"{kind}, the worst: {found.words}", values=found.document())


def reduction_words(reduced: ReducedMachine) -> str:
    """What the reduction of a machine leaves out."""
    ratio = reduced.damped.damping_ratio
    return REDUCTION.format(
        vectors=reduced.vectors,
        modes=reduced.modes,
        error=number(100.0 * reduced.error, 2),
        damped=DAMPED.format(ratio=number(ratio)) if ratio else "",
    )
