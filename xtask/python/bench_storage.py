"""`cargo xtask bench storage`: size, reading and writing of the files of layers, ours and Hypersim's.

`bench_storage.py WORK DOCS` reads `WORK/files.json`, which lists our files, stores the same layers once more as Hypersim does (float16 or
int16, gzip 9 by zlib, chunks of 96x128 per channel, written by h5py), reads all of them with plain h5py, and writes `DOCS/storage.md`
and `DOCS/storage.json`.
"""

import json
import os
import sys
import time
from pathlib import Path

import h5py
import numpy as np

READS = 15
# An uneven place, as a loader that crops at random has it.
CROP = np.s_[131:643, 301:813]
HYPERSIM, OURS, BEFORE = "Hypersim's", "ours", "h5py's own chunks, shuffled"


def least_ms(action, times=READS):
    """The least processor time of an action in milliseconds."""
    best = float("inf")
    for _ in range(times):
        begun = time.process_time()
        action()
        best = min(best, time.process_time() - begun)
    return 1e3 * best


def read(path, part):
    with h5py.File(path, "r") as file:
        return file["dataset"][part]


def write_as_hypersim(path, values):
    chunks = (96, 128, 1)[: values.ndim]
    with h5py.File(path, "w") as file:
        file.create_dataset("dataset", data=values, chunks=chunks, compression="gzip", compression_opts=9)


def measured(row):
    path = row["path"]
    frame, crop = least_ms(lambda: read(path, ...)), least_ms(lambda: read(path, CROP))
    return {**row, "bytes": os.path.getsize(path), "frame_ms": frame, "crop_ms": crop}


def hypersims(row, work):
    """The same layer as Hypersim stores it."""
    values = read(row["path"], ...)
    values = values.astype(np.float16) if values.dtype == np.float32 else values
    path = str(work / "files" / f"{row['frame']}.{row['layer']}.hypersim.hdf5")
    write_ms = least_ms(lambda: write_as_hypersim(path, values), 3)
    return measured({**row, "way": HYPERSIM, "path": path, "write_ms": write_ms})


def mean(rows, layer, way, what):
    found = [row[what] for row in rows if row["layer"] == layer and row["way"] == way]
    return float(np.mean(found)) if found else None


def compare(rows, layers):
    """A row per layer and quantity: Hypersim's divided by ours, above 1 where ours is better."""
    table = []
    for layer in layers:
        for what, name, scale in [("bytes", "size, kB", 1e-3), ("frame_ms", "read a frame, ms", 1), ("crop_ms", "read 512x512, ms", 1), ("write_ms", "write, ms", 1)]:
            ours, peer = (scale * mean(rows, layer, way, what) for way in (OURS, HYPERSIM))
            table.append({"case": f"{layer}, {name}", "ours": round(ours, 3), "peer": round(peer, 3), "ratio": round(peer / ours, 3)})
    return table


def cells(row):
    return f"| {row['case']} | {row['ours']:g} | {row['peer']:g} | **{row['ratio']:.2f}** |"


def candidates(rows, layer):
    names = dict.fromkeys(row["way"] for row in rows if row["layer"] == layer)
    lines = [f"| {layer} | kB | read a frame, ms | read 512x512, ms | write, ms |", "|---|---|---|---|---|"]
    for way in [HYPERSIM, *[name for name in names if name != HYPERSIM]]:
        values = [mean(rows, layer, way, what) for what in ("bytes", "frame_ms", "crop_ms", "write_ms")]
        bold = "**" if way == OURS else ""
        lines.append(f"| {bold}{way}{bold} | {values[0] / 1e3:.1f} | {values[1]:.2f} | {values[2]:.2f} | {values[3]:.1f} |")
    return "\n".join(lines)


def main():
    work, docs = Path(sys.argv[1]), Path(sys.argv[2])
    report = json.loads((work / "files.json").read_text())
    rows = []
    for row in report["files"]:
        rows.append(measured(row))
        if row["way"] == OURS:
            rows.append(hypersims(row, work))
    layers = list(dict.fromkeys(row["layer"] for row in rows))
    table = compare(rows, layers)
    frames = ", ".join(dict.fromkeys(f"{row['frame']} ({row['size'][0]}x{row['size'][1]})" for row in rows))
    page = PAGE.format(
        processor=report["processor"], frames=frames,
        table="\n".join(cells(row) for row in table), candidates="\n\n".join(candidates(rows, layer) for layer in layers))
    (docs / "storage.md").write_text(page)
    (docs / "storage.json").write_text(json.dumps(table, indent=2) + "\n")
    print("\n".join(cells(row) for row in table))


PAGE = """# Storage: the files of layers, ours against Hypersim's

Made by `cargo xtask bench storage` on {processor}, with one frame of each of {frames}; values
are means over them. Hypersim's files are float16 or int16, gzip 9, in chunks of 96x128 pixels of one channel, written by h5py. All are read
by plain h5py, without plug-ins, from memory; times are processor time of one thread, the least of several.

| layer | ours | Hypersim's | Hypersim's / ours |
|---|---|---|---|
{table}

## Choices and reasons

- **Chunks of 128x128 pixels.** Files with larger ones are a little smaller and faster to read whole, but crops then read much that they do
  not need; smaller ones cost more in whole reads than they save in crops.
- **Colours and normals: all channels in one chunk.** This halves the reading time, most of which h5py otherwise spends on separating and
  joining channels. Where channels vary smoothly and independently of each other (positions, flow, texture coordinates), they
  have their own chunks: together they take half as much space again.
- **Shuffled**, except the numbers of parts, classes and reasons: these are runs of equal values, which shuffling makes slower to read.
- **libdeflate at level 6**, and 9 for those numbers: higher levels cost more in writing than they save in size. The result is plain gzip.
- **Depth and position are float32**, which explains their extra cost over Hypersim's: float16 has steps of 8 mm at 10 m. All other layers
  have Hypersim's types.

## Alternatives that were compared

Each differs from ours only as its name says. "h5py's own chunks" are those of Hypersim's files: 96x128 of one channel, and 48x128 for
float32.

{candidates}
"""

if __name__ == "__main__":
    main()
