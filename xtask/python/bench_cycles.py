"""`cargo xtask bench cycles`: noise that a core-second leaves, by enfilade and by Cycles, in homes at night.

Every picture is a process of its own, the renderers in turn, and counts processor seconds (user and system). Start-up and load
are not counted: of Cycles' the same run with one sample is subtracted, of ours what passes until the scene is loaded, so that
learning and the geometry layers count.
"""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from PIL import Image

import command
import figures
import views
from bench_render import relative_error, time_to
from machine import processor
from renderers import HERE, Ours, luminance, run

SIZE, LARGE = "256x192", "1024x768"
SEEDS, THREADS, BOUNCES = 2, 2, 64
OURS, PEER = [4, 16, 64], [16, 64]
LARGE_VIEW, LARGE_OURS, LARGE_PEER = views.VIEWS[0], [1, 4], [4]
# Sides of the blocks whose means are compared between the renderers, and whose noise is told beside that of pixels.
BLOCK, COARSE = 16, 8
MODES = {"default": [], "guided": ["--guiding"]}
KINDS = {"default": "its defaults", "guided": "path guiding"}
TITLES = {"ours": "enfilade", "default": "Cycles", "guided": "Cycles, path guiding"}


def main():
    job = command.parse("bench cycles", __doc__, "views", "views, such as home-1-living_1")
    known = {f"home-{seed}-{camera}": (seed, camera) for seed, camera in views.VIEWS}
    if unknown := [name for name in job.views if name not in known]:
        sys.exit(f"no view {unknown[0]!r}; expected some of {', '.join(known)}")
    os.environ["RAYON_NUM_THREADS"] = str(THREADS)
    started, rows, pictures, work = time.time(), [], [], Path(job.work)
    for name in job.views or known:
        scene = views.prepare(job.program, *known[name], work / "views")
        blend = scene.with_suffix(".blend")
        subprocess.run([sys.executable, HERE / "peer_cycles.py", scene, "--convert", blend], check=True, stdout=subprocess.DEVNULL)
        sizes = [(SIZE, OURS, PEER)] + [(LARGE, LARGE_OURS, LARGE_PEER)] * (known[name] == LARGE_VIEW)
        for size, ours_samples, peer_samples in sizes:
            curves, means = measure(Ours(job.measure), scene, blend, size, ours_samples, peer_samples)
            rows.append(compare(name, size, curves, means))
            report(rows[-1])
            if size == SIZE:
                pictures.append((f"{name}: enfilade, Cycles, difference", means["ours"], means["guided"]))
    # What only some views tell does not replace the tables of all.
    docs = work / "docs" if job.views else Path(job.docs)
    write(rows, pictures, docs, time.time() - started)
    print(f"tables and figures: {docs}")


def cycles(blend, size, samples, seed, mode):
    arguments = ["--size", size, "--samples", samples, "--bounces", BOUNCES, "--threads", THREADS, "--seed", seed, *MODES[mode]]
    return run([sys.executable, HERE / "peer_cycles.py", blend, *arguments])


def measure(ours, scene, blend, size, ours_samples, peer_samples):
    """Error and core-seconds of enfilade and of both modes of Cycles at each number of samples, and the mean picture of each."""
    # `Ours` counts as Mitsuba does, two more.
    renderers = {"ours": (ours_samples, lambda n, seed: ours.render(scene, size, n, BOUNCES + 2, seed=seed))}
    for mode in MODES:
        renderers[mode] = ([1, *peer_samples], lambda n, seed, mode=mode: cycles(blend, size, n, seed, mode))
    runs = {who: {n: [] for n in samples} for who, (samples, _) in renderers.items()}
    for seed in range(1, 1 + SEEDS):
        for who, (samples, render) in renderers.items():
            for n in samples:
                runs[who][n].append(render(n, seed))
    curves, means = {}, {}
    for who, by_samples in runs.items():
        counted = ours_samples if who == "ours" else peer_samples
        means[who] = np.mean([n * one.pictures[0].astype(np.float64) for n in counted for one in by_samples[n]], axis=0) / np.mean(counted)
        reference = luminance(means[who])
        first = by_samples[min(by_samples)]
        base = np.median([one.told.get("load_core_s", one.core_s) for one in first])
        curves[who] = dict(
            mean=float(reference.mean()),
            base_s=float(base),
            peak_mb=float(np.median([one.peak_mb for one in by_samples[counted[-1]]])),
            samples=counted,
            error=[relative_error([luminance(one.pictures[0]) for one in by_samples[n]], reference) for n in counted],
            block_error=[relative_error([blocks(luminance(one.pictures[0]), COARSE) for one in by_samples[n]], blocks(reference, COARSE)) for n in counted],
            core_s=[float(np.median([one.core_s for one in by_samples[n]]) - base) for n in counted],
            version=first[0].told.get("blender"),
        )
    return curves, means


