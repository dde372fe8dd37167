"""The files of `examples/farm` for engines that `farm submit` does not know, each run on this machine by the engine itself.

In every test the first start of one task ends with 75, and must be followed by another.
"""

import os
import shutil
import subprocess
import time
from pathlib import Path

from engines import say, version
from farm import FarmError, audit

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "farm"
PATIENCE = 600

# Stands for the program on the nodes.
WRAPPER = """\
#!/bin/sh
here=$(dirname "$0")
case " $* " in *" --task 1 "*) mkdir "$here/tried" 2>/dev/null && exit 75 ;; esac
exec "$here/program" "$@"
"""

# A pool of one machine, whose daemons are ordinary processes of an ordinary user.
CONDOR = """\
CONDOR_HOST = 127.0.0.1
COLLECTOR_HOST = 127.0.0.1:39618
NETWORK_INTERFACE = 127.0.0.1
NO_DNS = true
DEFAULT_DOMAIN_NAME = localdomain
USE_SHARED_PORT = false
DAEMON_LIST = MASTER COLLECTOR NEGOTIATOR SCHEDD STARTD
RELEASE_DIR = /usr
BIN = /usr/bin
SBIN = /usr/sbin
LIB = /usr/lib/condor
LIBEXEC = /usr/libexec/condor
LOCAL_DIR = /pool/condor
LOG = /pool/condor/log
SPOOL = /pool/condor/spool
EXECUTE = /pool/condor/execute
RUN = /pool/condor/run
LOCK = /pool/condor/lock
MAIL = /bin/true
SEC_DEFAULT_AUTHENTICATION_METHODS = FS
ALLOW_READ = *
ALLOW_WRITE = *
ALLOW_DAEMON = *
ALLOW_NEGOTIATOR = *
ALLOW_ADMINISTRATOR = *
START = TRUE
SUSPEND = FALSE
PREEMPT = FALSE
KILL = FALSE
NUM_CPUS = 2
MEMORY = 4000
NEGOTIATOR_INTERVAL = 5
NEGOTIATOR_CYCLE_DELAY = 1
SCHEDD_INTERVAL = 5
"""

# In namespaces of its own, so that mounts and processes end with it.
ENTER = """\
set -e
mkdir -p {root}/pool
mount --bind {folder} {root}/pool
mount -t proc proc {root}/proc
mount --rbind /dev {root}/dev
exec chroot --userspec={user} {root} /usr/bin/env -i HOME=/pool CONDOR_CONFIG=/pool/condor_config PATH=/pool/bin:/usr/bin:/bin:/usr/sbin sh -e /pool/steps.sh
"""

STEPS = """\
cd /pool
condor_master -f &
until condor_status -af State 2>/dev/null | grep -q Unclaimed; do sleep 0.5; done
./missing.sh /pool/job > tasks.txt
condor_submit job=/pool/job program=/pool/bin/enfilade cpus=1 memory=500MB with_condor.sub
condor_wait -wait {patience} condor.log
condor_version | head -1
"""


def prepare(farm, folder, copy=False):
    """A fresh job, and an environment in which `enfilade` is the program."""
    job, place = farm.new_job(folder / "job"), folder / "bin"
    place.mkdir()
    (shutil.copy if copy else os.symlink)(farm.program, place / "program")
    (place / "enfilade").write_text(WRAPPER)
    (place / "enfilade").chmod(0o755)
    scratch = folder / "scratch"
    scratch.mkdir()
    return job, {**os.environ, "PATH": f"{place}:{os.environ['PATH']}", "TMPDIR": str(scratch)}


def run(words, folder, env):
    try:
        done = subprocess.run([str(word) for word in words], capture_output=True, text=True, env=env, cwd=folder, timeout=PATIENCE)
    except subprocess.TimeoutExpired as expired:
        raise FarmError(f"`{words[0]}` did not end within {PATIENCE} s: {expired.stdout!r} {expired.stderr!r}") from None
    if done.returncode:
        raise FarmError(f"`{words[0]}` ended with {done.returncode}: {(done.stdout + done.stderr).strip()[-2000:]}")
    return done.stdout


def judge(farm, job, folder, begun, engine_version):
    if not (folder / "bin" / "tried").exists():
        raise FarmError("no task ended with 75: the test tests nothing")
    farm.judge(job, folder / "dataset")
    return {**audit(job), "seconds": round(time.monotonic() - begun, 1), "version": engine_version}


def parallel(farm, python, folder):
    job, env = prepare(farm, folder)
    begun = time.monotonic()
    run([EXAMPLES / "with_parallel.sh", job], folder, env)
    return judge(farm, job, folder, begun, say(["parallel", "--version"], "parallel").split()[2])


def condor(farm, python, folder):
    if os.geteuid() != 0 or farm.condor is None:
        return {"left_out": "needs root, for a folder with Debian 13's HTCondor and its user"}
    root = Path(farm.condor)
    prepare(farm, folder, copy=True)
    for name in ["missing.sh", "with_condor.sub"]:
        shutil.copy(EXAMPLES / name, folder / name)
    (folder / "condor_config").write_text(CONDOR)
    (folder / "steps.sh").write_text(STEPS.format(patience=PATIENCE))
    for name in ["log", "spool", "execute", "run", "lock"]:
        (folder / "condor" / name).mkdir(parents=True)
    user = next(line.split(":") for line in (root / "etc/passwd").read_text().splitlines() if line.startswith("farm:"))
    say(["chown", "-R", f"{user[2]}:{user[3]}", folder], "chown")
    begun = time.monotonic()
    enter = ENTER.format(root=root, folder=folder, user=f"{user[2]}:{user[3]}")
    said = run(["unshare", "--mount", "--pid", "--fork", "--kill-child", "sh", "-c", enter], folder, {**os.environ})
    return judge(farm, folder / "job", folder, begun, said.split("$CondorVersion:")[1].split()[0])


def ray(farm, python, folder):
    job, env = prepare(farm, folder)
    begun = time.monotonic()
    # Ray's workers have niceness 15 unless this says otherwise, which on a busy machine is next to nothing. Without a mode it keeps a
    # token in the home folder.
    own = {"RAY_TMPDIR": str(folder / "ray"), "RAY_USAGE_STATS_ENABLED": "0", "RAY_worker_niceness": "0", "RAY_AUTH_MODE": "disabled"}
    run([python, EXAMPLES / "with_ray.py", job, "--cpus", "1"], folder, {**env, **own})
    return judge(farm, job, folder, begun, version(python, "ray"))


def hyperqueue(farm, python, folder):
    job, env = prepare(farm, folder)
    begun = time.monotonic()
    run([python, EXAMPLES / "with_hyperqueue.py", job, "--cpus", "1", "--local", "2"], folder, env)
    return judge(farm, job, folder, begun, version(python, "hyperqueue"))


SCHEDULERS = [
    ("GNU parallel", "`examples/farm/with_parallel.sh`, on this machine without ssh; a task ends with 75 the first time", parallel),
    ("HTCondor", "`with_condor.sub` on a pool of one machine, by Debian 13's package in a folder of its own; the same", condor),
    ("Ray", "`with_ray.py` on a cluster of one machine; the same", ray),
    ("HyperQueue", "`with_hyperqueue.py`, a server and two workers by the Python package; the program `hq` is not tried; the same", hyperqueue),
]  # fmt: skip
