"""Table of the steady motions and orbits of a machine."""

from __future__ import annotations

from dataclasses import asdict

from carom.closed_forms import find_equilibria
from carom.closed_forms.exact_results import exact_results
from carom.models import Rotor
from carom.orbits import Orbit
from carom.orbits.single_impact import orbits_within_reach
from carom.studies import Wording
from carom.studies.summaries import simple_motion_rows, steady_rows

NO_ORBITS = (
    "Orbits are not searched on this page: only those on a rigid wall that stands still, of a rotor with one mass, have closed forms. "
    "carom orbits searches them."
)
"""What is said in place of orbits that are not known in closed form."""


def table_of(rotor: Rotor) -> dict[str, object]:
    """Compute the ``rows`` of the table, and the ``argument`` why no orbit is missing; of a rotor whose orbits are not known in closed form it has the steady motions.

    Refuse one that never is at rest in the co-rotating frame.
    """
    if not exact_results(rotor).orbits:
        steady = steady_rows(find_equilibria(rotor).members, Wording(rotor.scales))
        return {"rows": [asdict(row) for row in steady], "argument": NO_ORBITS}
    orbits = orbits_within_reach(rotor)
    texts = {f"orbit {orbit.name}": _multipliers(orbit) for orbit in orbits if orbit.admissible}
    rows = simple_motion_rows(find_equilibria(rotor).members, orbits, Wording(rotor.scales))
    listed = [asdict(row) | {"multipliers": texts.get(row.name, "")} for row in rows]
    return {"rows": listed, "argument": orbits.argument}


def _multipliers(orbit: Orbit) -> str:
    """Non-trivial multipliers, the largest first; of a conjugate pair one, with a double sign."""
    texts = []
    for value in orbit.multipliers.values.tolist():
        if value.imag < 0.0:
            continue
        sign = "−" if value.real < 0.0 else ""
        part = f" ± {value.imag:.3g}i" if value.imag > 0.0 else ""
        texts.append(f"{sign}{abs(value.real):.3g}{part}")
    return ", ".join(texts)
