"""The machine of the source paper: the data of section 2, and the parameters that its figures vary."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from string import Template
from types import MappingProxyType
from typing import Any

from carom.parameters import Parameters, Scales

CITATION = (
    "K. Mora, C. Budd, P. Glendinning and P. Keogh, Non-smooth Hopf-type bifurcations arising from impact-friction "
    "contact events in rotating machinery, Proc. R. Soc. A 470, 20130490 (2014), doi:10.1098/rspa.2013.0490"
)

_PRINTED: dict[str, list[dict[str, str]]] = tomllib.loads(
    Path(__file__).with_name("printed.toml").read_text(encoding="utf-8")
)
GIVEN = MappingProxyType(
    {
        row["value"]: float(row["printed"])
        for row in _PRINTED["numbers"]
        if (row["place"], row.get("kind")) == ("section 2", "given")
    }
)
"""Section 2, in SI units (read-only)."""

SCALES = Scales(mass=GIVEN["mass"], clearance=GIVEN["clearance"], speed=GIVEN["speed"])


def machine_at(gamma: float, omega: float = 0.76) -> Parameters:
    """Return the parameters of the figures, all others as given; the default ``ω = 0.76`` is rounded as in the paper."""
    return Parameters(
        gamma=gamma,
        omega=omega,
        rho=3.0 / 7.0,
        phi=GIVEN["unbalance_phase"],
        mu=GIVEN["friction"],
        d=GIVEN["restitution"],
        radius_ratio=GIVEN["rotor_radius"] / GIVEN["clearance"],
        scales=SCALES,
    )


def printed_texts(table: str, found: Mapping[str, str]) -> Iterator[dict[str, Any]]:
    """Entries of a table of ``printed.toml``, what the paper prints and what is said of it, with what was ``found`` in them."""
    for entry in _PRINTED[table]:
        yield {name: Template(text).substitute(found) for name, text in entry.items()}
