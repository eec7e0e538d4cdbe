"""The command ``gyrocal``."""

from __future__ import annotations

import signal
import sys

from . import _gyrocal


def main() -> int:
    """Runs the command with the arguments of the process; returns its exit code."""
    # The interpreter would notice an interrupt only after the computation.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _gyrocal.command(["gyrocal", *sys.argv[1:]])
