"""Theorems about one machine, or about a box of machines, in ball arithmetic.

=====================  ==================================================================================================
``hypotheses``         the numbers of a machine exactly as they are given, or the equations of any rotor
``balls``              exact numbers to balls, balls to decimal enclosures; functions of balls and of power series of balls
``rotor``              a rotor whose numbers are balls, and the conditions of stability
``periods``            all roots of ``F₁``
``single_impact``      orbits with one impact a period: existence, course, slip, stability
``steady``             levitation, harmless kicks, rubs and what acts along the wall next to one
``whirl``              rolling in backward whirl, what leads to it, and where there is none
``courses``            orbits with one impact a period with their derivatives; whether a flight stays inside the wall
``zeros``              zeros of a function on intervals, and of systems, enclosed and unique
``lines``              numbers of the equations; machines that differ in one, and where something holds
``blocks``             an orbit on an interval of a parameter, by mean value forms
``block_orbits``       all orbits on such an interval
``ranges``             claims about an interval of a parameter
``points``             bifurcation points along a parameter
``several_impacts``    motions with several impacts a period, by shooting
``seeds``              what is looked at, found in double precision
``claims``             claims, proofs and evidence, which a search found, so that a check need not
``headlines``          a theorem in one sentence with its numbers in the units of the machine
``proven_kicks``       what a proof shows of a disc of kicks, for figures and studies
``proving``            the theorems by name; prove, at a precision that rises by itself
``patches``            patches of states, and the flights that leave them, also in double precision
``moments``            all flights of a patch at a time, as numbers with derivatives
``passages``           what happens next on all flights of a patch
``bends``              second derivatives of where flights reach the wall
``rub_traps``          a region around a stable rub from which no bounce gets out
``recoveries``         states after an impact, and whether all states of a patch return
``sides``              by how much a parameter of a box moves flights
``steady_lines``       levitation, rubs, whirl and harmless kicks along a parameter
``starts``             how a disturbance takes a rotor out of levitation
``families``           kicks, shocks and steps of the unbalance: sizes and words
``kick_cells``         a disc of kicks, or of others, and a box of machines, as cells that halve one another
``kick_discs``         what is proven of a cell
``kick_search``        the search for cells, in several processes
``kick_claims``        claims about kicks, of one machine or of a box of them
``levitation_claims``  levitation of any rotor, and what never touches
``recovering``         prove that kicks, shocks, steps of the unbalance and all states come back, as far as a time allows
``forms``              quadratic forms that fall in flight and in contact, and the states that they hold
``form_search``        which forms show that all states return
``state_claims``       claims about all states up to a speed, and motions that never return
``certificates``       proofs as JSON, and their check
=====================  ==================================================================================================
"""

from carom.base.outcome import CaromError

try:
    import flint  # noqa: F401
except ImportError:
    raise CaromError('proofs need python-flint; install it with: pip install "carom[proof]"') from None

from carom.proofs.balls import Enclosure
from carom.proofs.certificates import check
from carom.proofs.claims import Claim, Proof
from carom.proofs.hypotheses import Hypotheses, hypotheses_of
from carom.proofs.proven_kicks import ProvenKicks
from carom.proofs.proving import prove, prove_levitation
from carom.proofs.recovering import prove_kicks, prove_shocks, prove_states, prove_unbalance_steps

__all__ = [
    "Claim",
    "Enclosure",
    "Hypotheses",
    "Proof",
    "ProvenKicks",
    "check",
    "hypotheses_of",
    "prove",
    "prove_kicks",
    "prove_levitation",
    "prove_shocks",
    "prove_states",
    "prove_unbalance_steps",
]
