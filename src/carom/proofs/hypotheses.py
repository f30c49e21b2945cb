"""Hypotheses of a proof: the numbers of a machine exactly as they are given, and the dimensionless ones that follow.

The equations hold only ``ω²``, never ``ω``.  So all numbers of the equations are rational functions of those of a machine.
They are rational if these are, up to a power of π where an angular speed is counted in turns.

Those of a theorem about any rotor are its equations of motion in the fixed frame, as doubles that count exactly.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from decimal import Decimal
from fractions import Fraction
from functools import cached_property
from typing import Any, ClassVar, Literal, TypeVar, cast

import numpy as np
from flint import acb, acb_mat, arb, arb_series

from carom.base.arguments import checked
from carom.base.outcome import InputError, Problems, shown, together
from carom.loading import load
from carom.models import Rotor, Subject, exact_rotor_of
from carom.parameters import DIMENSIONLESS_FIELDS, HELPER_FIELDS, MACHINE_FIELDS, PARAMETERS, TERMS
from carom.parameters.fields import name_errors, unknown_name
from carom.parameters.machine_file import split_settings
from carom.parameters.quantities import ExactNumber, Written, read_exact
from carom.parameters.terms import DEFAULTS, check_names
from carom.proofs.claims import Document, NotShownError

Given = str | int | float | Fraction | Decimal | tuple[Any, Any]
"""A number as it may be given: a float stands for itself, a tuple for an interval."""
_Number = TypeVar("_Number", ExactNumber, arb | arb_series)
NUMBERS = ("gamma", "omega_squared", "rho", "mu", "d", "radius_ratio")
"""The numbers that the equations hold.  The phase ``φ`` of the unbalance only turns motions."""


@dataclass(frozen=True)
class Hypotheses:
    """What a proof assumes: a machine, or a box of machines, by exact numbers.

    Attributes
    ----------
    table : {"machine", "dimensionless"}
        Which names the values have.
    values : mapping of str to str
        Each number of the table as it was given: ``"0.76"``, ``"3/7"``, ``"50 kg"``, ``"double 0.1"`` or ``"[0.1, 0.2]"``.
    settings : mapping of str to str
        Dimensionless numbers that replace what follows from a machine.
    helpers : mapping of str to str
        Entries of the machine's file that a term needs along which something is proven, such as ``force_current_factor``.

    Raises
    ------
    InputError
        A name is unknown or missing, or a number not allowed.
    """

    table: Literal["machine", "dimensionless"]
    values: Mapping[str, str]
    settings: Mapping[str, str]
    helpers: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        fields = MACHINE_FIELDS if self.table == "machine" else DIMENSIONLESS_FIELDS
        errors = name_errors(self.values, fields, f"[{self.table}]")
        helpers = HELPER_FIELDS if self.table == "machine" else {}
        for given, known, where in (
            (self.settings, DIMENSIONLESS_FIELDS, "the settings"),
            (self.helpers, helpers, "the entries of the machine's file"),
        ):
            errors += [unknown_name(name, text, known, where) for name, text in given.items() if name not in known]
        if errors:
            raise together(errors)
        self.numbers  # noqa: B018  (raises if a value is not allowed)
        for name, text in self.helpers.items():
            read_exact(HELPER_FIELDS[name], text)

    @cached_property
    def numbers(self) -> Mapping[str, ExactNumber]:
        """The numbers of :data:`NUMBERS` and ``phi``, exactly."""
        found: dict[str, ExactNumber] = {}
        if self.table == "machine":
            machine = {name: read_exact(MACHINE_FIELDS[name], text) for name, text in self.values.items()}
            found = {**dimensionless_of(machine), "phi": machine["unbalance_phase"]}
        given = self.settings if self.table == "machine" else {**self.values, **self.settings}
        for name, text in given.items():
            number = read_exact(DIMENSIONLESS_FIELDS[name], text)
            if name == "omega":
                name, number = "omega_squared", number * number
            found[name] = number
        return found

    @property
    def exact(self) -> bool:
        """Whether it is one machine, not a box of them."""
        return all(self.numbers[name].low == self.numbers[name].high for name in NUMBERS)

    def rational(self, *names: str) -> tuple[Fraction, ...] | None:
        """These numbers, if each is a single rational number."""
        found = [self.numbers[name].rational for name in names]
        return None if any(number is None for number in found) else cast("tuple[Fraction, ...]", tuple(found))

    def replace(self, **changes: Given) -> Hypotheses:
        """The same with other numbers, by the names of the table or of dimensionless numbers."""
        written = {name: written_exactly(value) for name, value in changes.items()}
        values = {**self.values, **{name: text for name, text in written.items() if name in self.values}}
        rest = {name: text for name, text in written.items() if name not in self.values}
        return Hypotheses(self.table, values, {**self.settings, **rest}, self.helpers)

    def document(self) -> dict[str, object]:
        """As plain data for JSON; ``exact`` holds what follows, for the reader."""
        exact = {name: str(self.numbers[name]) for name in (*NUMBERS, "phi")}
        stated = {"helpers": dict(self.helpers)} if self.helpers else {}
        return {
            "table": self.table,
            "values": dict(self.values),
            "settings": dict(self.settings),
            **stated,
            "exact": exact,
        }

    @classmethod
    def from_document(cls, document: Document) -> Hypotheses:
        """Read what :meth:`document` gives.

        Raises
        ------
        InputError
            It is not such data, or the numbers do not follow from those given.
        """
        try:
            tables = [document["values"], document["settings"], document.get("helpers", {})]
            if document["table"] not in ("machine", "dimensionless"):
                raise KeyError("table")
            if not all(isinstance(text, str) for table in tables for text in table.values()):
                raise TypeError("text")
            read = cls(document["table"], *tables)
        except (AttributeError, IndexError, KeyError, TypeError) as problem:
            raise InputError("hypotheses", shown(problem), "must be those of a certificate") from None
        if read.document() != dict(document):
            raise InputError(
                "hypotheses", shown(document.get("exact")), "the exact numbers do not follow from those given"
            )
        return read


def dimensionless_of(machine: Mapping[str, _Number]) -> dict[str, _Number]:
    """The numbers of :data:`NUMBERS` that follow from those of a machine: exact numbers, balls or power series."""
    speed = machine["speed"]
    return {
        "gamma": machine["damping"] / (machine["mass"] * speed),
        "omega_squared": machine["stiffness"] / (machine["mass"] * speed * speed),
        "rho": machine["eccentricity"] / machine["clearance"],
        "mu": machine["friction"],
        "d": machine["restitution"],
        "radius_ratio": machine["rotor_radius"] / machine["clearance"],
    }


@checked
def hypotheses_of(
    machine: Subject | Hypotheses | str | os.PathLike[str] | Mapping[str, Given],
    settings: Iterable[str] = (),
    along: Iterable[str] = (),
) -> Hypotheses:
    """Hypotheses of any description of a rotor.

    Parameters
    ----------
    machine : Machine, Case, Parameters, model, path, mapping or Hypotheses
        A file counts as it is written, to the last decimal.  A mapping holds dimensionless numbers by name.  All others, and
        floats, count as doubles.
    settings : iterable of str
        Texts ``"name=value"`` that change the numbers of a file.
    along : iterable of str
        Parameters along which something is to be proven: what terms among them need of the file is kept.

    Raises
    ------
    InputError
        It is none of these, or a number is not allowed.
    """
    given = list(settings)
    if isinstance(machine, str | os.PathLike):
        return _from_file(machine, given, [need for name in along if name in TERMS for need in TERMS[name].needs])
    if given:
        raise InputError("settings", given, "for a file only: give a machine with the values wanted")
    if isinstance(machine, Hypotheses):
        return machine
    if isinstance(machine, Mapping):
        return Hypotheses("dimensionless", {name: written_exactly(value) for name, value in machine.items()}, {})
    numbers = exact_rotor_of(machine).parameters.as_dict()
    return Hypotheses("dimensionless", {name: written_exactly(value) for name, value in numbers.items()}, {})


def _from_file(path: str | os.PathLike[str], settings: list[str], needs: list[str]) -> Hypotheses:
    """Numbers of a file as they are written, with what is needed of its other entries; of those that follow from other terms, the nearest doubles."""
    problems = Problems()
    texts = split_settings(settings, problems)
    pull = [f"gravity={texts.pop('gravity')}"] if "gravity" in texts else []
    problems.attempt(check_names, texts)
    problems.raise_all()
    terms = [name for name in texts if name not in PARAMETERS]
    case = load(path, [f"{name}={text}" for name, text in texts.items()] + pull if terms else pull)
    # What is proven is of planar rotors without weight and limits, in a rigid wall that stands still, at a constant speed.
    exact_rotor_of(case)
    values = {name: written_exactly(value) for name, value in case.written.items()}
    given = {name: text for name, text in texts.items() if name not in terms}
    if not case.given:
        return Hypotheses("dimensionless", values, {}).replace(**given)
    entries = {
        **DEFAULTS,
        **{name: text for each in case.given.values() for name, text in each.items()},
        **texts,
    }
    helpers = {name: written_exactly(entries[name]) for name in needs if name in HELPER_FIELDS and name in entries}
    return Hypotheses("machine", values, {}, helpers).replace(**given)


def written_exactly(value: Given) -> str:
    """A number as text that :func:`~carom.parameters.quantities.read_exact` reads back exactly."""
    if isinstance(value, tuple):
        return f"[{', '.join(written_exactly(end) for end in value)}]"
    if isinstance(value, Written):
        return value.text
    return f"double {float(value)!r}" if isinstance(value, float) else str(value)


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
        ``limits`` of the magnetic bearings: rows by ``z``, then by ``ż``, then what bias currents leave of the bound; and ``units``: the speed and the length in SI units that count
        one, none if they are not known.
    values : mapping of str to str
        What is assumed, in words.
    """

    numbers: Document
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
        weight = np.sum(
            [force.accelerations for force in (*whole.acting.forces, *whole.definition.pull)], axis=0
        ) * np.ones(n)
        across, push = whole.equations.conjugate, np.zeros(n)
        with suppress(InputError):  # of several nodes with an unbalance, a step of which is meant?
            push = whole.definition.unbalance_push()
        # Bias currents that carry the weight take their part of a limit.
        rooms = [
            np.nextafter(each.bound - abs(asked), -np.inf)
            for each, asked in zip(whole.listed_limits, whole.acting.asked_by_bias.tolist(), strict=True)
        ]
        rows = zip(whole.listed_limits, rooms, strict=True)
        limits = [[*each.displacement, *each.velocity, room] for each, room in rows]
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

    def document(self) -> dict[str, object]:
        """As plain data for JSON."""
        return {"table": self.table, "numbers": dict(self.numbers), "values": dict(self.values)}

    @classmethod
    def from_document(cls, document: Document) -> StatedEquations:
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


def array_of(text: Document) -> np.ndarray:
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
