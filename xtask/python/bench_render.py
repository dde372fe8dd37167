"""`cargo xtask bench render`: what a picture of a room costs, by enfilade and by Mitsuba 3.

Every picture is a process of its own, both renderers in turn, and counts processor seconds (user and system). Start-up and load
are not counted: of Mitsuba's the same run with one sample is subtracted, of ours what passes until the scene is loaded, so that
learning and the geometry layers count.
"""

import json
import sys
import time
from pathlib import Path

import numpy as np

import command
import figures
import rooms
from machine import processor
from renderers import Mitsuba, Ours, luminance

SIZE, LARGE = "256x192", "1024x768"
LARGE_ROOM, LARGE_SAMPLES = "grey-white-room", 32
# Samples of the denoised frames.
DENOISED = [8, 32]
DEPTH = 10
SEEDS = 2
CURVE = [4, 16, 64, 256]
# The samples at which the tables compare.
AT = 256
# The noise of a delivered image: see `tone_mapped_noise`.
TARGET = 0.02
# Bounces of a delivered image: all that matter.
DELIVERED_DEPTH = 66
NAMES = {"ours": "enfilade", "peer": "Mitsuba 3"}


def main():
    job = command.parse("bench render", __doc__, "rooms", "rooms")
    if not job.scenes:
        sys.exit("ENFILADE_SCENES should name the folder of the shared rooms: this measures nothing else")
    if unknown := [name for name in job.rooms if name not in rooms.ROOMS]:
        sys.exit(f"no room {unknown[0]!r}; expected some of {', '.join(rooms.ROOMS)}")
    renderers = {"ours": Ours(job.measure), "peer": Mitsuba()}
    started, equal, large, costs = time.time(), [], [], []
    for name in job.rooms or rooms.ROOMS:
        scene = rooms.prepare(name, job.scenes, Path(job.work) / "rooms", job.exporter)
        curves = measure(renderers, scene, SIZE, CURVE)
        equal.append(row(name, SIZE, curves, AT))
        report(equal[-1])
        if name == LARGE_ROOM:
            large.append(row(name, LARGE, measure(renderers, scene, LARGE, [LARGE_SAMPLES], 2), LARGE_SAMPLES))
            report(large[-1])
        costs.append(delivered(renderers["ours"], scene, name))
        print(f"{name:28} delivered at {costs[-1]['samples']} samples: {costs[-1]['core_min']:.2f} core-minutes; denoised at "
            f"{costs[-1]['denoised']['samples']}: {costs[-1]['denoised']['core_min']:.2f}", flush=True)
    # What only some rooms tell does not replace the tables of all.
    docs = Path(job.work) / "docs" if job.rooms else Path(job.docs)
    write(equal, large, costs, renderers["peer"], docs, time.time() - started)
    print(f"tables and figures: {docs}")


def measure(renderers, scene, size, samples, seeds=SEEDS):
    """Error, core-seconds and memory of both at each number of samples."""
    runs = {who: {n: [] for n in [1, *samples]} for who in renderers}
    renderers["peer"].render(scene, size, 1, DEPTH)  # compiles Mitsuba's kernels, which it keeps on disk
    for seed in range(seeds):
        for n in [1, *samples]:
            for who, renderer in renderers.items():
                runs[who][n].append(renderer.render(scene, size, n, DEPTH, seed=1 + seed))
    curves = {}
    for who, by_samples in runs.items():
        reference = np.mean([n * luminance(run.pictures[0]) for n in samples for run in by_samples[n]], axis=0) / np.mean(samples)
        base = np.median([run.told.get("load_core_s", run.core_s) for run in by_samples[1]])
        curves[who] = dict(
            mean=float(reference.mean()),
            base_s=float(base),
            peak_mb=float(np.median([run.peak_mb for run in by_samples[samples[-1]]])),
            samples=samples,
            error=[relative_error([luminance(run.pictures[0]) for run in by_samples[n]], reference) for n in samples],
            core_s=[float(np.median([run.core_s for run in by_samples[n]]) - base) for n in samples],
            version=by_samples[1][0].told.get("mitsuba"),
        )
    return curves


