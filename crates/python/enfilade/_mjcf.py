"""Writes a compiled model of MuJoCo as files that `import_scene` reads: MJCF, meshes (MSH) and textures (PNG)."""

import struct
import zlib
from xml.etree import ElementTree

import numpy

_GEOMS = ["plane", "hfield", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh", "sdf"]
_JOINTS = ["free", "ball", "slide", "hinge"]
_LIGHTS = ["spot", "directional", "point"]
# Of cameras, by the numbers of mjtCamLight.
_MODES = ["fixed", "track", "trackcom", "targetbody", "targetbodycom"]
# Roles of textures: mjTEXROLE_RGB and mjTEXROLE_RGBA.
_COLORS = [1, 9]

def write(model, folder):
    """Writes the model to a folder, and gives the path of its scene file."""
    root = ElementTree.Element("mujoco", model="world")
    ElementTree.SubElement(root, "compiler", angle="radian", autolimits="false")
    ElementTree.SubElement(root, "option", timestep=repr(float(model.opt.timestep)))
    ElementTree.SubElement(root, "statistic", center=_numbers(model.stat.center))
    _assets(model, ElementTree.SubElement(root, "asset"), folder)
    elements = {0: ElementTree.SubElement(root, "worldbody")}
    for body, name in enumerate(names(model, "body", model.nbody)):
        if body:
            elements[body] = ElementTree.Element("body", _named(name))
            elements[body].attrib |= {"pos": _numbers(model.body_pos[body]), "quat": _numbers(model.body_quat[body])}
            if model.body_mocapid[body] >= 0:
                elements[body].set("mocap", "true")
    _joints(model, elements)
    _geoms(model, elements)
    _views(model, elements)
    # Behind what is in the body itself, so that parts come in the model's order.
    for body in range(1, model.nbody):
        elements[int(model.body_parentid[body])].append(elements[body])
    file = folder / "model.xml"
    ElementTree.ElementTree(root).write(file, encoding="utf-8")
    return file


def names(model, kind, count):
    """Names of all bodies, geoms, …; an empty one of what has none."""
    starts = getattr(model, f"name_{kind}adr")
    return [bytes(model.names)[start : bytes(model.names).index(b"\0", start)].decode() for start in map(int, starts[:count])]


def _joints(model, elements):
    for joint, name in enumerate(names(model, "jnt", model.njnt)):
        kind = _JOINTS[int(model.jnt_type[joint])]
        element = ElementTree.SubElement(elements[int(model.jnt_bodyid[joint])], "joint", _named(name), type=kind)
        element.attrib |= {"pos": _numbers(model.jnt_pos[joint]), "axis": _numbers(model.jnt_axis[joint])}
        if kind in ("slide", "hinge"):
            element.set("ref", repr(float(model.qpos0[model.jnt_qposadr[joint]])))
            if model.jnt_limited[joint]:
                element.attrib |= {"limited": "true", "range": _numbers(model.jnt_range[joint])}


def _geoms(model, elements):
    for geom, name in enumerate(names(model, "geom", model.ngeom)):
        kind = _GEOMS[int(model.geom_type[geom])] if int(model.geom_type[geom]) < len(_GEOMS) else "other"
        element = ElementTree.SubElement(elements[int(model.geom_bodyid[geom])], "geom", _named(name), type=kind)
        element.attrib |= {"pos": _numbers(model.geom_pos[geom]), "quat": _numbers(model.geom_quat[geom]), "rgba": _numbers(model.geom_rgba[geom])}
        element.attrib |= {"group": str(model.geom_group[geom]), "contype": str(model.geom_contype[geom])}
        element.set("conaffinity", str(model.geom_conaffinity[geom]))
        if kind == "mesh":
            element.set("mesh", f"mesh_{model.geom_dataid[geom]}")
        else:
            element.set("size", _numbers(model.geom_size[geom]))
        if model.geom_matid[geom] >= 0:
            element.set("material", f"material_{model.geom_matid[geom]}")


def _views(model, elements):
    bodies = [name or f"body_{body}" for body, name in enumerate(names(model, "body", model.nbody))]
    for camera, name in enumerate(names(model, "cam", model.ncam)):
        element = ElementTree.SubElement(elements[int(model.cam_bodyid[camera])], "camera", _named(name))
        element.attrib |= {"pos": _numbers(model.cam_pos[camera]), "quat": _numbers(model.cam_quat[camera])}
        element.attrib |= {"fovy": repr(float(model.cam_fovy[camera])), "resolution": "{} {}".format(*map(int, model.cam_resolution[camera]))}
        mode = _MODES[int(model.cam_mode[camera])]
        if mode.startswith("target"):
            element.attrib |= {"mode": mode, "target": bodies[int(model.cam_targetbodyid[camera])]}
        elif mode != "fixed":
            element.set("mode", mode)
    for light, name in enumerate(names(model, "light", model.nlight)):
        kinds = getattr(model, "light_type", None)
        kind = int(model.light_directional[light]) if kinds is None else int(kinds[light])
        element = ElementTree.SubElement(elements[int(model.light_bodyid[light])], "light", _named(name))
        element.attrib |= {"type": _LIGHTS[kind] if kind < len(_LIGHTS) else "image", "active": "true" if model.light_active[light] else "false"}
        element.attrib |= {"pos": _numbers(model.light_pos[light]), "dir": _numbers(model.light_dir[light])}
        element.attrib |= {"diffuse": _numbers(model.light_diffuse[light]), "cutoff": repr(float(model.light_cutoff[light]))}
        if hasattr(model, "light_intensity"):
            element.set("intensity", repr(float(model.light_intensity[light])))
        if int(model.light_mode[light]) >= 3:
            element.attrib |= {"mode": "targetbody", "target": bodies[int(model.light_targetbodyid[light])]}


def _assets(model, asset, folder):
    for mesh in sorted({int(mesh) for mesh, kind in zip(model.geom_dataid, model.geom_type) if kind == _GEOMS.index("mesh")}):
        (folder / f"mesh_{mesh}.msh").write_bytes(_mesh(model, mesh))
        ElementTree.SubElement(asset, "mesh", name=f"mesh_{mesh}", file=f"mesh_{mesh}.msh")
    used = set()
    for material, name in enumerate(names(model, "mat", model.nmat)):
        element = ElementTree.SubElement(asset, "material", name=f"material_{material}", rgba=_numbers(model.mat_rgba[material]))
        element.attrib |= {"texrepeat": _numbers(model.mat_texrepeat[material])}
        element.attrib |= {"texuniform": "true" if model.mat_texuniform[material] else "false"}
        for key in ("emission", "specular", "shininess", "reflectance", "metallic", "roughness"):
            if hasattr(model, f"mat_{key}"):
                element.set(key, repr(float(getattr(model, f"mat_{key}")[material])))
        roles = numpy.atleast_1d(model.mat_texid[material])
        found = [int(roles[role]) for role in (_COLORS if len(roles) > 1 else [0]) if role < len(roles) and roles[role] >= 0]
        if found:
            element.set("texture", f"texture_{found[0]}")
            used.add(found[0])
    for texture in sorted(used):
        _texture(model, texture, asset, folder)


def _mesh(model, mesh):
    """The bytes of an MSH file, with vertices of their own for the corners of each face."""
    first, count = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
    faces = slice(first, first + count)

    def corners(values, start, numbers):
        return numpy.asarray(values)[int(start) + numpy.asarray(numbers)[faces].reshape(-1)].astype("<f4")

    positions = corners(model.mesh_vert, model.mesh_vertadr[mesh], model.mesh_face)
    normals = corners(model.mesh_normal, model.mesh_normaladr[mesh], model.mesh_facenormal)
    has_uvs = int(model.mesh_texcoordadr[mesh]) >= 0
    uvs = corners(model.mesh_texcoord, model.mesh_texcoordadr[mesh], model.mesh_facetexcoord) if has_uvs else numpy.empty((0, 2), "<f4")
    head = struct.pack("<4i", len(positions), len(normals), len(uvs), count)
    return head + b"".join(part.tobytes() for part in (positions, normals, uvs, numpy.arange(3 * count, dtype="<i4")))


def _texture(model, texture, asset, folder):
    width, height = int(model.tex_width[texture]), int(model.tex_height[texture])
    channels = int(model.tex_nchannel[texture])
    start = int(model.tex_adr[texture])
    pixels = numpy.asarray(model.tex_data)[start : start + width * height * channels].reshape(height, width, channels)
    (folder / f"texture_{texture}.png").write_bytes(_png(pixels.astype(numpy.uint8)))
    element = ElementTree.SubElement(asset, "texture", name=f"texture_{texture}", file=f"texture_{texture}.png", type="2d")
    if int(model.tex_type[texture]) != 0:
        # The sides of a cube are one below the other.
        element.attrib |= {"type": "cube", "gridsize": "6 1", "gridlayout": "RLUDFB"}


def _png(pixels):
    kind = {1: 0, 2: 4, 3: 2, 4: 6}[pixels.shape[2]]
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    head = struct.pack(">2I5B", pixels.shape[1], pixels.shape[0], 8, kind, 0, 0, 0)

    def chunk(name, body):
        return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))

    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 6)) + chunk(b"IEND", b"")


def _named(name):
    return {"name": name} if name else {}


def _numbers(values):
    return " ".join(repr(float(value)) for value in numpy.ravel(values))
