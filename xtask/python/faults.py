"""Faults of a Slurm cluster that a job must survive. Each is put in from outside: by the script that stands for the program on the
nodes, by signals, by file systems that are full, by a clock that is set wrong. The program itself is the one that is shipped.
"""

import contextlib
import json
import shutil
import signal
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

from farm import FarmError, attempts, audit
from slurm import Cluster, signal_to

# A job of this size takes seconds on an idle machine; this is for busy ones.
PATIENCE = 420
# A full store stays full for so long, seconds: every worker has tried to hand in a frame by then.
HELD = 20
# Machines at the dollars per vCPU-hour that half of Hypersim's rendering was paid at or below, and its licence by the minute.
PRICE = Path(__file__).resolve().parents[1] / "cluster" / "machines.csv"


@dataclass
class Fault:
    """One fault."""

    name: str
    done: str
    # Run by the script on each node before the program, in its place where it ends.
    script: str = ""
    # Run before the job is submitted, and while it is at work.
    before: Callable = lambda trial: None
    during: Callable = lambda trial: None
    # What must hold of the attempts in the end.
    after: Callable = lambda trial, found: None
    # Mounts file systems, which needs root.
    mounts: bool = False


class Trial:
    """A fault at work on a fresh job in a fresh cluster."""

    def __init__(self, farm, fault, folder):
        self.farm, self.fault, self.folder = farm, fault, folder
        self.job, self.out, self.disks = folder / "job", folder / "dataset", folder / "disks"

    def run(self):
        """Seconds from submission to the collected dataset, and what was found; fails where something does not hold."""
        self.folder.mkdir()
        self.fault.before(self)
        if not (self.job / "plan.json").exists():
            self.farm.new_job(self.job)
        script = self.fault.script.format(go=self.folder / "go", program=self.farm.program)
        self.wrapper = self.farm.write_wrapper(self.folder / "program", self.job, self.disks, script)
        with Cluster(self.folder / "slurm") as self.cluster:
            begun = time.monotonic()
            self.submit()
            self.fault.during(self)
            self.cluster.wait_for_jobs(PATIENCE)
            collected = self.out.exists()
            status = self.farm.judge(self.job, self.out, collect=not collected)
            seconds = time.monotonic() - begun
            restarts = sum(int(job.get("Restarts", 0)) for job in self.cluster.jobs())
        found = {**audit(self.job), "restarts": restarts, "seconds": round(seconds, 1), "collected_by": "Slurm" if collected else "hand", "status": status}
        if found["different"]:
            raise FarmError(f"{found['different']} frames were made twice with different bytes")
        self.fault.after(self, found)
        found["costs"] = self.farm.run("farm", "status", str(self.job), "--price", str(PRICE)).splitlines()
        self.farm.run("farm", "status", str(self.job), "--price", str(PRICE), "--attempts", str(self.folder / "attempts.csv"))
        found["rows"] = (self.folder / "attempts.csv").read_text().splitlines()
        return found

    def submit(self):
        words = ["farm", "submit", str(self.job), "--engine", "slurm", "--program", str(self.wrapper), "-o", str(self.folder / "slurm"), "--collect", str(self.out)]
        self.farm.run(*words, env=self.cluster.env, cwd=self.folder)

    def worker_on(self, node):
        """Waits for a worker on a node that has begun with its task; its process and the task's number."""
        found = []

        def at_work():
            hosts = {record["host"]: record["task"] for record in self.records() if record["ended"] is None}
            pids = self.cluster.workers(node, self.farm.program)
            found[:] = [(pids[0], hosts[node])] if pids and node in hosts else []
            return bool(found)

        self.cluster.wait_until(at_work, PATIENCE, f"a worker on {node}", pause=0.05)
        return found[0]

    def records(self):
        # A record may be in the making.
        with contextlib.suppress(ValueError, OSError):
            return attempts(self.job)
        return []

    def markers(self):
        return len(list((self.job / "done").rglob("*.json")))


def expect(holds, what):
    if not holds:
        raise FarmError(f"expected {what}")


