"""The results as plain data, and the files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from carom.bifurcations.documents import diagram_document
from carom.files import staged_directory, write_json
from carom.reproductions.loss_of_bouncing.drawing import loss_figure
from carom.reproductions.loss_of_bouncing.following import LossOfBouncing
from carom.reproductions.loss_of_bouncing.samples import BouncingSample
from carom.results import fields_of


def loss_document(found: LossOfBouncing) -> dict[str, Any]:
    """Branches and samples as plain data for JSON."""
    return {
        "diagram": diagram_document(found.diagram),
        "samples": [_sample(sample) for sample in found.every],
        "lost_between": list(found.lost),
    }


def _sample(sample: BouncingSample) -> dict[str, Any]:
    survival = sample.lifetimes.survival
    return fields_of(sample, "gamma", "speeds", "impacts", "ended", "exponent", "error") | {
        "half_life_impacts": survival.half_life,
        "half_life_interval_impacts": [bound if bound != float("inf") else None for bound in survival.interval],
        "verdict": sample.lifetimes.verdict,
        "destinations": sample.lifetimes.destinations,
    }


def write_loss(found: LossOfBouncing, directory: str) -> list[Path]:
    """Draw the figure, and write it with the numbers; return the files written.

    Parameters
    ----------
    directory : str
        Created if it does not exist; files of the same name are replaced.

    Raises
    ------
    InputError
        The directory cannot be written.
    """
    from carom.plots import save

    with staged_directory(directory, "directory") as place:
        names = [path.name for path in save(loss_figure(found), place / "loss-of-bouncing")]
        write_json(place / "loss-of-bouncing.json", loss_document(found))
    return [Path(directory) / name for name in (*names, "loss-of-bouncing.json")]
