"""The interactive page of ``carom explore``.

==============  ====================================================================================
``computing``   what the page shows, as plain values and arrays
``background``  jobs in a thread beside the page
``page``        the page: shared objects, figures, template and scripts, and the session behind them
``server``      address, port, and which requests are refused
``example``     the machine that is shown if no file is given
==============  ====================================================================================

All but ``computing``, ``background`` and ``example`` need the extra ``carom[explore]``.
"""
