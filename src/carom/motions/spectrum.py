"""Full spectrum of a motion: forward and backward whirl at each multiple of the shaft speed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from carom.arguments import Count, checked
from carom.motions.trajectories import Trajectory
from carom.outcome import InputError
from carom.results import Result

if TYPE_CHECKING:
    from carom.parameters import Scales


@dataclass(frozen=True, eq=False, repr=False)
class FullSpectrum(Result):
    """Amplitudes of the motion in the fixed frame, ``Z(t) = Σ a e^{iνt}``.

    Attributes
    ----------
    orders : ndarray, shape (m,)
        ``ν`` in multiples of the shaft speed: positive for forward whirl, negative for backward, 1 for synchronous.
    amplitudes : ndarray of complex, shape (m,)
        In clearances.  A steady circle of radius ``r`` at an order on the grid shows the amplitude ``r``.
    resolution : float
        Smallest distance of two orders that can be distinguished, four grid steps (Hann window).
    scales : carom.parameters.Scales or None
        Those of the rotor.
    """

    figure: ClassVar[str] = "spectrum"

    orders: np.ndarray
    amplitudes: np.ndarray
    resolution: float
    scales: Scales | None = None


@checked
def full_spectrum(
    trajectory: Trajectory, since: float = 0.0, highest_order: float = 6.0, samples_per_turn: Count = 64
) -> FullSpectrum:
    """Fourier transform of the last part of a motion in the fixed frame, with a Hann window.

    The sampled stretch holds a whole number of shaft turns, so that the multiples of the shaft speed lie on the grid.

    Parameters
    ----------
    since : float
        Earliest time to include, in ``1/Ω``.
    highest_order : float
        Largest ``|ν|`` to return.
    samples_per_turn : int
        At least twice the highest order.  Corners of the path (impacts) cause aliasing that falls with its square.

    Raises
    ------
    InputError
        Less than four turns are left, or too few samples for the highest order.

    See Also
    --------
    carom.motions.energy_ledger : energies of a motion
    carom.plots.spectrum : draw it

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> spectrum = cm.motions.full_spectrum(cm.simulate(machine, cm.kick("60 mm/s"), 200.0), since=100.0)
    >>> print(spectrum.orders[abs(spectrum.amplitudes).argmax()])
    1.0
    """
    turns = int((trajectory.time - since) / (2 * np.pi))
    if since < 0.0 or turns < 4:
        raise InputError("since", since, f"between 0 and four shaft turns before the end at {trajectory.time:g}")
    if samples_per_turn < 2 * highest_order:
        raise InputError(
            "samples_per_turn", samples_per_turn, f"at least {2 * highest_order:g}, twice the highest order"
        )
    count = turns * samples_per_turn
    times = trajectory.time - 2 * np.pi * turns * (1.0 - np.arange(count) / count)
    window = 1.0 - np.cos(2 * np.pi * np.arange(count) / count)
    position = trajectory.position(times, "fixed")
    amplitudes = np.fft.fft(window * position) / count
    orders = np.fft.fftfreq(count, 1.0 / samples_per_turn)
    amplitudes = amplitudes * np.exp(-1j * orders * (trajectory.begins + times[0]))
    kept = np.argsort(orders)
    kept = kept[np.abs(orders[kept]) <= highest_order]
    return FullSpectrum(orders[kept], amplitudes[kept], 4.0 / turns, trajectory.scales)
