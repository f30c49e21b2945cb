"""The main job: from a machine to a verdict.

==================  ==================================================================================
``assembly``        :func:`study` and the frozen :class:`Study`
``ranges``          for which damping and stiffness equilibria exist, in closed form
``folds``           for which damping and stiffness single-impact orbits exist, by search
``endings``         what became of simulated disturbances
``verdict``         all of it in words
``findings``        the paragraphs of the verdict
``wording``         numbers with units
``summaries``       its tables, as text
``document``        results as JSON
==================  ==================================================================================
"""

from carom.study.assembly import Study, study
from carom.study.document import as_json, orbits_document, trajectory_document
from carom.study.ranges import Edge, MotionRange, Span, Threshold, free_spans
from carom.study.verdict import NOT_COVERED, Finding, Verdict
from carom.study.wording import Wording

__all__ = [
    "NOT_COVERED",
    "Edge",
    "Finding",
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
