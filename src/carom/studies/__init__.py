"""Study a machine: from its parameters to a verdict.

Read them in this order.

=======================  ========================================================================================
``assembly``             :func:`study` and the frozen :class:`Study`
``questions``            what a machine may have to survive, the questions of a study with the events each may take, and the form of its answers: :class:`Fact`
``study_data``           :class:`StudyData`: what a study has found, before it is stated; what limits of the magnetic bearings do in the motions
``trials``               disturbances followed at one value of a parameter after another
``recovery``             :func:`find_recovery`: for which values of any parameter each simple motion exists, and which leave only recovery
``survives``             the sizes of disturbances up to which none is lost, and what touchdown bearings bear in what must be survived
``advice``               the least change that leaves only recovery, in the user's terms and within limits
``drops``                loads of touchdowns against limits, and :class:`DropStudy`: what a drop asks of the touchdown bearing
``landing``              a drop for its report: touchdown bearings and their loads beside each other, and how far from their limits
``standstill``           a spin-down to standstill in words and as JSON
``levitating``           how a machine levitates: whirls, response, sensitivity, separations
``verdict``              what is survived and what is proven, as facts, and the headline
``findings``             the list of all facts: the recommendation, the motions, what disturbances did, loads, and what is not covered
``summaries``            the tables of a study, as text
``wording``              numbers with units, and where motions end, as text
``document``             results as JSON: studies, orbits, attractors, and motions with what touchdown bearings bear
``response``             :func:`unbalance_response`: amplitude, phase and contact over the speed of the shaft, and what it says in sentences
``response_data``        :class:`UnbalanceResponse`: what it has found, also as JSON
``critical_speeds``      peaks of the response, with their separation from the operating speeds, and limits of vibration: API 617, ISO 14839-2
=======================  ========================================================================================
"""

from carom.studies.assembly import Study, study
from carom.studies.critical_speeds import Critical, Separation
from carom.studies.document import found_orbits_document, orbits_document, trajectory_document
from carom.studies.drops import DropStudy, LoadCheck, check_loads
from carom.studies.recovery import MotionRange, Recovery, find_recovery
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
