"""Reads a BOP export of placed objects by BOP's rules, and evaluates its true poses with bop_toolkit where that is installed.

usage: bop_evaluation.py EXPORT

Without numpy or pillow it ends with 77 and one line. Without bop_toolkit_lib only the rules are checked, and the last line says so.
"""

import glob
import importlib.util
import json
import os
import sys

EXPORT = sys.argv[1] if len(sys.argv) > 1 else ""
missing = [name for name in ("numpy", "PIL") if importlib.util.find_spec(name) is None]
if missing:
    print(f"skipped: the Python lacks {', '.join(missing)}")
    sys.exit(77)

import numpy as np
from PIL import Image


def load(name):
    with open(f"{EXPORT}/{name}") as file:
        return json.load(file)


def picture(name):
    return np.asarray(Image.open(f"{EXPORT}/{name}"))


def ply(name):
    """Vertices, normals and triangles of a text PLY file."""
    with open(f"{EXPORT}/{name}") as file:
        lines = file.read().split("\n")
    end = lines.index("end_header")
    counts = {line.split()[1]: int(line.split()[2]) for line in lines[:end] if line.startswith("element")}
    vertices = np.array([line.split() for line in lines[end + 1 : end + 1 + counts["vertex"]]], float)
    faces = np.array([line.split() for line in lines[end + 1 + counts["vertex"] : end + 1 + sum(counts.values())]], int)
    return vertices[:, :3], vertices[:, 3:6], faces[:, 1:]


def render(vertices, faces, R, t, K, size):
    """Planar depth of a model at pixel centres at whole numbers, 0 where there is none: every triangle's plane where it covers the pixel."""
    width, height = size
    depth = np.zeros((height, width))
    points = vertices @ R.T + t.reshape(3)
    image = points @ K.T
    image = image[:, :2] / image[:, 2:]
    columns, rows = np.meshgrid(np.arange(width), np.arange(height))
    rays = np.stack([columns, rows, np.ones_like(rows)], -1) @ np.linalg.inv(K).T
    for face in faces[points[faces, 2].min(1) > 0]:
        a, b, c = image[face]
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        low = np.maximum(np.floor(image[face].min(0)), 0).astype(int)
        high = np.minimum(np.ceil(image[face].max(0)) + 1, size).astype(int)
        if abs(area) < 1e-12 or (high <= low).any():
            continue
        here = np.s_[low[1] : high[1], low[0] : high[0]]
        inside = np.ones_like(depth[here], bool)
        for p, q in ((a, b), (b, c), (c, a)):
            inside &= ((q[0] - p[0]) * (rows[here] - p[1]) - (q[1] - p[1]) * (columns[here] - p[0])) * np.sign(area) >= 0
        normal = np.cross(points[face[1]] - points[face[0]], points[face[2]] - points[face[0]])
        slope = rays[here] @ normal
        z = np.where(inside & (slope != 0), (normal @ points[face[0]]) / np.where(slope == 0, 1, slope), 0)
        depth[here] = np.where((z > 0) & ((depth[here] == 0) | (z < depth[here])), z, depth[here])
    return depth


class Renderer:
    """The renderer that bop_toolkit's VSD asks for."""

    def __init__(self, models, size):
        self.models, self.size = models, size

    def render_object(self, obj_id, R, t, fx, fy, cx, cy):
        vertices, _, faces = self.models[obj_id]
        return {"depth": render(vertices, faces, R, t, np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]]), self.size)}


def distance(points, vertices, faces):
    """Distance of each point from a surface: to the planes of triangles within them, and to their sides."""
    best = np.full(len(points), np.inf)
    for a, b, c in vertices[faces]:
        normal = np.cross(b - a, c - a)
        if np.linalg.norm(normal) == 0:
            continue
        normal /= np.linalg.norm(normal)
        height = (points - a) @ normal
        foot = points - height[:, None] * normal
        inside = np.ones(len(points), bool)
        for p, q in ((a, b), (b, c), (c, a)):
            inside &= np.cross(q - p, foot - p) @ normal >= 0
            along = np.clip(((points - p) @ (q - p)) / ((q - p) @ (q - p)), 0, 1)
            best = np.minimum(best, np.linalg.norm(points - p - along[:, None] * (q - p), axis=1))
        best = np.where(inside, np.minimum(best, np.abs(height)), best)
    return best


