"""A small file in the layout of NYUv2's nyu_depth_v2_labeled.mat: MATLAB 7.3's block of 512 bytes in front, and transposed arrays."""

from pathlib import Path

import h5py
import numpy as np


def write(path: Path, images: np.ndarray, labels: np.ndarray) -> None:
    """images: uint8, N x H x W x 3. labels: N x H x W, classes of the file's 894, 0 where there is none."""
    with h5py.File(path, "w", userblock_size=512) as file:
        options = {"compression": "gzip", "compression_opts": 3, "chunks": True}
        file.create_dataset("images", data=images.transpose(0, 3, 2, 1), **options)
        file.create_dataset("depths", data=np.ones(labels.shape, dtype=np.float32).transpose(0, 2, 1), **options)
        file.create_dataset("labels", data=labels.astype(np.uint16).transpose(0, 2, 1), **options)
    with path.open("r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM")
