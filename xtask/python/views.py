"""Views of generated homes at night that enfilade and Blender read from one glTF file.

Two things of a home mean different things to the two, and are changed in the file:

- A pane without thickness is thin to enfilade and a block of glass to Blender. Panes become black and keep their reflection: it is night.
- The sheen of towels follows another model in each, and is left out; so is the colour that thick glass and water take by depth.

The sky of the night is left out as well, which glTF has no place for.
"""

import json
import struct
import subprocess

# Seed of the home, and camera in it.
VIEWS = [("1", "living_1"), ("1", "bedroom_1"), ("2", "living_2"), ("3", "living_3")]
GLASS, VOLUME, SHEEN = "KHR_materials_transmission", "KHR_materials_volume", "KHR_materials_sheen"


def prepare(program, seed, camera, work):
    """Writes the view's file, `<home>-<camera>.glb` below `work`, and returns its path."""
    work.mkdir(parents=True, exist_ok=True)
    home = work / f"home-{seed}.glb"
    subprocess.run([program, "home", "--seed", seed, "--moment", "night", "--quiet", "--output", home], check=True, stdout=subprocess.DEVNULL)
    data = home.read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    document = json.loads(data[20 : 20 + length])
    simplify(document, camera)
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length :]
    view = work / f"home-{seed}-{camera}.glb"
    view.write_bytes(struct.pack("<4sIII4s", b"glTF", 2, 20 + len(text) + len(rest), len(text), b"JSON") + text + rest)
    return view


def simplify(document, camera):
    """Leaves one camera, no sky, and materials that both read alike."""
    for node in document["nodes"]:
        if node.get("name") != camera:
            node.pop("camera", None)
    for scene in document["scenes"]:
        scene.get("extras", {}).pop("environment", None)
    for material in document["materials"]:
        extensions = material.get("extensions", {})
        extensions.pop(SHEEN, None)
        if VOLUME in extensions:
            extensions[VOLUME] = {"thicknessFactor": 1.0}
        elif extensions.pop(GLASS, None):
            material["pbrMetallicRoughness"]["baseColorFactor"] = [0, 0, 0, 1]
