"""The page.

=============  ==============================================================
``models``     the two objects that browser and server share
``messages``   results as plain dictionaries for the browser
``session``    takes requests, has the work done, sends the answers
``figures``    the figures with axes, which the browser fills
``document``   all of these in one document, with the template
``files``      template, style and scripts
=============  ==============================================================
"""
