"""The command line.

=============  ==========================================================
``app``        the commands together, and how errors are told
``study``      ``carom study``
``simulate``   ``carom simulate``
``orbits``     ``carom orbits``
``basins``     ``carom basins``, its tables in ``basin_tables``
``starts``     starts and times from text, with or without units
``tables``     tables for people
``terminal``   output, progress and options that commands share
``screen``     no control character of a name or a file reaches the terminal
=============  ==========================================================

Modules here import only what is needed to show help; commands load the rest when they run.
"""

from carom.cli.app import main

__all__ = ["main"]
