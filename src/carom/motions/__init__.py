"""Motions of the rotor: followed from one start or many, and evaluated.

====================  ======================================================================================
``starts``            states, and levitation
``trajectories``      one motion: its course, contacts and forces
``simulation``        from a start to a motion
``storage``           motions as datasets and files
``ensembles``         many motions, on all cores; only their endings are kept
``portions``          the work of an ensemble, shared by threads
``budget``            how many events each question of a study may take
``quiet``             when it has been quiet for a time: no contact, or no fast rotor
``settling``          how it is recognised that a motion has settled, repeats, or lies on its touchdown bearing
``contacts``          the log of contacts, of whatever law, with impulses in events and works of lasting contact
``kinematics``        speeds at the touchdown bearings, and the course there with forces and slip
``tables``            tables of columns with units
``loads``             what the touchdown bearing bears, over all stages: forces, impulses, heat, race, whirl and rest; how near magnets come
``heating``           torque of balls, temperatures and growth of a touchdown bearing
``load_sums``         loads, added up piece by piece
``standstill``        a drop followed until the shaft stands still
``descent``           its way down: torques, gyroscopic moments in steps of speed, and what is passed
``courses``           a drop sampled over all stages, to be drawn
``channels``            histories of displacements, forces, speeds and currents as sensors record them, and their files
``ledger``            energies of a motion
====================  ======================================================================================
"""

from carom.motions.channels import write_channels
from carom.motions.contacts import ContactLog
from carom.motions.ensembles import Endings, settle
from carom.motions.heating import Network, RaceRun, Temperatures, ball_torque, thermal_network
from carom.motions.kinematics import ContactHistory, LastingContact
from carom.motions.ledger import EnergyLedger, energy_ledger
from carom.motions.load_sums import drop_loads, follow_loads
from carom.motions.loads import Braking, CatalogueLoads, DropLoads, LastWhirl, TouchdownLoads
from carom.motions.settling import PATIENCE
from carom.motions.simulation import simulate
from carom.motions.standstill import SpinDown, spin_down
from carom.motions.starts import State
from carom.motions.trajectories import Trajectory

__all__ = [
    "PATIENCE",
    "Braking",
    "CatalogueLoads",
    "ContactHistory",
    "ContactLog",
    "DropLoads",
    "Endings",
    "EnergyLedger",
    "LastWhirl",
    "LastingContact",
    "Network",
    "RaceRun",
    "SpinDown",
    "State",
    "Temperatures",
    "TouchdownLoads",
    "Trajectory",
    "ball_torque",
    "drop_loads",
    "energy_ledger",
    "follow_loads",
    "settle",
    "simulate",
    "spin_down",
    "thermal_network",
    "write_channels",
]
