"""Sweeps: studies or basins on a grid of machines, computed by many workers, stored by chunks, resumable.

==================  =================================================================================
``sweep_file``      :func:`load_sweep`: TOML text to a plan
``axes``            :class:`GridAxis`: the values of one parameter
``plan``            :class:`SweepPlan`: the grid, its chunks and its seeds; :func:`plan_sweep` in Python
``variables``       what is stored for each point
``studies``         what a study computes at a point
``basins``          where disturbances end at a point
``chunk``           computes the arrays of a chunk from its number
``chunk_record``    the record of a chunk, which says which files are its own
``layout``          creates the store, without chunks
``store``           the Zarr store, :func:`open_sweep`
``versions``        versions of software on which the last bits of results depend
``local``           chunks computed by processes and threads of this machine
``cluster``         chunks computed by Dask workers
``running``         :func:`run_sweep`
==================  =================================================================================
"""

from carom.sweeps.axes import GridAxis
from carom.sweeps.plan import SweepPlan, plan_sweep
from carom.sweeps.running import Tally, run_sweep
from carom.sweeps.store import open_sweep
from carom.sweeps.studies import StudyTask
from carom.sweeps.sweep_file import load_sweep

__all__ = ["GridAxis", "StudyTask", "SweepPlan", "Tally", "load_sweep", "open_sweep", "plan_sweep", "run_sweep"]
