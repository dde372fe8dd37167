"""Does the missing tasks of a job on a Ray cluster: python with_ray.py JOB [--cpus 8].

It is the cluster that RAY_ADDRESS names, or this machine alone. A task that ends with 75, or is killed, is tried again; one that ends with
65 is not, since the same would happen again.
"""

import argparse
import json
import subprocess
import sys

import ray


class Transient(Exception):
    """Another try may help."""


@ray.remote(max_retries=4, retry_exceptions=[Transient])
def work(job, task, cpus):
    words = ["enfilade", "--threads", str(cpus), "--quiet", "farm", "work", job, "--task", str(task)]
    code = subprocess.run(words).returncode
    if code not in (0, 65):
        raise Transient(f"task {task} ended with {code}")
    return code


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("job")
    parser.add_argument("--cpus", type=int, default=8, help="threads of a worker")
    args = parser.parse_args()
    status = subprocess.run(["enfilade", "farm", "status", args.job, "--json"], stdout=subprocess.PIPE, text=True)
    missing = json.loads(status.stdout)["missing"]
    ray.init()
    codes = ray.get([work.options(num_cpus=args.cpus).remote(args.job, task, args.cpus) for task in missing])
    sys.exit(max(codes, default=0))


if __name__ == "__main__":
    main()
