"""Renders with Cycles and writes the colour as a NumPy array: the peer's side of `cargo xtask bench cycles`, a process of its own.

peer_cycles.py SCENE.blend --size WIDTHxHEIGHT --samples N --bounces N --threads N [--seed S] [--guiding] [--out FILE.npy]
peer_cycles.py SCENE.glb --convert FILE.blend

The array is float32, 1 × height × width × 3, linear. `--convert` keeps what Blender reads from glTF in its own format, which loads
faster. Whatever makes Cycles' pictures biased is off: clamping, blurred caustics, lights left out, adaptive sampling, the denoiser.
One line of JSON tells the version. The file is not called `cycles.py` because Blender has a module of that name.
"""

import argparse
import json
import tempfile

import bpy
import numpy as np

BOUNCES = ["max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces", "transparent_max_bounces"]
UNBIASED = dict(
    device="CPU",
    use_denoising=False,
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


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("scene")
    parser.add_argument("--size", default="256x192")
    parser.add_argument("--samples", type=int, default=16)
    parser.add_argument("--bounces", type=int, default=64)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--guiding", action="store_true")
    parser.add_argument("--convert")
    parser.add_argument("--out")
    job = parser.parse_args()
    if job.convert:
        convert(job.scene, job.convert)
    else:
        bpy.ops.wm.open_mainfile(filepath=job.scene)
        set_up(bpy.context.scene, job)
        picture = render(bpy.context.scene)
        if job.out:
            np.save(job.out, picture[None])
    print(json.dumps({"blender": bpy.app.version_string}))


def convert(source, target):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=source)
    bpy.context.scene.camera = next(thing for thing in bpy.data.objects if thing.type == "CAMERA")
    bpy.ops.file.pack_all()
    bpy.ops.wm.save_as_mainfile(filepath=target, compress=False)


def set_up(scene, job):
    import _cycles

    if job.guiding and not _cycles.with_path_guiding:
        raise SystemExit("this Blender has no path guiding")
    scene.render.engine = "CYCLES"
    for key, value in {**UNBIASED, **dict.fromkeys(BOUNCES, job.bounces)}.items():
        setattr(scene.cycles, key, value)
    scene.cycles.samples, scene.cycles.seed, scene.cycles.use_guiding = job.samples, job.seed, job.guiding
    for material in bpy.data.materials:
        # Of glTF's single-sided materials; a lamp's inside lights nothing.
        if material.use_backface_culling:
            material.cycles.emission_sampling = "FRONT"
    scene.world = bpy.data.worlds.new("black")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0
    to = scene.render
    to.resolution_x, to.resolution_y = map(int, job.size.split("x"))
    to.resolution_percentage = 100
    to.threads_mode, to.threads = "FIXED", job.threads
    to.use_compositing = to.use_sequencer = False
    to.image_settings.file_format, to.image_settings.color_depth = "OPEN_EXR", "32"


def render(scene):
    """The picture as float32, row by row from the top: written as OpenEXR and read again, since Blender hands out no result directly."""
    to = scene.render
    with tempfile.TemporaryDirectory() as folder:
        to.filepath = f"{folder}/picture.exr"
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(to.filepath)
        values = np.empty(to.resolution_x * to.resolution_y * 4, np.float32)
        image.pixels.foreach_get(values)
    return values.reshape(to.resolution_y, to.resolution_x, 4)[::-1, :, :3]


if __name__ == "__main__":
    main()
