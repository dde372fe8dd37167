"""What each kind of ground truth costs: python bench_products.py PROGRAM WORK DOCS.

Makes the demo's room at 1024x768 plain and with each kind asked for, and what is derived from it by each verb. Writes
DOCS/benchmarks/products.md and products.json, and the pictures of DOCS/ground-truth.md.
"""

import json
import shutil
import sys
from pathlib import Path

import product_pictures
from cost import Cost, measured
from machine import processor

FRAMES = 2
# Each kind of frame is rendered this many times, in turn: the clock of a shared machine is not steady.
ROUNDS = 3
SIZE = "1024x768"
# Few samples: what does not depend on their number counts the more.
QUALITY = "draft"
# As `enfilade run --demo` has them.
SCENE, CAMERA = "home", "cam_00"


class Program:
    """The program, its dataset, and what its commands cost."""

    def __init__(self, program: Path, out: Path):
        self.program, self.out = program, out

    def run(self, *arguments) -> Cost:
        return measured([self.program, "--quiet", *arguments])

    def bytes_of(self, pattern: str) -> int:
        return sum(path.stat().st_size for path in self.out.glob(pattern) if path.is_file())


def demo(program: Program, frames: int, *flags: str) -> None:
    """The demo with these flags and no others, whatever was asked for before."""
    program.run("run", "--demo", program.out, "--size", SIZE, "--frames", frames, "--quality", QUALITY, *flags)


def rendered(program: Program, work: Path) -> list[dict]:
    """What the layers cost that are rendered: the stage for one frame with each kind asked for, at its least of some rounds."""
    final, geometry = (f"scenes/{SCENE}/images/scene_{CAMERA}_{kind}_hdf5/frame.*" for kind in ("final", "geometry"))
    kinds = {"plain": [], "parts of light": ["--light-parts"], "fixtures": ["--fixtures"], "extra": ["--extra"],
             "everything": ["--light-parts", "--fixtures", "--extra"]}
    made = {name: Program(program.program, work / name) for name in kinds}
    for name, flags in kinds.items():
        demo(made[name], 1, *flags)
    rounds = [{name: one.run("run", one.out, "--only", "render", "--force") for name, one in made.items()} for _ in range(ROUNDS)]
    least = {name: min((costs[name] for costs in rounds), key=lambda cost: cost.cpu_s) for name in kinds}
    size = {name: one.bytes_of(final) + one.bytes_of(geometry) for name, one in made.items()}
    base = least["plain"].cpu_s
    return [dict(name=name, cpu_s=cost.cpu_s, bytes=size[name], peak_bytes=cost.peak_bytes, ratio=cost.cpu_s / base,
                 more_bytes=size[name] - size["plain"]) for name, cost in least.items()]


def derived(program: Program, work: Path) -> list[dict]:
    """What is made of finished frames."""
    mixes = work / "mixes.csv"
    alone = {"one_window": "window_1/*", "sun": "sun", "lamps": "lamp"}
    mixes.write_text("mix,fixture,r,g,b\n" + "".join(f"{mix},*,0,0,0\n{mix},{of},1,1,1\n" for mix, of in alone.items())
                     + "evening,sky,0.1,0.12,0.2\nevening,sun,0,0,0\nevening,lamp,12,10,7\n")
    detail = f"scenes/{SCENE}/_detail"
    nouns = [
        ("pairs", [], [f"{detail}/covisibility*", "pairs.csv"]),
        ("flow", ["--step", "1"], [f"{detail}/{CAMERA}/pairs/*"]),
        ("tracks", [], [f"{detail}/{CAMERA}/tracks.npz"]),
        ("surfaces", [], [f"{detail}/{CAMERA}/surfaces/*"]),
        ("rooms", [], [f"{detail}/metadata_planes.csv", f"{detail}/{CAMERA}/planes/*"]),
        ("words", [], [f"{detail}/metadata_instance*", f"{detail}/{CAMERA}/*.jsonl"]),
        ("sensors", ["--sensors", "examples/sensors.toml"], ["sensors/**/*"]),
        ("relit", ["--mixes", mixes], ["relit/**/*"]),
    ]
    rows = []
    for noun, arguments, patterns in nouns:
        cost = program.run("make", program.out, noun, *arguments, "--force")
        size = sum(program.bytes_of(pattern) for pattern in patterns)
        rows.append(dict(name=noun, cpu_s=cost.cpu_s / FRAMES, bytes=size / FRAMES, peak_bytes=cost.peak_bytes))
    return rows


def page(told: dict):
    """The page about the costs."""
    number = lambda value: f"{value:.2f}" if value < 10 else f"{value:.0f}"
    mb = lambda value: number(value / 1e6)
    yield "# The cost of each kind of ground truth"
    yield ""
    yield f"Made by `cargo xtask bench products`: frames of the demo's room, {SIZE} at {told['samples']} samples per pixel, on {told['processor']}."
    yield "Seconds are core-seconds per frame; memory is the largest resident set. [Ground truth](../ground-truth.md) describes each."
    yield ""
    yield "## Rendered with the picture"
    yield ""
    yield f"The whole stage for one frame, including scene preparation and writing: the least of {ROUNDS} rounds, in which one run of each kind follows"
    yield f"the other. There are {told['fixtures']} fixtures."
    yield ""
    yield "| layers | core-s | relative to plain | additional MB | memory, GB |"
    yield "|---|---|---|---|---|"
    for row in told["rendered"]:
        more = "" if row["name"] == "plain" else mb(row["more_bytes"])
        yield f"| {row['name']} | {number(row['cpu_s'])} | {row['ratio']:.2f} | {more} | {row['peak_bytes'] / 1e9:.2f} |"
    yield ""
    yield "## Derived from finished frames"
    yield ""
    yield "| `enfilade make` | core-s | MB | memory, GB |"
    yield "|---|---|---|---|"
    for row in told["derived"]:
        yield f"| `{row['name']}` | {number(row['cpu_s'])} | {mb(row['bytes'])} | {row['peak_bytes'] / 1e9:.2f} |"
    yield ""
    yield "`relit` makes four mixes of each frame, `sensors` has the six of `examples/sensors.toml`. `pairs`, `flow`, `tracks`,"
    yield "`surfaces` and `words` prepare the scene for rays first."


def main() -> None:
    program, work, docs = (Path(word) for word in sys.argv[1:4])
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    made = Program(program.resolve(), work.resolve() / "out")
    told = dict(processor=processor(), rendered=rendered(made, work.resolve()))
    demo(made, FRAMES, "--light-parts", "--fixtures", "--extra")
    fixtures = (made.out / f"scenes/{SCENE}/_detail/metadata_fixtures.csv").read_text().splitlines()
    record = json.loads((made.out / f"scenes/{SCENE}/_detail/{CAMERA}/frames/frame.0000.json").read_text())
    told |= dict(fixtures=len(fixtures) - 1, samples=record["samples"])
    told["derived"] = derived(made, work)
    verified = made.run("verify", made.out, "--strict")
    told["verify_cpu_s"] = verified.cpu_s / FRAMES
    (docs / "benchmarks/products.json").write_text(json.dumps(told, indent=1) + "\n")
    (docs / "benchmarks/products.md").write_text("\n".join(page(told)) + "\n")
    product_pictures.make(made.out, docs / "products", SCENE, CAMERA)


if __name__ == "__main__":
    main()
