"""Run the command line as ``python -m carom``."""

import sys

from carom.cli import main

if __name__ == "__main__":
    code = main()
    # Where a Ctrl-C came while an import ran generated code, Python would end by that signal whatever code is returned; to
    # run any other code makes it forget.
    exec("")
    sys.exit(code)
