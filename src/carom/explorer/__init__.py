"""The interactive page of ``carom explore``, and its figures in a notebook.

==============  ====================================================================================
``computing``   what the page shows, as plain values and arrays
``background``  jobs in a thread beside the page
``page``        the page: shared objects, figures, template and scripts, and the session behind them
``server``      address, port, and which requests are refused
``notebook``    plane of kicks and motion below a cell of a notebook
``example``     the machine that is shown if no file is given
==============  ====================================================================================

``page`` and ``server`` need the extra ``carom[explore]``, ``notebook`` needs ``carom[notebook]``.
"""

from carom.explorer.notebook import explore

__all__ = ["explore"]
