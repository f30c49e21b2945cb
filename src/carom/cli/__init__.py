"""The command line.

=============  ==========================================================
``app``        all commands, and how errors are reported
``study``      ``carom study``
``simulate``   ``carom simulate``
``orbits``     ``carom orbits``
``basins``     ``carom basins``, its tables in ``basin_tables``
``starts``     starts and times from text, with or without units
``tables``     results as tables
``terminal``   output, progress and options that commands share
``screen``     output to the terminal, with control characters escaped
=============  ==========================================================

Modules here import only what the help needs; commands import the rest when they run.
"""

from carom.cli.app import main

__all__ = ["main"]
