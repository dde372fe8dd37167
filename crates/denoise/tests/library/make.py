"""Makes `answers.f32`, what Open Image Denoise makes of the pictures that `../layers.rs` compares: every eleventh value, little-endian.

    python make.py          # needs numpy and pyoidn 2.5.1.0
"""

from pathlib import Path

import numpy as np
import pyoidn

# Width, height, and the scale of the colours: dim, usual, bright, and all of it black.
PICTURES = [(77, 50, 1e-3), (64, 96, 1.0), (129, 33, 1e4), (40, 40, 0.0)]
STRIDE = 11


def random(pixels, purpose):
    """Numbers on [0,1) for every pixel and channel, as `random` in `../layers.rs` makes them."""
    pixel, channel = np.arange(pixels, dtype=np.uint64)[:, None], np.arange(3, dtype=np.uint64)[None]
    x = (pixel << np.uint64(20)) ^ (channel << np.uint64(10)) ^ np.uint64(purpose)
    for _ in range(3):
        x = (x ^ (x >> np.uint64(31))) * np.uint64(0x9E3779B97F4A7C15)
    return (x >> np.uint64(40)).astype(np.float32) / np.float32(1 << 24)


def picture(width, height, scale, purpose):
    return (np.float32(scale) * np.square(random(width * height, purpose))).reshape(height, width, 3)


answers = []
for width, height, scale in PICTURES:
    color, albedo, normal = (picture(width, height, s, purpose) for s, purpose in [(scale, 4), (1.2, 5), (1.0, 6)])
    answers.append(pyoidn.denoise(color, albedo, normal, hdr=True, clean_aux=True).ravel()[::STRIDE])
Path(__file__).with_name("answers.f32").write_bytes(np.concatenate(answers).astype("<f4").tobytes())
