"""The program's verbs for jobs of a farm, and what must hold of a job and a dataset in the end."""

import hashlib
import json
import os
import shutil
import subprocess
import time
from pathlib import Path

# Times differ from run to run: they stand in the work folder and in this table, and nowhere else.
EXEMPT = [".enfilade", "manifest_times.csv"]
# A task per frame, since none takes less, for workers of one thread.
DIVISION = ["--minutes", "1e-6", "--cpus", "1"]

# Stands for the program on the nodes: each has a disk of its own, and this is where faults are put in.
WRAPPER = """\
#!/bin/bash
arguments=("$@")
for ((i = 0; i < $#; i++)); do
    case ${{arguments[i]}} in
        --task) task=${{arguments[i + 1]}} ;;
        --scratch) arguments[i + 1]={disks}/$SLURMD_NODENAME ;;
    esac
done
first() {{ [ "${{SLURM_RESTART_COUNT:-0}}" -eq 0 ]; }}
at_work() {{ compgen -G "{job}/attempts/$(printf %06d "$task").*" >/dev/null; }}
{fault}
exec {program} "${{arguments[@]}}"
"""


class FarmError(Exception):
    """Something does not hold."""


class Farm:
    """The program, the configuration of a small dataset, what one machine makes of it, and what the nodes' program adds."""

    def __init__(self, program, config, folder):
        self.program, self.config, self.folder = program, config, folder
        self.planned, self.whole = folder / "planned", folder / "whole"

    def prepare(self):
        """Plans the job that all tests copy, and renders the dataset on one machine; seconds of the latter."""
        self.run("farm", "plan", str(self.config), "-o", str(self.planned), *DIVISION)
        begun = time.monotonic()
        self.run("run", str(self.config), "-o", str(self.whole))
        self.reference = {**tree(self.whole), **added_by_nodes(self.whole)}
        return time.monotonic() - begun

    def run(self, *words, code=0, env=None, cwd=None):
        """Runs the program; what it says. It must end with `code`, or with any where that is `None`."""
        done = subprocess.run([self.program, *words, "--quiet"], capture_output=True, text=True, env={**os.environ, **(env or {})}, cwd=cwd)
        said = done.stdout + done.stderr
        if code is not None and done.returncode != code:
            raise FarmError(f"`enfilade {' '.join(words)}` ended with {done.returncode}, expected {code}: {said.strip()}")
        return said

    def new_job(self, place):
        """A fresh store with the planned job."""
        shutil.copytree(self.planned, place, dirs_exist_ok=True)
        return place

    def write_wrapper(self, path, job, disks, fault):
        disks.mkdir(exist_ok=True)
        path.write_text(WRAPPER.format(program=self.program, job=job, disks=disks, fault=fault))
        path.chmod(0o755)
        return path

    def judge(self, job, out, env=None, collect=True):
        """Collects the dataset unless the engine has, and holds it against that of one machine with what nodes add; what is known of the job."""
        status = json.loads(self.run("farm", "status", str(job), "--json", env=env))
        if collect:
            self.run("farm", "collect", str(job), "-o", str(out), env=env)
        compare(self.reference, tree(out))
        return status


def tree(folder):
    """Hashes of all files by path, but for [`EXEMPT`]."""
    folder, hashes = Path(folder), {}
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder)
        if path.is_file() and not any(part in EXEMPT for part in name.parts):
            hashes[str(name)] = hashlib.sha256(path.read_bytes()).hexdigest()
    return hashes


def added_by_nodes(folder):
    """Hashes of what `after_frame` of the configuration leaves of each frame of a dataset, by path: the checksum of its color."""
    hashes = {}
    for color in sorted(folder.glob("scenes/*/images/scene_*_final_hdf5/frame.*.color.hdf5")):
        scene, frame = color.relative_to(folder).parts[1], color.name.split(".")[1]
        camera = color.parent.name.removeprefix("scene_").removesuffix("_final_hdf5")
        checksum = subprocess.run(["cksum"], input=color.read_bytes(), capture_output=True, check=True).stdout
        hashes[f"scenes/{scene}/_detail/{camera}/after_frame/frame.{frame}/color.cksum"] = hashlib.sha256(checksum).hexdigest()
    return hashes


def compare(expected, found):
    """Fails with the names of files in which two trees differ."""
    differing = [name for name in sorted({*expected, *found}) if expected.get(name) != found.get(name)]
    if differing:
        raise FarmError(f"{len(differing)} of {len(expected)} files differ from what they must be, first {differing[0]}")


def audit(job):
    """What lies in a job's folder. Every frame must have exactly one marker, and every marker its payload."""
    plan = json.loads((job / "plan.json").read_text())
    frames = [(task["scene"], task["camera"], frame) for task in plan["tasks"] for frame in task["frames"]]
    markers = [json.loads(path.read_text()) for path in sorted((job / "done").rglob("*.json"))]
    done = sorted((marker["scene"], marker["camera"], marker["frame"]) for marker in markers)
    if done != sorted(frames):
        raise FarmError(f"{job} has {len(done)} markers for {len(frames)} frames")
    for marker in markers:
        if (job / marker["payload"]).stat().st_size != marker["bytes"]:
            raise FarmError(f"{job}/{marker['payload']} is not of the length that its marker says")
    records = attempts(job)
    return {
        "frames": len(frames),
        "markers": len(markers),
        "payloads": len(list((job / "frames").rglob("*.tar"))),
        "attempts": len(records),
        "ended": {word: sum((record["ended"] or "open") == word for record in records) for word in ["done", "transient", "permanent", "open"]},
        "lost": sum(record["lost"] for record in records),
        "different": sum(record["different"] for record in records),
    }


def attempts(job):
    return [json.loads(path.read_text()) for path in sorted((job / "attempts").glob("*.json"))]
