"""The page.

=============  ==============================================================
``models``     the two objects that browser and server share
``messages``   results as plain dictionaries for the browser
``view``       what the page wishes to see of a machine
``questions``  what the page asks of a machine, and the work that answers it
``session``    takes requests, has the work done, sends the answers
``figures``    the figures with axes, which the browser fills
``document``   all of these in one document, with the template
``scripts``    the scripts as one text, and those that draw
``files``      template, style and scripts
=============  ==============================================================
"""
