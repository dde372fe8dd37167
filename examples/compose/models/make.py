"""Writes the ten models of this folder: solids of revolution and boxes with one colour each, in metres, y up, as glTF.

python make.py"""

import json
import math
import pathlib
import struct

FOLDER = pathlib.Path(__file__).parent


def lathe(profile, around=40, sweep=2 * math.pi, center=(0, 0, 0)):
    """The profile (radius, height), from the bottom to the top, turned about y."""
    points, faces = [], []
    for i in range(around):
        angle = sweep * i / around
        points += [(center[0] + r * math.cos(angle), center[1] + y, center[2] + r * math.sin(angle)) for r, y in profile]
    n = len(profile)
    for i in range(around):
        a, b = i * n, (i + 1) % around * n
        faces += [t for k in range(n - 1) for t in ((a + k, a + k + 1, b + k), (b + k, a + k + 1, b + k + 1))]
    return points, faces


def smooth(profile, steps=5):
    """A Catmull-Rom curve through the points of a profile."""
    at = lambda i: profile[min(max(i, 0), len(profile) - 1)]
    curve = []
    for i in range(len(profile) - 1):
        for step in range(steps):
            t = step / steps
            weights = (-t + 2 * t**2 - t**3, 2 - 5 * t**2 + 3 * t**3, t + 4 * t**2 - 3 * t**3, -(t**2) + t**3)
            curve.append(tuple(sum(w * at(i + k - 1)[axis] for k, w in enumerate(weights)) / 2 for axis in (0, 1)))
    return curve + [profile[-1]]


def box(size, at=(0, 0, 0)):
    points = [tuple(at[k] + size[k] * ((i >> k & 1) - 0.5) for k in range(3)) for i in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return points, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]


def tube(path, radius, around=12):
    """A closed tube about a path in the plane z = 0."""
    points, faces = [], []
    for i, (x, y) in enumerate(path):
        (x0, y0), (x1, y1) = path[max(i - 1, 0)], path[min(i + 1, len(path) - 1)]
        length = math.hypot(x1 - x0, y1 - y0)
        normal = ((y1 - y0) / length, -(x1 - x0) / length)
        for k in range(around):
            c, s = radius * math.cos(2 * math.pi * k / around), radius * math.sin(2 * math.pi * k / around)
            points.append((x + normal[0] * c, y + normal[1] * c, s))
    for i in range(len(path) - 1):
        for k in range(around):
            a, b, c = i * around + k, i * around + (k + 1) % around, (i + 1) * around
            faces += [(a, b, c + k), (b, c + (k + 1) % around, c + k)]
    return points, faces


def joined(*meshes):
    points, faces = [], []
    for more, triangles in meshes:
        faces += [tuple(i + len(points) for i in t) for t in triangles]
        points += more
    return points, faces


