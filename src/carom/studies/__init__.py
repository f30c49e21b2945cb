"""Study a machine: from its parameters to a verdict.

Read them in this order.

=======================  ========================================================================================
``assembly``             :func:`study` and the frozen :class:`Study`
``questions``            what a machine may have to survive, the questions of a study, and how many events each may take
``study_data``           :class:`StudyData`: what a study has found, before it is stated
``ranges``               for which values of a parameter each simple motion exists
``trials``               disturbances followed at one value of a parameter after another
``recovery``             :func:`find_recovery`: which values of any parameter leave only recovery
``survives``             the sizes of disturbances up to which none is lost, and what touchdown bearings bear in what must be survived
``advice``               the least change that leaves only recovery, in the user's terms and within limits
``drops``                loads of touchdowns against limits, and :class:`DropStudy`: what a drop asks of the touchdown bearing
``motion_documents``     motions as JSON, with what touchdown bearings bear
``actuator``             what motions ask of the magnetic bearings, against the limits of these
``levitating``           how a machine levitates: whirls, response, sensitivity, separations
``endings``              where simulated disturbances ended
``facts``                :class:`Fact`: what headline, page, report and JSON show
``advice_facts``         the recommendation, as facts
``verdict``              what is survived and what is proven, as facts, and the headline
``findings``             the list of all facts: the motions, what disturbances did, loads, what would change it, and what is not covered
``summaries``            the tables of a study, as text
``wording``              numbers with units
``document``             results as JSON
``response``             :func:`unbalance_response`: amplitude, phase and contact over the speed of the shaft, and what it says in sentences
``response_data``        :class:`UnbalanceResponse`: what it has found, also as JSON
``critical_speeds``      peaks of the response, with their separation from the operating speeds
``standards``            limits of vibration: API 617, ISO 14839-2
=======================  ========================================================================================
"""

from carom.studies.assembly import Study, study
from carom.studies.critical_speeds import Critical, Separation
from carom.studies.document import found_orbits_document, orbits_document
from carom.studies.drops import DropStudy, LoadCheck, check_loads
from carom.studies.motion_documents import trajectory_document
from carom.studies.ranges import MotionRange, Threshold
from carom.studies.recovery import Recovery, find_recovery
from carom.studies.response import unbalance_response
from carom.studies.response_data import Rubs, SpeedStretch, Steady, UnbalanceResponse
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
