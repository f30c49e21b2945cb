"""JSON documents: plain data from results, as text and as files.

Complex numbers are ``[re, im]``; values that are not finite are ``null``.
"""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np


def as_json(document: dict[str, object]) -> str:
    """Return a document as the text of one JSON object; characters that are not printable are escaped."""
    text = json.dumps(_plain(document), indent=2, ensure_ascii=False, allow_nan=False)
    if text.replace("\n", "").isprintable():
        return text
    return "".join(sign if sign.isprintable() or sign == "\n" else json.dumps(sign)[1:-1] for sign in text)


def write_json(target: Path, document: dict[str, object]) -> None:
    """Write a document to a file."""
    target.write_text(as_json(document) + "\n", encoding="utf-8")


def _plain(value: object) -> object:
    """Convert a value to the types of JSON."""
    if isinstance(value, dict):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, complex):
        return [_plain(value.real), _plain(value.imag)]
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value
