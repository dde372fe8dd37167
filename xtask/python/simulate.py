"""`cargo xtask simulate`: a job of Hypersim's size on 1 to 10,000 nodes, as a simulation of discrete events.

`simulate.py DOCS` writes `simulation.md`, `.json` and `.svg` there, and reads what our frames cost from `render.json` there. A task is
frames of one scene for a quarter of an hour, as `farm plan` divides them: one frame by Hypersim's times, many by ours. Two things are shared and serve one after the other: the engine, which starts so many tasks a second, and
the store's bandwidth, over which scenes come to nodes and frames leave them. Everything else a node does alone. Nodes are taken away at
random, most with notice, when what there is of a frame is kept; the engine then starts the task again.
"""

import heapq
import json
import math
import random
import sys
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from svg import chart

FRAMES, PER_SCENE = 77_400, 170
HOUR = 3600.0


@dataclass(frozen=True)
class Model:
    """What is assumed, in seconds, bytes and shares."""

    nodes: int = 100
    # Published for Hypersim's 77,400 final frames: 7.7, 23 and 75 minutes at 10, 50 and 90 %, on machines of 32 threads in the mean.
    median_s: float = 23 * 60
    spread: float = math.log(75 / 7.7) / 2.5631
    # Hypersim ended a frame after this.
    longest_s: float = 300 * 60
    # Share of that variance which frames of one scene have in common.
    common: float = 0.8
    vcpus: int = 32
    dollars_per_vcpu_hour: float = 0.0165
    # Slurm 22.05, 300 empty elements of an array in 62.8 s.
    starts_per_s: float = 5.0
    # Until a requeued element starts again: the lifetime of its credential, 120 s by default.
    requeue_s: float = 121.0
    # Assumed, as all that follows: starting a worker, and loading and learning a scene, which take real rooms 1 to 3 s.
    load_s: float = 20.0
    scene_bytes: float = 300e6
    frame_bytes: float = 20e6
    store_bytes_per_s: float = 1e9
    # Nodes that run at half speed.
    slow: float = 0.02
    # Losses per node-hour, the share of them without notice, and until another node is there.
    losses_per_hour: float = 0.05
    unannounced: float = 0.1
    replace_s: float = 300.0
    longest_first: bool = False
    # Core-seconds of a frame in each of the rooms of which a scene is one; Hypersim's times where there is none.
    rooms: tuple = ()
    # Threads at work on a frame, as a share of the node's: as `run --estimate` takes it.
    busy: float = 0.95
    # `farm plan` gives a task frames for so long.
    task_s: float = 15 * 60


