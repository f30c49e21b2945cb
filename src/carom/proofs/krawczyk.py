"""Zeros of systems of equations: existence and uniqueness by the operator of Krawczyk, in ball arithmetic."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from flint import arb, arb_mat, arb_series, ctx

from carom.proofs.balls import exact_ends, rational
from carom.proofs.claims import Document, rational_of
from carom.proofs.series import terms

System = Callable[..., Sequence[arb | arb_series]]
"""Takes as many balls or power series as it gives."""
STEPS = 14
"""Largest number of steps of Newton's method."""
_WIDTHS = (8, 12, 16, 20, 26, 32, 40, 50, 64, 80, 100)
"""Widths of the boxes that are tried: these powers of 1/2, relative to the unknowns."""


def derivatives(system: System, box: Sequence[arb]) -> tuple[list[arb], arb_mat]:
    """Values of a system on a box and its Jacobian, an ``arb_mat``."""
    columns, values = [], []
    with terms(2):
        for place in range(len(box)):
            found = system(*(arb_series([x, 1]) if k == place else x for k, x in enumerate(box)))
            series = [f if isinstance(f, arb_series) else arb_series([f]) for f in found]
            columns.append([f[1] for f in series])
            values = [f[0] for f in series]
    return values, arb_mat([[column[row] for column in columns] for row in range(len(values))])


def newton(system: System, guess: Sequence[arb | float]) -> list[arb] | None:
    """Zero near a guess by Newton's method, not proven; ``None`` if the method fails."""
    place = [arb(x).mid() for x in guess]
    for _ in range(STEPS):
        try:
            values, jacobian = derivatives(system, place)
            change = jacobian.mid().solve(arb_mat([[value.mid()] for value in values]))
        except (ValueError, ZeroDivisionError):
            return None
        place = [(x - change[k, 0]).mid() for k, x in enumerate(place)]
        if not all(x.is_finite() for x in place):
            return None
        if all(abs(change[k, 0]) <= abs(x) * arb(2) ** (-ctx.prec // 2) for k, x in enumerate(place)):
            return place
    return None


def enclosed_zero(system: System, centre: Sequence[arb], width: int | None = None) -> tuple[list[arb], int] | None:
    """Balls that contain a zero of a system, which is the only one in a wider box, and the width of that box.

    The operator ``K(X) = c − Y f(c) + (1 − Y f'(X))(X − c)`` maps a box into its interior only if the box has exactly one
    zero.  It then lies in ``K(X)``.  The centre is exact, next to the zero.  The width is ``2**-width`` relative to the centre; if
    it is given, no other box is tried.  ``None`` if no box shows a zero.
    """
    try:
        values, jacobian = derivatives(system, centre)
        inverse = jacobian.mid().inv().mid()
    except (ValueError, ZeroDivisionError):
        return None
    shift = inverse * arb_mat([[value] for value in values])

    def image(box: list[arb]) -> list[arb] | None:
        try:
            _, slopes = derivatives(system, box)
        except (ValueError, ZeroDivisionError):
            return None
        count = len(box)
        unit = arb_mat(count, count, [int(i == j) for i in range(count) for j in range(count)])
        away = arb_mat([[x - c] for x, c in zip(box, centre, strict=True)])
        found = arb_mat([[c] for c in centre]) - shift + (unit - inverse * slopes) * away
        return [found[k, 0] for k in range(count)]

    for bits in _WIDTHS if width is None else (width,):
        box = box_around(centre, bits)
        inner = image(box)
        if inner is None or not all(x.contains_interior(y) for x, y in zip(box, inner, strict=True)):
            continue
        for _ in range(6):
            again = image(inner)
            if again is None or not all(x.overlaps(y) for x, y in zip(inner, again, strict=True)):
                break
            narrow = [x.intersection(y) for x, y in zip(inner, again, strict=True)]
            gained = any(x.rad() < 0.5 * y.rad() for x, y in zip(narrow, inner, strict=True))
            inner = narrow
            if not gained:
                break
        return inner, bits
    return None


def box_around(centre: Sequence[arb], width: int) -> list[arb]:
    """The box ``2**-width`` wide around a centre, relative to that, in which a zero is unique."""
    return [c + arb(0, (arb(2) ** -width * (abs(c) + 2**-10)).upper()) for c in centre]


def box_of(evidence: Document) -> list[arb]:
    """The box in which the zero of such evidence is unique."""
    centre = [rational(rational_of(text)).mid() for text in evidence["centre"]]
    return box_around(centre, int(evidence["width"]))


def found_zero(system: System, guess: Sequence[arb | float]) -> tuple[dict[str, object], list[arb]] | None:
    """Evidence of a zero near a guess, for a certificate, and balls that contain it; ``None`` if none is shown."""
    centre = newton(system, guess)
    found = None if centre is None else enclosed_zero(system, centre)
    if centre is None or found is None:
        return None
    return {"centre": [str(exact_ends(x)[0]) for x in centre], "width": found[1]}, found[0]


def shown_zero(system: System, evidence: Document) -> list[arb] | None:
    """Balls that contain the zero of such evidence; ``None`` if it shows none."""
    centre = [rational(rational_of(text)).mid() for text in evidence["centre"]]
    found = enclosed_zero(system, centre, int(evidence["width"]))
    return None if found is None else found[0]
