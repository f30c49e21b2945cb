"""Criticality of a period doubling: the coefficient of its normal form, from derivatives of the impact map up to the third.

At a multiplier ``−1`` with ``Jq = −q``, ``pJ = −p`` and ``pq = 1``, and no other multiplier of modulus one, the impact map is on
its centre manifold, in suitable coordinates, ``ξ ↦ −ξ + bξ³ + O(ξ⁴)`` (Kuznetsov, "Elements of Applied Bifurcation Theory", section 5.4)
with

    b = p (C(q,q,q)/6 + B(q, h)),      h = (1 − J)⁻¹ B(q,q)/2,

``B`` and ``C`` the second and third derivatives.  ``h`` and ``b`` are coefficients of the image of a curve: that of ``εq`` is
``−εq + ε²B(q,q)/2 + …``, and that of ``εq + ε²h`` has ``C(q,q,q)/6 + B(q,h)`` beside ``ε³``.  So power series of one variable
suffice.

``b > 0``: *supercritical*, the orbit of twice the period is born stable if the other multipliers are inside the unit circle.
``b < 0``: *subcritical*, it is unstable.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flint import acb, acb_series, arb, arb_mat, arb_series, ctx

from carom.proofs.courses import Course
from carom.proofs.series import I, conjugate, imaginary, real, squared, terms


def flip_coefficient(course: Course) -> Any:
    """``b`` of an orbit with a multiplier ``−1``; ``q`` has the length one in ``(θ, ṙ, θ̇)``.  Not finite next to a fold."""
    jacobian = arb_mat(course.jacobian())
    one = arb_mat(3, 3, [1, 0, 0, 0, 1, 0, 0, 0, 1])
    right, left = _kernel(jacobian + one), _kernel((jacobian + one).transpose())
    scale = _product(left, right)
    with terms(4):
        found = image_of_curve(course, [arb_series([0, q]) for q in right])
        try:
            bent = (one - jacobian).solve(arb_mat([[series[2]] for series in found]))
        except ZeroDivisionError:
            return arb.nan()
        found = image_of_curve(course, [arb_series([0, q, bent[k, 0]]) for k, q in enumerate(right)])
        return _product(left, [series[3] for series in found]) / scale


def image_of_curve(course: Course, curve: Sequence[Any]) -> list[Any]:
    """Image of a curve through an orbit under the impact map with forward slip, as power series.

    The curve and its image are deviations of ``θ``, ``ṙ`` and ``θ̇``, which begin with the first power.
    """
    back, speed = course.back, course.speed
    angle, radial, angular = curve
    levitation = 1 + back.lever * speed
    place = (angle * I).exp()
    arriving = speed + radial
    leaving = (arriving + (course.angular_speed + angular) * I - back.q * arriving) * place

    def flown(late: Any) -> tuple[Any, Any]:
        away, velocity = back.numbers.fly(place - levitation, leaving, arb_series([back.period]) + late)
        return away + levitation, velocity

    # The delay makes |U| = 1 at each power in turn, as the rate of |U|² is 2ṙ at the end.
    late = arb_series([0])
    for power in range(1, ctx.cap):
        miss = squared(flown(late)[0])[power]
        late = late + arb_series([0] * power + [-miss / (2 * speed)])
    position, velocity = flown(late)
    local = velocity * conjugate(position)
    # On the orbit the position is one.
    turned = imaginary(acb_series([acb(1), *position.coeffs()[1:]]).log())
    return [arb_series([arb(0), *series.coeffs()[1:]]) for series in (turned, real(local), imaginary(local))]


def _kernel(matrix: Any) -> list[Any]:
    """Unit vector of the kernel of a matrix of rank two: the largest cross product of two rows."""
    rows = matrix.tolist()
    crosses = []
    for k in range(3):
        a, b = rows[k - 1], rows[k - 2]
        crosses.append([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
    best = max(crosses, key=lambda cross: sum(float(x.mid()) ** 2 for x in cross))
    length = _product(best, best).sqrt()
    return [x / length for x in best]


def _product(one: Sequence[Any], other: Sequence[Any]) -> Any:
    return sum((a * b for a, b in zip(one, other, strict=True)), arb(0))