def tasks(model, draw):
    """Seconds of every task, its scene, and its number of frames."""
    if not model.rooms:
        return [(seconds, scene, 1) for seconds, scene in frames(model, draw)]
    own = model.spread * math.sqrt(1 - model.common)
    found = []
    for scene in range(-(-FRAMES // PER_SCENE)):
        mean_s = draw.choice(model.rooms) / (model.vcpus * model.busy)
        seconds, count = 0.0, 0
        for _ in range(min(PER_SCENE, FRAMES - scene * PER_SCENE)):
            frame_s = mean_s * math.exp(own * draw.gauss(0, 1) - own * own / 2)
            if count and seconds + frame_s > model.task_s:
                found.append((seconds, scene, count))
                seconds, count = 0.0, 0
            seconds, count = seconds + frame_s, count + 1
        found.append((seconds, scene, count))
    return sorted(found, reverse=True) if model.longest_first else found


def frames(model, draw):
    """Seconds of every frame by Hypersim's times, and its scene."""
    scenes = [draw.gauss(0, math.sqrt(model.common)) for _ in range(-(-FRAMES // PER_SCENE))]
    own = math.sqrt(1 - model.common)
    seconds = [model.median_s * math.exp(model.spread * (scenes[i // PER_SCENE] + draw.gauss(0, own))) for i in range(FRAMES)]
    tasks = [(min(each, model.longest_s), i // PER_SCENE) for i, each in enumerate(seconds)]
    return sorted(tasks, reverse=True) if model.longest_first else tasks


class Pipe:
    """Serves one request after the other."""

    def __init__(self, per_s):
        self.per_s, self.free, self.waited = per_s, 0.0, 0.0

    def done(self, now, amount):
        begun = max(now, self.free)
        self.waited += begun - now
        self.free = begun + amount / self.per_s
        return self.free


def simulate(model, seed):
    """When all frames are committed, what was paid, and how many nodes were at work over time."""
    draw = random.Random(seed)
    queue = list(reversed(tasks(model, draw)))
    engine, store = Pipe(model.starts_per_s), Pipe(model.store_bytes_per_s)
    events = [(0.0, node, "idle", None) for node in range(model.nodes)]
    speed = [2.0 if draw.random() < model.slow else 1.0 for _ in range(model.nodes)]
    cached = [set() for _ in range(model.nodes)]
    lost_at = [draw.expovariate(model.losses_per_hour / HOUR) if model.losses_per_hour else math.inf for _ in range(model.nodes)]
    paid = frame_s = lost_work = 0.0
    done = losses = 0
    finished, changes, waiting = 0.0, [], []
    while events:
        now, node, what, task = heapq.heappop(events)
        if what == "back":
            queue.append(task)
            if waiting:
                heapq.heappush(events, (now, waiting.pop(), "idle", None))
            continue
        if what == "done":
            done += task
            finished = max(finished, now)
        if not queue:
            waiting.append(node)
            continue
        seconds, scene, count = queue.pop()
        begun = engine.done(now, 1)
        loaded = begun + model.load_s
        if scene not in cached[node]:
            cached[node].add(scene)
            loaded = store.done(begun, model.scene_bytes) + model.load_s
        rendered = loaded + seconds * speed[node]
        if rendered < lost_at[node]:
            # The bandwidth of frames is taken out of the pipe's rate, not queued for: they leave one by one.
            ended = rendered + count * model.frame_bytes / model.store_bytes_per_s
            frame_s += seconds * speed[node]
            heapq.heappush(events, (ended, node, "done", count))
        else:
            ended = max(lost_at[node], begun)
            made = max(0.0, ended - loaded) / speed[node]
            kept = draw.random() >= model.unannounced
            lost_work += 0 if kept else made * speed[node]
            frame_s += made * speed[node] if kept else 0
            left = max(0.0, seconds - made) if kept else seconds
            losses += 1
            heapq.heappush(events, (ended + model.requeue_s, node, "back", (left, scene, count)))
            cached[node] = set()
            lost_at[node] = ended + model.replace_s + draw.expovariate(model.losses_per_hour / HOUR)
            heapq.heappush(events, (ended + model.replace_s, node, "idle", None))
        paid += ended - now
        changes += [(now, 1), (ended, -1)]
    assert done == FRAMES, done
    return {
        "hours": finished / HOUR, "node_hours": paid / HOUR, "dollars": paid / HOUR * model.vcpus * model.dollars_per_vcpu_hour,
        "utilization": frame_s / paid, "occupied": paid / (model.nodes * finished), "losses": losses, "lost_work_hours": lost_work / HOUR,
        "engine_wait_s": engine.waited / FRAMES, "store_wait_s": store.waited / FRAMES, "at_work": over_time(changes, finished),
    }  # fmt: skip


def over_time(changes, end, points=200):
    """Nodes at work at evenly spaced times."""
    changes.sort()
    series, level, i = [], 0, 0
    for point in range(points + 1):
        time = end * point / points
        while i < len(changes) and changes[i][0] <= time:
            level += changes[i][1]
            i += 1
        series.append((time / HOUR, level))
    return series


CASES = {
    "as it is": {},
    "longest frames first": {"longest_first": True},
    "and 50 starts a second": {"longest_first": True, "starts_per_s": 50.0},
    "and a store of 10 GB/s": {"longest_first": True, "starts_per_s": 50.0, "store_bytes_per_s": 1e10},
    "and no slow nodes": {"longest_first": True, "starts_per_s": 50.0, "store_bytes_per_s": 1e10, "slow": 0.0},
}
SIZES = [100, 1000, 10_000]
OUR_SIZES = [1, 10, 100]
SEEDS = 2
# Published for Hypersim: V-Ray's licence, dollars per vCPU-hour.
LICENCE = 0.009


def costs(docs):
    """Core-seconds of a frame of 1024x768 pixels by quality, in each of the rooms in which they were measured."""
    measured = json.loads((docs / "render.json").read_text())["delivered"]

    def denoised(samples):
        return tuple(room["fixed_s"] + samples * room["sample_s"] + room["denoised"]["denoise_s"] for room in measured)

    # As rendered, to a noise of 2 %; what was measured has the scene's loading and learning in it, seconds of hours.
    return {"ours, `normal`": denoised(32), "ours, `high`": denoised(128), "ours, `reference`": tuple(60 * room["core_min"] for room in measured)}


def run_case(name, nodes, changes):
    """Means over the seeds, and nodes at work over time by the first."""
    runs = [simulate(replace(Model(nodes=nodes), **changes), seed) for seed in range(SEEDS)]
    mean = {key: round(sum(run[key] for run in runs) / SEEDS, 4) for key in runs[0] if key != "at_work"}
    print(f"   {name}, {nodes} nodes: {mean['hours']:.2f} h, {mean['dollars']:.0f} dollars", flush=True)
    return {"case": name, "nodes": nodes, **mean, "at_work": runs[0]["at_work"]}


def main():
    docs = Path(sys.argv[1])
    rows = [run_case(name, nodes, changes) for name, changes in CASES.items() for nodes in SIZES]
    rooms = {"V-Ray, by Hypersim's times": (), **costs(docs)}
    ours = [run_case(name, nodes, {"rooms": seconds}) for name, seconds in rooms.items() for nodes in OUR_SIZES]
    ideal = rows[0]["node_hours"] * rows[0]["utilization"]
    panels = [
        ("hours until the last frame, by nodes", {**{case: [(row["nodes"], row["hours"]) for row in rows if row["case"] == case] for case in CASES}, "frames / nodes": [(n, ideal / n) for n in SIZES]}, True),
        *[(f"nodes at work, by hours: {n:,}", {row["case"]: row["at_work"] for row in rows if row["nodes"] == n and row["case"] in list(CASES)[:3]}, False) for n in SIZES],
    ]  # fmt: skip
    (docs / "simulation.svg").write_text(chart(panels))
    (docs / "simulation.json").write_text(json.dumps({"model": asdict(Model()), "frames": FRAMES, "seeds": SEEDS, "rows": [{k: v for k, v in row.items() if k != "at_work"} for row in rows + ours]}, indent=1) + "\n")
    (docs / "simulation.md").write_text(page(rows, ours, rooms))


def told(value, digits=2):
    """A number with as many digits as two seeds are good for."""
    if value == 0:
        return "0"
    places = digits - 1 - math.floor(math.log10(abs(value)))
    return f"{round(value, places):,.{max(0, places)}f}"


def forecast(ours, rooms):
    """The table of 1 to 100 nodes."""
    table = ["| renderer | core-seconds of a frame: mean, least to most | nodes | days | node-hours | machines, dollars | licence, dollars |", "|---|---|---|---|---|---|---|"]
    for row in ours:
        seconds, first = rooms[row["case"]], row["nodes"] == OUR_SIZES[0]
        frame = f"{told(sum(seconds) / len(seconds))}, {told(min(seconds))} to {told(max(seconds))}" if seconds else "published: see above"
        licence = "none" if seconds else told(row["node_hours"] * Model.vcpus * LICENCE)
        table.append(f"| {row['case'] if first else ''} | {frame if first else ''} | {row['nodes']} | {told(row['hours'] / 24)} | {told(row['node_hours'])} | {told(row['dollars'])} | {licence} |")
    return "\n".join(table)


def page(rows, ours, rooms):
    table = ["| case | nodes | hours | node-hours | dollars | in frames | losses | wait for the engine, s per frame | for the store |", "|---|---|---|---|---|---|---|---|---|"]
    for row in rows:
        table.append(f"| {row['case']} | {row['nodes']:,} | {told(row['hours'])} | {told(row['node_hours'])} | {told(row['dollars'])} | {100 * row['utilization']:.0f} % | {told(row['losses'])} | {told(row['engine_wait_s'], 1)} | {told(row['store_wait_s'], 1)} |")
    return PAGE.format(table="\n".join(table), forecast=forecast(ours, rooms), licence=LICENCE, **{key: value for key, value in asdict(Model()).items()})


PAGE = """\
# A farm of thousands of nodes, simulated

Made by `cargo xtask simulate`: 77,400 frames in 456 scenes, means of two seeds to two digits. It is a simulation, not a measurement.

## Hypersim's run on 1 to 100 nodes, by our renderer and by Hypersim's times

{forecast}

*Ours*: each scene costs as much as one of the six rooms of [render.md](render.md), whose core-seconds at 1024 × 768 pixels were measured
with every layer: `normal` has 32 samples and `high` 128, both denoised; `reference` has 2 % of noise without a denoiser, and most of its
time is the room with sun on rough metal. Frames of a scene differ as Hypersim's do, tasks take a quarter of an hour (`farm plan`), and 95 %
of a node's threads are busy. A vCPU counts as a core of that machine; if two share a core, the time is up to twice as long. Hypersim's
scenes have more triangles than these rooms. *V-Ray*: only its final pass, at {licence:g} dollars per vCPU-hour in addition to the machines;
Hypersim paid 45,000 dollars for it, and a sixth more for two other passes. Our renderer needs no licence; if you pay for one,
state it: `--price {dollars_per_vcpu_hour},licence=RATE`. `enfilade run --estimate` forecasts your own scenes.

## What limits up to 10,000 nodes, by Hypersim's times, with one task per frame

| what | value | from |
|---|---|---|
| time of a frame | 7.7, 23, 75 minutes at 10, 50, 90 %, log-normal, 300 at most; frames of a scene share 80 % of the variance | Hypersim's published costs and settings; the share is assumed |
| node | {vcpus} threads at {dollars_per_vcpu_hour} dollars per vCPU-hour | Hypersim's published costs |
| starts of the engine | {starts_per_s:g} a second, one after the other; {requeue_s:g} s until a task starts again | Slurm 22.05, measured |
| loading a scene | {load_s:g} s, and 300 MB over the store's bandwidth if the node does not have it | assumed; loading and learning take 0.5 to 2.6 processor seconds for real rooms ([render.md](render.md)) |
| store | 1 GB/s for all nodes; a frame has 20 MB | assumed |
| nodes | 2 % run at half speed; each is lost every 20 hours, one time in ten without notice, and replaced after {replace_s:g} s | assumed |

{table}

Each case includes the changes of those above it. Nodes are paid for while they wait.

- Up to 1,000 nodes, nothing shared is a limit: a frame waits a second for the engine and less for the store. Time is lost at the end, when
  the last long frames run on few nodes; starting with the longest frames saves a tenth of the time.
- At 10,000 nodes, the store is the first limit: nearly every frame fetches its scene anew, 23 TB at 1 GB/s, and the cost is half as much
  again as for 1,000 nodes. A store with 10 GB/s, as buckets have, removes that limit; so do longer tasks (`--minutes`), which fetch less
  often.
- The next limit is the end: the longest frame, on the slowest node, perhaps twice. A limit on a frame's time (`--time-limit`) or a noise
  target, and repeating what is missing elsewhere (`farm submit` again), which is harmless, bound it.
- The engine's starts cost minutes per frame at 10,000 nodes, and nothing at 1,000. Lost nodes cost next to nothing.

![hours by nodes, and nodes at work over time](simulation.svg)
"""

if __name__ == "__main__":
    main()
