"""Study a machine: from its parameters to a verdict.

Read them in this order.

=======================  ========================================================================================
``assembly``             :func:`study` and the frozen :class:`Study`
``ranges``               for which damping and stiffness equilibria exist, in closed form
``orbit_ranges``         for which damping and stiffness single-impact orbits are possible, by search
``alone``                for which damping and stiffness levitation is the only motion found
``safety``               the least damping above which no contact motion is found
``advice``               the least change of either gain that leaves only levitation, checked by simulation
``load_checks``          loads of touchdowns against stated limits
``actuator``             what motions ask of the magnetic bearings, against the limits of these
``endings``              where simulated disturbances ended
``verdict``              the results in words
``findings``             the paragraphs of the verdict
``remedies``             where levitation is the only motion found, in words
``proven``               what a proof has decided, in words
``recommendation``       the least change, its margin and its evidence
``one_page``             the recommendation as lines of text
``summaries``            the tables of a study, as text
``wording``              numbers with units
``document``             results as JSON
``attractors_document``  attractors as JSON
``response``             :func:`unbalance_response`: amplitude, phase and contact over the speed of the shaft
``response_words``       what it says about the machine, in sentences
``response_document``    the response as JSON
``standards``            limits of vibration: API 617, ISO 14839-2
=======================  ========================================================================================
"""

from carom.studies.advice import Advice
from carom.studies.alone import LevitationAlone, OtherMotion
from carom.studies.assembly import Study, study
from carom.studies.document import found_orbits_document, orbits_document, trajectory_document
from carom.studies.load_checks import LoadCheck, WorstLoads, check_loads, worst_loads
from carom.studies.ranges import Edge, MotionRange, Span, Threshold, free_spans
from carom.studies.recommendation import Change, Margin, Recommendation, Tried
from carom.studies.response import Separation, Steady, Stretch, UnbalanceResponse, unbalance_response
from carom.studies.verdict import NOT_COVERED, Finding, Verdict
from carom.studies.wording import Wording

__all__ = [
    "NOT_COVERED",
    "Advice",
    "Change",
    "Edge",
    "Finding",
    "LevitationAlone",
    "LoadCheck",
    "Margin",
    "MotionRange",
    "OtherMotion",
    "Recommendation",
    "Separation",
    "Span",
    "Steady",
    "Stretch",
    "Study",
    "Threshold",
    "Tried",
    "UnbalanceResponse",
    "Verdict",
    "Wording",
    "WorstLoads",
    "check_loads",
    "found_orbits_document",
    "free_spans",
    "orbits_document",
    "study",
    "trajectory_document",
    "unbalance_response",
    "worst_loads",
]
