"""Ten models in a heap as BOP, by BlenderProc: the steps and the numbers of its `bop_challenge/main_ycbv_random.py`, on models of ours.

recipe_bop.py BOP_FOLDER DATASET COPIES TEXTURES OUT SCENES IMAGES WIDTHxHEIGHT

BOP_FOLDER/DATASET/models has obj_000001.ply to obj_000010.ply, in millimetres.
"""

import sys
from pathlib import Path

import blenderproc as bproc
import numpy as np

bop_folder, dataset, copies, textures, out, scenes, images, size = sys.argv[1:]
scenes, images, copies = int(scenes), int(images), int(copies)
width, height = map(int, size.split("x"))

bproc.init()
bproc.camera.set_resolution(width, height)

# The models whose poses are learnt, so many times each, and distractors, which are smaller.
models = str(Path(bop_folder) / dataset)
targets = bproc.loader.load_bop_objs(models, obj_ids=list(range(1, 11)) * copies, object_model_unit="mm")
distractors = bproc.loader.load_bop_objs(models, obj_ids=[4, 5, 6, 7, 10, 5], object_model_unit="mm")
for thing in distractors:
    thing.set_scale(thing.get_scale() * np.random.uniform(0.5, 0.8))
everything = targets + distractors
for thing in everything:
    thing.set_shading_mode("auto")

# A room of five planes.
quarter = np.pi / 2
planes = [bproc.object.create_primitive("PLANE", scale=[2, 2, 1])]
for location, rotation in [
    ([0, -2, 2], [-quarter, 0, 0]),
    ([0, 2, 2], [quarter, 0, 0]),
    ([2, 0, 2], [0, -quarter, 0]),
    ([-2, 0, 2], [0, quarter, 0]),
]:
    planes.append(bproc.object.create_primitive("PLANE", scale=[2, 2, 1], location=location, rotation=rotation))
for plane in planes:
    plane.enable_rigidbody(False, collision_shape="BOX", mass=1.0, friction=100.0, linear_damping=0.99, angular_damping=0.99)

# A ceiling that shines, and a lamp.
ceiling = bproc.object.create_primitive("PLANE", scale=[3, 3, 1], location=[0, 0, 10])
ceiling.set_name("light_plane")
shine = bproc.material.create("light_material")
lamp = bproc.types.Light()
lamp.set_energy(200)
surfaces = bproc.loader.load_ccmaterials(textures)

bproc.renderer.enable_depth_output(activate_antialiasing=False)
bproc.renderer.set_max_amount_of_samples(50)


def drawn_pose(thing):
    low = np.random.uniform([-0.3, -0.3, 0.0], [-0.2, -0.2, 0.0])
    high = np.random.uniform([0.2, 0.2, 0.4], [0.3, 0.3, 0.6])
    thing.set_location(np.random.uniform(low, high))
    thing.set_rotation_euler(bproc.sampler.uniformSO3())


for _ in range(scenes):
    for thing in everything:
        material = thing.get_materials()[0]
        material.set_principled_shader_value("Roughness", np.random.uniform(0, 1.0))
        material.set_principled_shader_value("Specular IOR Level", np.random.uniform(0, 1.0))
        thing.enable_rigidbody(True, mass=1.0, friction=100.0, linear_damping=0.99, angular_damping=0.99)

    shine.make_emissive(emission_strength=np.random.uniform(3, 6), emission_color=np.random.uniform([0.5, 0.5, 0.5, 1.0], [1.0, 1.0, 1.0, 1.0]))
    ceiling.replace_materials(shine)
    lamp.set_color(np.random.uniform([0.5, 0.5, 0.5], [1, 1, 1]))
    lamp.set_location(bproc.sampler.shell(center=[0, 0, 0], radius_min=1, radius_max=1.5, elevation_min=5, elevation_max=89))
    surface = np.random.choice(surfaces)
    for plane in planes:
        plane.replace_materials(surface)

    bproc.object.sample_poses(objects_to_sample=everything, sample_pose_func=drawn_pose, max_tries=1000)
    bproc.object.simulate_physics_and_fix_final_poses(
        min_simulation_time=3, max_simulation_time=10, check_object_interval=1, substeps_per_frame=20, solver_iters=25
    )

    obstacles = bproc.object.create_bvh_tree_multi_objects(everything)
    views = 0
    while views < images:
        location = bproc.sampler.shell(center=[0, 0, 0], radius_min=0.61, radius_max=1.24, elevation_min=5, elevation_max=89)
        looked_at = bproc.object.compute_poi(np.random.choice(targets, size=15, replace=False))
        rotation = bproc.camera.rotation_from_forward_vec(looked_at - location, inplane_rot=np.random.uniform(-np.pi, np.pi))
        pose = bproc.math.build_transformation_mat(location, rotation)
        if bproc.camera.perform_obstacle_in_view_check(pose, {"min": 0.3}, obstacles):
            bproc.camera.add_camera_pose(pose, frame=views)
            views += 1

    found = bproc.renderer.render()
    bproc.writer.write_bop(
        out,
        target_objects=targets,
        dataset=dataset,
        depth_scale=0.1,
        depths=found["depth"],
        colors=found["colors"],
        color_file_format="JPEG",
        ignore_dist_thres=10,
    )
    for thing in everything:
        thing.disable_rigidbody()
