"""`cargo xtask oracle`: the same scenes, from the same XML, by enfilade and by Mitsuba 3, and what differs.

Each renders every scene with K independent seeds. The variance between its own seeds tells the standard error of each of its
means, so a difference of means is judged by its own noise: per pixel, per block (the image cut into 8 × 8) and for the image.
"""

import json
import shutil
import sys
import time
from pathlib import Path

import numpy as np
from PIL import Image

import assets
import command
import figures
import rooms
from errors import luminance
from renderers import Mitsuba, Ours

SEEDS = 8
DEPTH = 64
BLOCKS = 8
# A block whose means differ by more is listed.
LIMIT = 0.01
# A block that differs by more than the limit and by more standard errors than this needs an explanation.
SIGNIFICANT = 4.0
# Half of float16's last place, relative: what enfilade's stored colour is rounded by at most.
ROUNDING = 2.0**-12

# Samples per seed where the default (32) is not enough, and other depths.
SAMPLES = {"dielectric": 128, "roughdielectric": 64, "roughdielectric-beckmann": 64, "principled-spec-trans": 64, "slab": 128, "pane": 256, "envmap": 64, "area-textured": 64}
DEPTHS = {"cornell-3": 3}


def main():
    job = command.parse("oracle", __doc__, "cases", "scenes or rooms")
    cases = scenes(Path(job.work) / "scenes") | {name: None for name in rooms.ROOMS if job.scenes}
    chosen = job.cases or list(cases)
    if unknown := [name for name in chosen if name not in cases]:
        sys.exit(f"no case {unknown[0]!r}; expected some of {', '.join(cases)}" + ("" if job.scenes else " (rooms need ENFILADE_SCENES)"))
    if not job.scenes:
        print("note: ENFILADE_SCENES names no folder, so the shared rooms are left out, and the tables go below the target folder")
    ours, peer = Ours(job.bench), Mitsuba()
    explanations = json.loads((Path(__file__).parent.parent / "oracle/explanations.json").read_text())
    results, started = [], time.time()
    for name in chosen:
        scene, size, samples = cases[name], "128x96", 32
        if scene is None:
            scene, size, samples = rooms.prepare(name, job.scenes, Path(job.work) / "rooms", job.bench), "256x192", 32
        settings = dict(size=size, samples=SAMPLES.get(name, samples), depth=DEPTHS.get(name, DEPTH), seeds=SEEDS)
        a, b = ours.render(scene, **settings), peer.render(scene, **settings, merged=False)
        result = compare(a.pictures, b.pictures) | dict(case=name, room=cases[name] is None, samples=SEEDS * settings["samples"])
        result |= dict(depth=settings["depth"], explanation=explanations.get(name, ""), version=b.told["mitsuba"])
        results.append(result | dict(pictures=(a.pictures.mean(0), b.pictures.mean(0))))
        print(summary(result), flush=True)
    # What only some cases tell does not replace the tables of all.
    docs = Path(job.work) / "docs" if job.cases or not job.scenes else Path(job.docs)
    write(results, docs, time.time() - started)
    print(f"tables and figures: {docs}")
    unexplained = [r["case"] for r in results if r["significant"] and not r["explanation"]]
    if unexplained:
        sys.exit(f"blocks differ by more than {LIMIT:.0%} and {SIGNIFICANT} standard errors, unexplained, in: {', '.join(unexplained)}")


def scenes(work):
    """Copies our own scenes beside their meshes and pictures; gives them by name."""
    work.mkdir(parents=True, exist_ok=True)
    assets.write(work)
    parts = ["stage", "lamp"]
    found = {}
    for xml in sorted((Path(__file__).parent.parent / "oracle").glob("*.xml")):
        shutil.copy(xml, work / xml.name)
        if xml.stem not in parts:
            found[xml.stem] = work / xml.name
    return found | {"cornell-3": found["cornell"]}


def z_of(a, b):
    """The difference of the means of two sets of equally distributed values (first axis), in standard errors.

    Welch's t with its degrees of freedom, taken to the normal distribution's scale (Wallace 1959).
    """
    n, m = len(a), len(b)
    difference = a.mean(0) - b.mean(0)
    va, vb = a.var(0, ddof=1) / n, b.var(0, ddof=1) / m
    rounding = (ROUNDING * a.mean(0)) ** 2
    variance = va + vb + rounding + 1e-20
    freedom = (va + vb + 1e-30) ** 2 / (va**2 / (n - 1) + vb**2 / (m - 1) + 1e-60)
    freedom = np.where(va + vb > rounding, np.maximum(freedom, 1), 1e6)
    t2 = difference**2 / variance
    return np.sign(difference) * (8 * freedom + 1) / (8 * freedom + 3) * np.sqrt(freedom * np.log1p(t2 / freedom))


