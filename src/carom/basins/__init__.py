"""Basins of attraction of disturbances: the share that recovers, and the gains with which more recover.

======================  ==================================================================================
``classification``      :func:`map_basins` and the frozen :class:`Basin`
``dataset``             endings as a dataset with coordinates, units and provenance
``shares``              the share of disturbances that come back, with its confidence interval
``brackets``            the bracket that a search for the smallest loss finds
``losses``              the smallest kicks, shocks and losses of a blade that are lost
``families``            which kinds have sizes, and up to which they cannot touch
``blade_losses``        the smallest unbalance after the loss of a blade that is not survived
``maps``                maps over two numbers of any measure: the next two
``gains``               these measures against two parameters: gain maps
``drops``               how drops end and what the bearing bears, against two numbers
``document``            results as JSON
======================  ==================================================================================
"""

from carom.basins.brackets import SmallestLoss
from carom.basins.classification import Basin, Cells, map_basins, map_cells
from carom.basins.drops import DropMap, map_drops
from carom.basins.gains import GainMap, map_gains
from carom.basins.losses import smallest_loss
from carom.basins.shares import Population, Share, share_of_kicks

__all__ = [
    "Basin",
    "Cells",
    "DropMap",
    "GainMap",
    "Population",
    "Share",
    "SmallestLoss",
    "map_basins",
    "map_cells",
    "map_drops",
    "map_gains",
    "share_of_kicks",
    "smallest_loss",
]
