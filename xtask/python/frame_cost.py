"""What a large frame of ours with every layer costs, at a noise that a delivered image may have."""

import numpy as np

SMALL, LARGE = "256x192", "1024x768"
# Noise of a delivered image: see `tone_mapped_noise`.
TARGET = 0.02
# Samples at which noise is measured: of small pictures as rendered, of large ones denoised.
COUNTS, DENOISED = [32, 128], [8, 32]
# Samples of the large frames that tell the seconds of one.
TIMED = [1, 9]
SEEDS = [1, 2]
TENT = dict(filter="tent", filter_radius=1.0)


def measure(store, ours, scene, name):
    """Samples that leave the target noise, and what a large frame with every layer then costs, as rendered and denoised."""
    shoot = lambda size, n, seed=SEEDS[0]: store.shot(ours, scene, size, n, seed, **TENT)
    # Noise per pixel hardly depends on the image's size: it is measured on a small one. A denoiser looks at many pixels.
    noise = [tone_mapped_noise([shoot(SMALL, n, seed).raw for seed in SEEDS]) for n in COUNTS]
    clean = [tone_mapped_noise([shoot(LARGE, n, seed).delivered for seed in SEEDS]) for n in DENOISED]
    few, more = (shoot(LARGE, n).facts for n in TIMED)
    per_sample = (more["render_core_s"] - few["render_core_s"]) / (TIMED[1] - TIMED[0])
    fixed = max(0.0, few["render_core_s"] - TIMED[0] * per_sample)
    before, denoising = few["load_core_s"] + more["learn_core_s"] + fixed, more["denoise_core_s"]
    # Fewer samples than were measured say nothing.
    samples, clean_samples = samples_for_target(COUNTS, noise), max(DENOISED[0], samples_for_target(DENOISED, clean))
    core_min = (before + clean_samples * per_sample + denoising) / 60
    denoised = dict(noise=dict(zip(map(str, DENOISED), clean)), samples=clean_samples, core_min=core_min, denoise_s=denoising)
    return dict(
        case=name,
        noise=dict(zip(map(str, COUNTS), noise)),
        samples=samples,
        core_min=(before + samples * per_sample) / 60,
        denoised=denoised,
        load_s=few["load_core_s"],
        learn_s=more["learn_core_s"],
        fixed_s=fixed,
        sample_s=per_sample,
        peak_mb=more["peak_mb"],
    )


def tone_mapped_noise(pictures):
    """Noise of an image as delivered: the root mean square over the pixels of the standard error of the tone-mapped value, over its mean.

    Tone-mapped is (s·L)^(1/2.2), at most 1, where s takes the 90th percentile of brightness to 0.8, as in the previews.
    """
    brightness = np.array([picture.astype(np.float64) @ [0.3, 0.59, 0.11] for picture in pictures])
    scale = 0.8**2.2 / np.percentile(brightness.mean(0), 90)
    values = np.minimum(np.maximum(scale * brightness, 0) ** (1 / 2.2), 1)
    return float(np.sqrt(np.var(values, axis=0, ddof=1).mean()) / values.mean())


def samples_for_target(counts, noise):
    """Samples per pixel at which the noise reaches the target, by the power law between two counts."""
    slope = np.log(noise[1] / noise[0]) / np.log(counts[1] / counts[0])
    return int(np.ceil(counts[1] * (TARGET / noise[1]) ** (1 / min(slope, -0.3))))


def report(cost):
    clean = cost["denoised"]
    print(f"{cost['case']:40} delivered at {cost['samples']} samples: {cost['core_min']:.2f} core-minutes; denoised at {clean['samples']}: {clean['core_min']:.2f}", flush=True)


def section(costs, bounces):
    """Markdown."""
    few, more = map(str, COUNTS)
    yield "## What a delivered frame costs"
    yield ""
    yield f"{LARGE}, every layer, tent filter and {bounces} bounces, at the noise of a delivered image: the root mean square, over the pixels, of the standard"
    yield f"error of the tone-mapped value (90th percentile of brightness to 0.8, gamma 1/2.2, at most 1) is {TARGET:.0%} of its mean. The samples needed are"
    yield f"measured between two seeds at {SMALL} ({few} and {more} samples, extrapolated by the power law between them), the seconds per sample at {LARGE}"
    yield f"({TIMED[0]} and {TIMED[1]} samples)."
    yield "*Geometry* is the time of the geometry layers and of all else that does not grow with the samples: the frame's time, extrapolated to no"
    yield "samples."
    yield ""
    yield f"| room | noise at {few} | at {more} samples | samples needed | **core-minutes** | of which loading | learning | geometry | per sample | peak MB |"
    yield "|---|---|---|---|---|---|---|---|---|---|"
    for c in costs:
        yield (
            f"| {c['case']} | {c['noise'][few]:.2%} | {c['noise'][more]:.2%} | {c['samples']} | {c['core_min']:.2f} | {c['load_s']:.2f} s | {c['learn_s']:.2f} s | "
            f"{c['fixed_s']:.2f} s | {c['sample_s']:.2f} s | {c['peak_mb']:.0f} |"
        )
    few, more = map(str, DENOISED)
    yield ""
    yield f"Median as rendered: {np.median([c['core_min'] for c in costs]):.2f} core-minutes."
    yield ""
    yield f"The same frame denoised: the noise is that between two seeds at {LARGE}. What the denoiser changes in the same way for every seed is not"
    yield "part of this number, but of the tables above."
    yield ""
    yield f"| room | noise at {few} | at {more} samples | samples needed | **core-minutes** | of which denoising |"
    yield "|---|---|---|---|---|---|"
    for c in costs:
        d = c["denoised"]
        yield f"| {c['case']} | {d['noise'][few]:.2%} | {d['noise'][more]:.2%} | {d['samples']} | {d['core_min']:.2f} | {d['denoise_s']:.1f} s |"
    yield ""
    yield f"Median denoised: {np.median([c['denoised']['core_min'] for c in costs]):.2f} core-minutes."
    yield ""
