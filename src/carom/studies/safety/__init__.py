"""The least damping above which no contact motion is met, and which motion sets it.

==============  ==============================================================================================
``limits``      :class:`DampingLimit`, :class:`SafeDamping`: what was found, in words too
``losses``      disturbances that are lost, and variants of them, at any damping
``search``      :func:`least_safe_damping`
==============  ==============================================================================================
"""

from carom.studies.safety.limits import DampingLimit, SafeDamping
from carom.studies.safety.losses import DampingCheck, try_disturbances
from carom.studies.safety.search import FRESH, least_safe_damping

__all__ = ["FRESH", "DampingCheck", "DampingLimit", "SafeDamping", "least_safe_damping", "try_disturbances"]