def check_models():
    infos, names = load("models/models_info.json"), load("objects.json")
    assert infos == load("models_eval/models_info.json") and infos.keys() == names.keys()
    keys = [(one["model"], one["scale"]) for one in (names[number] for number in sorted(names, key=int))]
    assert keys == sorted(set(keys)) and sorted(map(int, names)) == list(range(1, len(names) + 1))
    models = {}
    for number, info in infos.items():
        vertices, normals, faces = ply(f"models/obj_{int(number):06}.ply")
        fine, _, fine_faces = ply(f"models_eval/obj_{int(number):06}.ply")
        low = np.array([info[f"min_{axis}"] for axis in "xyz"])
        size = np.array([info[f"size_{axis}"] for axis in "xyz"])
        assert np.allclose(vertices.min(0), low, atol=1e-3) and np.allclose(np.ptp(vertices, axis=0), size, atol=1e-3)
        apart = np.linalg.norm(vertices[:, None] - vertices[None], axis=-1).max()
        assert abs(apart - info["diameter"]) < 1e-3 and np.allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-5)
        sides = np.linalg.norm(fine[fine_faces] - fine[np.roll(fine_faces, 1, axis=1)], axis=-1)
        assert sides.max() <= 0.05 * info["diameter"] + 1e-3 and distance(fine, vertices, faces).max() < 1e-2
        for turn in info.get("symmetries_discrete", []):
            turn = np.array(turn).reshape(4, 4)
            assert np.allclose(turn[:3, :3] @ turn[:3, :3].T, np.eye(3), atol=1e-6) and np.allclose(turn[3], [0, 0, 0, 1])
            assert distance(vertices @ turn[:3, :3].T + turn[:3, 3], vertices, faces).max() <= 0.02 * info["diameter"] + 1e-3
        models[int(number)] = (fine, None, fine_faces)
    return models, {int(number): info for number, info in infos.items()}


def check_images(models):
    """Poses put models where the depth pictures show them; masks, counts, boxes and COCO's entries say the same."""
    checked, targets = 0, {}
    for folder in sorted(glob.glob(f"{EXPORT}/*/??????")):
        name = os.path.relpath(folder, EXPORT)
        split, scene = os.path.split(name)
        cameras, truths, infos = (load(f"{name}/scene_{what}.json") for what in ("camera", "gt", "gt_info"))
        coco = load(f"{name}/scene_gt_coco.json")
        assert [one["id"] for one in coco["categories"]] == sorted(models)
        annotations = {}
        for one in coco["annotations"]:
            annotations.setdefault(one["image_id"], []).append(one)
        assert len({one["id"] for one in coco["annotations"]}) == len(coco["annotations"])
        for image in coco["images"]:
            frame = str(image["id"])
            color = picture(f"{name}/{image['file_name']}")
            assert color.shape == (image["height"], image["width"], 3)
            assert image["file_name"].endswith(".jpg" if split == "train_pbr" else ".png")
            K = np.array(cameras[frame]["cam_K"]).reshape(3, 3)
            depth = picture(f"{name}/depth/{int(frame):06}.png") * cameras[frame]["depth_scale"]
            entries = annotations.get(image["id"], [])
            assert len(truths[frame]) == len(infos[frame]) == len(entries)
            for index, (truth, info, entry) in enumerate(zip(truths[frame], infos[frame], entries)):
                visible, whole = (picture(f"{name}/{kind}/{int(frame):06}_{index:06}.png") > 0 for kind in ("mask_visib", "mask"))
                R, t = np.array(truth["cam_R_m2c"]).reshape(3, 3), np.array(truth["cam_t_m2c"])
                vertices, _, faces = models[truth["obj_id"]]
                drawn = render(vertices, faces, R, t, K, (image["width"], image["height"]))
                # Silhouettes may differ where a side passes through a pixel's centre.
                assert (visible & (drawn == 0)).sum() <= 2 and visible.sum() == info["px_count_visib"]
                both = visible & (drawn > 0)
                assert np.abs(drawn - depth)[both].max() <= 1.5, np.abs(drawn - depth)[both].max()
                mask = np.zeros(visible.size, bool)
                ends = np.cumsum(entry["segmentation"]["counts"])
                for begin, end in zip(ends[0::2], ends[1::2]):
                    mask[begin:end] = True
                assert np.array_equal(mask.reshape(entry["segmentation"]["size"], order="F"), visible)
                rows, columns = np.nonzero(whole)
                box = [columns.min(), rows.min(), np.ptp(columns) + 1, np.ptp(rows) + 1]
                assert entry["bbox"] == box and entry["area"] == visible.sum() and entry["category_id"] == truth["obj_id"]
                assert entry["ignore"] == (info["visib_fract"] < 0.1)
                if info["visib_fract"] >= 0.1:
                    key = (int(scene), int(frame), truth["obj_id"])
                    targets.setdefault(split, {}).setdefault(key, 0)
                    targets[split][key] += 1
                checked += 1
    for split, expected in targets.items():
        listed = load(f"{split}_targets_bop19.json")
        assert {(one["scene_id"], one["im_id"], one["obj_id"]): one["inst_count"] for one in listed} == expected
    assert checked > 0
    return checked, sorted(targets)


