"""Motions: followed from their starts, one or many, and what they do on their way.

==================  =======================================================================
``starts``          states, and kicks out of levitation
``trajectories``    one motion
``storage``         motions as datasets and files
``ensembles``       many motions, on all cores, of which only the endings are kept
``settling``        what a motion remembers of its way, and the orbit it settles to
``contacts``        what the bearing gets: the log of impacts, stretches of lasting contact
``ledger``          energies of a motion
``spectrum``        whirl forward and backward at each multiple of the shaft speed
==================  =======================================================================
"""

from carom.motions.contacts import ContactHistory, ContactLog, LastingContact
from carom.motions.ensembles import Endings, settle
from carom.motions.ledger import EnergyLedger, energy_ledger
from carom.motions.settling import PATIENCE, ClosedOrbit, closed_orbit
from carom.motions.spectrum import FullSpectrum, full_spectrum
from carom.motions.starts import Kick, State, kick
from carom.motions.trajectories import Trajectory, simulate

__all__ = [
    "PATIENCE",
    "ClosedOrbit",
    "ContactHistory",
    "ContactLog",
    "Endings",
    "EnergyLedger",
    "FullSpectrum",
    "Kick",
    "LastingContact",
    "State",
    "Trajectory",
    "closed_orbit",
    "energy_ledger",
    "full_spectrum",
    "kick",
    "settle",
    "simulate",
]
