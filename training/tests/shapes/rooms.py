"""A tiny data set in Pix3D's layout: blocks before a camera, drawn flat."""

import json
import struct
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

SIZE, FOCAL = 96, 110.0
CATEGORIES = ["bed", "bookcase", "chair", "desk", "misc", "sofa", "table", "tool", "wardrobe"]


def block(extents: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray]:
    """A block in the ball of diameter 1: vertices and faces, from 0."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * np.array(extents)
    corners = corners / (2 * np.linalg.norm(corners, axis=1).max())
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return corners, np.array([t for a, b, c, d in quads for t in ([a, b, c], [a, c, d])])


def mat(voxels: np.ndarray) -> bytes:
    """A MATLAB file of version 5 with the array `voxel`, in Pix3D's axes."""

    def element(kind: int, data: bytes) -> bytes:
        return struct.pack("<II", kind, len(data)) + data + bytes(-len(data) % 8)

    parts = element(6, struct.pack("<II", 9, 0)) + element(5, struct.pack("<3i", *voxels.shape)) + element(1, b"voxel")
    return b"MATLAB 5.0".ljust(124) + b"\x00\x01IM" + element(14, parts + element(2, voxels.astype(np.uint8).tobytes(order="F")))


def solid(extents: tuple[float, float, float], side: int = 24) -> np.ndarray:
    """The voxels of `block` by x, y, z of the model."""
    longest = max(extents)
    at = np.abs((np.arange(side) + 0.5) / side * 2 - 1) * longest
    return (at[:, None, None] <= extents[0]) & (at[None, :, None] <= extents[1]) & (at[None, None, :] <= extents[2])


def write(folder: Path, objects: list[list[tuple[str, tuple[float, float, float], tuple[float, float, float]]]]) -> Path:
    """Writes images of blocks, each by category, extents and place (camera space), and gives the JSON."""
    images, annotations = [], []
    for number, shown in enumerate(objects, 1):
        picture = Image.new("RGB", (SIZE, SIZE), (40, 44, 60))
        for category, extents, place in shown:
            key = f"{category}_{len(annotations):03}"
            vertices, faces = block(extents)
            seen = vertices + np.array(place)
            pixels = SIZE / 2 - FOCAL * seen[:, :2] / seen[:, 2:]
            mask = Image.new("L", (SIZE, SIZE))
            shade = 90 + 15 * CATEGORIES.index(category)
            for i, face in enumerate(faces):
                corners = [tuple(pixels[c]) for c in face]
                ImageDraw.Draw(mask).polygon(corners, fill=255)
                ImageDraw.Draw(picture).polygon(corners, fill=(shade, shade - 8 * (i // 2), 200 - 10 * (i // 2)))
            left, upper, right, lower = mask.getbbox()
            files = {"segmentation": f"mask/{key}.png", "model": f"model/{key}/model.obj", "voxel": f"model/{key}/voxel.mat"}
            for name in files.values():
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
            mask.save(folder / files["segmentation"])
            text = "".join(f"v {x} {y} {z}\n" for x, y, z in vertices) + "".join(f"f {a} {b} {c}\n" for a, b, c in faces + 1)
            (folder / files["model"]).write_text(text)
            # In the file: x left, y outward, z up.
            (folder / files["voxel"]).write_bytes(mat(solid(extents).transpose(0, 2, 1)[:, ::-1]))
            annotations.append(
                {
                    "id": len(annotations) + 1,
                    "image_id": number,
                    "category_id": CATEGORIES.index(category) + 1,
                    "iscrowd": 0,
                    "area": float(np.asarray(mask).astype(bool).sum()),
                    "bbox": [left, upper, right - left, lower - upper],
                    "K": [FOCAL, SIZE / 2, SIZE / 2],
                    "rot_mat": np.eye(3).tolist(),
                    "trans_mat": list(place),
                    **files,
                }
            )
        picture.save(folder / f"{number}.png")
        images.append({"id": number, "file_name": f"{number}.png", "width": SIZE, "height": SIZE})
    categories = [{"id": i, "name": name} for i, name in enumerate(CATEGORIES, 1)]
    path = folder / "pix3d_all.json"
    path.write_text(json.dumps({"images": images, "annotations": annotations, "categories": categories}))
    return path


TWO = [
    [("chair", (0.5, 1.0, 0.5), (0.1, 0.0, 2.0))],
    [("table", (1.0, 0.4, 0.6), (0.25, 0.2, 2.2)), ("sofa", (0.9, 0.5, 0.5), (-0.3, -0.35, 2.4))],
]
