"""BOP's folders as bop_toolkit reads them, and whether models and poses agree with what they say of the pictures."""

import numpy as np
from bop_toolkit_lib import inout, misc

# Targets of which less is visible do not count, as in BOP's challenge.
VISIBLE = 0.1
# Pixels by which a side of a box may differ: corners of pixels and their middles, and boxes with and without their last pixel.
SLACK = 2


def read(folder):
    """Pictures, targets that are visible, boxes that were compared, their sides beyond `SLACK`, and the median difference of sides in pixels."""
    images, visible, differences = 0, 0, []
    models = {int(path.stem[4:]): inout.load_ply(str(path))["pts"] for path in sorted((folder / "models").glob("obj_*.ply"))}
    for scene in scenes(folder):
        cameras = inout.load_scene_camera(str(scene / "scene_camera.json"))
        truth = inout.load_scene_gt(str(scene / "scene_gt.json"))
        told = inout.load_json(str(scene / "scene_gt_info.json"), keys_to_int=True)
        for image, camera in cameras.items():
            images += 1
            depth = inout.load_depth(str(scene / "depth" / f"{image:06d}.png"))
            for target, facts in zip(truth[image], told[image], strict=True):
                if facts["visib_fract"] >= VISIBLE:
                    visible += 1
                    differences += compared(models[target["obj_id"]], camera["cam_K"], target, facts["bbox_obj"], depth.shape)
    sides = np.array(differences)
    return dict(images=images, visible=visible, boxes=len(sides), beyond=int((sides > SLACK).sum()), median_px=float(np.median(sides)))


def compared(points, k, target, box, shape):
    """Differences of the four sides of a target's box, in a list; an empty one where the box reaches the end of what is known."""
    corners = misc.project_pts(points, k, target["cam_R_m2c"], target["cam_t_m2c"])
    found = np.array([*corners.min(axis=0), *corners.max(axis=0)])
    limits = np.array([shape[1], shape[0]])
    if (found[:2] < -limits + SLACK).any() or (found[2:] > 2 * limits - SLACK).any():
        return []
    return [np.abs(found - [box[0], box[1], box[0] + box[2], box[1] + box[3]])]


def scenes(folder):
    return sorted(path.parent for path in folder.glob("*/*/scene_gt.json"))


def pictures(folder, count):
    """Colour pictures of a folder, evenly spread over all."""
    paths = sorted(path for scene in scenes(folder) for path in (scene / "rgb").iterdir())
    return [inout.load_im(str(path))[..., :3] for path in paths[len(paths) // (2 * count) :: len(paths) // count][:count]]
