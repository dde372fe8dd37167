"""Renders with Cycles and writes the colour as a NumPy array: the peer's side of `cargo xtask bench cycles`, a process of its own.

peer_cycles.py SCENE.blend --size WIDTHxHEIGHT --samples N --bounces N [--seed S] [--denoise] [--out FILE.npy]
peer_cycles.py SCENE.glb --convert FILE.blend

The array is float32, 1 × height × width × 3, linear. With `--denoise` there follows the picture rendered anew with the same seed and denoised by
what Cycles has for it, Open Image Denoise guided by albedo and normals that it filters first, at high quality. `--convert` keeps what Blender reads from glTF,
and the surroundings that enfilade writes there, in Blender's own format, which loads faster. Whatever else makes Cycles' pictures biased is off:
clamping, blurred caustics, lights left out, adaptive sampling. One line of JSON tells the version and the processor seconds of all threads until a first
picture was made, of rendering, and of what denoising adds. The file is not called `cycles.py` because Blender has a module of that name.
"""

import argparse
import json
import struct
import tempfile
from pathlib import Path
from time import process_time

import bpy
import numpy as np
from mathutils import Matrix

BOUNCES = ["max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces", "transparent_max_bounces"]
UNBIASED = dict(
    device="CPU",
    use_adaptive_sampling=False,
    sample_clamp_direct=0,
    sample_clamp_indirect=0,
    caustics_reflective=True,
    caustics_refractive=True,
    blur_glossy=0,
    light_sampling_threshold=0,
    use_light_tree=True,
    # The mean over the pixel's square.
    pixel_filter_type="BOX",
)
DENOISER = dict(
    denoiser="OPENIMAGEDENOISE",
    denoising_input_passes="RGB_ALBEDO_NORMAL",
    denoising_prefilter="ACCURATE",
    denoising_quality="HIGH",
    denoising_use_gpu=False,
)
# What Blender calls a direction in glTF, which has y up.
BLENDER_FROM_GLTF = Matrix(((1, 0, 0), (0, 0, -1), (0, 1, 0)))
# From the map of surroundings, whose middle is +z, to Blender's, whose middle is +x.
BLENDERS_MAP = Matrix(((0, -1, 0), (1, 0, 0), (0, 0, 1)))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("scene")
    parser.add_argument("--size", default="256x192")
    parser.add_argument("--samples", type=int, default=16)
    parser.add_argument("--bounces", type=int, default=64)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--denoise", action="store_true")
    parser.add_argument("--convert")
    parser.add_argument("--out")
    job = parser.parse_args()
    seconds = {}
    if job.convert:
        convert(job.scene, job.convert)
    else:
        bpy.ops.wm.open_mainfile(filepath=job.scene)
        set_up(bpy.context.scene, job)
        render(bpy.context.scene, 1, job.denoise)
        times, pictures = [process_time()], []
        for denoised in [False, True][: 1 + job.denoise]:
            pictures.append(render(bpy.context.scene, job.samples, denoised))
            times.append(process_time())
        first, *taken = np.diff(times, prepend=0)
        seconds = dict(load_core_s=first, render_core_s=taken[0], denoise_core_s=taken[-1] - taken[0])
        if job.out:
            np.save(job.out, np.stack(pictures))
    print(json.dumps({"blender": bpy.app.version_string, **seconds}))


def convert(source, target):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=source)
    scene = bpy.context.scene
    scene.camera = next(thing for thing in bpy.data.objects if thing.type == "CAMERA")
    for material in bpy.data.materials:
        # Of glTF's single-sided materials; a lamp's inside lights nothing.
        if material.use_backface_culling:
            material.cycles.emission_sampling = "FRONT"
    with tempfile.TemporaryDirectory() as folder:
        surround(scene, Path(source).read_bytes(), f"{folder}/surroundings.exr")
        bpy.ops.file.pack_all()
    bpy.ops.wm.save_as_mainfile(filepath=target, compress=False)


def surround(scene, glb, path):
    """The surroundings that stand in the extras of a glTF file, or black."""
    scene.world = bpy.data.worlds.new("surroundings")
    scene.world.use_nodes = True
    nodes, links = scene.world.node_tree.nodes, scene.world.node_tree.links
    (length,) = struct.unpack_from("<I", glb, 12)
    document = json.loads(glb[20 : 20 + length])
    found = document["scenes"][0].get("extras", {}).get("environment")
    if not found:
        nodes["Background"].inputs["Strength"].default_value = 0
        return
    view, start = document["bufferViews"][found["bufferView"]], 28 + length
    start += view.get("byteOffset", 0)
    Path(path).write_bytes(glb[start : start + view["byteLength"]])
    direction, turned, picture = (nodes.new(f"ShaderNode{kind}") for kind in ("TexCoord", "Mapping", "TexEnvironment"))
    numbers = found["gltf_from_map"]
    map_from_gltf = Matrix([numbers[0:3], numbers[3:6], numbers[6:9]]).transposed()
    rotation = BLENDERS_MAP @ BLENDER_FROM_GLTF @ map_from_gltf @ BLENDER_FROM_GLTF.transposed()
    turned.inputs["Rotation"].default_value = rotation.to_euler()
    picture.image = bpy.data.images.load(path)
    links.new(direction.outputs["Generated"], turned.inputs["Vector"])
    links.new(turned.outputs["Vector"], picture.inputs["Vector"])
    links.new(picture.outputs["Color"], nodes["Background"].inputs["Color"])


def set_up(scene, job):
    scene.render.engine = "CYCLES"
    for key, value in {**UNBIASED, **DENOISER, **dict.fromkeys(BOUNCES, job.bounces)}.items():
        setattr(scene.cycles, key, value)
    scene.cycles.seed = job.seed
    to = scene.render
    to.resolution_x, to.resolution_y = map(int, job.size.split("x"))
    to.resolution_percentage = 100
    # What was loaded for one picture stays for the next.
    to.use_persistent_data = True
    to.use_compositing = to.use_sequencer = False
    to.image_settings.file_format, to.image_settings.color_depth = "OPEN_EXR", "32"


def render(scene, samples, denoised):
    """The picture as float32, row by row from the top: written as OpenEXR and read again, since Blender hands out no result directly."""
    scene.cycles.samples, scene.cycles.use_denoising = samples, denoised
    to = scene.render
    with tempfile.TemporaryDirectory() as folder:
        to.filepath = f"{folder}/picture.exr"
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(to.filepath)
        values = np.empty(to.resolution_x * to.resolution_y * 4, np.float32)
        image.pixels.foreach_get(values)
        bpy.data.images.remove(image)
    return values.reshape(to.resolution_y, to.resolution_x, 4)[::-1, :, :3]


if __name__ == "__main__":
    main()
