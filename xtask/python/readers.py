"""`cargo xtask readers FOLDER`: our readers of scene files beside other programs', on every file below a folder.

FOLDER/<owner>/<repository>/… holds files of public repositories. Each file is imported by `enfilade import` in a process of its own, and
read by every peer that knows its format (`reader_peers.py`). Triangles are counted, and bounds are compared, in metres with z up. What
differs must be explained in `xtask/readers/explanations.json`, or the program fails. `reader_page.py` writes the tables.

Answers are kept in WORK/answers.jsonl, as long as the program and the peers stay the same.
"""

import argparse
import hashlib
import json
import os
import queue
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from importlib.metadata import files, version
from pathlib import Path

import numpy as np

import reader_page
from reader_peers import Z_FROM_Y, frame, measured

# Peers of a format, by the extensions of its files.
FORMATS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "glTF": ((".gltf", ".glb"), ("trimesh", "assimp")),
    "OBJ": ((".obj",), ("trimesh", "assimp", "mitsuba")),
    "PLY": ((".ply",), ("trimesh", "assimp", "mitsuba")),
    "USD": ((".usd", ".usda", ".usdc", ".usdz"), ("usd-core",)),
    "FBX": ((".fbx",), ("assimp",)),
    "COLLADA": ((".dae",), ("trimesh", "assimp")),
    "STL": ((".stl",), ("trimesh", "assimp")),
    "Mitsuba": ((".xml",), ("mitsuba",)),
}
# What is read of the packages that the peers are.
PACKAGES = {"trimesh": "trimesh", "assimp": "cmeel-assimp", "usd-core": "usd-core", "mitsuba": "mitsuba"}
# What peers' answers depend on beside them.
PROGRAMS = ("reader_peers.py", "round_shapes.py")
# Seconds that a reader has for a file; many, because other work may take the processors.
LIMIT_S = 600
# Bounds are the same that differ by less than this share of their diagonal, and of their distance from the origin, where single precision ends.
SHARE, ROUNDING = 1e-4, 1e-6
# Files at a time.
THREADS = 2
# Bytes of a scene description in which its root element is looked for.
HEAD = 4096


def format_of(path: Path) -> str | None:
    """Other programs' XML is no scene; so only what has Mitsuba's root element is one."""
    found = next((name for name, (extensions, _) in FORMATS.items() if path.suffix.lower() in extensions), None)
    return None if found == "Mitsuba" and b"<scene" not in path.read_bytes()[:HEAD] else found