def write(name, mesh, color, roughness=0.5, metallic=0.0):
    """Edges of more than 40 degrees stay sharp, others are shaded smoothly."""
    points, faces = mesh
    flat = []
    for face in faces:
        a, b, c = (points[i] for i in face)
        u, v = [[q - p for p, q in zip(a, other)] for other in (b, c)]
        n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        length = math.sqrt(sum(x * x for x in n))
        if length > 1e-10:
            flat.append(((a, b, c), n, length))
    around = {}
    for triangle, n, length in flat:
        for p in triangle:
            around.setdefault(tuple(round(x, 6) for x in p), []).append((n, length))
    vertices, indices = {}, []
    for triangle, n, length in flat:
        for p in triangle:
            near = [m for m, size in around[tuple(round(x, 6) for x in p)] if sum(x * y for x, y in zip(m, n)) > 0.766 * size * length]
            total = [sum(m[k] for m in near) for k in range(3)]
            size = math.sqrt(sum(x * x for x in total))
            vertex = (tuple(round(x, 6) for x in p), tuple(round(x / size, 5) for x in total))
            indices.append(vertices.setdefault(vertex, len(vertices)))
    corners, normals = zip(*vertices)
    data = b"".join(struct.pack("<3f", *p) for p in corners) + b"".join(struct.pack("<3f", *n) for n in normals)
    half, count = len(data) // 2, len(corners)
    data += struct.pack(f"<{len(indices)}H", *indices) + b"\0" * (len(indices) % 2 * 2)
    low, high = ([f(p[k] for p in corners) for k in range(3)] for f in (min, max))
    gltf = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "scene": 0,
        "nodes": [{"name": name, "mesh": 0}],
        "meshes": [{"name": name, "primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 0}]}],
        "materials": [{"name": name, "pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "roughnessFactor": roughness, "metallicFactor": metallic}}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3", "min": low, "max": high},
            {"bufferView": 1, "componentType": 5126, "count": count, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5123, "count": len(indices), "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": half},
            {"buffer": 0, "byteOffset": half, "byteLength": half},
            {"buffer": 0, "byteOffset": 2 * half, "byteLength": 2 * len(indices)},
        ],
        "buffers": [{"byteLength": len(data)}],
    }
    text = json.dumps(gltf, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<2I", len(text), 0x4E4F534A) + text + struct.pack("<2I", len(data), 0x004E4942) + data
    (FOLDER / f"{name}.glb").write_bytes(struct.pack("<3I", 0x46546C67, 2, 12 + len(chunks)) + chunks)


handle = [(0.04 + 0.026 * math.sin(math.pi * t / 12), 0.05 - 0.03 * math.cos(math.pi * t / 12)) for t in range(13)]
cup = lathe([(0, 0), (0.036, 0), (0.04, 0.006), (0.04, 0.095), (0.036, 0.095), (0.036, 0.006), (0, 0.005)])
write("mug", joined(cup, tube(handle, 0.005)), (0.75, 0.2, 0.12), 0.25)
write("bowl", lathe([(0, 0), *smooth([(0.04, 0), (0.065, 0.02), (0.08, 0.06)]), *smooth([(0.077, 0.06), (0.062, 0.023), (0.038, 0.005), (0, 0.005)])]), (0.85, 0.82, 0.72), 0.2)
write("bottle", lathe([(0, 0), (0.033, 0), *smooth([(0.036, 0.004), (0.036, 0.12), (0.034, 0.15), (0.016, 0.185), (0.013, 0.21), (0.013, 0.235)]), (0, 0.235)]), (0.1, 0.35, 0.2), 0.15)
write("can", lathe([(0, 0), (0.029, 0), (0.033, 0.006), (0.033, 0.114), (0.029, 0.12), (0, 0.12)]), (0.72, 0.73, 0.75), 0.3, 1.0)
write("plate", lathe([(0, 0), (0.06, 0), (0.115, 0.018), (0.115, 0.021), (0.06, 0.005), (0, 0.005)]), (0.88, 0.88, 0.9), 0.15)
write("vase", lathe([(0, 0), *smooth([(0.035, 0), (0.055, 0.06), (0.045, 0.12), (0.025, 0.16), (0.035, 0.19)]), *smooth([(0.031, 0.19), (0.021, 0.16), (0.01, 0.12)]), (0, 0.12)]), (0.2, 0.3, 0.6), 0.35)
write("cereal", box((0.19, 0.28, 0.06), (0, 0.14, 0)), (0.85, 0.6, 0.1), 0.6)
write("book", joined(box((0.15, 0.004, 0.21), (0, 0.002, 0)), box((0.15, 0.004, 0.21), (0, 0.028, 0)), box((0.145, 0.022, 0.2), (-0.0015, 0.015, 0))), (0.35, 0.1, 0.15), 0.7)
write("cube", box((0.06, 0.06, 0.06), (0, 0.03, 0)), (0.15, 0.5, 0.55), 0.5)
write("bracket", joined(box((0.12, 0.012, 0.05), (0, 0.006, 0)), box((0.012, 0.09, 0.05), (-0.054, 0.057, 0))), (0.5, 0.5, 0.52), 0.35, 1.0)
