"""Makes the fixtures of tests/usd_binary.rs with Pixar's own library: `pip install usd-core`, then `python make.py` here.

room.usda and moving.usda are written by hand; this makes room.usdc and room.usdz of it, and room.json with what the library itself computes from it:
world points of meshes, in metres with z up, the field of view and place of the camera, and the colours bound. reference.usdc has a
reference that names no prim, to the layer `box.usda`, and a sublayer, empty.usdc, that is empty. moving.usdc is moving.usda, and
moving.json has the matrices of its cubes, row by row for row vectors, at time codes. bending.usda has a skin of two joints that is bound
through a transform, in a node that is stretched, blend shapes on it, and a cloth of sampled points; bending.usdc is the same, and
bending.json has the world points and normals of both at time codes, baked by the library.
"""

import json
import math
import os
import struct
import zlib

from pxr import Gf, Sdf, Usd, UsdGeom, UsdShade, UsdSkel, UsdUtils, Vt


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


CODES = [0, 6, 12, 18, 24]
SIDES = 6


def tube():
    """Points, normals, faces and weights of a tube of radius 0.2 about y, three rings high."""
    turn = [2 * math.pi * side / SIDES for side in range(SIDES)]
    points = [(0.2 * math.cos(a), 0.5 * ring, 0.2 * math.sin(a)) for ring in range(3) for a in turn]
    normals = [(math.cos(a), 0.0, math.sin(a)) for _ in range(3) for a in turn]
    at = lambda ring, side: ring * SIDES + side % SIDES
    faces = [[at(r, s), at(r + 1, s), at(r + 1, s + 1), at(r, s + 1)] for r in range(2) for s in range(SIDES)]
    weights = [w for ring in range(3) for _ in range(SIDES) for w in (1 - ring / 2, ring / 2)]
    return points, normals, faces, weights


def mesh(stage, path, points, faces):
    made = UsdGeom.Mesh.Define(stage, path)
    made.CreatePointsAttr(points)
    made.CreateFaceVertexCountsAttr([len(face) for face in faces])
    made.CreateFaceVertexIndicesAttr([corner for face in faces for corner in face])
    made.CreateSubdivisionSchemeAttr("none")
    return made


def skinned(stage):
    points, normals, faces, weights = tube()
    root = UsdSkel.Root.Define(stage, "/World/Person")
    UsdGeom.XformCommonAPI(root).SetTranslate((1, 0, 0.5))
    skeleton = UsdSkel.Skeleton.Define(stage, "/World/Person/Rig/Bones")
    UsdGeom.XformCommonAPI(stage.GetPrimAtPath("/World/Person/Rig")).SetRotate((0, 30, 0))
    joints = ["hip", "hip/knee"]
    skeleton.CreateJointsAttr(joints)
    knee = Gf.Matrix4d().SetTranslate((0, 0.5, 0))
    skeleton.CreateBindTransformsAttr([Gf.Matrix4d(1), knee])
    skeleton.CreateRestTransformsAttr([Gf.Matrix4d(1), knee])
    animation = UsdSkel.Animation.Define(stage, "/World/Person/Walk")
    animation.CreateJointsAttr(["hip/knee"])
    animation.CreateTranslationsAttr().Set([(0, 0.5, 0)], 0)
    animation.GetTranslationsAttr().Set([(0, 0.6, 0.1)], 24)
    turn = lambda degrees: Gf.Quatf(Gf.Rotation((0.6, 0, 0.8), degrees).GetQuat())
    rotations = animation.CreateRotationsAttr()
    for code, degrees in [(0, 0), (12, 80), (24, -20)]:
        rotations.Set(Vt.QuatfArray([turn(degrees)]), code)
    animation.CreateScalesAttr(Vt.Vec3hArray([Gf.Vec3h(1, 1.25, 1)]))
    animation.CreateBlendShapesAttr(["bulge"])
    animation.CreateBlendShapeWeightsAttr().Set([0.0], 6)
    animation.GetBlendShapeWeightsAttr().Set([1.0], 18)
    UsdSkel.BindingAPI.Apply(skeleton.GetPrim()).CreateAnimationSourceRel().SetTargets(["/World/Person/Walk"])
    body = mesh(stage, "/World/Person/Body", points, faces)
    body.CreateNormalsAttr(normals)
    body.SetNormalsInterpolation("vertex")
    UsdGeom.XformCommonAPI(body).SetScale((1, 2, 1))
    binding = UsdSkel.BindingAPI.Apply(body.GetPrim())
    binding.CreateSkeletonRel().SetTargets([skeleton.GetPath()])
    binding.CreateJointIndicesPrimvar(False, 2).Set([0, 1] * len(points))
    binding.CreateJointWeightsPrimvar(False, 2).Set(weights)
    binding.CreateGeomBindTransformAttr(Gf.Matrix4d().SetTranslate((0.05, 0, 0)))
    shape = UsdSkel.BlendShape.Define(stage, "/World/Person/Body/Bulge")
    shape.CreatePointIndicesAttr([6, 7, 8])
    shape.CreateOffsetsAttr([(0.1, 0, 0.1)] * 3)
    shape.CreateNormalOffsetsAttr([(0, 0.5, 0)] * 3)
    binding.CreateBlendShapesAttr(["bulge"])
    binding.CreateBlendShapeTargetsRel().SetTargets([shape.GetPath()])


def cloth(stage):
    flat = [(x, 0.0, z) for x in range(3) for z in range(3)]
    faces = [[a, a + 1, a + 4, a + 3] for a in (0, 1, 3, 4)]
    made = mesh(stage, "/World/Cloth", flat, faces)
    for code in (0, 8, 24):
        made.GetPointsAttr().Set([(x, 0.3 * math.sin(code + x), z + 0.01 * code) for x, _, z in flat], code)


def bending():
    stage = Usd.Stage.CreateNew("bending.usda")
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    stage.SetTimeCodesPerSecond(24)
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(24)
    UsdGeom.Xform.Define(stage, "/World")
    skinned(stage)
    cloth(stage)
    stage.Save()
    stage.GetRootLayer().Export("bending.usdc")
    baked = Usd.Stage.Open("bending.usda")
    baked.SetEditTarget(baked.GetSessionLayer())
    assert UsdSkel.BakeSkinning(baked.Traverse(), Gf.Interval(0, 24))
    expected = {}
    for code in CODES:
        cache = UsdGeom.XformCache(code)
        for path in ("/World/Person/Body", "/World/Cloth"):
            prim = UsdGeom.Mesh(baked.GetPrimAtPath(path))
            normals = prim.GetNormalsAttr().Get(code) or []
            turned = cache.GetLocalToWorldTransform(prim.GetPrim()).GetInverse().GetTranspose()
            directions = [turned.TransformDir(n).GetNormalized() for n in normals]
            found = {"code": code, "points": world(baked, cache, prim.GetPrim(), prim.GetPointsAttr().Get(code))}
            found["normals"] = [[n[0], -n[2], n[1]] for n in directions]
            expected.setdefault(path[1:], []).append(found)
    with open("bending.json", "w") as f:
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
bending()
main()
