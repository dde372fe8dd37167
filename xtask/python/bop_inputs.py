"""What BlenderProc's recipe takes: models with colours as BOP has them, and materials in ambientCG's files."""

import json
import struct
from pathlib import Path

import numpy as np
from PIL import Image

MATERIALS = ["Wood001", "Tiles001", "Concrete001", "Fabric001"]
SIDE = 2048


def models(exported, sources, folder):
    """The models of an export, each corner with the base colour of the file that the model is from."""
    folder.mkdir(parents=True, exist_ok=True)
    for number, told in json.loads((exported / "objects.json").read_text()).items():
        if told["scale"] == 1:
            name = f"obj_{int(number):06d}.ply"
            colour(exported / "models" / name, base_color(sources / told["model"]), folder / name)


def base_color(path: Path):
    """Of the first material of a binary glTF file, 8 bits, as the display shows it."""
    data = path.read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    linear = np.array(json.loads(data[20 : 20 + length])["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"][:3])
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return [int(round(255 * value)) for value in encoded]


def colour(source, color, target):
    """Adds a colour to every corner of a PLY file in words."""
    head, _, body = source.read_text().partition("end_header\n")
    count = int(next(line.split()[2] for line in head.splitlines() if line.startswith("element vertex")))
    before, face, after = head.partition("element face")
    kinds = "".join(f"property uchar {name}\n" for name in ["red", "green", "blue", "alpha"])
    lines = body.splitlines()
    suffix = " ".join(map(str, [*color, 255]))
    coloured = [f"{line} {suffix}" for line in lines[:count]]
    target.write_text(before + kinds + face + after + "end_header\n" + "\n".join(coloured + lines[count:]) + "\n")


def textures(folder):
    """Colour, roughness and normals of a few materials: smooth noise of several sizes between two tones."""
    for seed, name in enumerate(MATERIALS):
        draw = np.random.default_rng(seed)
        heights = sum(layer(draw, 8 << octave) / 2**octave for octave in range(5)) / 2
        low, high = draw.uniform(0.1, 0.5, 3), draw.uniform(0.4, 0.9, 3)
        slopes = [SIDE / 64 * (np.roll(heights, -1, axis) - np.roll(heights, 1, axis)) for axis in (1, 0)]
        normals = np.stack([-slopes[0], slopes[1], np.ones_like(heights)], axis=-1)
        normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
        place = folder / name
        place.mkdir(parents=True, exist_ok=True)
        for kind, picture in {"Color": low + heights[..., None] * (high - low), "Roughness": 0.3 + 0.6 * heights, "NormalGL": 0.5 + 0.5 * normals}.items():
            Image.fromarray((np.clip(picture, 0, 1) * 255 + 0.5).astype(np.uint8)).save(place / f"{name}_2K-JPG_{kind}.jpg", quality=95)


def layer(draw, cells):
    """Values of a grid, which repeats, smoothed to the full size."""
    grid = Image.fromarray(np.pad(draw.random((cells, cells), np.float32), 2, mode="wrap"), "F")
    edge = 2 * SIDE // cells
    return np.asarray(grid.resize((SIDE + 2 * edge,) * 2, Image.BICUBIC))[edge:-edge, edge:-edge]
