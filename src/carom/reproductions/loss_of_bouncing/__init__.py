"""How the machine of the source paper loses its bouncing as the damping falls: orbits, simulated motions, exponents, half-lives.

>>> from carom.reproductions import loss_of_bouncing
>>> found = loss_of_bouncing.follow_loss(progress=True)      # some minutes; fewer values take less
>>> loss_of_bouncing.loss_figure(found)                      # a matplotlib figure
>>> loss_of_bouncing.write_loss(found, "out")                # loss-of-bouncing.svg, .png and .json

The source paper follows the orbit ``B1,d`` and says where its bouncing is stable.  What happens below the period doubling is not in
it.
"""

from carom.reproductions.loss_of_bouncing.drawing import loss_figure
from carom.reproductions.loss_of_bouncing.following import LossOfBouncing, follow_loss
from carom.reproductions.loss_of_bouncing.samples import BouncingSample, sample_bouncing
from carom.reproductions.loss_of_bouncing.writing import loss_document, write_loss

__all__ = [
    "BouncingSample",
    "LossOfBouncing",
    "follow_loss",
    "loss_document",
    "loss_figure",
    "sample_bouncing",
    "write_loss",
]
