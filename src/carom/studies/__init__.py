"""The main job: from a machine to a verdict.

==================  ==================================================================================
``assembly``        :func:`study` and the frozen :class:`Study`
``ranges``          for which damping and stiffness equilibria exist, in closed form
``orbit_ranges``    for which damping and stiffness single-impact orbits can happen, by search
``alone``           where along damping and stiffness levitation is the only motion found
``advice``          the least change of either that leaves it alone, checked by simulation
``endings``         what became of simulated disturbances
``verdict``         all of it in words
``findings``        the paragraphs of the verdict
``remedies``        what would change it, in words
``wording``         numbers with units
``summaries``       its tables, as text
``document``        results as JSON
==================  ==================================================================================
"""

from carom.studies.advice import Advice
from carom.studies.alone import LevitationAlone, Met
from carom.studies.assembly import Study, study
from carom.studies.document import as_json, orbits_document, trajectory_document
from carom.studies.ranges import Edge, MotionRange, Span, Threshold, free_spans
from carom.studies.verdict import NOT_COVERED, Finding, Verdict
from carom.studies.wording import Wording

__all__ = [
    "NOT_COVERED",
    "Advice",
    "Edge",
    "Finding",
    "LevitationAlone",
    "Met",
    "MotionRange",
    "Span",
    "Study",
    "Threshold",
    "Verdict",
    "Wording",
    "as_json",
    "free_spans",
    "orbits_document",
    "study",
    "trajectory_document",
]
