"""Covisibility of a scene read without our code, and computed anew from positions, K and poses alone."""

import csv
import json
import sys
from pathlib import Path

import h5py
import numpy

scene = Path(sys.argv[1])
with h5py.File(scene / "_detail/covisibility.hdf5") as file:
    shares = file["dataset"][:]
    assert file["dataset"].attrs["hidden_by"] == "scene"
frames = list(csv.DictReader(open(scene / "_detail/covisibility_frames.csv")))
assert shares.dtype == numpy.float32 and shares.shape == (len(frames), len(frames))
assert (numpy.diag(shares) == 1).all() and (shares >= 0).all() and (shares <= 1).all()


def layer(frame, name):
    folder = scene / f"images/scene_{frame['camera_name']}_geometry_hdf5"
    return h5py.File(folder / f"frame.{int(frame['frame_id']):04d}.{name}.hdf5")["dataset"][:]


def camera(frame):
    model = json.load(open(scene / "_detail" / frame["camera_name"] / "cameras_opencv.json"))
    pose = next(p for p in model["frames"] if p["frame"] == int(frame["frame_id"]))
    return numpy.array(model["K"]), numpy.array(pose["world_from_camera"])


for i, a in enumerate(frames):
    step = int(a["grid_step_px"])
    points = layer(a, "position")[step // 2 :: step, step // 2 :: step].reshape(-1, 3).astype(float)
    points = points[numpy.isfinite(points).all(axis=1)]
    assert len(points) == int(a["surface_pixels"])
    for j, b in enumerate(frames):
        k, pose = camera(b)
        distance = layer(b, "depth_meters")
        inside = (points - pose[:3, 3]) @ pose[:3, :3]
        pixel = inside @ k.T
        x, y = numpy.floor(pixel[:, :2] / pixel[:, 2:] + 0.5).T
        height, width = distance.shape
        seen = (inside[:, 2] > 0) & (x >= 0) & (y >= 0) & (x < width) & (y < height)
        stored = distance[y.clip(0, height - 1).astype(int), x.clip(0, width - 1).astype(int)]
        seen &= numpy.linalg.norm(inside, axis=1) < 1.05 * stored
        assert abs(seen.mean() - shares[i, j]) < 0.02, (i, j, seen.mean(), shares[i, j])
