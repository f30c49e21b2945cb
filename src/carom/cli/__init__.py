"""The command line.

A module for each command (``study``, ``simulate``, ``drop``, ``orbits``, ``attractors``, ``prove``, ``response``, ``bifurcations``
with ``regions``, ``basins``, ``sweep``, ``paper``, ``explore``, ``template``, ``import_rotor``), and what they share:

===================  ==========================================================
``app``              all commands, and how errors are reported
``terminal``         output, progress and options that commands share
``screen``           output to the terminal, with control characters escaped
``output``           the directory of ``--out``
``fitting``          tables that fit into a narrow terminal
``load_tables``      what touchdown bearings bear
``tables``           tables of ``study``, ``simulate`` and ``orbits``
``motion_tables``      one motion: its contacts, and where it is at the end
``steady``           steady motions of flexible machines
``basin_options``    options of ``basins``
``basin_tables``     what ``basins`` prints
``region_tables``    what ``regions`` prints
``starts``           starts, times and ranges from text, with or without units
``drop_map``         drops over a plane of two numbers
``proof_options``    options of prove
``release_options``  how a motion begins, as options of ``simulate`` and ``drop``
``drops``            drops, and motions in several stages
``logs``             contact logs as files
===================  ==========================================================

Modules here import only what the help needs; commands import the rest when they run.
"""

from carom.cli.app import main

__all__ = ["main"]
