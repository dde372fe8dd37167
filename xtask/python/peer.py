"""Renders a Mitsuba scene with Mitsuba 3 and writes the colour as a NumPy array: the peer's side, a process of its own.

peer.py SCENE --size WIDTHxHEIGHT --samples N --depth D [--seed S] [--seeds K] [--sampler NAME] [--unmerged] [--out FILE.npy]

K pictures (default 1) with seeds S, S + 1, …; float32, K × height × width × 3, linear. The scene takes `width`, `height`, `depth`
and `sampler` as parameters (`rooms.py` prepares it so). `--unmerged` keeps shapes apart, which Mitsuba merges by default: 3.9.1 then
forgets merged rectangles in the scene's bounds, so that light from the surroundings passes through walls. One line of JSON tells how Mitsuba was run.
"""

import argparse
import json
import sys

import numpy as np

VARIANT = "llvm_ad_rgb"
# Samples that one call renders at once: Mitsuba keeps the state of all of them in memory.
WAVEFRONT = 1 << 24
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
    largest = max(1, WAVEFRONT // (width * height))
    pictures = []
    for seed in range(job.seed, job.seed + job.seeds):
        total, done, part = 0.0, 0, 0
        while done < job.samples:
            samples = min(largest, job.samples - done)
            picture = mi.render(scene, spp=samples, seed=seed + 1_000_003 * part)
            total = total + samples * np.array(picture, dtype=np.float64)[:, :, :3]
            done, part = done + samples, part + 1
        pictures.append(total / job.samples)
    if job.out:
        np.save(job.out, np.array(pictures, dtype=np.float32))
    print(json.dumps({"mitsuba": mi.__version__, "variant": VARIANT}))


if __name__ == "__main__":
    main()
