"""Read a machine file, of whatever rotor, as the case to study."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from carom.base.arguments import checked
from carom.base.outcome import Problems, printable
from carom.parameters.machine_file import Case, read_case, split_settings
from carom.parameters.toml_reader import read_machine_tables


@checked
def load(path: str | os.PathLike[str], settings: Iterable[str] = ()) -> Case:
    """Read a machine file and apply settings to it.

    Parameters
    ----------
    path : path
        TOML file with a ``[machine]`` or a ``[dimensionless]`` table, and perhaps ``[zones]``, ``[limits]``,
        ``[survive]``, ``[gravity]``, ``[touchdown]`` and ``[drive]``; or with a ``[rotor]`` table and those of the parts of a flexible
        machine, whose case holds a model.
    settings : iterable of str
        Texts ``"name=value"`` as in ``--set``; the name is a machine field, a dimensionless parameter, or ``gravity``
        for its acceleration, or an entry of the touchdown bearing, such as ``touchdown_stiffness``.
        Physical values are set first. A dimensionless one set on a machine keeps mass, speed and clearance and
        changes its partner: ``gamma`` the damping, ``omega`` the stiffness, ``rho`` the eccentricity, ``phi`` the
        unbalance phase, ``mu`` the friction, ``d`` the restitution, ``radius_ratio`` the rotor radius.

    Raises
    ------
    InputError
        If the file cannot be used, or a setting has no value, has an unknown name, has a value that is not allowed,
        sets the same quantity as another one, or sets a physical value of a file without scales.  Errors
        of the file and names of settings are reported together, values of settings once the file is in order.

    Warns
    -----
    CaromWarning
        The rotor radius is less than 5 clearances: a unit was probably forgotten.

    See Also
    --------
    carom.parameters.Machine : the same values, given in Python
    carom.models.Rotor : any linear rotor, from its matrices

    Examples
    --------
    >>> import carom as cm
    >>> case = cm.load("examples/keogh-cole.toml", ["speed=1500 rpm", "gamma=0.1"])
    >>> case.parameters.gamma
    0.1
    """
    problems = Problems()
    tables = read_machine_tables(path, problems)
    texts, name = split_settings(settings, problems), printable(Path(path).stem)
    return read_case(name, tables, texts, problems, _read_rotor)


def _read_rotor(*given: Any) -> dict[str, object]:
    """Read a rotor of parts; who reads a planar one does not wait for models and kernels to load."""
    from carom.rotors.machine_file import read_rotor_tables

    return read_rotor_tables(*given)
