"""Datasets for the tests: one that enfilade makes, the same as Hypersim stores it, and Hypersim's own."""

import atexit
import functools
import os
import shutil
import tempfile
from pathlib import Path

import enfilade
import h5py
import numpy as np

SIZE = (200, 140)


@functools.cache
def folder():
    """A folder that is removed at the end; the processes that tests start share it."""
    shared = os.environ.get("ENFILADE_TEST_FOLDER")
    if shared:
        return Path(shared)
    made = Path(tempfile.mkdtemp(prefix="enfilade-python-"))
    os.environ["ENFILADE_TEST_FOLDER"] = str(made)
    owner = os.getpid()
    atexit.register(lambda: os.getpid() == owner and shutil.rmtree(made, ignore_errors=True))
    return made


def small_config():
    return enfilade.Config.demo(frames=3, size=SIZE, samples=2)


@functools.cache
def made():
    """Three frames of the demo's room, with labels."""
    out = folder() / "made"
    if not (out / "manifest.json").is_file():
        enfilade.run(out, small_config())
    return out


@functools.cache
def as_hypersim():
    """The same frames as Hypersim's release has them: float16 and int16, gzip 9, chunks of h5py, nothing of ours beside them."""
    out = folder() / "release"
    if out.is_dir():
        return out
    ours = ("frames", "manifest*", "cameras_opencv.json", ".enfilade*", "*.jpg", "*.png", "depth_z_meters")
    shutil.copytree(made(), out, ignore=shutil.ignore_patterns(*ours))
    for path in out.glob("scenes/*/images/*_hdf5/*.hdf5"):
        values = read(path)
        layer = path.name.split(".")[2]
        if layer in ("valid", "depth_z_meters", "color_standard_error"):
            path.unlink()
            continue
        values = values.astype(np.float16) if values.dtype == np.float32 else values
        path.unlink()
        with h5py.File(path, "w") as file:
            file.create_dataset("dataset", data=values, compression="gzip", compression_opts=9)
    return out


def real():
    """Hypersim's own frame, where it is at hand."""
    scenes = os.environ.get("ENFILADE_SCENES")
    path = Path(scenes) / "hypersim-real" if scenes else None
    return path if path and path.is_dir() else None


def read(path):
    with h5py.File(path, "r") as file:
        return file["dataset"][...]


def file_of(root, sample, layer):
    """The file of a layer of a sample."""
    name = f"frame.{sample['frame']:04}.{layer}.hdf5"
    found = sorted(Path(root).glob(f"**/{sample['scene']}/images/scene_{sample['camera']}_*_hdf5/{name}"))
    assert len(found) == 1, found
    return found[0]
