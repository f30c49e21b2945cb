"""Files that are there whole or not at all.

===========  ============================================================
``whole``    a file is written completely, or what was there stays
``netcdf``   datasets as netCDF files with a checksum
===========  ============================================================
"""

from carom.files.whole import sync_directory, try_place, write_whole

__all__ = ["sync_directory", "try_place", "write_whole"]