def compare(name, size, curves, means):
    """How far the means agree, and the ratios of core-seconds to the error that Cycles reaches at its most samples."""
    pictures = {who: luminance(mean) for who, mean in means.items()}
    # Both modes have the same mean, and together they know it best.
    pictures["peer"] = np.mean([pictures[mode] for mode in MODES], axis=0)
    result = dict(case=name, size=size, curves=curves, agreement=agreement(pictures["ours"], pictures["peer"]))
    result["itself"] = agreement(pictures["guided"], pictures["default"])
    result["modes"] = {}
    for mode in MODES:
        error, seconds = curves[mode]["error"][-1], curves[mode]["core_s"][-1]
        mine = time_to(error, curves["ours"])
        coarse = time_to(curves[mode]["block_error"][-1], curves["ours"] | dict(error=curves["ours"]["block_error"]))
        found = dict(samples=curves[mode]["samples"][-1], error=error, peer=seconds, ours=mine, ratio=seconds / mine)
        result["modes"][mode] = found | dict(ours_blocks=coarse, ratio_blocks=seconds / coarse)
    return result


def agreement(one, other):
    """One picture over another less one: of the whole, in the median of blocks, and how many blocks are near."""
    difference = blocks(one, BLOCK) / blocks(other, BLOCK) - 1
    within = {f"within_{percent}": float((np.abs(difference) < percent / 100).mean()) for percent in (5, 10)}
    return dict(whole=float(one.mean() / other.mean() - 1), median=float(np.median(difference)), **within)


