"""Hypotheses of a theorem about any rotor: its equations of motion in the fixed frame, as doubles that count exactly."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
from flint import acb, acb_mat, arb

from carom.base.outcome import InputError
from carom.models import Rotor
from carom.proofs.evidence import NotShownError

LARGEST = 400
"""Most coordinates of a rotor."""


@dataclass(frozen=True)
class StatedEquations:
    """``M z̈ + C ż + K z + C′ z̄˙ + K′ z̄ = f e^{it} + g`` with the displacement ``W z`` at the touchdown bearings, in units of the model.

    Attributes
    ----------
    numbers : mapping of str to lists
        Each array as text of its doubles: ``mass``, ``damping`` (with the gyroscopic terms), ``stiffness``, ``across`` (``C′``, ``K′``), ``forcing`` ``f``,
        ``weight`` ``g``, ``planes`` ``W``, ``translation`` (the change of the rates by a kick), ``push`` (the force of an unbalance of one) and
        ``limits`` of the magnetic bearings: rows by ``z``, then by ``ż``, then the bound; and ``units``: the speed and the length in SI units that count
        one, none if they are not known.
    values : mapping of str to str
        What is assumed, in words.
    """

    numbers: Mapping[str, Any]
    values: Mapping[str, str]
    settings: Mapping[str, str] = field(default_factory=dict)
    helpers: Mapping[str, str] = field(default_factory=dict)

    table: ClassVar[str] = "equations"
    exact: ClassVar[bool] = True

    @classmethod
    def of(cls, model: Rotor) -> StatedEquations:
        """Equations of a rotor; of a flexible machine with all its modes.

        Raises
        ------
        InputError
            A force acts that changes in the fixed frame, or the rotor has more coordinates than can be treated.
        """
        reduced = model.finite_elements
        whole = model if reduced is None else reduced.machine.whole.model
        system, n = whole.system, len(whole.system.rest)
        if system.is_externally_forced:
            system.refuse_non_stationary()
        if n > LARGEST:
            raise InputError("machine", f"{n} coordinates", f"at most {LARGEST} for a theorem")
        mass, damping, gyroscopic, stiffness, forcing = whole.matrices
        weight = np.sum([force.accelerations for force in (*whole.forces, *whole.definition.pull)], axis=0) * np.ones(n)
        across, push = whole.equations.conjugate, np.zeros(n)
        with suppress(InputError):  # of several nodes with an unbalance, a step of which is meant?
            push = whole.definition.unbalance_push()
        limits = [[*each.displacement, *each.velocity, each.bound] for each in whole.listed_limits]
        given = {
            "mass": mass,
            "damping": damping - 1j * gyroscopic,
            "stiffness": stiffness,
            "across": np.zeros((0, n, n)) if across is None else across,
            "forcing": forcing,
            "weight": mass @ weight,
            "planes": system.planes,
            "translation": system.translated,
            "push": push,
            "limits": np.array(limits).reshape(-1, 2 * n + 1),
            "units": np.array([whole.scales.velocity, whole.scales.length] if whole.scales else []),
        }
        parts = "all modes of the flexible rotor" if reduced is not None else "the rotor"
        values = {"equations": f"{n} coordinates of {parts}, doubles of the machine's numbers"}
        return cls({name: text_of(np.asarray(array, complex)) for name, array in given.items()}, values)

    def array(self, name: str) -> np.ndarray:
        """An array in doubles."""
        return array_of(self.numbers[name])

    def document(self) -> dict[str, Any]:
        """As plain data for JSON."""
        return {"table": self.table, "numbers": dict(self.numbers), "values": dict(self.values)}

    @classmethod
    def from_document(cls, document: Mapping[str, Any]) -> StatedEquations:
        """Read what :meth:`document` gives."""
        if sorted(document) != ["numbers", "table", "values"] or document["table"] != cls.table:
            raise NotShownError("its hypotheses are no equations of a rotor")
        return cls(document["numbers"], document["values"])


def text_of(array: np.ndarray) -> dict[str, object]:
    """An array as text of its doubles, with its shape."""
    pairs = np.stack([array.real.ravel(), array.imag.ravel()], axis=1).ravel()
    return {
        "shape": list(array.shape),
        "doubles": " ".join("0" if each == 0.0 else each.hex() for each in pairs.tolist()),
    }


def array_of(text: Any) -> np.ndarray:
    """The array of such a text."""
    pairs = np.array([float.fromhex(each) for each in text["doubles"].split()]).reshape(-1, 2)
    if not np.isfinite(pairs).all():
        raise NotShownError("a number is not finite")
    return (pairs[:, 0] + 1j * pairs[:, 1]).reshape(text["shape"])


def balls(array: np.ndarray) -> acb_mat:
    """Matrix of exact balls of an array of doubles; a vector is a column."""
    whole = array if array.ndim == 2 else array[:, None]
    return acb_mat(
        whole.shape[0], whole.shape[1], [acb(arb(each.real), arb(each.imag)) for each in whole.ravel().tolist()]
    )