def relative_error(pictures, reference):
    """relMSE: the mean of variance / (reference² + 0.01), the image scaled to a mean of 0.5, the worst 0.1 % of pixels left out.

    The variance is that between seeds, the reference the renderer's own mean of all its pictures.
    """
    scale = 0.5 / reference.mean()
    errors = np.var(pictures, axis=0, ddof=1) * scale**2 / ((reference * scale) ** 2 + 0.01)
    errors = np.sort(errors.ravel())
    return float(errors[: len(errors) * 999 // 1000].mean())


def row(name, size, curves, at):
    """Error × time of both, and the ratio of core-seconds to the error that the peer reaches at `at` samples."""
    megapixels = np.prod([int(n) for n in size.split("x")]) / 1e6
    i = curves["ours"]["samples"].index(at)
    result = dict(case=name, size=size, samples=at)
    for who, c in curves.items():
        product = c["error"][i] * c["core_s"][i] / megapixels
        rate = at * megapixels / c["core_s"][i]
        result[who] = c | dict(error_time=product, rate=rate)
    error, seconds = curves["peer"]["error"][i], curves["peer"]["core_s"][i]
    result["ratio"] = seconds / time_to(error, curves["ours"])
    return result


def time_to(error, curve):
    """Core-seconds to an error, between measured points on straight lines in log-log; beyond them, and for one point, error ∝ 1/time."""
    e, t = np.log(curve["error"]), np.log(curve["core_s"])
    if len(e) == 1 or np.log(error) <= e[-1]:
        return float(np.exp(t[-1] + e[-1] - np.log(error)))
    return float(np.exp(np.interp(-np.log(error), -e, t)))


def tone_mapped_noise(pictures):
    """Noise of an image as delivered: the root mean square over the pixels of the standard error of the tone-mapped value, over its mean.

    Tone-mapped is (s·L)^(1/2.2), at most 1, where s takes the 90th percentile of brightness to 0.8, as in the previews.
    """
    brightness = np.array([picture.astype(np.float64) @ [0.3, 0.59, 0.11] for picture in pictures])
    scale = 0.8**2.2 / np.percentile(brightness.mean(0), 90)
    values = np.minimum(np.maximum(scale * brightness, 0) ** (1 / 2.2), 1)
    return float(np.sqrt(np.var(values, axis=0, ddof=1).mean()) / values.mean())


def delivered(ours, scene, name):
    """Samples that leave the target noise, and what a large frame with every layer then costs, as rendered and denoised."""
    # Noise per pixel hardly depends on the image's size: it is measured on a small one, with the tent filter of delivered images.
    tent = dict(filter="tent", filter_radius=1.0)
    counts = [32, 128]
    runs = [ours.render(scene, SIZE, n, DELIVERED_DEPTH, seeds=2, **tent) for n in counts]
    noise = [tone_mapped_noise(run.pictures) for run in runs]
    samples = samples_for_target(counts, noise)
    few, more = (ours.render(scene, LARGE, n, DELIVERED_DEPTH, **tent) for n in (1, 9))
    per_sample = (more.told["render_core_s"] - few.told["render_core_s"]) / 8
    fixed = max(0.0, few.told["render_core_s"] - per_sample)
    # A denoiser looks at many pixels: what it leaves is measured at the delivered size.
    clean = [ours.render(scene, LARGE, n, DELIVERED_DEPTH, seeds=2, denoise=True, **tent) for n in DENOISED]
    clean_noise = [tone_mapped_noise(run.pictures[2:]) for run in clean]
    # Fewer samples than were measured say nothing.
    clean_samples = max(DENOISED[0], samples_for_target(DENOISED, clean_noise))
    before = few.told["load_core_s"] + more.told["learn_core_s"] + fixed
    denoising = clean[0].told["denoise_core_s"] / 2
    return dict(
        case=name,
        noise=dict(zip(map(str, counts), noise)),
        samples=samples,
        core_min=(before + samples * per_sample) / 60,
        denoised=dict(
            noise=dict(zip(map(str, DENOISED), clean_noise)), samples=clean_samples, core_min=(before + clean_samples * per_sample + denoising) / 60, denoise_s=denoising
        ),
        load_s=few.told["load_core_s"],
        learn_s=more.told["learn_core_s"],
        fixed_s=fixed,
        sample_s=per_sample,
        peak_mb=more.peak_mb,
    )


def samples_for_target(counts, noise):
    """Samples per pixel at which the noise reaches the target, by the power law between two counts."""
    slope = np.log(noise[1] / noise[0]) / np.log(counts[1] / counts[0])
    return int(np.ceil(counts[1] * (TARGET / noise[1]) ** (1 / min(slope, -0.3))))


def report(r):
    ours, peer = r["ours"], r["peer"]
    print(
        f"{r['case']:28} {r['size']:9} err*time {ours['error_time']:.2f} / {peer['error_time']:.2f}, M samples per core-s {ours['rate']:.3f} / {peer['rate']:.3f}, "
        f"means {ours['mean']:.5f} / {peer['mean']:.5f}, to equal error {r['ratio']:.2f}",
        flush=True,
    )


def write(equal, large, costs, peer, docs, seconds):
    docs.mkdir(parents=True, exist_ok=True)
    rows = [dict(case=f"{r['case']} {r['size']}: core-seconds to equal error", ours=r["peer"]["core_s"][i] / r["ratio"], peer=r["peer"]["core_s"][i], ratio=r["ratio"]) for r in equal + large for i in [r["peer"]["samples"].index(r["samples"])]]
    rows += [dict(case=f"{r['case']} {r['size']}: error x core-seconds per megapixel", ours=r["ours"]["error_time"], peer=r["peer"]["error_time"], ratio=r["peer"]["error_time"] / r["ours"]["error_time"]) for r in equal + large]
    rows += [dict(case=f"{r['case']} {r['size']}: peak MB", ours=r["ours"]["peak_mb"], peer=r["peer"]["peak_mb"], ratio=r["peer"]["peak_mb"] / r["ours"]["peak_mb"]) for r in equal + large]
    version = equal[0]["peer"]["version"]
    (docs / "render.json").write_text(json.dumps(dict(processor=processor(), mitsuba=version, rows=rows, curves=equal + large, delivered=costs), indent=1) + "\n")
    (docs / "render.svg").write_text(figures.curves([(r["case"], {NAMES[w]: (r[w]["core_s"], r[w]["error"]) for w in NAMES}) for r in equal]))
    lines = [
        "# Rendering, against Mitsuba 3",
        "",
        f"`cargo xtask bench render` on {processor()}: enfilade and Mitsuba {version} (`llvm_ad_rgb`, LLVM {peer.llvm}, independent samples) render the same XML with the",
        f"same camera, box filter and path depth ({DEPTH} segments: Mitsuba's `max_depth` {DEPTH}, our `max_bounces` {DEPTH - 2}). Ours writes every layer, Mitsuba color alone.",
        f"Processor seconds, user and system, of {SEEDS} seeds (median), in turn. Start-up and load are subtracted: of Mitsuba the run with one sample, of ours",
        "what passes until the scene is loaded, so that learning where light comes from and the geometry layers count.",
        "",
        "relMSE: mean of variance between seeds / (own mean² + 0.01), the image scaled to a mean of 0.5, the worst 0.1 % of pixels left out.",
        "*err·time*: relMSE × core-seconds per megapixel. *ratio*: Mitsuba's core-seconds over ours at the error that Mitsuba reaches with the",
        "samples stated, ours taken from its curve; above 1 where ours is better.",
        "",
        "| room | size | samples | relMSE ours | Mitsuba | M samples/core-s ours | Mitsuba | err·time ours | Mitsuba | ratio | subtracted: ours | Mitsuba | peak MB ours | Mitsuba |",
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for r in equal + large:
        o, p, i = r["ours"], r["peer"], r["ours"]["samples"].index(r["samples"])
        lines.append(
            f"| {r['case']} | {r['size']} | {r['samples']} | {o['error'][i]:.4f} | {p['error'][i]:.4f} | {o['rate']:.3f} | {p['rate']:.3f} | {o['error_time']:.2f} | {p['error_time']:.2f} | "
            f"**{r['ratio']:.2f}** | {o['base_s']:.2f} s | {p['base_s']:.2f} s | {o['peak_mb']:.0f} | {p['peak_mb']:.0f} |"
        )
    lines += ["", "![error against time](render.svg)", "", f"Samples {', '.join(map(str, CURVE))} at {SIZE}.", "", "## What a delivered frame costs", ""]
    lines += [
        f"{LARGE}, every layer, tent filter, {DELIVERED_DEPTH - 2} bounces, at the noise of a delivered image: the root mean square over the pixels of the standard",
        f"error of the tone-mapped value (90th percentile of brightness to 0.8, gamma 1/2.2, at most 1) is {TARGET:.0%} of its mean. The samples this needs are measured",
        f"between two seeds at {SIZE} (32 and 128 samples, the power law between them carried on), the seconds per sample at {LARGE} (1 and 9 samples).",
        "*Geometry*: the geometry layers and whatever else does not grow with the samples, by carrying the frame's time on to no samples.",
        "",
        "| room | noise at 32 | at 128 samples | samples needed | **core-minutes** | of them load | learning | geometry | per sample | peak MB |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for c in costs:
        lines.append(
            f"| {c['case']} | {c['noise']['32']:.2%} | {c['noise']['128']:.2%} | {c['samples']} | {c['core_min']:.2f} | {c['load_s']:.2f} s | {c['learn_s']:.2f} s | "
            f"{c['fixed_s']:.2f} s | {c['sample_s']:.2f} s | {c['peak_mb']:.0f} |"
        )
    few, more = map(str, DENOISED)
    lines += [
        "",
        f"Median as rendered: {np.median([c['core_min'] for c in costs]):.2f} core-minutes.",
        "",
        f"The same frame denoised (`color_denoised`, written beside the unbiased layers): its noise is that between two seeds at {LARGE}. What the denoiser",
        "changes in the same way for every seed is not in this number: [denoise.md](denoise.md) compares with references.",
        "",
        f"| room | noise at {few} | at {more} samples | samples needed | **core-minutes** | of them denoising |",
        "|---|---|---|---|---|---|",
    ]
    for c in costs:
        d = c["denoised"]
        lines.append(f"| {c['case']} | {d['noise'][few]:.2%} | {d['noise'][more]:.2%} | {d['samples']} | {d['core_min']:.2f} | {d['denoise_s']:.1f} s |")
    lines += ["", f"Median denoised: {np.median([c['denoised']['core_min'] for c in costs]):.2f} core-minutes. The run took {seconds / 60:.0f} minutes.", ""]
    (docs / "render.md").write_text("\n".join(lines))


if __name__ == "__main__":
    main()
