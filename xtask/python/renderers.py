"""The renderers as processes of their own, and what a run costs.

Every one renders a scene twice as it is delivered: as rendered, and denoised. Start-up and load, with what is compiled, are not counted, by each
program's own clock of processor seconds (user and system, all threads); learning where light comes from and all layers are.
"""

import glob
import importlib.metadata
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
# Surfaces after the first that scatter light: all that matter.
BOUNCES = 64


@dataclass
class Scene:
    """A scene as our renderer reads it and as the peer does, and a digest of what is in it."""

    ours: Path
    peer: Path
    digest: str


@dataclass
class Shot:
    """One picture as rendered and as delivered (height × width × 3), and its facts.

    Those are `load_core_s`, `raw_core_s` and `delivered_core_s`, which includes the former but not load; `peak_mb`; and the renderer's `version`.
    """

    raw: np.ndarray
    delivered: np.ndarray
    facts: dict


@dataclass
class Run:
    """Pictures (seeds × height × width × 3), peak memory, and what the program told."""

    pictures: np.ndarray
    peak_mb: float
    told: dict

    def shot(self, version):
        """Of a run of one seed: the picture as rendered comes first, the delivered one last."""
        raw = self.told.get("learn_core_s", 0.0) + self.told["render_core_s"]
        facts = dict(raw_core_s=raw, delivered_core_s=raw + self.told["denoise_core_s"], peak_mb=self.peak_mb, version=version)
        return Shot(self.pictures[0], self.pictures[-1], self.told | facts)


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
        return Run(np.load(out), usage.ru_maxrss * unit / 1e6, json.loads(printed.strip().splitlines()[-1]))


class Ours:
    """enfilade's instrument `measure`, every layer written; `fields` of `RenderConfig` replace its defaults, but for references."""

    name, denoises_references = "ours", True

    def __init__(self, program, **fields):
        self.bench = program
        self.fields = fields

    def settings(self, reference):
        return {"max_bounces": BOUNCES, "filter": "box", "filter_radius": 0.5} | ({} if reference else self.fields)

    @property
    def program(self):
        return self.bench and Path(self.bench).read_bytes()

    def shot(self, scene, size, samples, seed, reference, **fields):
        found = self.run(scene.ours, size, dict(samples=samples, seed=seed) | self.settings(reference) | fields, "--denoise")
        return found.shot(found.told["denoiser"])

    def render(self, scene, size, samples, depth, seed=0, seeds=1):
        # Mitsuba counts a path's segments (1: lights seen directly, 2: direct light), `max_bounces` surfaces after the first.
        return self.run(scene, size, self.settings(False) | dict(samples=samples, max_bounces=depth - 2, seed=seed), "--seeds", seeds)

    def run(self, scene, size, config, *words):
        return run([self.bench, "measure", scene, "--size", size, "--config", json.dumps(config), *words])


class Mitsuba:
    """Mitsuba 3."""

    name, denoises_references = "mitsuba", True

    def __init__(self):
        library = os.environ.get("DRJIT_LIBLLVM_PATH") or newest_llvm()
        if library:
            os.environ["DRJIT_LIBLLVM_PATH"] = library
        self.llvm = version(library) if library else "of unknown version"
        self.denoiser = importlib.metadata.version("pyoidn").removesuffix(".0")

    def settings(self, _reference):
        return {"bounces": BOUNCES}

    @property
    def program(self):
        return (HERE / "peer.py").read_bytes() + f"{versions('mitsuba', 'drjit', 'pyoidn')}, LLVM {self.llvm}".encode()

    def shot(self, scene, size, samples, seed, _reference):
        found = self.render(scene.peer, size, samples, BOUNCES + 2, seed, denoise=True)
        return found.shot(found.told["mitsuba"])

    def render(self, scene, size, samples, depth, seed=0, seeds=1, sampler="independent", merged=True, denoise=False):
        arguments = ["--size", size, "--samples", samples, "--depth", depth, "--seed", seed, "--seeds", seeds, "--sampler", sampler]
        arguments += ["--unmerged"] * (not merged) + ["--denoise"] * denoise
        return run([sys.executable, HERE / "peer.py", scene, *arguments])


class Cycles:
    """Cycles of Blender, which brings its denoiser; references are not denoised, for Cycles would have to render them once more."""

    name, denoises_references = "cycles", False

    def settings(self, _reference):
        return {"bounces": BOUNCES}

    @property
    def program(self):
        return (HERE / "peer_cycles.py").read_bytes() + versions("bpy").encode()

    def shot(self, scene, size, samples, seed, reference):
        arguments = ["--size", size, "--samples", samples, "--bounces", BOUNCES, "--seed", seed, *["--denoise"] * (not reference)]
        found = run([sys.executable, HERE / "peer_cycles.py", scene.peer, *arguments])
        return found.shot(found.told["blender"])

    def convert(self, source, target):
        subprocess.run([sys.executable, HERE / "peer_cycles.py", source, "--convert", target], check=True, stdout=subprocess.DEVNULL)


def versions(*packages):
    return ", ".join(f"{package} {importlib.metadata.version(package)}" for package in packages)


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