def valid_poses(scene, image, truths, info, wanted):
    """As `eval_calc_scores.py`: of every object the most visible poses, as many as are to be found."""
    left = {one["obj_id"]: one["inst_count"] for one in wanted if (one["scene_id"], one["im_id"]) == (scene, image)}
    valid = [False] * len(truths)
    for index in sorted(range(len(truths)), key=lambda index: -info[index]["visib_fract"]):
        number = truths[index]["obj_id"]
        if left.get(number, 0) > 0:
            valid[index], left[number] = True, left[number] - 1
    return valid


def recall(split, models, infos, estimate):
    """bop_toolkit's average recalls of VSD, MSSD, MSPD, and the recall of ADD at a tenth of the diameter, of poses made from true ones."""
    from bop_toolkit_lib import inout, misc, pose_error, pose_matching, score

    wanted = inout.load_json(f"{EXPORT}/{split}_targets_bop19.json")
    symmetries = {number: misc.get_symmetry_transformations(info, 0.01) for number, info in infos.items()}
    points = {number: inout.load_ply(f"{EXPORT}/models_eval/obj_{number:06}.ply")["pts"] for number in infos}
    taus = list(np.arange(0.05, 0.51, 0.05))
    scene_ids = sorted({one["scene_id"] for one in wanted})
    errors = {kind: {scene: [] for scene in scene_ids} for kind in [("vsd", k) for k in range(len(taus))] + ["mssd", "mspd", "add"]}
    truths, size = {}, None
    for scene in scene_ids:
        folder = f"{EXPORT}/{split}/{scene:06}"
        truths[scene] = inout.load_scene_gt(f"{folder}/scene_gt.json")
        info = inout.load_json(f"{folder}/scene_gt_info.json", keys_to_int=True)
        cameras = inout.load_scene_camera(f"{folder}/scene_camera.json")
        for target in (one for one in wanted if one["scene_id"] == scene):
            image, number = target["im_id"], target["obj_id"]
            K = cameras[image]["cam_K"]
            depth = inout.load_depth(f"{folder}/depth/{image:06}.png") * cameras[image]["depth_scale"]
            size = (depth.shape[1], depth.shape[0])
            renderer, diameter = Renderer(models, size), infos[number]["diameter"]
            same = [(index, gt) for index, gt in enumerate(truths[scene][image]) if gt["obj_id"] == number]
            # The best of them are asked for, as many as are visible.
            best = sorted(same, key=lambda one: -info[image][one[0]]["visib_fract"])[: target["inst_count"]]
            for index, gt in best:
                R, t = estimate(gt["cam_R_m2c"], gt["cam_t_m2c"], infos[number])
                found = {kind: {} for kind in errors}
                for other, true in same:
                    Rg, tg = true["cam_R_m2c"], true["cam_t_m2c"]
                    vsd = pose_error.vsd(R, t, Rg, tg, depth, K, 15, taus, True, diameter, renderer, number, "step")
                    for k, e in enumerate(vsd):
                        found["vsd", k][other] = [e]
                    found["mssd"][other] = [pose_error.mssd(R, t, Rg, tg, points[number], symmetries[number]) / diameter]
                    found["mspd"][other] = [pose_error.mspd(R, t, Rg, tg, K, points[number], symmetries[number])]
                    found["add"][other] = [pose_error.add(R, t, Rg, tg, points[number]) / diameter]
                for kind, e in found.items():
                    visible = {other: info[image][other]["visib_fract"] for other in e}
                    errors[kind][scene].append(
                        {"im_id": image, "obj_id": number, "est_id": index, "score": 1.0, "errors": e, "gt_visib_fracts": visible}
                    )

    def recalled(kind, threshold):
        matches = []
        for scene in scene_ids:
            info = inout.load_json(f"{EXPORT}/{split}/{scene:06}/scene_gt_info.json", keys_to_int=True)
            images = sorted({one["im_id"] for one in wanted if one["scene_id"] == scene})
            valid = {image: valid_poses(scene, image, truths[scene][image], info[image], wanted) for image in images}
            entries = {image: truths[scene][image] for image in images}
            matches += pose_matching.match_poses_scene(scene, entries, info, valid, errors[kind][scene], [threshold], 0)
        return score.calc_localization_scores(scene_ids, sorted(infos), matches, -1, do_print=False)["recall"]

    shares = np.arange(0.05, 0.51, 0.05)
    pixels = np.arange(5, 51, 5) * size[0] / 640
    return {
        "vsd": np.mean([recalled(("vsd", k), share) for k in range(len(taus)) for share in shares]),
        "mssd": np.mean([recalled("mssd", share) for share in shares]),
        "mspd": np.mean([recalled("mspd", pixel) for pixel in pixels]),
        "add": recalled("add", 0.1),
    }


