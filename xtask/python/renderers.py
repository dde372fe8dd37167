"""Both renderers as processes of their own, and what a run costs."""

import glob
import json
import os
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent


@dataclass
class Run:
    """Pictures (seeds × height × width × 3), processor seconds (user and system), peak memory, and what the program told."""

    pictures: np.ndarray
    core_s: float
    peak_mb: float
    told: dict


def run(command):
    """Runs a renderer that takes `--out` and prints a line of JSON last."""
    with tempfile.TemporaryDirectory() as folder:
        out = f"{folder}/out.npy"
        with open(f"{folder}/err", "w+") as messages:
            process = subprocess.Popen([*map(str, command), "--out", out], stdout=subprocess.PIPE, stderr=messages, text=True)
            printed = process.stdout.read()
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            if process.returncode != 0:
                messages.seek(0)
                hint = "" if "fminimum" not in messages.read() else "\nthis LLVM is too old for Mitsuba: see peer.py"
                messages.seek(0)
                sys.exit(f"{' '.join(map(str, command))} ended with {process.returncode}:\n{messages.read()[-3000:]}{hint}")
        # Linux counts ru_maxrss in KiB, macOS in bytes.
        unit = 1 if sys.platform == "darwin" else 1024
        told = json.loads(printed.strip().splitlines()[-1])
        return Run(np.load(out), usage.ru_utime + usage.ru_stime, usage.ru_maxrss * unit / 1e6, told)


class Ours:
    """enfilade's `measure`, every layer written."""

    def __init__(self, program):
        self.program = program

    def render(self, scene, size, samples, depth, seed=0, seeds=1, denoise=False, **fields):
        # Mitsuba counts a path's segments (1: lights seen directly, 2: direct light), `max_bounces` surfaces after the first.
        config = {"samples": samples, "max_bounces": depth - 2, "filter": "box", "filter_radius": 0.5, "seed": seed, **fields}
        return run([self.program, scene, "--size", size, "--config", json.dumps(config), "--seeds", seeds, *(["--denoise"] if denoise else [])])


class Mitsuba:
    """Mitsuba 3."""

    def __init__(self):
        library = os.environ.get("DRJIT_LIBLLVM_PATH") or newest_llvm()
        if library:
            os.environ["DRJIT_LIBLLVM_PATH"] = library
        self.llvm = version(library) if library else "of unknown version"

    def render(self, scene, size, samples, depth, seed=0, seeds=1, sampler="independent", merged=True):
        arguments = ["--size", size, "--samples", samples, "--depth", depth, "--seed", seed, "--seeds", seeds, "--sampler", sampler]
        arguments += [] if merged else ["--unmerged"]
        return run([sys.executable, HERE / "peer.py", scene, *arguments])


def newest_llvm():
    """The newest LLVM library of the system, else the one that comes with the Rust compiler; `None` if neither is 16 or newer."""
    found = []
    for pattern in ["/usr/lib/*/libLLVM*.so*", "/usr/lib/llvm-*/lib/libLLVM*.so*", "/usr/lib64/libLLVM*.so*", "/opt/homebrew/opt/llvm*/lib/libLLVM*.dylib"]:
        found += [(version(path), path) for path in glob.glob(pattern)]
    system = max(found, default=(0, None))
    if system[0] >= 16:
        return system[1]
    try:
        root = subprocess.run(["rustc", "--print", "sysroot"], capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return None
    return max(((version(path), path) for path in glob.glob(f"{root}/lib/libLLVM.so.*")), default=(0, None))[1]


def version(path):
    """The major version in a library's name."""
    numbers = re.findall(r"\d+", os.path.basename(os.path.realpath(path)))
    return int(numbers[0]) if numbers else 0


def luminance(pictures):
    """Rec. 709 luminance of linear RGB, in double precision."""
    return pictures.astype(np.float64) @ [0.2126, 0.7152, 0.0722]