def blocks(image, side):
    """Means of squares of so many pixels."""
    height, width = (n // side * side for n in image.shape)
    return image[:height, :width].reshape(height // side, side, width // side, side).mean((1, 3))


def report(r):
    ratios = ", ".join(f"{TITLES[mode]} {found['ratio']:.2f} (of blocks {found['ratio_blocks']:.2f})" for mode, found in r["modes"].items())
    found = r["agreement"]
    print(f"{r['case']:22} {r['size']:9} mean {found['whole']:+.2%}, blocks within 5 % {found['within_5']:.0%}; to equal error: {ratios}", flush=True)


def write(rows, pictures, docs, seconds):
    docs.mkdir(parents=True, exist_ok=True)
    kinds = [("equal error", "ours", "ratio"), (f"equal error of blocks of {COARSE}x{COARSE} pixels", "ours_blocks", "ratio_blocks")]
    cases = [
        dict(case=f"{r['case']} {r['size']}, {TITLES[mode]}: core-seconds to {what}", ours=found[ours], peer=found["peer"], ratio=found[ratio])
        for what, ours, ratio in kinds
        for r in rows
        for mode, found in r["modes"].items()
    ]
    version = rows[0]["curves"]["default"]["version"]
    (docs / "cycles.json").write_text(json.dumps(dict(processor=processor(), blender=version, rows=cases, views=rows), indent=1) + "\n")
    panels = [(r["case"], {TITLES[who]: (curve["core_s"], curve["error"]) for who, curve in r["curves"].items()}) for r in rows if r["size"] == SIZE]
    (docs / "cycles.svg").write_text(figures.curves(panels))
    figures.sheet(pictures, 1).save(docs / "cycles.jpg", quality=70)
    (docs / "cycles.md").write_text("\n".join(page(rows, version, seconds)))


def page(rows, version, seconds):
    yield "# Noise per core-second, against Cycles"
    yield ""
    yield f"`cargo xtask bench cycles` on {processor()}: enfilade and Cycles of Blender {version}, the renderer of BlenderProc, Infinigen and Kubric, render the same"
    yield "glTF files with their cameras: homes that `enfilade home --moment night` makes, lit by their lamps alone. Every lamp is a surface that emits light."
    yield f"Both: {THREADS} threads, box filter of one pixel, {BOUNCES} bounces, black surroundings, float32. Of Cycles, all that makes pictures biased is off: clamping of direct"
    yield "and indirect light, filtered caustics, the threshold below which lamps are left out, adaptive sampling and the denoiser; the light tree is on, and lamps that"
    yield "shine to one side are sampled from that side, which lowers its noise. *Path guiding* is Cycles' (Open PGL), with its own settings. Ours writes every layer with"
    yield f"its default settings, Cycles color alone. Processor seconds, user and system, of {SEEDS} seeds (median), in turn. Start-up and load are subtracted: of Cycles the"
    yield "run with one sample, of ours what passes until the scene is loaded, so that learning where light comes from and the geometry layers count."
    yield ""
    yield "Two things are changed in the files because the two programs mean different things by them: window panes, sheets without thickness, become black and keep"
    yield "their reflection; the sheen of towels, and the colour of thick glass and water, are left out."
    yield ""
    yield "relMSE: mean of variance between seeds / (own mean² + 0.01), the image scaled to a mean of 0.5, the worst 0.1 % of pixels left out. A bright speck that one of two"
    yield "seeds has counts as 2 at most, however bright."
    yield "*ratio*: Cycles' core-seconds over ours at the error that Cycles reaches with the samples stated, ours taken from its curve; above 1 where ours is better."
    yield f"*ratio of blocks*: the same with the means of {COARSE}×{COARSE} pixels in place of pixels: what a look from farther away,"
    yield "a smaller picture or a denoiser sees of the noise."
    yield "Path guiding learns during its first 128 samples, so with fewer it is not yet at its best."
    yield ""
    yield "| view | size | Cycles | samples | relMSE | core-s | ours to that relMSE | ratio | ratio of blocks | subtracted: ours | Cycles | peak MB ours | Cycles |"
    yield "|---|---|---|---|---|---|---|---|---|---|---|---|---|"
    for r in rows:
        ours = r["curves"]["ours"]
        for mode, found in r["modes"].items():
            peer = r["curves"][mode]
            yield (
                f"| {r['case']} | {r['size']} | {KINDS[mode]} | {found['samples']} | {found['error']:.4f} | {found['peer']:.1f} | {found['ours']:.1f} | **{found['ratio']:.2f}** | {found['ratio_blocks']:.2f} | "
                f"{ours['base_s']:.2f} s | {peer['base_s']:.2f} s | {ours['peak_mb']:.0f} | {peer['peak_mb']:.0f} |"
            )
    yield ""
    for mode, kind in KINDS.items():
        pixels, coarse = (np.exp(np.mean([np.log(r["modes"][mode][ratio]) for r in rows])) for ratio in ("ratio", "ratio_blocks"))
        yield f"Geometric means against Cycles with {kind}: {pixels:.2f}, of blocks {coarse:.2f}."
    yield ""
    yield "![error against time](cycles.svg)"
    yield ""
    yield f"Samples at {SIZE}: ours {', '.join(map(str, OURS))}, Cycles {', '.join(map(str, PEER))}."
    yield ""
    yield "## The curves"
    yield ""
    yield "| view | size | renderer | samples: relMSE in core-s |"
    yield "|---|---|---|---|"
    for r in rows:
        for who, curve in r["curves"].items():
            points = "; ".join(f"{n}: {e:.4f} in {t:.1f}" for n, e, t in zip(curve["samples"], curve["error"], curve["core_s"]))
            yield f"| {r['case']} | {r['size']} | {TITLES[who]} | {points} |"
    yield ""
    yield "## Do they render the same?"
    yield ""
    yield f"The mean of all pictures of one over that of the other, less one: the whole image and blocks of {BLOCK}×{BLOCK} pixels. Below ours against Cycles, and for the"
    yield "share of noise in that, Cycles with path guiding against Cycles without."
    yield ""
    yield "| view | size | what | whole | median of blocks | blocks within 5 % | within 10 % |"
    yield "|---|---|---|---|---|---|---|"
    for r in rows:
        for what, found in [("ours against Cycles", r["agreement"]), ("Cycles against itself", r["itself"])]:
            yield f"| {r['case']} | {r['size']} | {what} | {found['whole']:+.2%} | {found['median']:+.2%} | {found['within_5']:.0%} | {found['within_10']:.0%} |"
    yield ""
    yield "![enfilade, Cycles and the difference of both](cycles.jpg)"
    yield ""
    yield f"The run took {seconds / 60:.0f} minutes."
    yield ""


if __name__ == "__main__":
    main()
