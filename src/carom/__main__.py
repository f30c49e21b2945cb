"""Run the command line as ``python -m carom``."""

import sys

from carom.cli import main

if __name__ == "__main__":
    sys.exit(main())
