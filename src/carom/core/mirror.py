"""Bearings that act differently in two directions: a force there pushes by its mirror image too.

In the fixed frame such a rotor obeys equations of ``Z`` and its conjugate.  With ``U = Ze^{−it}`` and ``V = Z̄e^{−it}`` these have constant
coefficients in the frame that turns with the shaft too, so ``U`` is a sum of exponentials, of twice as many modes.  A force ``f`` on ``U`` is a force
``f̄e^{−2it}`` on ``V``, so it acts on the amplitudes as

    ċ = Mc + Bf + B′f̄τ,      τ = e^{−2it}.

The turn ``τ`` is the amplitude of a mode that nothing changes, whose number is ``rotor.mirror[0]``; so states, and what is compared of them,
know how the bearings stand to the rotor.  Masses are alike in both directions: ``WB′`` and ``WMB′`` vanish, and a force accelerates
the planes as it does without such bearings.
"""

from __future__ import annotations

from carom.core.compiling.decorators import inlined


@inlined
def drive_by_mirror(rotor, k, work):
    """Add what the mirror images of contact forces, and of what lies beyond limits, do to the coefficients ``k + 1`` of the amplitudes."""
    turn, share = rotor.mirror[0], 1.0 / (k + 1)
    for plane in range(rotor.mirror_columns.shape[1]):
        mirrored = 0j
        for j in range(k + 1):
            mirrored += work.force[plane, j].conjugate() * work.series[k - j, turn]
        for m in range(work.series.shape[1]):
            work.series[k + 1, m] += rotor.mirror_columns[m, plane] * mirrored * share
    for each in range(rotor.limit_bounds.shape[0]):
        mirrored = 0j
        for j in range(k + 1):
            mirrored += work.excess[each, j].conjugate() * work.series[k - j, turn]
        for m in range(work.series.shape[1]):
            work.series[k + 1, m] += rotor.limit_mirrors[m, each] * mirrored * share
