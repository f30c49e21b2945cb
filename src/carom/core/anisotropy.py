"""Anisotropic bearings: a force there pushes by its conjugate too.

In the fixed frame such a rotor obeys equations of ``Z`` and its conjugate.  With ``U = Ze^{−it}`` and ``V = Z̄e^{−it}`` these have constant
coefficients in the frame that turns with the shaft too, so ``U`` is a sum of exponentials, of twice as many modes.  A force ``f`` on ``U`` is a force
``f̄e^{−2it}`` on ``V``, so it acts on the amplitudes as

    ċ = Mc + Bf + B′f̄τ,      τ = e^{−2it}.

The turn ``τ`` is the amplitude of a mode that nothing changes, whose number is ``rotor.anisotropy[0]``; so states, and what is compared of them,
know how the bearings stand to the rotor.  Masses are alike in both directions: ``WB′`` and ``WMB′`` vanish, and a force accelerates
the stations as it does without such bearings.
"""

from __future__ import annotations

from carom.core.compiling.decorators import inlined


@inlined
def add_conjugate_forces(rotor, k, work):
    """Add what the conjugates of contact forces, and of what lies beyond limits, do to the coefficients ``k + 1`` of the amplitudes."""
    turn, share = rotor.anisotropy[0], 1.0 / (k + 1)
    for station in range(rotor.conjugate_columns.shape[1]):
        conjugated = 0j
        for j in range(k + 1):
            conjugated += work.force[station, j].conjugate() * work.series[k - j, turn]
        for m in range(work.series.shape[1]):
            work.series[k + 1, m] += rotor.conjugate_columns[m, station] * conjugated * share
    for each in range(rotor.limit_bounds.shape[0]):
        conjugated = 0j
        for j in range(k + 1):
            conjugated += work.excess[each, j].conjugate() * work.series[k - j, turn]
        for m in range(work.series.shape[1]):
            work.series[k + 1, m] += rotor.limit_conjugates[m, each] * conjugated * share