def evaluate(splits, models, infos):
    said = []
    for split in splits:
        true = recall(split, models, infos, lambda R, t, info: (R, t))
        assert all(value == 1.0 for value in true.values()), (split, true)

        def turned(R, t, info):
            turn = np.array(info["symmetries_discrete"][-1]).reshape(4, 4)
            return R @ turn[:3, :3], R @ turn[:3, 3:] + t

        if all(info.get("symmetries_discrete") for info in infos.values()):
            # The surface is the same; ADD alone knows no symmetries.
            equivalent = recall(split, models, infos, turned)
            assert equivalent["mssd"] == equivalent["mspd"] == 1.0 and equivalent["vsd"] > 0.98 and equivalent["add"] == 0, equivalent
        off = recall(split, models, infos, lambda R, t, info: (R, t + np.array([[0.6 * info["diameter"]], [0], [0]])))
        assert off["mssd"] == off["add"] == 0 and off["vsd"] < 0.5, off
        said.append(f"{split}: AR of the true poses " + ", ".join(f"{kind} {value:.3f}" for kind, value in true.items()))
    return "; ".join(said)


def main():
    models, infos = check_models()
    checked, splits = check_images(models)
    print(f"{len(models)} objects, {checked} poses, splits {', '.join(splits)}")
    if importlib.util.find_spec("bop_toolkit_lib") is None:
        print("bop_toolkit skipped: the Python has no bop_toolkit_lib")
        return
    print(evaluate(splits, models, infos))


main()
