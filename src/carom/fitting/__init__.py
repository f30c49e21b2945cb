"""Parameters of a machine fitted to measurements, through contact.

==============  =================================================================================
``channels``    :class:`Channel`: what a measured channel shows
``records``     :class:`Record`, :func:`read_record`: displacements over time, refused where broken
``stretches``   the motion over a stretch of a record, from an unknown state
``shooting``    multiple shooting: residuals, derivatives through contact, rounds
``starts``      what free flights determine, and where a record is cut
``fitted``      :func:`fit`: the verb, and :class:`Fit`: values, intervals, what the record does not determine
==============  =================================================================================
"""

from carom.fitting.channels import Channel
from carom.fitting.fitted import Estimate, Fit, fit
from carom.fitting.records import Record, read_record

__all__ = ["Channel", "Estimate", "Fit", "Record", "fit", "read_record"]
