"""Makes the fixtures of tests/usd_binary.rs with Pixar's own library: `pip install usd-core`, then `python make.py` here.

room.usda and moving.usda are written by hand; this makes room.usdc and room.usdz of it, and room.json with what the library itself computes from it:
world points of meshes, in metres with z up, the field of view and place of the camera, and the colours bound. reference.usdc has a
reference that names no prim, to the layer `box.usda`, and a sublayer, empty.usdc, that is empty. moving.usdc is moving.usda, and
moving.json has the matrices of its cubes, row by row for row vectors, at time codes.
"""

import json
import math
import os
import struct
import zlib

from pxr import Sdf, Usd, UsdGeom, UsdShade, UsdUtils


def png(path):
    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    rows = b"".join(b"\0" + bytes([200, 100, 50, 255] * 2) for _ in range(2))
    header = struct.pack(">IIBBBBB", 2, 2, 8, 6, 0, 0, 0)
    with open(path, "wb") as f:
        f.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def world(stage, cache, prim, points):
    metres = UsdGeom.GetStageMetersPerUnit(stage)
    matrix = cache.GetLocalToWorldTransform(prim)
    moved = [matrix.Transform(p) for p in points]
    return [[p[0] * metres, -p[2] * metres, p[1] * metres] for p in moved]


def bare():
    Sdf.Layer.CreateNew("empty.usdc").Save()
    stage = Usd.Stage.CreateNew("reference.usdc")
    stage.GetRootLayer().subLayerPaths = ["empty.usdc"]
    stage.DefinePrim("/A").GetReferences().SetReferences([Sdf.Reference("box.usda")])
    stage.Save()


def moving():
    stage = Usd.Stage.Open("moving.usda")
    stage.GetRootLayer().Export("moving.usdc")
    expected = {}
    for code in [0, 10, 11, 13.7, 15, 20, 22.5, 25, 30, 33.25, 38, 40, 47, 50, 55.5, 60, 66, 70, 80, 111]:
        cache = UsdGeom.XformCache(code)
        for prim in stage.Traverse():
            if prim.IsA(UsdGeom.Cube):
                matrix = cache.GetLocalToWorldTransform(prim)
                places = expected.setdefault(str(prim.GetPath())[1:], [])
                places.append({"code": code, "matrix": [list(matrix.GetRow(i)) for i in range(4)]})
    with open("moving.json", "w") as f:
        json.dump(expected, f)
        f.write("\n")


def main():
    png("color.png")
    stage = Usd.Stage.Open("room.usda")
    stage.GetRootLayer().Export("room.usdc")
    UsdUtils.CreateNewUsdzPackage("room.usda", "room.usdz")
    cache = UsdGeom.XformCache(Usd.TimeCode.EarliestTime())
    expected = {"meshes": {}, "colors": {}, "cameras": {}}
    for prim in Usd.PrimRange(stage.GetPseudoRoot(), Usd.TraverseInstanceProxies()):
        name = str(prim.GetPath())[1:]
        if prim.IsA(UsdGeom.Mesh) and UsdGeom.Imageable(prim).ComputeVisibility() != "invisible":
            mesh = UsdGeom.Mesh(prim)
            expected["meshes"][name] = world(stage, cache, prim, mesh.GetPointsAttr().Get(Usd.TimeCode.EarliestTime()))
            material, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()
            if material:
                shader = material.ComputeSurfaceSource()[0]
                color = shader.GetInput("diffuseColor")
                if color and not color.HasConnectedSource():
                    expected["colors"][name] = list(color.Get())
        if prim.IsA(UsdGeom.Camera):
            camera = UsdGeom.Camera(prim).GetCamera(Usd.TimeCode.EarliestTime())
            expected["cameras"][name] = {
                "position": world(stage, cache, prim, [(0, 0, 0)])[0],
                "ahead": world(stage, cache, prim, [(0, 0, -100)])[0],
                "fov_x": math.radians(camera.GetFieldOfView(camera.FOVHorizontal)),
                "aspect": camera.aspectRatio,
            }
    with open("room.json", "w") as f:
        json.dump(expected, f, indent=1)
        f.write("\n")
    os.remove("color.png")


bare()
moving()
main()
