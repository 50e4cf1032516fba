"""`python -m daemon.cli` is `mmmd`."""

import sys

from daemon.cli.program import main

if __name__ == "__main__":
    sys.exit(main())
