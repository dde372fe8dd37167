"""`cargo xtask bench loader`: reading layers as arrays, by enfilade's module and by h5py, in one run.

`bench_loader.py WORK DOCS [DATASET...]` renders frames, or takes those of the datasets, stores them once more as Hypersim does (float16 or
int16, gzip 9 by zlib, chunks of 96x128 pixels of one channel, written by h5py), adds Hypersim's own frame where ENFILADE_SCENES has it,
repacks all that into storage for fast reading, and measures both readers on it in turns. It writes `DOCS/loader.md` and `DOCS/loader.json`.
"""

import json
import os
import shutil
import sys
import time
from pathlib import Path

import enfilade
import h5py
import numpy as np

from machine import processor

ROUNDS = 12
CROP = 512
# First rows and columns of crops: even and uneven places, as a loader that crops at random has them.
PLACES = [(0, 0), (17, 31), (64, 301), (131, 130), (200, 511), (256, 256), (96, 384), (250, 77)]
SETS = [
    ("color", ["color"]),
    ("depth", ["depth_meters"]),
    ("color, depth, normals and classes", ["color", "depth_meters", "normal_cam", "semantic"]),
    ("color with its three parts", ["color", "diffuse_reflectance", "diffuse_illumination", "residual"]),
]


def stored_as_hypersim(source, target):
    """The dataset's frames and cameras in the form of Hypersim's release; the files of layers are named."""
    frames = enfilade.Dataset(source, stored=True, mask=False, poses=False, layers=sorted({layer for _, layers in SETS for layer in layers}))
    for table in source.glob("scenes/*/_detail/metadata_cameras.csv"):
        detail = target / table.parent.relative_to(source)
        detail.mkdir(parents=True, exist_ok=True)
        shutil.copy(table, detail)
    for sample in frames:
        for layer in frames.layers:
            part = "geometry" if layer in ("depth_meters", "normal_cam", "semantic") else "final"
            folder = target / "scenes" / sample["scene"] / "images" / f"scene_{sample['camera']}_{part}_hdf5"
            folder.mkdir(parents=True, exist_ok=True)
            values = sample[layer].astype(np.float16) if sample[layer].dtype == np.float32 else sample[layer]
            with h5py.File(folder / f"frame.{sample['frame']:04}.{layer}.hdf5", "w") as file:
                chunks = (96, 128, 1)[: values.ndim]
                file.create_dataset("dataset", data=values, chunks=chunks, compression="gzip", compression_opts=9)


class Frames:
    """The frames of a dataset with some layers, and the files that these lie in."""

    def __init__(self, root, layers):
        self.root, self.layers = root, layers
        self.whole = self.open()
        self.crops = [self.open(crop=(CROP, CROP), crop_place=place) for place in PLACES]
        self.files = []
        for i in range(len(self.whole)):
            scene, camera, frame = self.whole.place(i)
            found = [sorted(Path(root).glob(f"**/{scene}/images/scene_{camera}_*_hdf5/frame.{frame:04}.{layer}.hdf5"))[0] for layer in layers]
            self.files.append(found)

    def open(self, **options):
        return enfilade.Dataset(self.root, layers=self.layers, stored=True, mask=False, poses=False, **options)

    def bytes(self):
        return sum(os.path.getsize(path) for files in self.files for path in files)


def read(path, part=...):
    with h5py.File(path, "r") as file:
        return file["dataset"][part]


def crop_of(place):
    return np.s_[place[0] : place[0] + CROP, place[1] : place[1] + CROP]


def timed(action):
    begun = time.process_time()
    action()
    return time.process_time() - begun


def compare(name, ours, peer, checks):
    """Takes turns, and gives the least processor time of each in milliseconds for one frame."""
    for a, b in checks():
        if a.dtype != b.dtype or a.shape != b.shape or a.tobytes() != b.tobytes():
            sys.exit(f"{name}: enfilade and h5py read different values")
    pairs = list(zip(ours, peer, strict=True))
    best = [[float("inf"), float("inf")] for _ in pairs]
    for _ in range(ROUNDS):
        for least, pair in zip(best, pairs):
            for which, action in enumerate(pair):
                least[which] = min(least[which], timed(action))
    own, other = (1e3 * sum(least[which] for least in best) / len(best) for which in (0, 1))
    return {"case": name, "ours": round(own, 3), "peer": round(other, 3), "ratio": round(other / own, 2)}


def full(name, ours, peers):
    """Whole frames of `ours` against h5py on the files of `peers`."""
    count = range(len(ours.whole))

    def checks():
        for i in count:
            sample = ours.whole[i]
            for layer, path in zip(ours.layers, peers.files[i]):
                yield sample[layer], read(path)

    own = [lambda i=i: ours.whole[i] for i in count]
    other = [lambda files=files: [read(path) for path in files] for files in peers.files]
    return compare(name, own, other, checks)


