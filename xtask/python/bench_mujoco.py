"""`cargo xtask bench mujoco`: depth and segmentation of a run of MuJoCo, by our dataset and by MuJoCo's own renderer.

The run is `examples/motion/simulation.toml`. Every frame is drawn by MuJoCo with the camera and at the moment of ours. MuJoCo needs
OpenGL for that: EGL, or OSMesa where `MUJOCO_GL=osmesa` says so.
"""

import csv
import json
import subprocess
from pathlib import Path

import command
import h5py
import mujoco
import numpy as np
from machine import processor
from PIL import Image

FOLDER, SCENE, CAMERA = Path("examples/motion"), "room", "cam_00"
# Depths are the same to within this share, and pixels are near an edge where MuJoCo's geoms differ within this many pixels.
SAME_DEPTH, EDGE = 1e-3, 1
# The frame of the picture on the page.
SHOWN = 12


def main():
    job = command.parse("bench mujoco", __doc__, "cases", "none", options)
    work = Path(job.work)
    work.mkdir(parents=True, exist_ok=True)
    dataset = work / "simulation"
    subprocess.run([job.program, "run", FOLDER / "simulation.toml", "-o", dataset, "--quality", "draft", "--size", job.size, "--frames", str(job.frames)], check=True)
    found, picture = compared(dataset)
    docs = Path(job.docs)
    docs.mkdir(parents=True, exist_ok=True)
    told = dict(processor=processor(), mujoco=mujoco.__version__, size=job.size, frames=len(found), **totals(found))
    (docs / "mujoco.json").write_text(json.dumps(told | {"by_frame": found}, indent=1) + "\n")
    (docs / "mujoco.md").write_text("\n".join(page(told)) + "\n")
    picture.save(docs / "mujoco.png")
    print("\n".join(page(told)))


def options(parser):
    parser.add_argument("--size", default="640x480", help="WIDTHxHEIGHT of the pictures [640x480]")
    parser.add_argument("--frames", type=int, default=24, help="frames of the video [24]")


def compared(dataset):
    """What each frame shows in both, and a picture of one."""
    images, details = dataset / f"scenes/{SCENE}/images", dataset / f"scenes/{SCENE}/_detail"
    names = {int(row["node_id"]): row["node_name"] for row in rows(details / "metadata_nodes.csv")}
    times = moments(details)
    model, camera_id = with_camera(details)
    data, states = mujoco.MjData(model), np.load(FOLDER / "simulation.npz")
    poses = camera_poses(details)
    found, picture = [], None
    for frame, time in times.items():
        layer = lambda name: h5py.File(images / f"scene_{CAMERA}_geometry_hdf5/frame.{frame:04}.{name}.hdf5")["dataset"][:]
        if not (images / f"scene_{CAMERA}_geometry_hdf5/frame.{frame:04}.depth_z_meters.hdf5").is_file():
            continue
        depth, nodes = layer("depth_z_meters").astype(np.float64), layer("render_entity_id")
        data.qpos[:] = at(model, states, time)
        model.cam_pos[camera_id], model.cam_quat[camera_id] = poses[frame]
        mujoco.mj_forward(model, data)
        their_depth, geoms = drawn(model, data, camera_id, depth.shape)
        ours = np.vectorize(lambda node: geom_of(model, names, node), otypes=[int])(nodes)
        found.append({"frame": frame, "time_s": time} | difference(depth, ours, their_depth, geoms))
        if frame == min(SHOWN, max(times)):
            picture = strip(model.ngeom, (ours, geoms), (depth, their_depth))
    return found, picture


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def moments(details):
    """Seconds by frame."""
    told = {row["parameter_name"]: float(row["parameter_value"]) for row in rows(details / CAMERA / "metadata_camera.csv")}
    with h5py.File(details / CAMERA / "camera_keyframe_frame_indices.hdf5") as file:
        return {int(frame): float(frame) * told["frame_time_seconds"] for frame in file["dataset"][:]}


def camera_poses(details):
    """Position and MuJoCo's quaternion by frame; both have x to the right, y up and z backward."""
    read = lambda name: h5py.File(details / CAMERA / f"camera_keyframe_{name}.hdf5")["dataset"][:]
    frames, positions, axes = read("frame_indices"), read("positions"), read("orientations")
    found = {}
    for frame, position, rotation in zip(frames, positions, axes):
        quaternion = np.zeros(4)
        mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(rotation, dtype=np.float64).ravel())
        found[int(frame)] = (position, quaternion)
    return found


def with_camera(details):
    """The model with one more camera in the world, of our field of view."""
    spec = mujoco.MjSpec.from_file(str(FOLDER / "simulation.xml"))
    seen = json.loads((details / CAMERA / "cameras_opencv.json").read_text())
    intrinsics = np.array(seen["K"] if "K" in seen else seen["frames"][0]["K"])
    # OpenCV's pixels have whole numbers at their centres.
    height = 2.0 * (intrinsics[1][2] + 0.5)
    spec.worldbody.add_camera(name="enfilade", fovy=np.degrees(2.0 * np.arctan(0.5 * height / intrinsics[1][1])))
    spec.visual.global_.offwidth, spec.visual.global_.offheight = 1920, 1440
    # Planes of the clip of depth: far enough for the room, and near enough for precision.
    spec.visual.map.znear, spec.visual.map.zfar = 0.02, 20.0
    model = spec.compile()
    return model, model.camera("enfilade").id