def of_glb(path: Path) -> dict:
    """Triangles and bounds of a file of ours: one buffer, single precision, a node's matrix beside its mesh, one root with children."""
    data = path.read_bytes()
    length = int.from_bytes(data[12:16], "little")
    document, binary = json.loads(data[20 : 20 + length]), data[28 + length :]
    nodes = document["nodes"]
    matrix = lambda node: np.array(node.get("matrix", np.eye(4).ravel()), float).reshape(4, 4).T

    def array(index: int, kind: type, width: int) -> np.ndarray:
        accessor = document["accessors"][index]
        start = document["bufferViews"][accessor["bufferView"]].get("byteOffset", 0) + accessor.get("byteOffset", 0)
        return np.frombuffer(binary, kind, accessor["count"] * width, start).reshape(-1, width)

    def pieces():
        for node in (nodes[k] for k in nodes[0]["children"]):
            for primitive in document["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []:
                points, indices = array(primitive["attributes"]["POSITION"], np.float32, 3), array(primitive["indices"], np.uint32, 1)
                yield points[indices.ravel()].astype(float), frame(Z_FROM_Y) @ matrix(nodes[0]) @ matrix(node)

    return measured(pieces())


def ours(program: str, path: Path, folder: Path) -> dict:
    """What we read, with the warnings of the report, or the message that refuses it."""
    with tempfile.TemporaryDirectory() as place:
        glb = Path(place, "scene.glb")
        words = [program, "import", path, "-o", glb, "--allow-missing-textures", "--quiet", "--threads", "1"]
        try:
            done = subprocess.run(words, capture_output=True, timeout=LIMIT_S)
        except subprocess.TimeoutExpired:
            return dict(error=f"not done after {LIMIT_S} s")
        if done.returncode:
            return dict(error=plain(done.stderr.decode(errors="replace"), path, folder))
        report = json.loads(glb.with_suffix(".report.json").read_text())["import"]
        found, offset = of_glb(glb), np.array(report.get("offset_m") or [0, 0, 0])
    if "low" in found:
        found |= {side: (np.array(found[side]) + offset).tolist() for side in ("low", "high")}
    return found | dict(warnings=[f"{each['place']}: {each['message']}" if isinstance(each, dict) else plain(each, path, folder) for each in report["warnings"]])


def plain(text: str, path: Path, folder: Path) -> str:
    """A message on one line, without the folder that the files are in."""
    return " ".join(text.replace(f"{path}: ", "").replace(f"{folder}/", "").removeprefix("error: ").split())


def library(package: str, name: str) -> str:
    """The folder of a shared library within a package."""
    return str(next(file.locate().parent for file in files(package) or [] if file.name == name))


class Peer:
    """A process that reads files with a library, started again after a file that it does not survive."""

    def __init__(self, name: str):
        self.name, self.process = name, None

    def read(self, path: Path) -> dict:
        if self.process is None or self.process.poll() is not None:
            words = [sys.executable, Path(__file__).with_name("reader_peers.py"), self.name]
            pipes = dict(stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
            self.process = subprocess.Popen(words, text=True, env=os.environ | dict(LD_LIBRARY_PATH=library("cmeel-assimp", "libassimp.so")), **pipes)
        late = threading.Timer(LIMIT_S, self.process.kill)
        late.start()
        begun = time.monotonic()
        self.process.stdin.write(f"{path}\n")
        self.process.stdin.flush()
        line = self.process.stdout.readline()
        late.cancel()
        if line:
            return json.loads(line)
        self.process.wait()
        slow = time.monotonic() - begun >= LIMIT_S
        return dict(error=f"not done after {LIMIT_S} s" if slow else f"the process ends with {self.process.returncode}", facts={})

    def close(self) -> None:
        if self.process:
            self.process.stdin.close()
            self.process.wait()


def digest(*paths: str | Path) -> str:
    return hashlib.sha256(b"".join(Path(path).read_bytes() for path in paths)).hexdigest()[:12]


class Readers:
    """Us, and the peers' processes for files at a time, with what all have answered before."""

    def __init__(self, job: argparse.Namespace):
        self.job, self.own, self.theirs = job, digest(job.program), digest(*(Path(__file__).with_name(name) for name in PROGRAMS))
        kept = job.work / "answers.jsonl"
        self.answers = dict(json.loads(line) for line in kept.read_text().splitlines()) if kept.exists() else {}
        self.kept, self.lock = kept.open("a"), threading.Lock()
        self.idle = {name: queue.SimpleQueue() for name in PACKAGES}
        self.all = [Peer(name) for name in PACKAGES for _ in range(THREADS)]
        for peer in self.all:
            self.idle[peer.name].put(peer)

    def ours(self, path: Path) -> dict:
        return self.answer(f"enfilade {self.own}", path, lambda: ours(self.job.program, path, self.job.folder))

    def peer(self, name: str, path: Path) -> dict:
        def read() -> dict:
            peer = self.idle[name].get()
            found = peer.read(path)
            self.idle[name].put(peer)
            return found

        return self.answer(f"{name} {version(PACKAGES[name])} {self.theirs}", path, read)

    def answer(self, reader: str, path: Path, read: Callable[[], dict]) -> dict:
        key = f"{reader}: {path.relative_to(self.job.folder)}"
        if key not in self.answers:
            found = read()
            with self.lock:
                self.answers[key] = found
                print(json.dumps([key, found]), file=self.kept, flush=True)
        return self.answers[key]

    def close(self) -> None:
        for peer in self.all:
            peer.close()
        self.kept.close()


def same_bounds(one: dict, other: dict) -> bool:
    if "low" not in one or "low" not in other:
        return ("low" in one) == ("low" in other)
    a, b = (np.array([each["low"], each["high"]]) for each in (one, other))
    allowed = SHARE * np.linalg.norm(b[1] - b[0]) + ROUNDING * np.abs(b).max()
    return bool((np.abs(a - b) <= allowed).all())


def verdict(own: dict, peer: dict) -> str:
    """One of `reader_page.VERDICTS`."""
    read = [each.get("triangles", 0) > 0 for each in (own, peer)]
    if not all(read):
        return ("neither", "ours only", "peer only")[read[0] + 2 * read[1]]
    triangles, bounds = own["triangles"] == peer["triangles"], same_bounds(own, peer)
    return ("triangles and bounds", "bounds", "triangles", "same")[triangles + 2 * bounds]


def row(readers: Readers, path: Path, kind: str) -> dict:
    own = readers.ours(path)
    found = {name: readers.peer(name, path) for name in FORMATS[kind][1]}
    judged = {name: each | dict(verdict=verdict(own, each)) for name, each in found.items()}
    return dict(file=path.relative_to(readers.job.folder).as_posix(), format=kind, ours=own, peers=judged)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="cargo xtask readers", description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, help="files of public repositories, below <owner>/<repository>/")
    parser.add_argument("--only", default="", help="files whose path has this in it; the tables then go below the target folder")
    for name in ("program", "work", "docs", "explanations"):
        parser.add_argument(f"--{name}", required=True, help=argparse.SUPPRESS)
    job = parser.parse_args()
    job.folder, job.work = job.folder.resolve(), Path(job.work)
    job.docs = job.work / "docs" if job.only else Path(job.docs)
    return job


def main() -> None:
    job = arguments()
    job.work.mkdir(parents=True, exist_ok=True)
    paths = [path for path in sorted(job.folder.rglob("*")) if path.is_file() and job.only in str(path)]
    jobs = [(path, kind) for path in paths if (kind := format_of(path))]
    readers = Readers(job)
    rows = []
    with ThreadPoolExecutor(THREADS) as pool:
        for each in pool.map(lambda each: row(readers, *each), jobs):
            rows.append(each)
            if len(rows) % 200 == 0:
                print(f"{len(rows)} of {len(jobs)}: {each['file']}", flush=True)
    readers.close()
    versions = {name: version(package) for name, package in PACKAGES.items()}
    sys.exit(reader_page.write(job, rows, versions))


if __name__ == "__main__":
    main()
