"""Numba kernels: floats and arrays in, floats and outcome codes out.

Nothing here knows units, files or results.  A kernel sees a rotor as the arrays of
:class:`~carom.core.layout.RotorArrays` and works for any number of modes and contact planes.
"""