def compare(ours, peer):
    """Everything that is told of one scene."""
    a, b = luminance(ours), luminance(peer)
    z = z_of(a, b)
    mean = float(b.mean())
    blocks_a, blocks_b = blocks(a), blocks(b)
    # Where a block is nearly black, a hundredth of the image's mean stands in for its own.
    relative = (blocks_a.mean(0) - blocks_b.mean(0)) / np.maximum(blocks_b.mean(0), 0.01 * mean)
    z_blocks = z_of(blocks_a, blocks_b)
    over = [
        dict(row=int(r), column=int(c), difference=float(relative[r, c]), z=float(z_blocks[r, c]))
        for r, c in np.argwhere(np.abs(relative) > LIMIT)
    ]
    return dict(
        ours=float(a.mean()),
        peer=mean,
        ratio=float(a.mean() / mean),
        z_image=float(z_of(a.mean((1, 2)), b.mean((1, 2)))),
        share_over_3=float((np.abs(z) > 3).mean()),
        block_rms=float(np.sqrt((relative**2).mean())),
        block_worst=float(relative.flat[np.abs(relative).argmax()]),
        blocks_over=over,
        significant=sum(abs(block["z"]) > SIGNIFICANT for block in over),
    )


def blocks(values):
    """Means of the image's blocks: seeds × 8 × 8."""
    seeds, height, width = values.shape
    return values.reshape(seeds, BLOCKS, height // BLOCKS, BLOCKS, width // BLOCKS).mean((2, 4))


def summary(r):
    return (
        f"{r['case']:28} ratio {r['ratio']:.5f} (z {r['z_image']:+.1f})  |z|>3: {r['share_over_3']:.2%}  "
        f"blocks rms {r['block_rms']:.2%} worst {r['block_worst']:+.2%}, {len(r['blocks_over'])} over 1 %, {r['significant']} of them significant"
    )


def write(results, docs, seconds):
    figure_folder = docs / "oracle"
    figure_folder.mkdir(parents=True, exist_ok=True)
    for name, room, columns in [("scenes", False, 2), ("rooms", True, 1)]:
        shown = [r for r in results if r["room"] == room]
        if shown:
            figures.sheet([(r["case"], *r["pictures"]) for r in shown], columns).save(figure_folder / f"{name}.jpg", quality=85)
    rows = [{k: v for k, v in r.items() if k not in ("pictures", "version", "room")} for r in results]
    (docs / "oracle.json").write_text(json.dumps(dict(mitsuba=results[0]["version"], seeds=SEEDS, rows=rows), indent=1) + "\n")
    lines = [
        "# Against Mitsuba 3",
        "",
        f"`cargo xtask oracle`: enfilade and Mitsuba {results[0]['version']} (`llvm_ad_rgb`) render the same scenes from the same XML.",
        f"{SEEDS} independent seeds each, with a box filter and paths of the same depth (Mitsuba's `max_depth` is ours plus two); nothing is clamped or",
        "hidden.",
        "",
        "- *ratio*: mean luminance of our image divided by Mitsuba's, and the difference in standard errors (z).",
        "- *|z| > 3*: share of pixels whose means differ by more than three standard errors; chance alone gives 0.27 %.",
        f"- *blocks*: the image divided into {BLOCKS} × {BLOCKS}; relative difference of the means: root mean square and worst.",
        f"- *> 1 %*: blocks that differ by more, and how many of those by more than {SIGNIFICANT:g} standard errors; the rest is noise.",
        "",
        "Color is stored as float16, whose rounding (0.02 %) counts as noise. Rooms that are glTF files were exported by",
        "`crates/bench/src/to_mitsuba.rs`, which documents the conversion of their materials; both renderers loaded the export.",
        "",
        "| scene | depth | samples | ours | Mitsuba | ratio | z | \\|z\\| > 3 | blocks rms | worst | > 1 % | remark |",
        "|---|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for r in results:
        lines.append(
            f"| {r['case']} | {r['depth']} | {r['samples']} | {r['ours']:.5f} | {r['peer']:.5f} | {r['ratio']:.5f} | {r['z_image']:+.1f} | "
            f"{r['share_over_3']:.2%} | {r['block_rms']:.2%} | {r['block_worst']:+.2%} | {len(r['blocks_over'])} ({r['significant']}) | {r['explanation']} |"
        )
    lines += ["", "## Every block that differs by more than 1 %", "", "Rows and columns are counted from the upper left, starting at 0.", ""]
    lines += ["| scene | row, column | difference | z | why |", "|---|---|---|---|---|"]
    for r in results:
        for block in r["blocks_over"]:
            why = r["explanation"] if abs(block["z"]) > SIGNIFICANT else "within the noise of both"
            lines.append(f"| {r['case']} | {block['row']}, {block['column']} | {block['difference']:+.2%} | {block['z']:+.1f} | {why} |")
    lines += ["", "## Pictures", "", "Ours, Mitsuba's, and their difference (red where ours is brighter, blue where darker; full colour at 10 % of the image's mean).", ""]
    lines += [f"![{name}](oracle/{name}.jpg)" for name in ["scenes", "rooms"] if (figure_folder / f"{name}.jpg").is_file()]
    lines += ["", f"The run took {seconds / 60:.0f} minutes.", ""]
    (docs / "oracle.md").write_text("\n".join(lines))


if __name__ == "__main__":
    main()
