"""The command line.

A module for each command (``study``, ``simulate``, ``drop``, ``orbits``, ``attractors``, ``prove``, ``response``, ``bifurcations``,
``regions``, ``basins``, ``fit``, ``sweep``, ``paper``, ``explore``, ``template``, ``import_rotor``), and what they share:

=================  ==================================================================================================================
``app``            all commands, and how errors are reported
``options``        options that commands share, and how one is declared
``terminal``       progress, the machine that is read, and what is handed over: figures and numbers in the directory of ``--out``, JSON or a text
``screen``         output with control characters escaped, and the one renderer of tables, whose cells never wrap
``tables``         tables of ``study`` and ``orbits``, and of one motion: its contacts, its loads, and where it is at the end
``basin_tables``   what ``basins`` prints
``starts``         starts, times, ranges and planes from text, with or without units, and how a motion begins
``recovery``       ``drop --recovery``: the share of drops that comes back
``logs``           contact logs as rows and as files
=================  ==================================================================================================================

Modules here import only what the help needs; commands import the rest when they run.
"""

from carom.cli.app import main

__all__ = ["main"]
