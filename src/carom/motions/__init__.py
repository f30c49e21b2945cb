"""Motions of the rotor: followed from one start or many, and evaluated.

====================  ======================================================================================
``starts``            states, and kicks out of levitation
``drops``             levitation lost
``trajectories``      one motion: its course, contacts and forces
``simulation``        from a start to a motion
``storage``           motions as datasets and files
``ensembles``         many motions, on all cores; only their endings are kept
``portions``          the work of an ensemble, shared by threads
``budget``            how many events each question of a study may take
``settling``          the record by which settling is recognised
``recurrence``        whether a motion that has recurred repeats or leaves, for rotors of several modes
``resting``           whether a rotor lies on its touchdown bearing
``blows``             impulses at the planes in each event, also where several are struck in one instant
``contacts``          load on the bearing: the log of impacts, stretches of lasting contact
``quadrature``        integrals along a motion
``spin``              what a shaft whose speed changes does along a motion
``touches``           contacts with walls that give way: impulses, peaks, depths, works
``loads``             loads of a touchdown: forces, impulses, heat
``bearing_loads``     the same of a drop, over all stages, with race, whirl and rest
``load_sums``         both, added up piece by piece
``last_whirl``        how a plane goes round at the end
``courses``           a drop sampled over all stages, to be drawn
``magnets``           how near a rotor comes to its magnets, and by how much their linear law is wrong there
``reduction_errors``  what the vectors left out of a flexible machine change
``ledger``            energies of a motion
``across``            energies of bearings that act differently in two directions
====================  ======================================================================================
"""

from carom.motions.bearing_loads import Braking, DropLoads, LastWhirl, PlaneLoads
from carom.motions.contacts import ContactHistory, ContactLog, LastingContact
from carom.motions.drops import Drop, Whirl, drop
from carom.motions.ensembles import Endings, settle
from carom.motions.ledger import EnergyLedger, energy_ledger
from carom.motions.load_sums import drop_loads, follow_loads, touchdown_loads
from carom.motions.loads import TouchdownLoads
from carom.motions.settling import PATIENCE
from carom.motions.simulation import simulate
from carom.motions.starts import Kick, State, kick
from carom.motions.touches import TouchLog
from carom.motions.trajectories import Trajectory

__all__ = [
    "PATIENCE",
    "Braking",
    "ContactHistory",
    "ContactLog",
    "Drop",
    "DropLoads",
    "Endings",
    "EnergyLedger",
    "Kick",
    "LastWhirl",
    "LastingContact",
    "PlaneLoads",
    "State",
    "TouchLog",
    "TouchdownLoads",
    "Trajectory",
    "Whirl",
    "drop",
    "drop_loads",
    "energy_ledger",
    "follow_loads",
    "kick",
    "settle",
    "simulate",
    "touchdown_loads",
]
