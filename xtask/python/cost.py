"""What a command costs."""

import os
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass


@dataclass
class Cost:
    """Processor seconds, user and system, of a command and all processes that it started; wall-clock seconds; and the most memory of one process."""

    cpu_s: float
    wall_s: float
    peak_bytes: int

    def __add__(self, other):
        return Cost(self.cpu_s + other.cpu_s, self.wall_s + other.wall_s, max(self.peak_bytes, other.peak_bytes))


def measured(words, **more) -> Cost:
    """Runs a command and ends with what it printed if it fails; `more` are arguments of `Popen`."""
    words = [str(word) for word in words]
    print("  ", *words, flush=True)
    start = time.monotonic()
    with tempfile.TemporaryFile("w+") as printed:
        process = subprocess.Popen(words, stdout=printed, stderr=printed, **more)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            printed.seek(0)
            sys.exit(f"{' '.join(words)} ended with {process.returncode}:\n{printed.read()[-3000:]}")
    # Linux counts ru_maxrss in KiB, macOS in bytes.
    unit = 1 if sys.platform == "darwin" else 1024
    return Cost(usage.ru_utime + usage.ru_stime, time.monotonic() - start, unit * usage.ru_maxrss)
