"""Figures for print.  They draw results and compute nothing.

Every function returns a :class:`matplotlib.figure.Figure` drawn with carom's own style sheet.  It shows nothing and
does not change the user's settings or backend.  :mod:`carom.plots.style` explains what the colours mean.

A
figure is 180 mm wide (two columns of a page) unless its function says otherwise.  What is drawn is in
the units of the machine (ms, mm, mm/s, N, N s, rpm) if it is known in SI units, and otherwise in those of the equations.
Long motions are thinned: the first contacts, the last turns of the shaft, the position once a turn.  Virtual orbits are not drawn.

Motions and orbits are drawn by ``motions``, ``courses``, ``landings`` and ``overviews``; levitation over the speed by ``levitation``; along
parameters ``diagrams`` and ``regions``; disturbances ``basins``, ``maps`` and ``sweeps``; measurements ``fits``.  Shared are ``style`` (what colours mean),
``figure`` (a figure that keeps the style sheet, and its files), ``plane`` (the clearance circle), ``cells`` (the looks of motions) and ``words``.
"""

from __future__ import annotations

from carom.plots.basins import attractors, basin, basin_pair, proven_kicks
from carom.plots.courses import energies, radius, shock_response, touchdown
from carom.plots.diagrams import bifurcation_diagram
from carom.plots.figure import ONE_COLUMN, TWO_COLUMNS, applied, figures_for, heading, save
from carom.plots.fits import fit
from carom.plots.landings import landing, standstill
from carom.plots.levitation import campbell, mode_shapes, sensitivity, unbalance_response
from carom.plots.maps import drop_map, gain_map
from carom.plots.motions import drop_orbit, motion, orbit
from carom.plots.overviews import equilibria, equilibria_and_orbits, multipliers, overview
from carom.plots.regions import region_map
from carom.plots.style import LOOKS, OUTCOMES, Look
from carom.plots.sweeps import sweep_map

__all__ = [
    "LOOKS",
    "ONE_COLUMN",
    "OUTCOMES",
    "TWO_COLUMNS",
    "Look",
    "applied",
    "attractors",
    "basin",
    "basin_pair",
    "bifurcation_diagram",
    "campbell",
    "drop_map",
    "drop_orbit",
    "energies",
    "equilibria",
    "equilibria_and_orbits",
    "figures_for",
    "fit",
    "gain_map",
    "heading",
    "landing",
    "mode_shapes",
    "motion",
    "multipliers",
    "orbit",
    "overview",
    "proven_kicks",
    "radius",
    "region_map",
    "save",
    "sensitivity",
    "shock_response",
    "standstill",
    "sweep_map",
    "touchdown",
    "unbalance_response",
]
