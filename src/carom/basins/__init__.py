"""Basins of attraction of disturbances: the share that recovers, and the gains with which more recover.

======================  ==================================================================================
``classification``      :func:`map_basins` and the frozen :class:`Basin`
``dataset``             endings as a dataset with coordinates, units and provenance
``shares``              the share of disturbances that come back, with its confidence interval
``sizes``               which kinds have sizes, up to which they cannot touch, and the bracket that a search finds
``unrecovered``         the smallest kicks, shocks and losses of a blade that do not come back
``maps``                maps over two numbers of any measure, and of these gain maps: the share that comes back
``drops``               how drops end and what the bearing bears, against two numbers
``recoveries``          how many drops come back, with recovery actions and without
``document``            results as JSON
======================  ==================================================================================
"""

from carom.basins.classification import Basin, Cells, map_basins, map_cells
from carom.basins.drops import DropMap, map_drops
from carom.basins.maps import GainMap, map_gains
from carom.basins.recoveries import Recoveries, RecoveryShare, compare_recoveries
from carom.basins.shares import Population, Share, share_of_kicks
from carom.basins.sizes import SmallestUnrecovered
from carom.basins.unrecovered import smallest_unrecovered

__all__ = [
    "Basin",
    "Cells",
    "DropMap",
    "GainMap",
    "Population",
    "Recoveries",
    "RecoveryShare",
    "Share",
    "SmallestUnrecovered",
    "compare_recoveries",
    "map_basins",
    "map_cells",
    "map_drops",
    "map_gains",
    "share_of_kicks",
    "smallest_unrecovered",
]
