"""The command line: what a user types, with errors of one line and an exit code for machines.

This file imports next to nothing, so that an interrupt in the first moments is one line, too.
"""

import sys


def main() -> None:
    """Run the command line; every failure is one line and an exit code."""
    try:
        from simulearn.cli.program import run
    except KeyboardInterrupt:
        print("simulearn: interrupted", file=sys.stderr)
        sys.exit(130)
    run()
