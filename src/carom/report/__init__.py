"""The report of a study: one self-contained HTML page, its figures as files, and the numbers as JSON.

==============  ====================================================
``basins``      where disturbances end now, and after the advised change
``figures``     the figures of a study with their captions
``page``        the HTML page
==============  ====================================================
"""

from carom.report.page import report_page, write_report

__all__ = ["report_page", "write_report"]
