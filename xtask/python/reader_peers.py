"""Triangles and bounds of scene files as other programs read them, for `cargo xtask readers`.

`reader_peers.py PEER` answers each path on its standard input with a line of JSON on its standard output: `triangles`, `low` and `high`,
or `error`, and in `facts` how often the file has what readers may differ in. Bounds are those of the corners of triangles, in metres with z
up, the frame that we import into:

- OBJ, PLY, glTF and Mitsuba's scenes: y up, and a unit is a metre, as `enfilade import` takes them where nothing is said.
- USD: by `metersPerUnit` and `upAxis` of the stage, centimetres and y where it states none.
- STL: z up, and a unit is a metre, as `enfilade import` takes it.
- COLLADA: by `unit` and `up_axis` of the file's `asset`, metres and y where it states none. assimp turns and scales it to y up and metres
  itself, trimesh leaves it as it is stored.
- FBX: assimp turns the axes of `GlobalSettings` to y up itself, and hands their unit on in its metadata, as centimetres.
"""

import json
import os
import sys
import xml.etree.ElementTree as ElementTree
from collections import Counter
from collections.abc import Callable, Iterator

import numpy as np

import round_shapes as shapes

# From y up to z up, and from x up.
Z_FROM_Y = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
Z_FROM_X = Z_FROM_Y @ np.array([[0, -1.0, 0], [1, 0, 0], [0, 0, 1]])

Piece = tuple[np.ndarray, np.ndarray]
"""Corners of triangles, three after three, in the peer's own frame; and the matrix to metres with z up."""


def trimesh_pieces(path: str, facts: Counter[str]) -> Iterator[Piece]:
    import trimesh

    scene = trimesh.load_scene(path, process=False)
    world = collada_world(path) if path.lower().endswith(".dae") else unstated_world(path)
    for node in scene.graph.nodes_geometry:
        transform, name = scene.graph[node]
        geometry = scene.geometry[name]
        if isinstance(geometry, trimesh.Trimesh):
            yield np.asarray(geometry.vertices)[geometry.faces].reshape(-1, 3), world @ transform
        else:
            facts[type(geometry).__name__] += 1


def unstated_world(path: str) -> np.ndarray:
    """From what a file without unit and axes has to metres with z up."""
    return frame(np.eye(3) if path.lower().endswith(".stl") else Z_FROM_Y)


def collada_world(path: str) -> np.ndarray:
    """From a COLLADA file's unit and axes to metres with z up."""
    asset = ElementTree.parse(path).getroot().find("{*}asset")
    find = lambda name: None if asset is None else asset.find(f"{{*}}{name}")
    unit, up = find("unit"), find("up_axis")
    axes = {"X_UP": Z_FROM_X, "Z_UP": np.eye(3)}.get("" if up is None else up.text.strip(), Z_FROM_Y)
    return frame(axes * (1.0 if unit is None else float(unit.get("meter", 1))))


def assimp_pieces(path: str, facts: Counter[str]) -> Iterator[Piece]:
    import impasse
    from impasse.constants import ProcessingStep
    from impasse.core import _assimp_lib
    from impasse.errors import AssimpError
    from impasse.structs import ffi

    ffi.cdef("const char *aiGetErrorString();", override=True)
    try:
        scene = impasse.load(path, processing=ProcessingStep.Triangulate)
    except AssimpError:  # No Exception, and without assimp's own message.
        raise ValueError(ffi.string(_assimp_lib.aiGetErrorString()).decode(errors="replace")) from None
    corners = [assimp_corners(mesh, facts) for mesh in scene.meshes]
    index = {mesh.struct: k for k, mesh in enumerate(scene.meshes)}
    told = scene.metadata or {}
    world = frame(Z_FROM_Y * told["UnitScaleFactor"] / 100) if "UnitScaleFactor" in told else unstated_world(path)
    waiting = [(scene.root_node, world)]
    while waiting:
        node, above = waiting.pop()
        placed = above @ np.asarray(node.transformation, float)
        yield from ((corners[index[mesh.struct]], placed) for mesh in node.meshes)
        waiting += [(child, placed) for child in node.children]


def assimp_corners(mesh, facts: Counter[str]) -> np.ndarray:
    from impasse.structs import ffi

    raw, count = mesh.struct, mesh.struct.mNumVertices
    points = np.frombuffer(ffi.buffer(raw.mVertices, 12 * count), np.float32).reshape(-1, 3)
    faces = np.frombuffer(ffi.buffer(raw.mFaces, 16 * raw.mNumFaces), [("corners", "<u4"), ("", "<u4"), ("at", "<u8")])
    facts["bones"] += raw.mNumBones
    facts["morph targets"] += raw.mNumAnimMeshes
    for corners, name in ((1, "points"), (2, "lines")):
        facts[name] += int((faces["corners"] == corners).sum())
    picked = [list(ffi.unpack(raw.mFaces[int(k)].mIndices, 3)) for k in np.flatnonzero(faces["corners"] == 3)]
    return points[np.array(picked, int).ravel()].astype(float)


