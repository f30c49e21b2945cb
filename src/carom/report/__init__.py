"""The report of a study: one self-contained HTML page, its figures as files, and the numbers as JSON.

==============  ====================================================
``directory``   the output directory: checked early, filled completely or not at all
``figures``     the figures of a study with their captions
``page``        the HTML page
==============  ====================================================
"""

from carom.report.directory import check_directory
from carom.report.page import report_page, write_report

__all__ = ["check_directory", "report_page", "write_report"]
