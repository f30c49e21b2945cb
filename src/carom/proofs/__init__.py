"""Theorems about one machine, or about a box of machines, in ball arithmetic.

==================  ==============================================================
``hypotheses``      the numbers of a machine exactly as they are given
``balls``           exact numbers to balls, balls to decimal enclosures
``rotor``           a rotor whose numbers are balls, and the conditions of stability
``cells``           signs of an analytic function on intervals
``periods``         all roots of ``F₁``
``single_impact``   orbits with one impact a period: existence, course, stability
``slip``            no orbit stops its slip
``steady``          levitation, rubs, harmless kicks
``rubs``            what acts along the wall next to a rub
``whirl``           rolling in backward whirl, what leads to it, and where there is none
``runs``            parts of such an interval as a claim
``series``          functions of balls and of power series of balls
``courses``         orbits with one impact a period with their derivatives
``krawczyk``        zeros of systems, enclosed and unique
``lines``           numbers of the equations; machines that differ in one
``blocks``          an orbit on an interval of a parameter, by mean value forms
``block_orbits``    all orbits on such an interval
``ranges``          claims about an interval of a parameter
``points``          bifurcation points along a parameter
``flights``         whether a flight stays inside the wall
``words``           motions with several impacts a period, by shooting
``several_impacts`` claims about them
``seeds``           what is looked at, found in double precision
``claims``          claims and proofs
``headlines``       a theorem in one sentence with its numbers in the units of the machine
``proven_kicks``    what a proof shows of a disc of kicks, for figures and studies
``evidence``        what a search found, so that a check need not search
``theorems``        the theorems by name
``proving``         prove, at a precision that rises by itself
``patches``         patches of states, and the flights that leave them
``moments``         all flights of a patch at a time
``passages``        what happens next on all flights of a patch
``impacts``         states after an impact
``mean_values``     numbers with derivatives by a few unknowns, in balls
``bends``           second derivatives of where flights reach the wall
``rub_traps``       a region around a stable rub from which no bounce gets out
``recoveries``      whether all states of a patch return
``boxes``           boxes of machines
``sides``           by how much a parameter of a box moves flights
``plain_flights``   flights in double precision
``steady_lines``    levitation, rubs, whirl and harmless kicks along a parameter
``starts``          how a disturbance takes a rotor out of levitation
``families``        kicks, shocks and steps of the unbalance: sizes and words
``kick_cells``      a disc of kicks, or of others, as cells that halve one another
``kick_discs``      what is proven of a cell
``kick_search``     the search for cells, in several processes
``kick_claims``     claims about kicks, of one machine or of a box of them
``stated_equations``  the equations of any rotor as hypotheses
``levitation_claims``  levitation of any rotor, and what never touches
``kicks``           prove_kicks, as far as a time allows
``shocks``          the same for shocks and steps of the unbalance
``sizes``           the largest size that a theorem is about
``forms``           quadratic forms that fall in flight and in contact
``impact_states``   all states in which motions first meet the wall
``form_search``     which forms show that all states return
``lost_states``     motions that never return
``state_claims``    claims about all states up to a speed
``states``          prove_states
``certificates``    proofs as JSON, and their check
==================  ==============================================================
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
from carom.proofs.kicks import prove_kicks
from carom.proofs.proven_kicks import ProvenKicks
from carom.proofs.proving import prove, prove_levitation
from carom.proofs.shocks import prove_shocks, prove_unbalance_steps
from carom.proofs.states import prove_states

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
