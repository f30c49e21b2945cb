r"""Speeds at which the two whirl frequencies of a disc, as the turning rotor sees them, are in a ratio of whole numbers.

A disc that tilts, with the natural frequency at rest as the unit of time, the polar inertia ``J_p`` per diametral one and no
damping, obeys ``z̈ − iJ_pΩż + z = 0`` in the fixed frame.  It whirls as ``e^{iat}`` forward and as ``e^{−it/a}`` backward, where

    a − 1/a = J_pΩ.

In the frame that turns with the rotor the frequencies are ``a − Ω`` and ``−1/a − Ω``.  Above its critical speed, ``Ω > a``, both
whirls go backward there, and contacts can feed one from the other where ``Ω + 1/a = (p/q)(Ω − a)``.  Multiplied by ``J_pq``, with
``J_pΩ = a − 1/a``, that is ``(p − q)(a − 1/a) = J_p(pa + q/a)``, so

    a² = (p − q + J_pq)/(p − q − J_pp),      Ω = (p + q)/√((p − q + J_pq)(p − q − J_pp)),

for ``J_p < (p − q)/p``; a thicker gyroscopic coupling keeps the whirls apart at all speeds.  Unbalance and damping shift it.
"""

from __future__ import annotations

import math

from carom.arguments import Count, NotNegative, checked
from carom.outcome import InputError


@checked
def internal_resonance(polar_inertia: NotNegative, backward: Count, forward: Count = 1) -> float:
    """Speed of an internal resonance between forward and backward whirl, derived in :mod:`carom.closed_forms.whirl_resonance`.

    Parameters
    ----------
    polar_inertia : float
        ``J_p``, per diametral inertia about the pivot; zero for a disc that does not tilt.
    backward, forward : int
        ``p`` and ``q``: the frequencies of backward and forward whirl in the turning frame are as ``p`` to ``q``, ``p > q``.

    Returns
    -------
    float
        ``Ω``, in units of the natural frequency of the rotor at rest; above the critical speed.

    Raises
    ------
    InputError
        ``p`` does not exceed ``q``, or the polar inertia is too large for this ratio.

    See Also
    --------
    carom.find_equilibria : the synchronous rubs of such a rotor

    Examples
    --------
    >>> import carom as cm
    >>> round(cm.closed_forms.internal_resonance(0.143, 2), 7)
    3.3208483
    """
    if backward <= forward:
        raise InputError(
            "backward", backward, f"a whole number above {forward}: backward whirl is the faster one there"
        )
    gap = backward - forward
    rest = gap - polar_inertia * backward
    if rest <= 0.0:
        allowed = f"below {gap}/{backward}: above, the whirls are in no ratio of {backward} to {forward}"
        raise InputError("polar_inertia", polar_inertia, allowed)
    return (backward + forward) / math.sqrt((gap + polar_inertia * forward) * rest)
