"""The meshes and pictures of the oracle's own scenes, made by formula."""

import numpy as np
from PIL import Image


def write(folder):
    sphere(folder / "sphere.ply", (0.0, 0.85, 0.0), 0.85)
    y, x = np.mgrid[0:256, 0:256] / 256
    checks = ((np.floor(x * 16) + np.floor(y * 8)) % 2)[..., None]
    picture(folder / "tiles.png", checks * [0.85, 0.8, 0.7] + (1 - checks) * np.stack([x, 0.3 + 0 * x, y], axis=-1))
    heights = 0.5 + 0.25 * np.sin(2 * np.pi * 8 * x) + 0.25 * np.sin(2 * np.pi * 5 * y)
    picture(folder / "heights.png", np.repeat(heights[..., None], 3, axis=-1))
    slope = np.stack([0.4 * np.cos(2 * np.pi * 8 * x), 0.3 * np.cos(2 * np.pi * 5 * y), np.ones_like(x)], axis=-1)
    picture(folder / "normals.png", 0.5 + 0.5 * slope / np.linalg.norm(slope, axis=-1, keepdims=True))
    holes = 0.5 + 0.5 * np.sin(2 * np.pi * 8 * x) * np.sin(2 * np.pi * 5 * y)
    picture(folder / "holes.png", np.repeat(holes[..., None], 3, axis=-1))
    sky(folder / "sky.pfm")


def picture(path, rgb):
    Image.fromarray((np.clip(rgb, 0, 1) * 255 + 0.5).astype(np.uint8), "RGB").save(path)


def sphere(path, centre, radius, columns=192, rows=96):
    """A sphere as triangles with smooth normals; u runs about the axis, v downward from the upper pole."""
    v, u = np.mgrid[0 : rows + 1, 0 : columns + 1]
    v, u = v.ravel() / rows, u.ravel() / columns
    normals = np.stack([np.sin(2 * np.pi * u) * np.sin(np.pi * v), np.cos(np.pi * v), np.cos(2 * np.pi * u) * np.sin(np.pi * v)], axis=1)
    vertices = np.concatenate([centre + radius * normals, normals, np.stack([u, v], axis=1)], axis=1).astype("<f4")
    faces = []
    for j in range(rows):
        for i in range(columns):
            a, b = j * (columns + 1) + i, (j + 1) * (columns + 1) + i
            faces += [(3, a, b, b + 1)] if j + 1 < rows else []
            faces += [(3, a, b + 1, a + 1)] if j > 0 else []
    table = np.array([tuple(f) for f in faces], dtype=[("n", "u1"), ("a", "<i4"), ("b", "<i4"), ("c", "<i4")])
    names = "".join(f"property float {name}\n" for name in ["x", "y", "z", "nx", "ny", "nz", "u", "v"])
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n{names}"
    header += f"element face {len(table)}\nproperty list uchar int vertex_indices\nend_header\n"
    path.write_bytes(header.encode() + vertices.tobytes() + table.tobytes())


def sky(path, width=256, height=128):
    """A blue gradient, dark ground and a sun five texels wide."""
    y, x = np.mgrid[0:height, 0:width]
    up = np.cos(np.pi * (y + 0.5) / height)[..., None]
    rgb = np.where(up > 0, (1 - up) * [0.8, 0.9, 1.0] + up * [0.2, 0.4, 0.9], [0.1, 0.08, 0.06])
    rgb = rgb + ((x - 60) ** 2 + (y - 36) ** 2 <= 6)[..., None] * np.array([900.0, 800.0, 600.0])
    # PFM keeps its rows from the bottom up.
    path.write_bytes(f"PF\n{width} {height}\n-1.0\n".encode() + rgb[::-1].astype("<f4").tobytes())