def usd_pieces(path: str, facts: Counter[str]) -> Iterator[Piece]:
    from pxr import Usd, UsdGeom

    stage = Usd.Stage.Open(path)
    axes = np.eye(3) if UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.z else Z_FROM_Y
    yield from usd_below(stage.GetPseudoRoot(), frame(axes * UsdGeom.GetStageMetersPerUnit(stage)), facts)


def usd_below(prim, above: np.ndarray, facts: Counter[str], prototype: bool = False, loose: bool = False) -> Iterator[Piece]:
    """What is seen of a prim and below it, at the first moment.

    A `prototype` is placed by its instancer, its own transform included; what is below one need not be defined (`loose`), as in Hydra.
    """
    from pxr import Usd, UsdGeom

    time = Usd.TimeCode.EarliestTime()
    here = above
    if not prototype and (form := UsdGeom.Xformable(prim)):
        here = above @ np.array(form.GetLocalTransformation(time)).T
    if image := UsdGeom.Imageable(prim):
        if image.GetVisibilityAttr().Get(time) == "invisible":
            facts["invisible"] += 1
            return
    if prim.IsA(UsdGeom.PointInstancer):
        yield from usd_instances(UsdGeom.PointInstancer(prim), here, facts)
        return
    if prim.IsA(UsdGeom.Gprim) or prim.GetTypeName().endswith("Light"):
        purpose = UsdGeom.Imageable(prim).ComputePurpose()
        if purpose in ("default", "render"):
            yield from usd_gprim(prim, here, facts)
        else:
            facts[purpose] += 1
    seen = Usd.PrimIsActive & Usd.PrimIsLoaded & ~Usd.PrimIsAbstract
    for child in prim.GetFilteredChildren(Usd.TraverseInstanceProxies(seen if loose else seen & Usd.PrimIsDefined)):
        yield from usd_below(child, here, facts, loose=loose)


def usd_instances(instancer, above: np.ndarray, facts: Counter[str]) -> Iterator[Piece]:
    from pxr import Usd

    time = Usd.TimeCode.EarliestTime()
    which, mask = instancer.GetProtoIndicesAttr().Get(time) or [], instancer.ComputeMaskAtTime(time)
    places = instancer.ComputeInstanceTransformsAtTime(time, time, instancer.IncludeProtoXform, instancer.IgnoreMask)
    prototypes = [instancer.GetPrim().GetStage().GetPrimAtPath(path) for path in instancer.GetPrototypesRel().GetForwardedTargets()]
    for k, place in enumerate(places):
        if not mask or mask[k]:
            facts["instances"] += 1
            yield from usd_below(prototypes[which[k]], above @ np.array(place).T, facts, prototype=True, loose=True)


def usd_gprim(prim, above: np.ndarray, facts: Counter[str]) -> Iterator[Piece]:
    from pxr import Usd, UsdGeom

    if not prim.IsA(UsdGeom.Mesh):
        facts[prim.GetTypeName()] += 1
        if (corners := usd_shape(prim)) is not None:
            yield corners, above
        return
    time, mesh = Usd.TimeCode.EarliestTime(), UsdGeom.Mesh(prim)
    read = lambda attribute, kind: np.array(attribute.Get(time) or [], kind)
    points, counts = read(mesh.GetPointsAttr(), float).reshape(-1, 3), read(mesh.GetFaceVertexCountsAttr(), int)
    indices, holes = read(mesh.GetFaceVertexIndicesAttr(), int), read(mesh.GetHoleIndicesAttr(), int)
    facts["holes"] += len(holes)
    if counts.sum() != len(indices) or (indices.size and not 0 <= indices.min() <= indices.max() < len(points)):
        facts["inconsistent mesh"] += 1
        return
    starts = np.cumsum(counts) - counts
    fans = [(s, s + k, s + k + 1) for face, (s, n) in enumerate(zip(starts, counts)) if face not in set(holes) for k in range(1, n - 1)]
    yield points[indices[np.array(fans, int).ravel()]], above


