"""The reproduction as plain data for JSON, and as a table in Markdown."""

from __future__ import annotations

from typing import Any

from carom.reproductions.mora2014.pictures import Picture
from carom.reproductions.mora2014.plane import NamedRegion
from carom.reproductions.mora2014.reproduction import Reproduction
from carom.reproductions.mora2014.source import CITATION, machine_at

__all__ = ["markdown", "paper_document"]


def paper_document(found: Reproduction, pictures: tuple[Picture, ...] = ()) -> dict[str, Any]:
    """Return all numbers with the printed ones, the misprints, and the curves and regions of figure 6b.

    Parameters
    ----------
    found : Reproduction
    pictures : tuple of Picture
        Figures that have been written.

    Returns
    -------
    dict
    """
    return {
        "source": CITATION,
        "parameters": {name: value for name, value in machine_at(0.1).as_dict().items() if name != "gamma"},
        "numbers": [
            {
                "where": row.place,
                "quantity": row.quantity,
                "kind": row.kind,
                "printed": row.printed,
                "printed_value": row.printed_value,
                "value": row.value,
                "difference": row.difference,
                "unit": row.unit,
                "agrees": row.agrees,
                "note": row.note,
            }
            for row in found.numbers
        ],
        "misprints": [
            {
                "where": row.place,
                "printed": row.printed,
                "right": row.right,
                "quantity": row.quantity,
                "printed_value": row.printed_value,
                "value": row.value,
                "difference": row.difference,
            }
            for row in found.misprints
        ],
        "claims": [
            {"where": claim.place, "statement": claim.statement, "holds": claim.holds, "found": claim.found}
            for claim in found.claims
        ],
        "curves": [
            {
                "kind": curve.kind,
                "points": curve.points.tolist(),
                "admissible": curve.admissible.tolist(),
                "ends": list(curve.stops),
            }
            for curve in found.plane.curves
        ],
        "codim2": [
            {"kind": point.kind, "value": list(point.value), "period": point.period}
            for curve in found.plane.curves
            for point in curve.codimension2
        ],
        "regions": [_region(region) for region in found.plane.regions],
        "figures": [
            {"name": picture.name, "panels": list(picture.panels), "caption": picture.caption} for picture in pictures
        ],
    }


def _region(region: NamedRegion) -> dict[str, Any]:
    motions = region.motions
    return {
        "name": region.source,
        "part": region.part,
        "point": list(region.point),
        "motions": motions.words,
        "contact_free": motions.contact_free,
        "orbits": motions.orbits,
        "stable_orbits": motions.stable_orbits,
        "rub": motions.rub,
        "rolling": motions.rolling,
        "note": region.words,
    }


def markdown(found: Reproduction) -> str:
    """Return tables of the numbers, the misprints and the regions.

    Parameters
    ----------
    found : Reproduction

    Returns
    -------
    str
    """
    lines = ["# Printed and computed", "", f"Source: {CITATION}.", "", "## Numbers", ""]
    lines += _table(
        ("where", "quantity", "printed", "computed", "difference", "note"),
        [
            (
                row.place,
                row.quantity,
                _with_unit(row.printed, row.unit),
                f"{row.value:.10g}",
                f"{row.difference:.2g}",
                row.note,
            )
            for row in found.numbers
            if row.kind != "given"
        ],
    )
    given = ", ".join(
        f"{row.quantity} = {_with_unit(row.printed, row.unit)} ({row.place})"
        for row in found.numbers
        if row.kind == "given"
    )
    lines += ["", f"Used as given: {given}.", "", "## Misprints", ""]
    lines += _table(
        ("where", "printed", "right", "evaluated", "printed form", "right form"),
        [
            (
                row.place,
                row.printed,
                row.right,
                row.quantity,
                "" if row.printed_value is None else f"{row.printed_value:.8g}",
                f"{row.value:.8g}",
            )
            for row in found.misprints
        ],
    )
    lines += ["", "## Statements", ""]
    lines += _table(
        ("where", "statement", "holds", "found"),
        [(claim.place, claim.statement, "yes" if claim.holds else "no", claim.found) for claim in found.claims],
    )
    lines += ["", "## Regions of figure 6b", ""]
    lines += _table(
        ("part", "for example at γ, ω", "simple motions", ""),
        [
            (region.part, f"{region.point[0]:g}, {region.point[1]:g}", region.motions.words, region.words)
            for region in found.plane.regions
        ],
    )
    return "\n".join(lines) + "\n"


def _with_unit(text: str, unit: str) -> str:
    return f"{text} {unit}" if unit else text


def _table(head: tuple[str, ...], rows: list[tuple[str, ...]]) -> list[str]:
    """Return a table in Markdown; vertical bars inside cells are escaped."""
    cells = [[cell.replace("|", "\\|") for cell in row] for row in rows]
    return [f"| {' | '.join(row)} |" for row in (head, ["---"] * len(head), *cells)]
