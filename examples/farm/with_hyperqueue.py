"""Does the missing tasks of a job on HyperQueue: python with_hyperqueue.py JOB [--cpus 8] [--local WORKERS].

It is the server that `hq server start` has started for this user, with whatever workers it has (`hq alloc add slurm` gets them from a
Slurm cluster); with --local one of its own, with workers on this machine. HyperQueue does not try a task again that ends with an error, so
that the loop below does.
"""

import argparse
import contextlib
import json
import subprocess
import sys
import tempfile

from hyperqueue import Client, Job
from hyperqueue.cluster import LocalCluster, WorkerConfig
from hyperqueue.ffi.protocol import ResourceRequest

# $0 is the job, $1 the task, $2 the number of threads. 75 says that another try may help.
WORK = """
for attempt in 1 2 3 4; do
    enfilade --threads "$2" --quiet farm work "$0" --task "$1"
    code=$?
    [ $code -eq 75 ] || exit $code
done
exit 75
"""


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("job")
    parser.add_argument("--cpus", type=int, default=8, help="threads of a worker")
    parser.add_argument("--local", type=int, metavar="WORKERS", help="start a server and workers here")
    args = parser.parse_args()
    status = subprocess.run(["enfilade", "farm", "status", args.job, "--json"], stdout=subprocess.PIPE, text=True)
    tasks = Job(max_fails=None, name="enfilade")
    for task in json.loads(status.stdout)["missing"]:
        words = ["sh", "-c", WORK, args.job, str(task), str(args.cpus)]
        tasks.program(words, resources=ResourceRequest(cpus=args.cpus), stdout=None, stderr=None)
    with contextlib.ExitStack() as stack:
        client = connect(stack, args)
        done = not tasks.tasks or client.wait_for_jobs([client.submit(tasks)], raise_on_error=False)
    sys.exit(0 if done else 1)


def connect(stack, args):
    if not args.local:
        return Client()
    cluster = stack.enter_context(LocalCluster(stack.enter_context(tempfile.TemporaryDirectory())))
    for _ in range(args.local):
        cluster.start_worker(WorkerConfig(cores=args.cpus))
    return cluster.client()


if __name__ == "__main__":
    main()
