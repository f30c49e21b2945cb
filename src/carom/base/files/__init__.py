"""Files and documents.

=============  ============================================================
``whole``      a file is written completely, or what was there stays
``directory``  an output directory receives all its files or none
``netcdf``     datasets as netCDF files with a checksum
``documents``  results as JSON
=============  ============================================================
"""

from carom.base.files.directory import check_directory, staged_directory
from carom.base.files.documents import as_json, write_json
from carom.base.files.whole import sync_directory, try_place, unfinished, write_whole

__all__ = [
    "as_json",
    "check_directory",
    "staged_directory",
    "sync_directory",
    "try_place",
    "unfinished",
    "write_json",
    "write_whole",
]
