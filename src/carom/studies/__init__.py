"""Study a machine: from its parameters to a verdict.

Read them in this order.

=======================  ========================================================================================
``assembly``             :func:`study` and the frozen :class:`Study`
``questions``            the questions of a study, how many events each may take, and what was not reached
``study_data``           :class:`StudyData`: what a study has found, before it is stated
``ranges``               for which values of a parameter each simple motion exists
``trials``               disturbances followed at one value of a parameter after another
``recovery``             :func:`find_recovery`: which values of any parameter leave only recovery
``kinds``                the kinds of disturbances that a machine may have to survive
``survives``             the sizes of kicks, shocks and losses of a blade up to which none is lost
``advice``               the least change that leaves only recovery, in the user's terms and within limits
``load_checks``          loads of touchdowns against stated limits
``load_tables``          what touchdown bearings bear in a motion, in rows and as JSON
``drops``                :class:`DropStudy`: what a drop asks of the touchdown bearing, in words and as JSON
``motion_documents``     motions as JSON, with what touchdown bearings bear
``actuator``             what motions ask of the magnetic bearings, against the limits of these
``levitating``           how a machine levitates: whirls, response, sensitivity, separations
``full_size``            what must be survived at its full size all around, and what touchdown bearings bear in it
``levitation_facts``     how it levitates, in words
``touchdown_facts``      loads, drop and accuracy, in words
``endings``              where simulated disturbances ended
``facts``                :class:`Fact`: what headline, page, report and JSON show
``advice_facts``         the recommendation, as facts
``verdict``              what is survived, as facts, and the headline
``coverage``             what is not covered
``findings``             the list of all facts: the motions, what disturbances did and what would change it
``proven``               what a proof has decided, in words
``summaries``            the tables of a study, as text
``wording``              numbers with units
``document``             results as JSON
``response``             :func:`unbalance_response`: amplitude, phase and contact over the speed of the shaft, and as JSON
``critical_speeds``      peaks of the response, with their separation from the operating speeds
``response_data``        what it has found, before it is stated
``response_words``       what it says about the machine, in sentences
``standards``            limits of vibration: API 617, ISO 14839-2
=======================  ========================================================================================
"""

from carom.studies.assembly import Study, study
from carom.studies.critical_speeds import Critical, Separation
from carom.studies.document import found_orbits_document, orbits_document
from carom.studies.drops import DropStudy
from carom.studies.load_checks import LoadCheck, check_loads
from carom.studies.motion_documents import trajectory_document
from carom.studies.ranges import MotionRange, Threshold
from carom.studies.recovery import Recovery, find_recovery
from carom.studies.response import UnbalanceResponse, unbalance_response
from carom.studies.response_data import Rubs, SpeedStretch, Steady
from carom.studies.trials import Check, Unrecovered, check_recovery
from carom.studies.wording import Wording

__all__ = [
    "Check",
    "Critical",
    "DropStudy",
    "LoadCheck",
    "MotionRange",
    "Recovery",
    "Rubs",
    "Separation",
    "SpeedStretch",
    "Steady",
    "Study",
    "Threshold",
    "UnbalanceResponse",
    "Unrecovered",
    "Wording",
    "check_loads",
    "check_recovery",
    "find_recovery",
    "found_orbits_document",
    "orbits_document",
    "study",
    "trajectory_document",
    "unbalance_response",
]