def preempt(trial):
    _, task = trial.worker_on("n2")
    time.sleep(1)
    job = next(job for job in trial.cluster.jobs() if job.get("ArrayTaskId") == str(task) and job["JobState"] == "RUNNING")
    # It tries again of its own accord, and complains when the job has been requeued meanwhile.
    trial.cluster.ask("scancel", "--signal=TERM", "--batch", job["JobId"], check=False)


def spoil(trial):
    """Damages what only one of both scenes needs."""
    plan = json.loads((trial.farm.new_job(trial.job) / "plan.json").read_text())
    of = {scene["name"]: {file["blake3"] for file in scene["files"].values()} for scene in plan["scenes"]}
    name = sorted(of["den"] - of["room"])[0]
    trial.spoilt = trial.job / "objects" / name[:2] / name
    trial.kept = shutil.copy(trial.spoilt, trial.folder / "kept")
    trial.spoilt.write_bytes(b"damaged")


def spoil_and_mend(trial):
    trial.cluster.wait_until(lambda: trial.cluster.jobs(), 30, "the job")
    trial.cluster.wait_for_jobs(PATIENCE)
    ended = [job for job in trial.cluster.jobs() if job["ExitCode"] == "65:0"]
    expect(len(ended) == 3 and all(job["Restarts"] == "0" for job in ended), "three elements that end with 65 and are not tried again")
    states = [job["JobState"] for job in trial.cluster.jobs() if "ArrayTaskId" not in job]
    expect(states == ["CANCELLED"], f"that nothing is collected, but the job that collects is {states}")
    said = trial.farm.run("farm", "status", str(trial.job), code=1)
    expect("does not hold what its name says" in said, f"the reason in what `farm status` says: {said}")
    shutil.copy(trial.kept, trial.spoilt)
    trial.submit()


def unplug(trial):
    trial.worker_on("n2")
    trial.cluster.pull_plug("n2")


def stall(trial):
    """A node goes on that the controller believes dead: its worker is stopped until another has done the same frames."""
    pid, _ = trial.worker_on("n2")
    signal_to(pid, signal.SIGSTOP)
    trial.cluster.kill_daemon("n2")
    trial.cluster.wait_until(lambda: trial.markers() == 6, PATIENCE, "all frames from the other nodes")
    signal_to(pid, signal.SIGCONT)
    trial.cluster.wait_until(lambda: not Path(f"/proc/{pid}").exists(), PATIENCE, "the end of the old attempt")


def restart_controller(trial):
    trial.cluster.wait_until(lambda: trial.markers() >= 1, PATIENCE, "a frame")
    # A controller saves its state every few seconds; a job that it has not saved is gone with it.
    time.sleep(8)
    trial.cluster.kill_controller()
    time.sleep(5)
    trial.cluster.start_controller()
    (trial.folder / "go").touch()


def nothing_kept(trial, found):
    """Two programs failed, and what was kept of their frames is used up."""
    counts(transient=2, restarts=2)(trial, found)
    expect(not list((trial.job / "kept").rglob("*.*")), "nothing in the job's folder kept/")
    expect(" for licence" in trial.farm.run("farm", "status", str(trial.job), "--price", str(PRICE)), "a sum for the licence")


def small_disk(trial):
    trial.disks.mkdir()
    mount(trial.disks / "n1", "200k")


def small_store(trial):
    size = sum(path.stat().st_blocks * 512 for path in trial.farm.planned.rglob("*") if path.is_file())
    mount(trial.job, f"{size // 1024 + 500}k")


def grow(place):
    def after_a_failure(trial):
        def failed():
            return any(record["ended"] == "transient" for record in trial.records()) or any(job.get("Restarts", "0") != "0" for job in trial.cluster.jobs())

        trial.cluster.wait_until(failed, PATIENCE, "a worker that finds no space")
        path = place(trial)
        subprocess.run(["mount", "-o", "remount,size=200m", str(path)], check=True)

    return after_a_failure


