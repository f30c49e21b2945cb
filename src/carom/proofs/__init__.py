"""Theorems about one machine, or about a box of machines, in ball arithmetic.

==================  =====================================================
``hypotheses``      the numbers of a machine exactly as they are given
``balls``           exact numbers to balls, balls to decimal enclosures
``rotor``           closed forms of the planar rotor in ball arithmetic
``claims``          claims and proofs
``evidence``        what a search found, so that a check need not search
==================  =====================================================
"""

from carom.outcome import CaromError

try:
    import flint  # noqa: F401
except ImportError:
    raise CaromError('proofs need python-flint; install it with: pip install "carom[proof]"') from None

from carom.proofs.claims import Claim, Proof
from carom.proofs.hypotheses import Hypotheses, hypotheses_of

__all__ = ["Claim", "Hypotheses", "Proof", "hypotheses_of"]