def cropped(name, frames, peer_read):
    """Crops of the same files; `peer_read(path, place)` is how h5py comes to one."""
    cases = [(i, crops, place) for i in range(len(frames.whole)) for crops, place in zip(frames.crops, PLACES)]

    def checks():
        for i, crops, place in cases:
            sample = crops[i]
            for layer, path in zip(frames.layers, frames.files[i]):
                yield sample[layer], np.ascontiguousarray(peer_read(path, place))

    own = [lambda i=i, crops=crops: crops[i] for i, crops, _ in cases]
    other = [lambda i=i, place=place: [np.ascontiguousarray(peer_read(path, place)) for path in frames.files[i]] for i, _, place in cases]
    return compare(name, own, other, checks)


def measure(label, root, fast, layers):
    plain, packed = Frames(root, layers), Frames(fast, layers)
    whole_then_cut = lambda path, place: read(path)[crop_of(place)]
    slice_of_file = lambda path, place: read(path, crop_of(place))
    rows = [
        full(f"full frame: {label}", plain, plain),
        cropped(f"crop 512x512, h5py reads all and cuts: {label}", plain, whole_then_cut),
        cropped(f"part 512x512, h5py reads a slice: {label}", plain, slice_of_file),
        full(f"native storage, full frame: {label}", packed, plain),
    ]
    size = {"layers": label, "frames": len(plain.whole), "gzip_mb": plain.bytes() / 1e6, "native_mb": packed.bytes() / 1e6}
    for row in rows:
        print(cells(row), flush=True)
    return rows, size


def cells(row):
    return f"| {row['case']} | {row['ours']:g} | {row['peer']:g} | **{row['ratio']:.2f}** |"


def rendered(work, datasets):
    """Datasets to read: those that are named, or two frames of the demo's room."""
    if datasets:
        return [Path(path) for path in datasets]
    room = work / "room"
    enfilade.run(room, enfilade.Config.demo(frames=2, size=(1024, 768), samples=16))
    return [room]


def main():
    work, docs, datasets = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3:]
    release, fast = work / "release", work / "native"
    sources = rendered(work, datasets)
    for folder in (release, fast):
        shutil.rmtree(folder, ignore_errors=True)
    for source in sources:
        stored_as_hypersim(source, release)
    enfilade.repack(release, fast)
    rows, sizes = [], []
    for label, layers in SETS:
        found, size = measure(label, release, fast, layers)
        rows += found
        sizes.append(size)
    real = Path(os.environ.get("ENFILADE_SCENES", "")) / "hypersim-real"
    if real.is_dir():
        shutil.rmtree(work / "real", ignore_errors=True)
        enfilade.repack(real, work / "real")
        found, size = measure("depth of Apple's own file", real, work / "real", ["depth_meters"])
        rows += found
        sizes.append(size)
    volume = "\n".join(f"| {s['layers']} | {s['gzip_mb'] / s['frames']:.2f} | {s['native_mb'] / s['frames']:.2f} |" for s in sizes)
    page = PAGE.format(processor=processor(), table="\n".join(cells(row) for row in rows), sizes=volume, frames=sizes[0]["frames"], rounds=ROUNDS, h5py=h5py.__version__)
    (docs / "loader.md").write_text(page)
    (docs / "loader.json").write_text(json.dumps(rows, indent=2) + "\n")


PAGE = """# Loader: reading layers as arrays with enfilade's Python module and with h5py

Made by `cargo xtask bench loader` on {processor}: {frames} rendered frames of 1024x768 pixels in Hypersim's layout (float16 and int16, gzip 9,
chunks of 96x128 pixels of one channel, written by h5py), and the one file of Apple's release that is available beside the repository.
Times are milliseconds of processor time of one core for a frame with all of its layers: the least of {rounds} rounds, in which both readers took
turns on the same files, which are in memory. h5py is {h5py}. The values are bit-identical; otherwise the run fails.

| case | enfilade, ms | h5py, ms | h5py / enfilade |
|---|---|---|---|
{table}

## The limits of each case

- **Full frames.** The whole file must be inflated. libdeflate takes less than half of zlib's time for that, and interleaving the channels,
  which h5py does value by value, costs next to nothing here; gzip allows no more. Images that hardly compress, or that
  compress to almost nothing, gain the most.
- **Crops.** A 512x512 crop of 1024x768 touches 24 to 35 of 64 chunks of 96x128 pixels, so about half of a file must be inflated; that is
  the limit. "crop" compares with reading all and cropping, as Hypersim's loaders do; "part" compares with h5py's slices,
  which also skip chunks.
- **Native storage.** `enfilade.repack` stores values uncompressed where LZ4 would save less than a quarter, as with colours, and always
  for depth and other images of one floating-point channel; reading these is a copy. The rest is compressed by LZ4, in chunks of 128x128
  pixels with all channels. h5py is measured on Hypersim's files, as elsewhere; to read LZ4 it needs the package hdf5plugin. Depth trades
  bytes for speed: gzip shrinks it sixfold and LZ4 fourfold, but LZ4 assembles it from many short runs, which takes a millisecond and left
  the ratio at 4.3. If the disk is slower than about 1 GB/s and files do not stay in memory, gzip is faster for depth. What remains is the
  kernel's copy of the pages, and the allocation of memory by Python. Sizes, in MB per frame:

| layers | Hypersim's gzip | native |
|---|---|---|
{sizes}

Times are of one core. Several threads decode several samples at once without holding the interpreter's lock, which h5py's lock prevents.
"""

if __name__ == "__main__":
    main()
