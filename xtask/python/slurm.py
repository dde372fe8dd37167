"""A Slurm cluster of one controller and some nodes, as ordinary processes below one folder: no systemd, no change to the machine.

Every node is a process that adopts what its daemon leaves behind (a child subreaper), so that all processes of a node are found below
it, and killing them is what pulling its plug would be.
"""

import contextlib
import ctypes
import os
import re
import signal
import socket
import subprocess
import time
from pathlib import Path

PR_SET_CHILD_SUBREAPER = 36
# Debian's daemons lie where only root looks.
PATH = f"{os.environ.get('PATH', '')}:/usr/sbin"
# Seconds without word from a node until the controller gives it up; a site has 300.
NODE_TIMEOUT = 12
# Lifetime of a job's credential, seconds. A requeued job waits for it: 120 by default, and less than 5 is refused.
CREDENTIAL = 5

CONF = """\
ClusterName=enfilade
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/munge/socket,cred_expire={credential}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool/%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.%n.pid
SlurmctldLogFile={folder}/log/slurmctld
SlurmdLogFile={folder}/log/slurmd.%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
SchedulerParameters=sched_interval=2,bf_interval=2,batch_sched_delay=0,sched_min_interval=0
SlurmdTimeout={node_timeout}
SlurmctldTimeout=30
MessageTimeout=10
KillWait=5
MinJobAge=3600
ReturnToService=2
JobRequeue=1
MpiDefault=none
MailProg=/bin/true
JobCompType=jobcomp/none
AccountingStorageType=accounting_storage/none
{nodes}
PartitionName=main Nodes={names} Default=YES MaxTime=INFINITE State=UP
"""


class ClusterError(Exception):
    """The cluster did not do what it was asked."""


