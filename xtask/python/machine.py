"""What a benchmark ran on."""

import platform
from pathlib import Path


def processor():
    """The processor's name and family: clouds hide more than that in the name."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        pairs = [[word.strip() for word in line.split(":", 1)] for line in lines if ":" in line]
        facts = dict(reversed(pairs))
        return f"{facts['model name']} (family {facts['cpu family']})"
    except (OSError, KeyError):
        return platform.processor() or platform.machine()
