"""Small files in the layout of NYUv2's nyu_depth_v2_labeled.mat, by h5py: MATLAB 7.3's block in front, transposed arrays, cells of texts."""

import h5py
import numpy as np

SCENES = ["kitchen_0004", "kitchen_0004", "office_0012", "bedroom_0106", "living_room_0083"]


def arrays(count, height, width, seed=0):
    """color, depth and labels as they are meant: image, row, column."""
    random = np.random.default_rng(seed)
    color = random.integers(0, 256, (count, height, width, 3), dtype=np.uint8)
    depth = random.uniform(0.7, 9.9, (count, height, width)).astype(np.float32)
    labels = random.integers(0, 895, (count, height, width)).astype(np.uint16)
    return color, depth, labels


def write(path, color, depth, labels, *, chunks=None, compression="gzip", shuffle=False, userblock=512, more_groups=0, libver=None):
    """chunks: of an image's rows and columns as stored; h5py's own shapes, which span images, unless given."""
    count = len(color)
    with h5py.File(path, "w", userblock_size=userblock, libver=libver) as file:
        stored = {
            "images": color.transpose(0, 3, 2, 1),
            "depths": depth.transpose(0, 2, 1),
            "rawDepths": depth.transpose(0, 2, 1),
            "labels": labels.transpose(0, 2, 1),
            "instances": np.minimum(labels, 255).astype(np.uint8).transpose(0, 2, 1),
        }
        for name, values in stored.items():
            options = {}
            if compression:
                shape = True if chunks is None else (1,) * (values.ndim - 2) + chunks
                options = {"compression": compression, "compression_opts": 3, "shuffle": shuffle, "chunks": shape}
            file.create_dataset(name, data=values, **options)
            file[name].attrs["MATLAB_class"] = np.bytes_(str(values.dtype))
        refs = file.create_group("#refs#")
        for name, texts in {"scenes": [SCENES[i % len(SCENES)] for i in range(count)], "names": ["book", "bottle"]}.items():
            cells = file.create_dataset(name, (1, len(texts)), dtype=h5py.ref_dtype)
            for i, text in enumerate(texts):
                units = np.frombuffer(text.encode("utf-16-le"), dtype=np.uint16)[:, None]
                target = refs.create_dataset(f"{name}{i}", data=units)
                target.attrs["MATLAB_class"] = np.bytes_("char")
                target.attrs["MATLAB_int_decode"] = np.int32(2)
                cells[0, i] = target.ref
        # MATLAB's group of further variables, and so many that the table of names grows a tree.
        for i in range(more_groups):
            file.create_dataset(f"variable{i:03}", data=np.zeros((1, 1)))
    if userblock:
        with open(path, "r+b") as file:
            head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Tue Sep  4 14:31:05 2012 HDF5 schema 1.00 ."
            file.write(head.ljust(124) + b"\x00\x02IM")
