"""What Open Image Denoise makes of a picture beside our network, and what it costs: the second half of `cargo xtask bench network`.

library.py FOLDER

The folder holds `color.pfm`, `normal.pfm` and `ours.pfm`, as the example `network` leaves them. The least processor seconds of three runs are
printed, and the difference: the mean of |ours - the library's| over the mean of the library's, and the greatest |ours - the library's| over the
library's and a hundredth of that mean.
"""

import sys
from pathlib import Path
from time import process_time

import numpy as np
import pyoidn


def read(path):
    """A portable float map in colour, rows from the top."""
    kind, size, scale, data = path.read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    if kind != b"PF" or not scale.startswith(b"-"):
        sys.exit(f"{path}: not a little-endian portable float map in colour")
    return np.frombuffer(data, "<f4").reshape(height, width, 3)[::-1].copy()


color, normal, ours = (read(Path(sys.argv[1]) / f"{name}.pfm") for name in ["color", "normal", "ours"])
seconds = []
for _ in range(3):
    before = process_time()
    found = pyoidn.denoise(color, np.ones_like(color), normal, hdr=True, clean_aux=True)
    seconds.append(process_time() - before)
found, ours = found.astype(np.float64), ours.astype(np.float64)
mean = np.abs(found).mean()
greatest = (np.abs(ours - found) / (np.abs(found) + 0.01 * mean)).max()
print(f"  the library  {min(seconds):>7.2f} core-s  mean {np.abs(ours - found).mean() / mean:.2e}, greatest {greatest:.2e}")
