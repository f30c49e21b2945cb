"""The reports of a study and of a drop: one self-contained HTML page, its figures as files, and the numbers as JSON.

==================  ===============================================================================================
``figures``         the figures of a study with captions, first where disturbances end now and after the advised change
``page``            the HTML pages of a study and of a drop
``film``            a drop in slow motion on it
``html``            what pages share: figures in files and embedded, formulas in text
==================  ===============================================================================================
"""

from carom.report.page import report_page, write_drop_report, write_report

__all__ = ["report_page", "write_drop_report", "write_report"]
