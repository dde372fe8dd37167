"""Views of generated homes that enfilade and the peers read from one glTF file.

What a home holds means different things to the renderers, and is changed in the file:

- A pane without thickness is thin to enfilade and a block of glass to Blender. At night panes become black and keep their reflection; by day
  they are left out, as if the windows stood open.
- The sheen of cloth stays, though Cycles has another model for it (Zeltner et al. 2022) than glTF's (Estevez & Kulla 2017), which is ours.
- The colour that thick glass and water take by depth is left out.
- The sky of the night is left out. That of the day, with the sun in it, stays: `peer_cycles.py` puts it into Blender's world.
"""

import json
import struct
import subprocess

# Seed of the home, time of day, and camera in it, by the view's name.
VIEWS = {f"home-{seed}-{moment}-{camera}": (seed, moment, camera) for seed, moment, camera in [
    ("1", "night", "living_1"),
    ("2", "night", "living_2"),
    ("3", "day", "living_3"),
    ("201", "day", "living_1"),
]}
GLASS, VOLUME = "KHR_materials_transmission", "KHR_materials_volume"


def prepare(program, name, work):
    """Writes the view's file, `<name>.glb` below `work`, and returns its path."""
    work.mkdir(parents=True, exist_ok=True)
    (seed, moment, camera), view = VIEWS[name], work / f"{name}.glb"
    subprocess.run([program, "home", "--seed", seed, "--moment", moment, "--quiet", "--output", view], check=True, stdout=subprocess.DEVNULL)
    data = view.read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    document = json.loads(data[20 : 20 + length])
    simplify(document, moment, camera)
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length :]
    view.write_bytes(struct.pack("<4sIII4s", b"glTF", 2, 20 + len(text) + len(rest), len(text), b"JSON") + text + rest)
    return view


def simplify(document, moment, camera):
    """Leaves one camera, the sky of the day, and materials that all read alike."""
    for node in document["nodes"]:
        if node.get("name") != camera:
            node.pop("camera", None)
    if moment == "night":
        for scene in document["scenes"]:
            scene.get("extras", {}).pop("environment", None)
    panes = set()
    for index, material in enumerate(document["materials"]):
        extensions = material.get("extensions", {})
        if VOLUME in extensions:
            extensions[VOLUME] = {"thicknessFactor": 1.0}
        elif extensions.pop(GLASS, None):
            panes.add(index)
            material["pbrMetallicRoughness"]["baseColorFactor"] = [0, 0, 0, 1]
    if moment == "day":
        open_windows(document, panes)


def open_windows(document, panes):
    """Takes what has the materials of panes out of the meshes, and meshes that held nothing else out of the nodes."""
    for mesh in document["meshes"]:
        mesh["primitives"] = [part for part in mesh["primitives"] if part.get("material") not in panes]
    empty = {index for index, mesh in enumerate(document["meshes"]) if not mesh["primitives"]}
    for node in document["nodes"]:
        if node.get("mesh") in empty:
            del node["mesh"]
    # A mesh without parts is not allowed: what nothing shows any more borrows those of another.
    whole = next(mesh["primitives"] for mesh in document["meshes"] if mesh["primitives"])
    for index in empty:
        document["meshes"][index]["primitives"] = whole
