"""Sweeps: studies or basins on a grid of machines, by many workers, stored as they come, gone on with at any time.

==================  =================================================================================
``sweep_file``      :func:`load_sweep`: TOML text to a plan
``plan``            :class:`SweepPlan`: the grid, its chunks and its seeds
``variables``       what is stored for each point
``studies``         what a study finds out at a point
``basins``          where a sample of disturbances ends at a point
``chunk``           from the number of a chunk to its arrays
``layout``          a store before its first chunk
``store``           the Zarr store, :func:`open_sweep`
``local``           processes and threads
``cluster``         Dask workers
``running``         :func:`run_sweep`
==================  =================================================================================
"""

from carom.sweeps.plan import GridAxis, SweepPlan
from carom.sweeps.running import Tally, run_sweep
from carom.sweeps.store import open_sweep
from carom.sweeps.sweep_file import load_sweep

__all__ = ["GridAxis", "SweepPlan", "Tally", "load_sweep", "open_sweep", "run_sweep"]
