"""Tracks read as TAP-Vid's loaders read a sample, and computed anew from K, poses and stored distances."""

import json
import sys
from pathlib import Path

import h5py
import numpy

scene = Path(sys.argv[1])
sample = dict(numpy.load(scene / "_detail/cam_00/tracks.npz"))
points, occluded = sample["points"], sample["occluded"]
n, t = occluded.shape
assert points.dtype == numpy.float32 and points.shape == (n, t, 2) and occluded.dtype == bool
assert sample["query_points"].shape == (n, 3) and sample["query_points"].dtype == numpy.float32
model = json.load(open(scene / "_detail/cam_00/cameras_opencv.json"))
k = numpy.array(model["K"])
size = numpy.array([model["width"], model["height"]])
for i, number in enumerate(sample["frame_ids"]):
    pose = numpy.array(next(p for p in model["frames"] if p["frame"] == number)["world_from_camera"])
    inside = (sample["positions"] - pose[:3, 3]) @ pose[:3, :3]
    pixel = inside @ k.T
    # OpenCV counts from the centre of the first pixel, TAP-Vid from its corner.
    expected = (pixel[:, :2] / pixel[:, 2:] + 0.5) / size
    assert abs(points[:, i] - expected).max() < 1e-4
    with h5py.File(scene / f"images/scene_cam_00_geometry_hdf5/frame.{number:04d}.depth_meters.hdf5") as file:
        distance = file["dataset"][:]
    x, y = numpy.floor(points[:, i] * size).astype(int).T
    within = (x >= 0) & (y >= 0) & (x < size[0]) & (y < size[1])
    assert occluded[~within, i].all()
    stored = distance[y[within], x[within]]
    away = numpy.linalg.norm(inside[within], axis=1)
    agree = (away > 1.05 * stored) == occluded[within, i]
    assert agree.mean() > 0.97, agree.mean()
# As tapnet's sample_queries_first does: the first frame in which each point is visible.
assert (~occluded).any(axis=1).all()
query = sample["query_points"]
rows = numpy.arange(n)
assert abs(points[rows, query[:, 0].astype(int)] * size - query[:, :0:-1]).max() < 1e-3
