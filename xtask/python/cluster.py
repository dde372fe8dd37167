"""`cargo xtask cluster`: a job of a farm on a real Slurm cluster of three nodes, on an S3 server and by other engines' files, with faults.

`cluster.py --program ENFILADE --config DATASET.TOML --python PYTHON --work DIR --docs DIR [NAME...]`. The work folder is a new one below
`--work`; it is removed when all is well, and named when something is not.
"""

import argparse
import json
import os
import platform
import shutil
import sys
import tempfile
import time
import traceback
from pathlib import Path

import faults
import slurm
from engines import ENGINES
from farm import Farm
from schedulers import SCHEDULERS
from stores import STORES, Server

KEYS = ["frames", "markers", "attempts", "restarts", "lost", "payloads", "seconds"]


def parse():
    parser = argparse.ArgumentParser(prog="cargo xtask cluster", description=__doc__.split("\n")[0])
    parser.add_argument("names", nargs="*", help="only tests whose names begin so; the table then goes below the target folder")
    parser.add_argument("--program-is", default="the release binary", help=argparse.SUPPRESS)
    parser.add_argument("--condor", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--before", default=0, type=int, help=argparse.SUPPRESS)
    parser.add_argument("--there", default="", help=argparse.SUPPRESS)
    for name in ["program", "config", "python", "work", "docs"]:
        parser.add_argument(f"--{name}", required=True, type=Path, help=argparse.SUPPRESS)
    return parser.parse_args()


def tests(farm, args, folder):
    """Every test: its kind, name, what is done, and a function of its folder."""
    for fault in faults.FAULTS:
        yield "Slurm", fault.name, fault.done, lambda place, fault=fault: run_fault(farm, fault, place)
    with Server(str(args.python), folder / "moto.log") as server:
        for name, done, run in STORES:
            yield "store", name, done, lambda place, run=run: run(farm, server, made(place))
    for name, done, run in [*ENGINES, *SCHEDULERS]:
        yield "engine", name, done, lambda place, run=run: run(farm, str(args.python), made(place))


def refuse_unknown(names):
    """Ends the program where a name is the beginning of no test's."""
    known = [*(fault.name for fault in faults.FAULTS), *(name for name, *_ in [*STORES, *ENGINES, *SCHEDULERS])]
    for each in names:
        if not any(begins(name, each) for name in known):
            sys.exit(f"no test begins with {each!r}; the tests are: {', '.join(known)}")


def begins(name, beginning):
    return name.lower().startswith(beginning.lower())


def run_fault(farm, fault, place):
    if fault.mounts and os.geteuid() != 0:
        return {"left_out": "needs root, to mount a small file system"}
    return faults.Trial(farm, fault, place).run()


def made(place):
    place.mkdir()
    return place


def main():
    args = parse()
    refuse_unknown(args.names)
    begun, load = time.monotonic(), round(os.getloadavg()[0], 1)
    args.work.mkdir(parents=True, exist_ok=True)
    # A short path: the names of sockets have 107 bytes at most.
    folder = Path(tempfile.mkdtemp(prefix="enfilade-"))
    farm = Farm(str(args.program.resolve()), args.config.resolve(), folder)
    farm.condor = args.condor
    rows, ok = [], True
    try:
        alone_s = farm.prepare()
        print(f"   {len(farm.reference)} files of the dataset that one machine makes, in {alone_s:.1f} s", flush=True)
        for number, (kind, name, done, run) in enumerate(tests(farm, args, folder)):
            if args.names and not any(begins(name, each) for each in args.names):
                continue
            rows.append({"kind": kind, "name": name, "done": done, **attempt(run, folder / str(number))})
            faults.unmount(folder)
            print(f"   {line(rows[-1])}", flush=True)
            (args.work / "cluster-rows.json").write_text(json.dumps(rows, indent=1))
            ok &= "failed" not in rows[-1]
    finally:
        faults.unmount(folder)
        if ok:
            shutil.rmtree(folder, ignore_errors=True)
    facts = {"program": args.program_is, "slurm": slurm.version(), "python": platform.python_version(), "cores": os.cpu_count(), "load": load, "alone_s": round(alone_s, 1), "files": len(farm.reference)}
    facts["before"], facts["there"] = args.before, args.there
    facts["seconds"] = round(time.monotonic() - begun)
    docs = args.docs if not args.names else args.work
    write(docs, facts, rows)
    print(f"   written to {docs / 'cluster.md'}; {facts['seconds']} s in all")
    if not ok:
        sys.exit(f"some tests failed; what they left is in {folder}")


def attempt(run, place):
    try:
        return run(place)
    except Exception as error:
        traceback.print_exc()
        return {"failed": f"{type(error).__name__}: {error}"}


def line(row):
    outcome = row.get("failed") or row.get("left_out") or row.get("refused") or ", ".join(f"{key} {row[key]}" for key in KEYS if key in row)
    return f"{row['kind']}: {row['name']}: {'FAILED: ' if 'failed' in row else ''}{outcome}"


def write(docs, facts, rows):
    (docs / "cluster.json").write_text(json.dumps({**facts, "tests": rows}, indent=1) + "\n")
    (docs / "cluster.md").write_text(page(facts, rows))


def page(facts, rows):
    text = [
        "# A farm and its faults",
        "",
        "Made by `cargo xtask cluster`, which runs a Slurm controller, three nodes of one processor each, moto's S3 server, and the files and",
        "examples for other engines, all as ordinary processes on one machine, without systemd. It changes nothing on the machine except",
        f"installing packages. The program is {facts['program']}. Every test has a fresh store and, with Slurm, a fresh cluster. Faults",
        "come from outside: from a script that takes the program's place on the nodes, from signals, from full file systems, from a proxy in",
        "front of the store, and from a wrong clock (libfaketime).",
        "",
        f"{facts['slurm']}, {facts['cores']} processors; other programs caused a load of {facts['load']:g} at the beginning.",
        f"The whole command took {facts['seconds'] + facts['before']} s: {facts['before']} s to install and build, {facts['seconds']} s for the tests.{there(facts)}",
        f"One machine alone makes the dataset in {facts['alone_s']} s.",
        f"After each test, every frame has exactly one marker, and all {facts['files']} files of the collected dataset have the same bytes as when a",
        "single machine makes them, including what the program that nodes run after every frame must add. Exempt are `.enfilade/` and",
        "`manifest_times.csv`, which contain measured times.",
        "",
        *table("Slurm", rows),
        "",
        "Attempts that were killed could not report their end and stay *open*. Restarts are Slurm's own count; a controller that has lost what",
        "happened since it last saved its state starts a task again without counting it. *Wasted* are frames that an attempt finished",
        "after another had committed them.",
        "",
        *costs(rows),
        *table("store", rows),
        "",
        *table("engine", rows),
    ]
    return "\n".join(text) + "\n"


def there(facts):
    return f" Already there: {facts['there']}." if facts["there"] else ""


HEADS = {"Slurm": "fault", "store": "store", "engine": "engine"}


def table(kind, rows):
    yield f"| {HEADS[kind]} | what is done | outcome | attempts | restarts | wasted | seconds |"
    yield "|---|---|---|---|---|---|---|"
    for row in (row for row in rows if row["kind"] == kind):
        if "frames" in row:
            outcome = f"{row['markers']} of {row['frames']} frames once, bytes equal"
            yield f"| {row['name']} | {row['done']} | {outcome} | {ended(row)} | {row.get('restarts', '')} | {row['lost']} | {row['seconds']} |"
        else:
            outcome = f"**failed**: {row['failed']}" if "failed" in row else row.get("left_out") or "refused, as required"
            yield f"| {row['name']} | {row['done']} | {outcome} | | | | {row.get('seconds', '')} |"


def costs(rows):
    """What `farm status --price` says of the runs in which nothing and most went wrong."""
    for row in rows:
        if row["name"] in ("none", "preemption", "old attempt ends last") and row.get("costs"):
            yield f"Costs, {row['name'] if row['name'] != 'none' else 'no fault'}:"
            yield ""
            yield from (f"    {line}" for line in row["costs"])
            yield ""


def ended(row):
    return ", ".join(f"{number} {word}" for word, number in row["ended"].items() if number)


if __name__ == "__main__":
    main()