def grow_store(trial):
    """Gives room to a store that is full: workers hold the frames that they could not hand in, and try again."""

    def is_full():
        left = shutil.disk_usage(trial.job).free
        frames = [path.stat().st_size for path in trial.job.glob("frames/**/*.tar")]
        return bool(frames) and left < max(frames)

    trial.cluster.wait_until(is_full, PATIENCE, "a store that has no room for another frame")
    time.sleep(HELD)
    subprocess.run(["mount", "-o", "remount,size=200m", str(trial.job)], check=True)


def mount(path, size):
    path.mkdir(parents=True)
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(path)], check=True)


def unmount(folder):
    """Frees what trials below a folder have mounted."""
    for line in Path("/proc/mounts").read_text().splitlines():
        place = line.split()[1]
        if place.startswith(f"{folder}/"):
            subprocess.run(["umount", place], check=False)


def clocks(trial, _):
    said = "".join(path.read_text() for path in trial.folder.glob("slurm-*.out"))
    dates = {line.split()[1]: float(line.split()[2]) for line in said.splitlines() if line.startswith("clock ")}
    spread = max(dates.values()) - min(dates.values())
    expect(spread > 86400, f"clocks that differ by more than a day, found {spread:.0f} s between {sorted(dates)}")


def counts(**least):
    """At least so many attempts that ended in these ways."""

    def check(_, found):
        for word, number in least.items():
            have = found["ended"].get(word, found.get(word, 0))
            expect(have >= number, f"at least {number} {word}, found {have}")

    return check


SKEW = """\
case $SLURMD_NODENAME in n1) skew=+2d ;; n2) skew=-3h ;; *) skew=+0s ;; esac
echo "clock $SLURMD_NODENAME $(faketime -f $skew date +%s)"
exec faketime -f $skew {program} "${{arguments[@]}}"
"""

# The first SIGSEGV that no bad address has caused is swallowed by Rust's handler for stack overflows, which then takes itself away.
SEGFAULT = """\
if first && [ "$task" = 2 ]; then
    {program} "${{arguments[@]}}" & worker=$!
    until at_work; do sleep 0.1; done
    until ! kill -SEGV $worker; do sleep 0.1; done 2>/dev/null
    wait $worker
    exit $?
fi
"""

FAULTS = [
    Fault("none", "nothing"),
    Fault("transient failure", "two tasks end with 75 the first time", 'first && [[ $task = [14] ]] && exit 75', after=counts(restarts=2)),
    Fault("program after a frame", "the program that nodes run after every frame ends with 75 in two tasks the first time", 'first && [[ $task = [14] ]] && export AFTER_FRAME_FAILS=75', after=nothing_kept),
    Fault("preemption", "SIGTERM by `scancel --batch` within a frame", during=preempt, after=counts(transient=1, restarts=1)),
    Fault("permanent failure", "an object of one scene is damaged, then repaired and submitted again", before=spoil, during=spoil_and_mend, after=counts(permanent=3)),
    Fault("crash", "a worker gets SIGSEGV within a frame", SEGFAULT, after=counts(open=1, restarts=1)),
    Fault("node lost", "all processes of a node are killed within a frame", during=unplug, after=counts(open=1, restarts=1)),
    Fault("old attempt ends last", "a node's daemon is killed and its worker stopped until another has made its frame", during=stall, after=counts(lost=1)),
    Fault("controller restarted", "the controller is killed for 5 s while frames are made", '[ "$task" -lt 3 ] || until [ -e {go} ]; do sleep 0.2; done', during=restart_controller),
    Fault("node's disk full", "the first node's disk has 200 KB, and more after a failure", before=small_disk, during=grow(lambda trial: trial.disks / "n1"), after=counts(transient=1), mounts=True),
    Fault("store full", "the store has room for some frames, and 20 s later for more; workers keep what they could not hand in", before=small_store, during=grow_store, mounts=True),
    Fault("clock skew", "clocks of two nodes are two days fast and three hours slow", SKEW, after=clocks),
]  # fmt: skip
