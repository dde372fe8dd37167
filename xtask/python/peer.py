"""Renders a Mitsuba scene with Mitsuba 3 and writes the colour as a NumPy array: the peer's side, a process of its own.

peer.py SCENE --size WIDTHxHEIGHT --samples N --depth D [--seed S] [--seeds K] [--sampler NAME] [--unmerged] [--denoise] [--out FILE.npy]

K pictures (default 1) with seeds S, S + 1, …; float32, K × height × width × 3, linear. With `--denoise` there follow as many by Open Image
Denoise, guided by albedo and normals of the first surface, of 64 samples that no time is counted of. The scene takes `width`, `height`, `depth`
and `sampler` as parameters (`rooms.py` prepares it so). `--unmerged` keeps shapes apart, which Mitsuba merges by default: 3.9.1 then
forgets merged rectangles in the scene's bounds, so that light from the surroundings passes through walls. One line of JSON tells how Mitsuba was
run, and the processor seconds of all threads until its kernels were compiled, of rendering, and of denoising.
"""

import argparse
import json
import sys
from time import process_time

import numpy as np

VARIANT = "llvm_ad_rgb"
# Samples that one call renders at once: Mitsuba keeps the state of all of them in memory.
WAVEFRONT = 1 << 24
# Samples of the guides of the denoiser.
GUIDES = 64
LLVM_MISSING = f"""\
Mitsuba's variant {VARIANT} needs LLVM's shared library, version 16 or newer. On Debian: apt-get install libllvm19
(or newer). Elsewhere: name the library in DRJIT_LIBLLVM_PATH."""


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("scene")
    parser.add_argument("--size", default="256x192")
    parser.add_argument("--samples", type=int, default=16)
    parser.add_argument("--depth", type=int, default=10)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--sampler", default="independent")
    parser.add_argument("--unmerged", action="store_true")
    parser.add_argument("--denoise", action="store_true")
    parser.add_argument("--out")
    job = parser.parse_args()
    import mitsuba as mi

    try:
        mi.set_variant(VARIANT)
    except ImportError as error:
        sys.exit(f"{error}\n{LLVM_MISSING}")
    width, height = map(int, job.size.split("x"))
    parameters = dict(width=str(width), height=str(height), depth=str(job.depth), sampler=job.sampler)
    scene = mi.load_file(job.scene, optimize=not job.unmerged, **parameters)
    # A power of two, for which one kernel does, as it does for two samples: this compiles it.
    largest = 1 << max(0, (WAVEFRONT // (width * height)).bit_length() - 1)
    seeds = range(job.seed, job.seed + job.seeds)
    np.array(mi.render(scene, spp=2))
    guides = denoiser(mi, scene) if job.denoise else None
    loaded = process_time()
    pictures = [picture(mi, scene, job.samples, seed, largest) for seed in seeds]
    rendered = process_time()
    if job.denoise:
        pictures += [guides(each) for each in pictures]
    denoised = process_time()
    if job.out:
        np.save(job.out, np.array(pictures))
    seconds = dict(load_core_s=loaded, render_core_s=rendered - loaded, denoise_core_s=denoised - rendered)
    print(json.dumps({"mitsuba": mi.__version__, "variant": VARIANT, **seconds}))


def picture(mi, scene, samples, seed, largest):
    total, done, part = 0.0, 0, 0
    while done < samples:
        some = min(largest, samples - done)
        found = mi.render(scene, spp=some, seed=seed + 1_000_003 * part)
        total = total + some * np.array(found, dtype=np.float64)[:, :, :3]
        done, part = done + some, part + 1
    return (total / samples).astype(np.float32)


def denoiser(mi, scene):
    """A function that denoises pictures of this scene."""
    import pyoidn

    integrator = mi.load_dict({"type": "aov", "aovs": "albedo:albedo,normal:sh_normal"})
    guides = np.array(mi.render(scene, integrator=integrator, spp=GUIDES))
    albedo, normal = (np.ascontiguousarray(guides[:, :, part]) for part in (slice(0, 3), slice(3, 6)))
    # The first call loads the library.
    pyoidn.denoise(*[np.zeros((16, 16, 3), np.float32)] * 3, hdr=True, clean_aux=True)
    return lambda color: pyoidn.denoise(color, albedo.clip(0, 1), normal, hdr=True, clean_aux=True)


if __name__ == "__main__":
    main()