class Cluster:
    """Use as a context; every process that it has started ends with it."""

    def __init__(self, folder, nodes=3):
        self.folder = Path(folder)
        self.nodes = [f"n{i + 1}" for i in range(nodes)]
        self.ports = free_ports(nodes + 1)
        self.env = {**os.environ, "PATH": PATH, "SLURM_CONF": str(self.folder / "slurm.conf")}
        self.trees, self.controller, self.munged = {}, None, None

    def __enter__(self):
        for name in ["munge", "state", "log", "spool"]:
            (self.folder / name).mkdir(parents=True, exist_ok=True)
        self.configure()
        try:
            self.start_munge()
            self.start_controller(clean=True)
            for node in self.nodes:
                self.start_node(node)
            self.wait_until(lambda: set(self.node_states().values()) == {"idle"}, 60, "all nodes idle")
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for node in list(self.trees):
            self.pull_plug(node)
        for process in [self.controller, self.munged]:
            if process and process.poll() is None:
                process.kill()
                process.wait()

    def configure(self):
        node = "NodeName={} NodeHostname=localhost NodeAddr=127.0.0.1 Port={} CPUs=1 RealMemory=4000 State=UNKNOWN"
        lines = [node.format(name, port) for name, port in zip(self.nodes, self.ports[1:])]
        text = CONF.format(
            ports=self.ports, user=os.popen("id -un").read().strip(), folder=self.folder, credential=CREDENTIAL,
            node_timeout=NODE_TIMEOUT, nodes="\n".join(lines), names=",".join(self.nodes),
        )  # fmt: skip
        (self.folder / "slurm.conf").write_text(text)
        # From version 23 on the daemons look for control groups even where nothing uses them.
        if int(re.search(r"(\d+)\.", version()).group(1)) >= 23:
            (self.folder / "cgroup.conf").write_text("CgroupPlugin=disabled\n")

    def start_munge(self):
        place = self.folder / "munge"
        place.chmod(0o711)
        (place / "key").write_bytes(os.urandom(128))
        (place / "key").chmod(0o400)
        files = {"key-file": "key", "socket": "socket", "pid-file": "pid", "log-file": "log", "seed-file": "seed"}
        words = [f"--{name}={place / file}" for name, file in files.items()]
        self.munged = self.spawn(["munged", "--foreground", "--force", "--num-threads=2", *words], "munged")
        self.wait_until((place / "socket").exists, 20, "munged's socket")

    def start_controller(self, clean=False):
        self.controller = self.spawn(["slurmctld", "-D", *(["-c"] if clean else [])], "slurmctld")
        self.wait_until(lambda: "UP" in self.ask("scontrol", "ping", check=False), 60, "the controller up")

    def kill_controller(self):
        self.controller.kill()
        self.controller.wait()

    def start_node(self, node):
        """Starts a node, as if it had just booted."""
        pid = os.fork()
        if pid == 0:
            try:
                ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
                signal.signal(signal.SIGINT, signal.SIG_IGN)
                self.spawn(["slurmd", "-D", "-N", node], f"slurmd.{node}")
                while True:
                    with contextlib.suppress(ChildProcessError, InterruptedError):
                        os.wait()
                    time.sleep(0.02)
            finally:
                os._exit(1)
        self.trees[node] = pid

    def pull_plug(self, node):
        """Kills all processes of a node at once."""
        pid = self.trees.pop(node)
        for victim in [*below(pid), pid]:
            signal_to(victim, signal.SIGKILL)
        for victim in below(pid):  # what was started meanwhile
            signal_to(victim, signal.SIGKILL)
        os.waitpid(pid, 0)

    def kill_daemon(self, node):
        """Kills a node's daemon alone: the controller loses the node, and what it does goes on."""
        for pid in below(self.trees[node]):
            if command_of(pid)[:1] == ["slurmd"]:
                signal_to(pid, signal.SIGKILL)

    def workers(self, node, program):
        """Processes of `program` on a node."""
        return [pid for pid in below(self.trees[node]) if command_of(pid)[:1] == [str(program)]]

    def spawn(self, words, log):
        with open(self.folder / "log" / f"{log}.said", "ab") as said:
            return subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=said, stderr=said, env=self.env, cwd=self.folder)

    def ask(self, *words, check=True):
        """Runs a command of Slurm; what it says. One that cannot reach the controller is ended."""
        try:
            done = subprocess.run(words, env=self.env, capture_output=True, text=True, timeout=30)
        except subprocess.TimeoutExpired:
            if check:
                raise ClusterError(f"`{' '.join(words)}` did not end within 30 s") from None
            return ""
        if check and done.returncode:
            raise ClusterError(f"`{' '.join(words)}` ended with {done.returncode}: {done.stderr.strip()}")
        return done.stdout

    def node_states(self):
        lines = self.ask("sinfo", "--noheader", "--Node", "--format=%N %t", check=False).split("\n")
        return {words[0]: words[1] for words in map(str.split, lines) if len(words) == 2}

    def jobs(self):
        """Every element of every job that the controller remembers, as its fields."""
        lines = self.ask("scontrol", "--oneliner", "show", "job", check=False).split("\n")
        found = [dict(word.split("=", 1) for word in line.split() if "=" in word) for line in lines]
        return [job for job in found if "JobId" in job]

    def wait_for_jobs(self, seconds):
        """Waits until nothing is queued or at work."""
        open_states = {"PENDING", "RUNNING", "COMPLETING", "SUSPENDED", "CONFIGURING", "REQUEUED"}

        def ended():
            jobs = self.jobs()
            return bool(jobs) and not any(job["JobState"] in open_states for job in jobs)

        self.wait_until(ended, seconds, "the end of all jobs", pause=0.5)

    def wait_until(self, holds, seconds, what, pause=0.1):
        begun = time.monotonic()
        while not holds():
            if time.monotonic() - begun > seconds:
                raise ClusterError(f"waited {seconds} s for {what}; the cluster's messages are in {self.folder / 'log'}")
            time.sleep(pause)


def version():
    return subprocess.run(["slurmd", "-V"], capture_output=True, text=True, env={**os.environ, "PATH": PATH}).stdout.strip()


def free_ports(count):
    """Ports that nothing else listens on. All are held until all are known."""
    with contextlib.ExitStack() as held:
        sockets = [held.enter_context(socket.socket()) for _ in range(count)]
        for each in sockets:
            each.bind(("127.0.0.1", 0))
        return [each.getsockname()[1] for each in sockets]


def signal_to(pid, number):
    with contextlib.suppress(ProcessLookupError):
        os.kill(pid, number)


def command_of(pid):
    """A process's words; none when it has ended."""
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes().decode(errors="replace").split("\0")
    except OSError:
        return []


def below(pid):
    """All processes below one, nearest first."""
    children = {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            with contextlib.suppress(OSError, IndexError, ValueError):
                parent = int((entry / "stat").read_text().rsplit(")", 1)[1].split()[1])
                children.setdefault(parent, []).append(int(entry.name))
    found = [pid]
    for each in found:
        found.extend(children.get(each, []))
    return found[1:]