def usd_shape(prim) -> np.ndarray | None:
    """A shape that is described by numbers, or a light that has a surface."""
    from pxr import Usd

    read = lambda name: prim.GetAttribute(name).Get(Usd.TimeCode.EarliestTime())
    light = lambda name: read(f"inputs:{name}")
    match prim.GetTypeName():
        case "Cube":
            return shapes.cube(read("size"))
        case "Sphere":
            return shapes.sphere(read("radius"))
        case "Plane":
            return shapes.along(read("axis"), shapes.rectangle(read("width"), read("length")))
        case "Cylinder":
            return shapes.along(read("axis"), shapes.cylinder(read("radius"), read("radius"), read("height")))
        case "Cylinder_1":
            return shapes.along(read("axis"), shapes.cylinder(read("radiusBottom"), read("radiusTop"), read("height")))
        case "Cone":
            return shapes.along(read("axis"), shapes.cylinder(read("radius"), 0, read("height")))
        case "Capsule":
            return shapes.along(read("axis"), shapes.capsule(read("radius"), read("radius"), read("height")))
        case "Capsule_1":
            return shapes.along(read("axis"), shapes.capsule(read("radiusBottom"), read("radiusTop"), read("height")))
        case "RectLight":
            return shapes.rectangle(light("width"), light("height"))
        case "DiskLight":
            return shapes.disk(light("radius"))
        case "SphereLight" if not read("treatAsPoint") and (light("shaping:cone:angle") or 90) >= 90 and not light("shaping:ies:file"):
            return shapes.lamp(light("radius"))
        case "CylinderLight":
            return shapes.along("X", shapes.tube(light("radius"), -light("length") / 2, light("length") / 2))
    return None


def mitsuba_pieces(path: str, facts: Counter[str]) -> Iterator[Piece]:
    import mitsuba

    mitsuba.set_variant("scalar_rgb")
    kind = path.lower().rsplit(".", 1)[-1]
    if kind == "xml":
        scene = mitsuba.load_file(path, optimize=False)
    else:
        scene = mitsuba.load_dict({"type": "scene", "shape": {"type": kind, "filename": path}}, optimize=False)
    for shape in scene.shapes():
        told, kind = mitsuba.traverse(shape), str(shape).split("[")[0]
        if kind in MITSUBA_SHAPES:
            yield MITSUBA_SHAPES[kind](), frame(Z_FROM_Y) @ np.array(told["to_world"].matrix, float).reshape(4, 4)
        elif shape.is_mesh():
            points, faces = (np.array(told[name]).reshape(-1, 3) for name in ("vertex_positions", "faces"))
            yield points[faces.ravel()].astype(float), frame(Z_FROM_Y)
        else:
            facts[kind] += 1


# Before their `to_world`.
MITSUBA_SHAPES: dict[str, Callable[[], np.ndarray]] = {
    "Rectangle": lambda: shapes.rectangle(2, 2),
    "Disk": shapes.disk,
    "Sphere": shapes.sphere,
    "Cylinder": lambda: shapes.tube(1, 0, 1),
}

PEERS: dict[str, Callable[[str, Counter[str]], Iterator[Piece]]] = {
    "trimesh": trimesh_pieces,
    "assimp": assimp_pieces,
    "usd-core": usd_pieces,
    "mitsuba": mitsuba_pieces,
}


def frame(axes: np.ndarray) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3] = axes
    return matrix


def measured(pieces: Iterator[Piece]) -> dict:
    """Triangles, how many of them have two equal corners, and bounds of their corners that are finite."""
    triangles, flat, low, high = 0, 0, np.full(3, np.inf), np.full(3, -np.inf)
    for corners, matrix in pieces:
        triangles += len(corners) // 3
        a, b, c = corners.reshape(-1, 3, 3).swapaxes(0, 1)
        flat += int(((a == b).all(1) | (b == c).all(1) | (c == a).all(1)).sum())
        placed = corners @ matrix[:3, :3].T + matrix[:3, 3]
        placed = placed[np.isfinite(placed).all(1)]
        if len(placed):
            low, high = np.minimum(low, placed.min(0)), np.maximum(high, placed.max(0))
    bounds = dict(low=low.tolist(), high=high.tolist()) if np.isfinite(low).all() else {}
    return dict(triangles=triangles, flat=flat, **bounds)


def answer(peer: str, path: str) -> dict:
    facts: Counter[str] = Counter()
    try:
        found = measured(PEERS[peer](path, facts))
    except Exception as error:
        found = dict(error=f"{type(error).__name__}: {error}".replace(os.path.dirname(path) + "/", "").splitlines()[0][:300])
    return found | dict(facts={name: count for name, count in facts.items() if count})


def main() -> None:
    # Libraries print to standard output too; answers keep it to themselves.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    for line in sys.stdin:
        print(json.dumps(answer(sys.argv[1], line.rstrip("\n"))), file=answers, flush=True)


if __name__ == "__main__":
    main()
