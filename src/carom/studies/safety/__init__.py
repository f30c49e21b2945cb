"""The least damping above which no contact motion is found, and the motion that determines it.

==============  ==============================================================================================
``limits``      :class:`DampingLimit`, :class:`SafeDamping`: the results, also in words
``losses``      search for lost disturbances and their variants, at any damping
``search``      :func:`least_safe_damping`
==============  ==============================================================================================
"""

from carom.studies.safety.limits import DampingLimit, SafeDamping
from carom.studies.safety.losses import DampingCheck, try_disturbances
from carom.studies.safety.search import FRESH, least_safe_damping

__all__ = ["FRESH", "DampingCheck", "DampingLimit", "SafeDamping", "least_safe_damping", "try_disturbances"]
