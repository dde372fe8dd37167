"""The command `enfilade`, which is installed with the package: `python -m enfilade` is the same."""

import os
import signal
import sys

from ._native import main as _main


def main() -> int:
    # As for any program, Ctrl-C ends it at once; what is on disk is resumed.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    program = os.path.abspath(sys.argv[0]) if os.path.basename(sys.argv[0]).startswith("enfilade") else None
    return _main(["enfilade", *sys.argv[1:]], program)


if __name__ == "__main__":
    sys.exit(main())
