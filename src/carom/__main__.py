"""Run the command line as ``python -m carom``."""

import sys

from carom.cli import main

if __name__ == "__main__":
    code = main()
    # After a Ctrl-C during an import that runs generated code, Python exits by that signal, whatever code is returned.
    # Running any other code resets this.
    exec("")
    sys.exit(code)