def at(model, states, time):
    """qpos at a moment, between the stored steps as MuJoCo's joints go: quaternions by the short way round."""
    times = states["time"]
    step = int(np.clip(np.searchsorted(times, time, side="right") - 1, 0, len(times) - 2))
    share = float(np.clip((time - times[step]) / (times[step + 1] - times[step]), 0.0, 1.0))
    velocity = np.zeros(model.nv)
    mujoco.mj_differentiatePos(model, velocity, 1.0, states["qpos"][step], states["qpos"][step + 1])
    found = states["qpos"][step].copy()
    mujoco.mj_integratePos(model, found, velocity, share)
    return found


def drawn(model, data, camera_id, shape):
    """MuJoCo's depth along the axis in metres, and the geom of each pixel, -1 for none."""
    with mujoco.Renderer(model, *shape) as renderer:
        renderer.enable_depth_rendering()
        renderer.update_scene(data, camera_id)
        depth = renderer.render().astype(np.float64)
        renderer.disable_depth_rendering()
        renderer.enable_segmentation_rendering()
        renderer.update_scene(data, camera_id)
        seen = renderer.render()
    return depth, np.where(seen[..., 1] == mujoco.mjtObj.mjOBJ_GEOM, seen[..., 0], -1)


def geom_of(model, names, node):
    """MuJoCo's number of the geom that a node of ours is; -1 of none."""
    return mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, names.get(int(node), ""))


def difference(depth, ours, their_depth, geoms):
    """Shares of the pixels in which both agree, in all of the picture and away from edges."""
    inner = ~near_edges(geoms)
    same = ours == geoms
    near = np.abs(depth - their_depth) <= SAME_DEPTH * their_depth
    both = same & inner
    error = np.abs(depth - their_depth)[both]
    return dict(
        same_geom=float(same.mean()),
        same_depth=float(near.mean()),
        inner=float(inner.mean()),
        inner_same_geom=float(same[inner].mean()),
        inner_same_depth=float(near[inner].mean()),
        median_error_m=float(np.median(error)),
        greatest_error_m=float(error.max()),
    )


def near_edges(geoms):
    """Where a pixel up to EDGE away shows another geom."""
    height, width = geoms.shape
    padded = np.pad(geoms, EDGE, mode="edge")
    shifts = [(y, x) for y in range(2 * EDGE + 1) for x in range(2 * EDGE + 1)]
    return np.any([padded[y : y + height, x : x + width] != geoms for y, x in shifts], axis=0)


def totals(found):
    """Means over frames of shares, and the greatest errors of all."""
    shares = {key: float(np.mean([frame[key] for frame in found])) for key in ("same_geom", "same_depth", "inner", "inner_same_geom", "inner_same_depth")}
    return shares | dict(median_error_m=float(np.median([frame["median_error_m"] for frame in found])), greatest_error_m=max(frame["greatest_error_m"] for frame in found))


def strip(count, geoms, depths):
    """Geoms and depths, ours above MuJoCo's."""
    colors = np.random.default_rng(5).integers(40, 256, (count + 1, 3), dtype=np.uint8)
    shaded = lambda depth: np.repeat((255.0 * np.clip(1.0 - depth / 5.0, 0, 1)).astype(np.uint8)[..., None], 3, axis=2)
    parts = [np.concatenate([colors[geom], shaded(depth)], axis=1) for geom, depth in zip(geoms, depths)]
    return Image.fromarray(np.concatenate(parts))


def page(told):
    percent = lambda key: f"{100 * told[key]:.3f} %"
    return [
        "# A run of MuJoCo, beside MuJoCo's own renderer",
        "",
        f"`cargo xtask bench mujoco` on {told['processor']}: depth and segmentation of `examples/motion/simulation.toml` ({told['frames']} frames of",
        f"{told['size']}, in which a door opens, a drawer slides and three things fall) and of MuJoCo {told['mujoco']}, drawn by OpenGL with the camera and",
        "at the moment of each of our frames. *Away from edges* are the pixels whose neighbours all show the same geom in MuJoCo's picture:",
        "both sample a pixel at its centre, but OpenGL draws round shapes as polygons and rounds corners to its own grid.",
        "",
        "| pixels | the same geom | the same depth, to a thousandth |",
        "|---|---|---|",
        f"| all | {percent('same_geom')} | {percent('same_depth')} |",
        f"| away from edges ({percent('inner')}) | {percent('inner_same_geom')} | {percent('inner_same_depth')} |",
        "",
        f"Where both show the same geom away from edges, depths differ by {1000 * told['median_error_m']:.3f} mm in the median frame's median pixel, and by",
        f"{1000 * told['greatest_error_m']:.1f} mm at most. Depth is along the viewing axis, metres; MuJoCo's comes from a depth buffer of 24 or 32 bits.",
        "",
        "![geoms and depth in one frame, ours above MuJoCo's](mujoco.png)",
    ]


if __name__ == "__main__":
    main()
