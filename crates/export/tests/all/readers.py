"""Reads an export with the format's own library, or by its rules where the library is heavy, and compares it with the dataset.

usage: readers.py FORMAT DATASET EXPORT

The dataset is read with h5py alone. Ends with 77 and one line when a library is missing.
"""

import csv
import glob
import importlib.util
import json
import os
import struct
import sys

import numpy as np

DATASET = sys.argv[2] if len(sys.argv) > 2 else ""
EXPORT = sys.argv[3] if len(sys.argv) > 3 else ""
FLIP = np.diag([1.0, -1.0, -1.0])


def array(path):
    import h5py

    with h5py.File(path) as file:
        return file["dataset"][()]


def scenes_dir():
    nested = os.path.join(DATASET, "scenes")
    return nested if os.path.isdir(nested) else DATASET


def layer(scene, camera, frame, name):
    for folder in ("final", "geometry"):
        path = f"{scenes_dir()}/{scene}/images/scene_{camera}_{folder}_hdf5/frame.{frame:04}.{name}.hdf5"
        if os.path.exists(path):
            return array(path)
    return None


def metres(scene):
    """Length of a scene's unit: the scene's own file says it, or, for what Apple released, the table of all cameras."""
    own, released = f"{scenes_dir()}/{scene}/_detail/metadata_scene.csv", f"{DATASET}/metadata_camera_parameters.csv"
    if os.path.exists(own):
        with open(own) as file:
            return float(dict(csv.reader(file))["meters_per_asset_unit"])
    if os.path.exists(released):
        with open(released) as file:
            rows = {row["scene_name"]: row for row in csv.DictReader(file)}
        return float(rows[scene]["settings_units_info_meters_scale"])
    return 1.0


def pose(scene, camera, frame):
    """Camera centre in metres and world_from_camera with y up and z backward."""
    folder = f"{scenes_dir()}/{scene}/_detail/{camera}"
    positions, rotations = (array(f"{folder}/camera_keyframe_{what}.hdf5") for what in ("positions", "orientations"))
    indices = f"{folder}/camera_keyframe_frame_indices.hdf5"
    row = list(array(indices)).index(frame) if os.path.exists(indices) else frame
    return positions[row] * metres(scene), rotations[row]


def picture(path):
    from PIL import Image

    return np.asarray(Image.open(path))


def record():
    with open(f"{EXPORT}/enfilade_export.json") as file:
        frames = json.load(file)["frames"]
    return [(scene, camera, frame) for scene in frames for camera in frames[scene] for frame in frames[scene][camera]]


def matrix(path):
    return np.loadtxt(path)


def check_points(scene, camera, frame, depth_mm, K, world_from_opencv, corner=0.0):
    """Points of a depth picture are those of the layer position, within the rounding to millimetres."""
    depth = depth_mm / 1000.0
    rows, columns = np.indices(depth.shape)
    x = (columns + corner - K[0, 2] - K[0, 1] * (rows + corner - K[1, 2]) / K[1, 1]) / K[0, 0]
    y = (rows + corner - K[1, 2]) / K[1, 1]
    points = np.stack([x * depth, y * depth, depth], -1) @ world_from_opencv[:3, :3].T + world_from_opencv[:3, 3]
    position = layer(scene, camera, frame, "position")
    if position is None:
        # Hypersim's depth_meters is the distance along the ray.
        origin, _ = pose(scene, camera, frame)
        found = np.linalg.norm(points - origin, axis=-1)
        expected = layer(scene, camera, frame, "depth_meters").astype(float)
        slant = np.sqrt(1 + x * x + y * y)
        seen = depth_mm > 0
        assert np.all(np.abs(found - expected)[seen] <= 0.00051 * slant[seen] + 1e-3 * expected[seen])
        assert seen.mean() > 0.5
        return
    seen = depth_mm > 0
    assert np.array_equal(seen, np.isfinite(position).all(-1)), "0 stands where nothing was hit and nowhere else"
    error = np.linalg.norm(points - position * metres(scene), axis=-1)[seen]
    bound = (0.00051 * np.sqrt(1 + x * x + y * y))[seen]
    assert np.all(error <= bound), f"{error.max()} m"


def check_planar(name, z, scene, camera, frame):
    """Apple released no planar depth: it is computed on the way, and lies before the distance along the ray."""
    distance = layer(scene, camera, frame, "depth_meters").astype(float)
    assert name == "depth_z_meters" and z.dtype == np.float32, name
    seen = np.isfinite(distance)
    assert np.array_equal(seen, np.isfinite(z)) and np.all(z[seen] > 0) and np.all(z[seen] <= distance[seen] * (1 + 1e-3))


def coco():
    from pycocotools import mask
    from pycocotools.coco import COCO

    truth = COCO(f"{EXPORT}/annotations/instances.json")
    assert sorted(truth.getCatIds()) == list(range(1, 41)) and len(truth.getImgIds()) == len(record())
    masks = 0
    for image in truth.loadImgs(truth.getImgIds()):
        at = (image["scene"], image["camera"], image["frame"])
        instances, semantic = layer(*at, "semantic_instance"), layer(*at, "semantic")
        assert picture(f"{EXPORT}/images/{image['file_name']}").shape == (image["height"], image["width"], 3)
        found = set()
        for annotation in truth.loadAnns(truth.getAnnIds(imgIds=image["id"])):
            decoded = truth.annToMask(annotation).astype(bool)
            assert np.array_equal(decoded, instances == annotation["instance"])
            assert annotation["area"] == decoded.sum() == mask.area(annotation["segmentation"])
            assert list(mask.toBbox(annotation["segmentation"])) == annotation["bbox"]
            assert annotation["category_id"] in semantic[decoded] and annotation["iscrowd"] == 0
            found.add(annotation["instance"])
            masks += 1
        assert found == set(np.unique(instances[(instances > 0) & (semantic > 0)]))
    return f"{masks} masks"


def panoptic():
    """The rules of panopticapi: its evaluation refuses a PNG and a JSON file that do not name the same segments."""
    with open(f"{EXPORT}/annotations/panoptic.json") as file:
        truth = json.load(file)
    things = {category["id"]: category["isthing"] for category in truth["categories"]}
    assert sorted(things) == list(range(1, 41)) and [one for one in things if not things[one]] == [1, 2, 22]
    assert len(truth["images"]) == len(truth["annotations"]) == len(record())
    images = {image["id"]: image for image in truth["images"]}
    numbers, segments = {}, 0
    for annotation in truth["annotations"]:
        image = images[annotation["image_id"]]
        at = (image["scene"], image["camera"], image["frame"])
        instances, semantic = layer(*at, "semantic_instance"), layer(*at, "semantic")
        assert annotation["file_name"] == image["file_name"].replace(".jpg", ".png")
        ids = picture(f"{EXPORT}/annotations/panoptic/{annotation['file_name']}").astype(np.uint32) @ np.array([1, 256, 65536], np.uint32)
        assert picture(f"{EXPORT}/images/{image['file_name']}").shape[:2] == ids.shape == semantic.shape
        found = {segment["id"]: segment for segment in annotation["segments_info"]}
        assert set(np.unique(ids)) - {0} == set(found) and len(found) == len(annotation["segments_info"])
        assert np.array_equal(ids == 0, (semantic <= 0) & (instances <= 0))
        for number, segment in found.items():
            rows, columns = np.nonzero(ids == number)
            left, top = columns.min(), rows.min()
            assert segment["bbox"] == [left, top, columns.max() - left + 1, rows.max() - top + 1] and segment["area"] == len(rows)
            assert segment["category_id"] in semantic[ids == number]
            if things[segment["category_id"]] and not segment["iscrowd"]:
                assert np.array_equal(ids == number, instances == segment["instance"])
            else:
                assert np.all(semantic[ids == number] == segment["category_id"]) and "instance" not in segment
            what = (at[0], segment["category_id"], segment["iscrowd"], segment.get("instance"))
            assert numbers.setdefault((at[0], number), what) == what, "a segment has one number in all frames of a scene"
        segments += len(found)
    if importlib.util.find_spec("panopticapi"):
        # Its own evaluation of the truth by itself, which finds the PNG files beside the JSON file.
        from panopticapi.evaluation import pq_compute

        scores = pq_compute(f"{EXPORT}/annotations/panoptic.json", f"{EXPORT}/annotations/panoptic.json")
        assert scores["All"]["pq"] == 1.0, scores
    return f"{segments} segments"


def colmap_folder():
    return [os.path.dirname(path) for path in sorted(glob.glob(f"{EXPORT}/*/sparse/0/cameras.*"))]


def colmap():
    import pycolmap

    points, sightings = 0, 0
    for folder in colmap_folder():
        model = pycolmap.Reconstruction(folder)
        scene = os.path.basename(os.path.dirname(os.path.dirname(folder)))
        assert model.num_images() == sum(at[0] == scene for at in record())
        for image in model.images.values():
            camera, number = image.name.removesuffix(".png").rsplit("_", 1)
            origin, rotation = pose(scene, camera, int(number))
            found = image.cam_from_world() if callable(image.cam_from_world) else image.cam_from_world
            assert np.allclose(found.rotation.matrix(), (rotation @ FLIP).T, atol=1e-9)
            assert np.allclose(found.inverse().translation, origin, atol=1e-9)
            lens = model.cameras[image.camera_id]
            assert picture(f"{folder}/../../images/{image.name}").shape == (lens.height, lens.width, 3)
            for point in image.points2D:
                at = lens.img_from_cam(found * model.points3D[point.point3D_id].xyz)
                assert np.linalg.norm(at - point.xy) < 1e-3
        points += model.num_points3D()
        sightings += model.compute_num_observations()
        assert model.num_points3D() > 0 and model.compute_mean_track_length() >= 1
    return f"{points} points seen {sightings} times"


def nerfstudio():
    frames = 0
    for path in sorted(glob.glob(f"{EXPORT}/*/transforms.json")):
        folder = os.path.dirname(path)
        scene = os.path.basename(folder)
        with open(path) as file:
            meta = json.load(file)
        assert meta["camera_model"] in ("OPENCV", "OPENCV_FISHEYE")
        for frame in meta["frames"]:
            camera, number = frame["file_path"].split("/")[1], int(frame["file_path"].split(".")[1])
            assert picture(f"{folder}/{frame['file_path']}").shape == (frame["h"], frame["w"], 3)
            origin, rotation = pose(scene, camera, number)
            to_world = np.array(frame["transform_matrix"])
            assert np.allclose(to_world[:3, :3], rotation, atol=1e-12) and np.allclose(to_world[:3, 3], origin, atol=1e-12)
            if all(frame[k] == 0 for k in ("k1", "k2", "k3", "k4", "p1", "p2")) and meta["camera_model"] == "OPENCV":
                K = np.array([[frame["fl_x"], 0, frame["cx"]], [0, frame["fl_y"], frame["cy"]], [0, 0, 1]])
                to_world[:3, :3] = to_world[:3, :3] @ FLIP
                check_points(scene, camera, number, picture(f"{folder}/{frame['depth_file_path']}"), K, to_world, corner=0.5)
            frames += 1
        with open(f"{folder}/{meta['ply_file_path']}", "rb") as file:
            header, body = file.read().split(b"end_header\n", 1)
        count = int(header.split(b"element vertex ")[1].split()[0])
        assert count > 0 and len(body) == 15 * count
    assert frames == len(record())
    return f"{frames} frames"


def scannet():
    for scene, camera, frame in record():
        folder = f"{EXPORT}/scans/{scene}_{camera}"
        K = matrix(f"{folder}/intrinsic/intrinsic_depth.txt")
        to_world = matrix(f"{folder}/pose/{frame}.txt")
        depth = picture(f"{folder}/depth/{frame}.png")
        assert depth.dtype == np.uint16 or depth.dtype == np.int32
        check_points(scene, camera, frame, depth, K, to_world)
        classes = layer(scene, camera, frame, "semantic")
        if classes is not None:
            # As BenchmarkScripts/2d_helpers converts label images: by the columns `id` and `nyu40id`.
            nyu40 = np.zeros(1 << 16, int)
            for raw, number in scannet_table("id", "nyu40id"):
                nyu40[int(raw)] = int(number)
            assert np.array_equal(nyu40[picture(f"{folder}/label-filt/{frame}.png")], np.maximum(classes, 0))
        instances = layer(scene, camera, frame, "semantic_instance")
        assert instances is None or np.array_equal(picture(f"{folder}/instance-filt/{frame}.png"), np.maximum(instances, 0))
        if layer(scene, camera, frame, "color") is not None:
            assert picture(f"{folder}/color/{frame}.jpg").shape == (*depth.shape, 3)
    meshes = sum(scannet_mesh(scene, camera) for scene, camera in {(scene, camera) for scene, camera, _ in record()})
    return f"{len(record())} frames, {meshes} meshes"


def scannet_table(*columns):
    with open(f"{EXPORT}/scannetv2-labels.combined.tsv") as file:
        return [[row[column] for column in columns] for row in csv.DictReader(file, delimiter="\t")]


def scannet_mesh(scene, camera):
    """By the rules of ScanNet's own scripts: groups of segments, and the table, say what the surface is that frames show there."""
    scan = f"{EXPORT}/scans/{scene}_{camera}/{scene}_{camera}"
    if not os.path.exists(f"{scan}_vh_clean_2.ply"):
        return 0
    with open(f"{scan}_vh_clean_2.ply", "rb") as file:
        header, body = file.read().split(b"end_header\n", 1)
    vertices = int(header.split(b"element vertex ")[1].split(b"\n")[0])
    kind = np.dtype([("at", "<f4", 3), ("rgba", "u1", 4)])
    positions = np.frombuffer(body, kind, vertices)["at"].astype(float)
    with open(f"{scan}_vh_clean_2.0.010000.segs.json") as file:
        segments = np.array(json.load(file)["segIndices"])
    with open(f"{scan}.aggregation.json") as file:
        groups = json.load(file)["segGroups"]
    number = {word: int(nyu40) for word, nyu40 in scannet_table("raw_category", "nyu40id")}
    assert len(segments) == vertices
    labels, instances = np.zeros(vertices, int), np.full(vertices, -1)
    for group in groups:
        inside = np.isin(segments, group["segments"])
        labels[inside], instances[inside] = number[group["label"]], group.get("instance", -1)
    for frame in [at[2] for at in record() if at[:2] == (scene, camera)]:
        seen, semantic, numbers = (layer(scene, camera, frame, name) for name in ("position", "semantic", "semantic_instance"))
        seen = seen * metres(scene)
        # The planes of the tests' frames go on where their mesh ends.
        inside = np.all((seen >= positions.min(axis=0) - 0.001) & (seen <= positions.max(axis=0) + 0.001), axis=-1)
        labelled = inside & (semantic > 0)
        for label, instance in set(zip(semantic[labelled].tolist(), numbers[labelled].tolist())):
            pixels = seen[(semantic == label) & (numbers == instance) & labelled][::7]
            of_it = positions[(labels == label) & (instances == instance)]
            # Within a triangle whose sides are 5 cm no point is further from a corner than 5 cm / sqrt(3).
            assert all(np.linalg.norm(of_it - pixel, axis=1).min() < 0.0295 for pixel in pixels), (label, instance)
    return 1


def rotation(qx, qy, qz, qw):
    """Of a unit quaternion, as the TUM benchmark's own tools have it."""
    return np.array(
        [
            [1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy - qz * qw), 2 * (qx * qz + qy * qw)],
            [2 * (qx * qy + qz * qw), 1 - 2 * (qx * qx + qz * qz), 2 * (qy * qz - qx * qw)],
            [2 * (qx * qz - qy * qw), 2 * (qy * qz + qx * qw), 1 - 2 * (qx * qx + qy * qy)],
        ]
    )


def tum():
    for scene, camera in {(scene, camera) for scene, camera, _ in record()}:
        folder = f"{EXPORT}/{scene}_{camera}"
        frames = [frame for *of, frame in record() if of == [scene, camera]]
        truth = np.atleast_2d(np.loadtxt(f"{folder}/groundtruth.txt"))
        fx, fy, cx, cy, width, height, scale = np.loadtxt(f"{folder}/calibration.txt")
        K = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])
        lists = [np.atleast_2d(np.loadtxt(f"{folder}/{name}.txt", dtype=str)) for name in ("rgb", "depth")]
        assert np.array_equal(lists[0][:, 0], lists[1][:, 0]) and len(truth) == len(frames) == len(lists[0])
        for row, rgb, depth, frame in zip(truth, lists[0][:, 1], lists[1][:, 1], frames):
            to_world = np.eye(4)
            to_world[:3, :3], to_world[:3, 3] = rotation(*row[4:]), row[1:4]
            stored = picture(f"{folder}/{depth}")
            assert stored.shape == (height, width) and picture(f"{folder}/{rgb}").shape == (height, width, 3)
            check_points(scene, camera, frame, stored * (1000 / scale), K, to_world)
    return f"{len(record())} frames"


def euroc():
    """Poses and intrinsics at the times of the pictures put depth where the dataset has it; measurements have the times of the truth."""
    for scene, camera in {(scene, camera) for scene, camera, _ in record()}:
        mav = f"{EXPORT}/{scene}_{camera}/mav0"
        frames = [frame for *of, frame in record() if of == [scene, camera]]
        listed = np.atleast_2d(np.loadtxt(f"{mav}/cam0/data.csv", delimiter=",", dtype=str))
        truth, measured = (np.atleast_2d(np.loadtxt(f"{mav}/{name}/data.csv", delimiter=",")) for name in ("state_groundtruth_estimate0", "imu0"))
        assert np.array_equal(truth[:, 0], measured[:, 0]) and len(listed) == len(frames)
        with open(f"{mav}/cam0/sensor.yaml") as file:
            sensor = dict(line.strip().split(": ", 1) for line in file if ": " in line)
        fx, fy, cx, cy = json.loads(sensor["intrinsics"])
        width, height = json.loads(sensor["resolution"])
        body_from_camera = np.array(json.loads(sensor["data"])).reshape(4, 4)
        for (time, name), frame in zip(listed, frames):
            (_, x, y, z, qw, qx, qy, qz, *_), = truth[truth[:, 0] == int(time)]
            world_from_body = np.eye(4)
            world_from_body[:3, :3], world_from_body[:3, 3] = rotation(qx, qy, qz, qw), (x, y, z)
            assert picture(f"{mav}/cam0/data/{name}").shape == (height, width)
            to_world = world_from_body @ body_from_camera
            # Along the axis of the pictures, which is another one where the image plane is tilted.
            position = layer(scene, camera, frame, "position").astype(float)
            ahead = (position - to_world[:3, 3]) @ to_world[:3, 2]
            K = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])
            check_points(scene, camera, frame, np.nan_to_num(ahead * 1000), K, to_world)
    return f"{len(record())} frames"


def replica():
    for scene, camera in {(scene, camera) for scene, camera, _ in record()}:
        folder = f"{EXPORT}/{scene}_{camera}"
        with open(f"{folder}/cam_params.json") as file:
            model = json.load(file)["camera"]
        K = np.array([[model["fx"], 0, model["cx"]], [0, model["fy"], model["cy"]], [0, 0, 1]])
        poses = np.loadtxt(f"{folder}/traj.txt").reshape(-1, 4, 4)
        frames = [frame for *of, frame in record() if of == [scene, camera]]
        assert len(poses) == len(frames)
        for number, (to_world, frame) in enumerate(zip(poses, frames)):
            stored = picture(f"{folder}/results/depth{number:06}.png")
            assert picture(f"{folder}/results/frame{number:06}.jpg").shape == (model["h"], model["w"], 3)
            check_points(scene, camera, frame, stored * (1000 / model["scale"]), K, to_world)
    return f"{len(record())} frames"


def wai():
    """The rules of MapAnything's loaders: files are where scene_meta.json says, and the matrix begins at byte 128."""
    import OpenEXR

    seen = []
    for scene in sorted({scene for scene, *_ in record()}):
        with open(f"{EXPORT}/{scene}/scene_meta.json") as file:
            meta = json.load(file)
        assert meta["scene_name"] == scene and meta["camera_convention"] == "opencv" and meta["camera_model"] == "PINHOLE"
        for entry in meta["frames"]:
            camera, number = entry["frame_name"].rsplit("_", 1)
            stored = OpenEXR.File(f"{EXPORT}/{scene}/{entry['depth']}", separate_channels=True).channels()
            assert list(stored) == ["Y"] and stored["Y"].pixels.dtype == np.float32
            check_opencv(f"{EXPORT}/{scene}/{entry['depth']}", stored["Y"].pixels)
            assert picture(f"{EXPORT}/{scene}/{entry['image']}").shape == (entry["h"], entry["w"], 3) and entry["file_path"] == entry["image"]
            K = np.array([[entry["fl_x"], 0, entry["cx"]], [0, entry["fl_y"], entry["cy"]], [0, 0, 1]])
            check_points(scene, camera, int(number), stored["Y"].pixels * 1000.0, K, np.array(entry["transform_matrix"]))
            seen.append((scene, camera, int(number)))
        if "pairwise_covisibility" in meta["scene_modalities"]:
            path = f"{EXPORT}/{scene}/{meta['scene_modalities']['pairwise_covisibility']['scene_key']}"
            shape = tuple(map(int, path.split("--")[1].removesuffix(".npy").split("x")))
            shares = np.memmap(path, np.float32, "r", 128, shape)
            assert shape == 2 * (len(meta["frames"]),) and np.allclose(np.diag(shares), 1)
    assert sorted(seen) == sorted(record())
    return f"{len(seen)} frames"


def check_opencv(path, expected):
    """OpenCV reads it too, where it is there and still reads OpenEXR: as docs/export.md says, below version 5."""
    os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
    try:
        import cv2
    except ImportError:
        return
    if int(cv2.__version__.split(".")[0]) < 5:
        assert np.array_equal(cv2.imread(path, cv2.IMREAD_UNCHANGED), expected)


def dust3r():
    """The rules of DUSt3R's class ScanNetpp: everything is in all_metadata.npz, depth is in millimetres."""
    with np.load(f"{EXPORT}/all_metadata.npz") as data:
        scenes, sceneids, images, pairs = (data[key] for key in ("scenes", "sceneids", "images", "pairs"))
        intrinsics, trajectories = data["intrinsics"].astype(np.float32), data["trajectories"].astype(np.float32)
    seen = []
    for sceneid, image, K, pose in zip(sceneids, images, intrinsics, trajectories):
        scene, (camera, number) = str(scenes[sceneid]), image.rsplit("_", 1)
        depth = picture(f"{EXPORT}/{scene}/depth/{image}.png")
        assert depth.dtype == np.uint16 or depth.dtype == np.int32, depth.dtype
        assert picture(f"{EXPORT}/{scene}/images/{image}.jpg").shape == (*depth.shape, 3)
        check_points(scene, camera, int(number), depth, K, pose)
        seen.append((scene, camera, int(number)))
    assert sorted(seen) == sorted(record())
    assert len(pairs) and all(sceneids[first] == sceneids[second] and first != second for first, second in pairs[:, :2].astype(int))
    return f"{len(seen)} frames, {len(pairs)} pairs"


def marigold():
    """By the rules of its `HypersimDepthDataset`: a list of a side, names from the side's folder on, depth / 1000."""
    found = []
    for side in ("train", "val", "test"):
        if not os.path.isdir(f"{EXPORT}/{side}"):
            continue
        with open(f"{EXPORT}/{side}/filename_list_{side}.txt") as file:
            lines = [line.split() for line in file.readlines()]
        for rgb, depth in lines:
            scene, name = rgb.split("/")
            camera, frame = name.removeprefix("rgb_").removesuffix(".png").rsplit("_fr", 1)
            assert depth == f"{scene}/depth_plane_{camera}_fr{frame}.png"
            found.append((scene, camera, int(frame)))
            colour, metres_z = picture(f"{EXPORT}/{side}/{rgb}"), picture(f"{EXPORT}/{side}/{depth}") / 1000.0
            distance, z = (layer(*found[-1], name) for name in ("depth_meters", "depth_z_meters"))
            seen = np.isfinite(distance)
            assert colour.shape == (*distance.shape, 3) and colour.dtype == np.uint8
            assert np.array_equal(metres_z > 0, seen) and np.all(metres_z[seen] <= distance[seen] * (1 + 1e-3) + 0.0006)
            if z is not None:
                assert np.all(np.abs(metres_z - z)[seen] <= 0.00051)
    assert sorted(found) == sorted(record())
    return f"{len(found)} frames"


def moge():
    """By the rules of its `read_depth` and of its loader of training data."""
    from PIL import Image

    with open(f"{EXPORT}/.index.txt") as file:
        names = file.read().splitlines()
    found = []
    for name in names:
        scene, stem = name.split("/")
        camera, frame = stem.rsplit("_", 1)
        found.append((scene, camera, int(frame)))
        with open(f"{EXPORT}/{name}/meta.json") as file:
            K = np.array(json.load(file)["intrinsics"])
        image, png = picture(f"{EXPORT}/{name}/image.jpg"), Image.open(f"{EXPORT}/{name}/depth.png")
        near, far, values = float(png.info["near"]), float(png.info["far"]), np.array(png)
        depth = (values.astype(np.float32) - 1) / 65533
        depth = near ** (1 - depth) * far**depth
        assert image.shape[:2] == values.shape and np.array_equal(values == 65535, layer(*found[-1], "render_entity_id") == -1)
        depth[(values == 0) | (values == 65535)] = 0
        K = np.diag([values.shape[1], values.shape[0], 1.0]) @ K
        origin, rotation = pose(*found[-1])
        world_from_opencv = np.eye(4)
        world_from_opencv[:3, :3], world_from_opencv[:3, 3] = rotation @ FLIP, origin
        check_points(*found[-1], depth * 1000.0, K, world_from_opencv, corner=0.5)
    assert sorted(found) == sorted(record())
    return f"{len(names)} frames"


def points():
    """Points lie on the surface of some pixel, with its labels, and no two in one cube."""
    total = 0
    for scene in {at[0] for at in record()}:
        with open(f"{EXPORT}/{scene}.ply", "rb") as file:
            lines = []
            while not lines or lines[-1] != "end_header":
                lines.append(file.readline().decode().strip())
            kinds = {"float": "<f4", "uchar": "u1", "short": "<i2"}
            fields = [(name, kinds[kind]) for _, kind, name in (line.split() for line in lines if line.startswith("property"))]
            cloud = np.frombuffer(file.read(), np.dtype(fields))
        assert f"element vertex {len(cloud)}" in lines and len(cloud) > 0
        places = np.stack([cloud[axis] for axis in "xyz"], -1)
        known = {}
        for at in record():
            if at[0] == scene and layer(*at, "position") is not None:
                shown = [layer(*at, name) for name in ("position", "semantic", "semantic_instance", "render_entity_id")]
                seen = np.isfinite(shown[0]).all(-1)
                labels = np.stack([part[seen] for part in shown[1:]], -1)
                rounded = np.floor(shown[0][seen].astype(float) * metres(scene) / 1e-3 + 0.5).astype(int)
                known.update({tuple(key): tuple(value) for key, value in zip(rounded.tolist(), labels.tolist())})
        if known:
            rounded = np.floor(places.astype(float) / 1e-3 + 0.5).astype(int).tolist()
            found = [known.get(tuple(key)) for key in rounded]
            labels = np.stack([cloud[name] for name in ("semantic", "instance", "part")], -1).tolist()
            same = [tuple(label) == other for label, other in zip(labels, found)]
            assert np.mean(same) > 0.95, np.mean(same)
        cubes = np.floor(places.astype(float) / 0.01 + 0.5).astype(int)
        assert len(np.unique(cubes, axis=0)) >= 0.99 * len(cubes)
        total += len(cloud)
    return f"{total} points"


def depth_png():
    for scene, camera, frame in record():
        with open(f"{EXPORT}/{scene}/{camera}/cameras.json") as file:
            cameras = json.load(file)
        entry = next(entry for entry in cameras["frames"] if entry["frame"] == frame)
        depth = picture(f"{EXPORT}/{scene}/{camera}/{entry['file']}")
        assert depth.shape == (cameras["height"], cameras["width"])
        if cameras["model"] == "pinhole" and cameras["depth"] == "planar":
            check_points(scene, camera, frame, depth, np.array(cameras["K"]), np.array(entry["world_from_camera"]))
            check_points(scene, camera, frame, depth, np.array(cameras["K_corner"]), np.array(entry["world_from_camera"]), corner=0.5)
    return f"{len(record())} frames"


def bop_ply(path):
    with open(path) as file:
        lines = file.read().split("\n")
    end = lines.index("end_header")
    vertices = int(next(line for line in lines if line.startswith("element vertex")).split()[-1])
    return np.array([[float(v) for v in line.split()] for line in lines[end + 1 : end + 1 + vertices]])


def bop():
    def read(name):
        with open(f"{EXPORT}/{name}") as file:
            return json.load(file)

    first = read("camera.json")
    assert {"fx", "fy", "cx", "cy", "width", "height", "depth_scale"} == set(first)
    objects, models, folders, poses = read("objects.json"), read("models/models_info.json"), read("scenes.json"), 0
    for number, model in models.items():
        path = f"{EXPORT}/models/obj_{int(number):06}.ply"
        if os.path.exists(path):
            points = bop_ply(path)
            assert np.allclose(points.min(0), [model[f"min_{axis}"] for axis in "xyz"], atol=1e-2)
            assert np.allclose(np.ptp(points, axis=0), [model[f"size_{axis}"] for axis in "xyz"], atol=1e-2)
            assert model["diameter"] <= np.linalg.norm(np.ptp(points, axis=0)) + 1e-2
    for number, which in folders.items():
        scene, camera, folder = which["scene"], which["camera"], f"train_pbr/{int(number):06}"
        truths, infos, cameras = (read(f"{folder}/scene_{what}.json") for what in ("gt", "gt_info", "camera"))
        for image, truth in truths.items():
            frame, lens = int(image), cameras[image]
            K = np.array(lens["cam_K"]).reshape(3, 3)
            R, t = np.array(lens["cam_R_w2c"]).reshape(3, 3), np.array(lens["cam_t_w2c"])
            to_world = np.eye(4)
            to_world[:3, :3], to_world[:3, 3] = R.T, -R.T @ t / 1000
            depth = picture(f"{EXPORT}/{folder}/depth/{frame:06}.png") * lens["depth_scale"]
            check_points(scene, camera, frame, depth, K, to_world)
            instances = layer(scene, camera, frame, "semantic_instance")
            rows, columns = np.indices(depth.shape)
            rays = np.stack([columns, rows, np.ones_like(rows)], -1) @ np.linalg.inv(K).T
            for index, (gt, info) in enumerate(zip(truth, infos[image])):
                seen = picture(f"{EXPORT}/{folder}/mask_visib/{frame:06}_{index:06}.png") == 255
                assert np.array_equal(seen, instances == objects[str(gt["obj_id"])]["instance"])
                xs, ys = columns[seen], rows[seen]
                assert info["bbox_visib"] == [xs.min(), ys.min(), np.ptp(xs), np.ptp(ys)]
                assert info["px_count_visib"] == seen.sum() and info["px_count_valid"] == (depth[seen] > 0).sum()
                # What the depth picture shows of the object lies in its model's box.
                model = models[str(gt["obj_id"])]
                R_m2c = np.array(gt["cam_R_m2c"]).reshape(3, 3)
                assert np.allclose(R_m2c @ R_m2c.T, np.eye(3), atol=1e-9) and np.linalg.det(R_m2c) > 0
                local = ((rays * depth[..., None])[seen & (depth > 0)] - gt["cam_t_m2c"]) @ R_m2c
                low = np.array([model[f"min_{axis}"] for axis in "xyz"])
                size = np.array([model[f"size_{axis}"] for axis in "xyz"])
                assert np.all(local > low - 3) and np.all(local < low + size + 3), (gt["obj_id"], local.min(0) - low, local.max(0) - low - size)
                poses += 1
    return f"{poses} poses of {len(models)} objects"


def exr():
    import OpenEXR

    compared = 0
    for scene, camera, frame in record():
        file = OpenEXR.File(f"{EXPORT}/{scene}/{camera}/frame.{frame:04}.exr", separate_channels=True)
        channels, header = file.channels(), file.header()
        mattes = {}
        for name, value in header.items():
            if name.startswith("cryptomatte/"):
                _, key, what = name.split("/")
                mattes.setdefault(key, {})[what] = value
        for name, channel in channels.items():
            stem, letter = name.rsplit(".", 1) if "." in name else ("color", name)
            if stem.startswith("crypto_"):
                continue
            values = layer(scene, camera, frame, stem)
            if values is None:
                check_planar(stem, channel.pixels, scene, camera, frame)
                continue
            part = values if values.ndim == 2 else values[..., "RGBXYZ".index(letter) % 3]
            expected = np.float16 if part.dtype == np.float16 else np.float32
            if stem in ("depth_meters", "position"):
                part = part.astype(np.float32)
                expected = np.float32
            assert channel.pixels.dtype == expected, name
            assert np.array_equal(channel.pixels, part.astype(expected), equal_nan=True), name
            compared += 1
        for matte in mattes.values():
            assert matte["hash"] == "MurmurHash3_32" and matte["conversion"] == "uint32_to_float32"
            labels = layer(scene, camera, frame, {"crypto_instance": "semantic_instance", "crypto_class": "semantic"}[matte["name"]])
            ids, coverage = (channels[f"{matte['name']}00.{letter}"].pixels for letter in "RG")
            assert np.array_equal(coverage, (labels > 0).astype(np.float32))
            manifest = json.loads(matte["manifest"])
            assert len(manifest) == len(np.unique(labels[labels > 0]))
            for text in manifest.values():
                chosen = ids == struct.unpack(">f", bytes.fromhex(text))[0]
                assert len(np.unique(labels[chosen])) == 1 and np.array_equal(chosen, labels == labels[chosen][0])
    return f"{compared} channels"


def webdataset():
    import webdataset as wds

    seen, arrays = set(), 0
    shards = sorted(glob.glob(f"{EXPORT}/shard-*.tar"))
    for sample in wds.WebDataset(shards, shardshuffle=False).decode("rgb8"):
        info = sample["json"]
        at = (info["scene"], info["camera"], info["frame"])
        assert sample["__key__"] == f"{at[0]}/{at[1]}/{at[2]:04}"
        for name, value in sample.items():
            if name.endswith(".npy"):
                values = layer(*at, name[: -len(".npy")])
                # Planar depth is along the axis of K, which is not the camera's where the image plane is tilted.
                if values is None or name == "depth_z_meters.npy":
                    check_planar(name[: -len(".npy")], value, *at)
                    if info["model"] == "pinhole":
                        rows, columns = np.indices(value.shape)
                        rays = np.stack([columns, rows, np.ones_like(rows)], -1) @ np.linalg.inv(info["K"]).T
                        distance = layer(*at, "depth_meters").astype(float)
                        assert np.allclose(np.linalg.norm(rays, axis=-1) * value, distance, rtol=2e-3, equal_nan=True)
                    continue
                assert np.array_equal(value.astype(float), values.astype(float), equal_nan=values.dtype.kind == "f"), name
                arrays += 1
        if "color.png" in sample:
            assert sample["color.png"].shape == (info["height"], info["width"], 3)
        origin, rotation = pose(*at)
        assert np.allclose(np.array(info["world_from_camera"])[:3, 3], origin)
        seen.add(at)
    assert seen == set(record())
    return f"{arrays} arrays in {len(shards)} shards"


def croissant():
    import mlcroissant as mlc

    dataset = mlc.Dataset(jsonld=f"{EXPORT}/croissant.json")
    assert not dataset.metadata.ctx.issues.errors, dataset.metadata.ctx.issues.errors
    frames = list(dataset.records(record_set="frames"))
    assert len(frames) == len(record())
    layers = [text(row["layers/name"]) for row in dataset.records(record_set="layers")]
    for row in frames:
        at = (text(row["frames/scene"]), text(row["frames/camera"]), int(row["frames/frame"]))
        assert at in record()
        for name in layers:
            path = text(row[f"frames/{name}"])
            assert path and os.path.exists(f"{DATASET}/{path}"), path
    assert len(list(dataset.records(record_set="classes"))) == 40
    for resource in dataset.metadata.distribution:
        for pattern in getattr(resource, "includes", None) or []:
            assert len(glob.glob(f"{DATASET}/{pattern}")) >= 1, pattern
    return f"{len(frames)} rows, {len(layers)} layers"


def opencv():
    """World points fall on the pixels that show them."""
    seen, checked = set(), 0
    for path in glob.glob(f"{EXPORT}/*/*/cameras_opencv.json"):
        with open(path) as file:
            cameras = json.load(file)
        scene, camera = cameras["scene"], cameras["camera"]
        for frame in cameras["frames"]:
            number, to_world = frame["frame"], np.array(frame["world_from_camera"])
            seen.add((scene, camera, number))
            assert np.allclose(to_world[:3, 3], pose(scene, camera, number)[0], atol=1e-12)
            position = layer(scene, camera, number, "position")
            if position is None or cameras.get("model") is not None:
                continue
            points = (position.reshape(-1, 3) * metres(scene) - to_world[:3, 3]) @ to_world[:3, :3] @ np.array(cameras["K"]).T
            rows, columns = np.indices(position.shape[:2]).reshape(2, -1)
            off = np.hypot(points[:, 0] / points[:, 2] - columns, points[:, 1] / points[:, 2] - rows)
            hit = np.isfinite(off)
            assert hit.any() and off[hit].max() < 0.01, f"{off[hit].max()} pixels"
            checked += 1
    assert seen == set(record())
    with open(f"{EXPORT}/intrinsics.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {(row["scene_name"], row["camera_name"]) for row in rows} == {at[:2] for at in record()}
    return f"{len(seen)} frames, {checked} projected"


def pix3d():
    """By COCO's own reader; masks are those of the dataset, and the vertices of models fall around them and at their depths."""
    from pycocotools.coco import COCO

    coco = COCO(f"{EXPORT}/pix3d_all.json")
    assert {(i["scene"], i["camera"], i["frame"]) for i in coco.imgs.values()} <= set(record())
    excluded = [entry["annotation"] for entry in coco.dataset.get("excluded", []) if "annotation" in entry]
    whole = 0
    for annotation in [*coco.anns.values(), *excluded]:
        image = coco.imgs[annotation["image_id"]]
        at = image["scene"], image["camera"], image["frame"]
        mask = picture(f"{EXPORT}/{annotation['segmentation']}") > 0
        assert np.array_equal(mask, layer(*at, "semantic_instance") == annotation["instance"])
        rows, columns = np.nonzero(mask)
        box = [columns.min(), rows.min(), columns.max() - columns.min() + 1, rows.max() - rows.min() + 1]
        assert np.array_equal(box, annotation["bbox"]), f"{box} {annotation['bbox']}"
        with open(f"{EXPORT}/{annotation['model']}") as file:
            vertices = np.array([line.split()[1:4] for line in file if line.startswith("v ")], float)
        assert np.isclose(np.linalg.norm(vertices, axis=-1).max(), 0.5)
        x, y, z = (np.array(annotation["rot_mat"]) @ vertices.T + np.array(annotation["trans_mat"])[:, None]) * annotation["meters_per_unit"]
        if annotation["leaves_frustum"]:
            continue
        f, cx, cy = annotation["K"]
        u, v = cx - f * x / z, cy - f * y / z
        assert u.min() < columns.min() + 1 and columns.max() < u.max() and v.min() < rows.min() + 1 and rows.max() < v.max()
        depth = layer(*at, "depth_z_meters")[mask]
        assert z.min() - 1e-3 < depth.min() and depth.max() < z.max() + 1e-3, f"{z.min()} {depth.min()} {depth.max()} {z.max()}"
        whole += 1
    assert whole > 0
    return f"{len(coco.anns)} annotations, {len(excluded)} excluded with a model, {whole} seen whole"


def huggingface():
    """By the library that it is for, from the folder alone; values are those of the dataset."""
    import tempfile

    import datasets

    with tempfile.TemporaryDirectory() as cache:
        loaded = datasets.load_dataset(EXPORT, cache_dir=cache)
        assert set(loaded) == {"train"}, loaded
        frames = loaded["train"]
        assert isinstance(frames.features["image"], datasets.Image) and isinstance(frames.features["depth"], datasets.Image)
        assert [(row["scene"], row["camera"], row["frame"]) for row in frames.remove_columns(["image", "depth", "semantic", "instance"])] == record()
        for row in frames:
            at = row["scene"], row["camera"], row["frame"]
            size = row["height"], row["width"]
            assert np.asarray(row["image"]).shape == (*size, 3) and row["image"].mode == "RGB"
            for name, of in (("semantic", "semantic"), ("instance", "semantic_instance")):
                assert np.array_equal(np.asarray(row[name]), np.maximum(layer(*at, of), 0)), name
            depth = np.asarray(row["depth"]).astype(np.uint16)
            assert depth.shape == size and row["model"] == "pinhole" and row["depth_kind"] == "planar"
            check_points(*at, depth, np.array(row["K"]), np.array(row["world_from_camera"]))
        del frames, loaded
    return f"{len(record())} frames"


def layout(scene):
    with open(f"{scenes_dir()}/{scene}/_detail/layout.json") as file:
        return json.load(file)


def spatiallm():
    """By the rules of SpatialLM's own reader: a line is a name, a kind, and numbers."""
    for scene in {at[0] for at in record()}:
        found = {"Wall": [], "Door": [], "Window": [], "Bbox": []}
        with open(f"{EXPORT}/layout/{scene}.txt") as file:
            for line in file.read().splitlines():
                name, call = line.split("=")
                kind, values = call.rstrip(")").split("(")
                assert name == f"{kind.lower()}_{len(found[kind])}", line
                found[kind].append(values.split(","))
        stored = layout(scene)
        walls = [[float(v) for v in values] for values in found["Wall"]]
        for wall, face in zip(walls, stored["walls"], strict=True):
            assert wall == [*face["from"], face["floor_z_m"], *face["to"], face["floor_z_m"], face["ceiling_z_m"] - face["floor_z_m"], 0.0]
        for kind, kinds in (("Door", ("door", "passage")), ("Window", ("window",))):
            for values, opening in zip(found[kind], [o for o in stored["openings"] if o["kind"] in kinds], strict=True):
                wall = walls[int(values[0].removeprefix("wall_"))]
                a, b, center = np.array(wall[:3]), np.array(wall[3:6]), np.array(values[1:4], float)
                along = (b - a) / np.linalg.norm(b - a)
                off = (center - a - along * ((center - a) @ along))[:2]
                assert np.abs(off).max() < 1e-9 and np.allclose(center, np.mean(opening["corners"], axis=0))
                width, height = (np.linalg.norm(np.subtract(*opening["corners"][i : i + 2])) for i in (0, 1))
                assert np.allclose([width, height], np.array(values[4:6], float))
        assert {values[0] for values in found["Bbox"]} == {"table", "chair"}
        with open(f"{EXPORT}/pcd/{scene}.ply", "rb") as file:
            header, body = file.read().split(b"end_header\n", 1)
        kind = np.dtype([("at", "<f4", 3), ("rgb", "u1", 3)])
        points = np.frombuffer(body, kind, int(header.split(b"element vertex ")[1].split(b"\n")[0]))["at"]
        # Layout.translate(-min) and normalize_and_discretize: nothing may lie below the cloud's least coordinates.
        corners = np.array([wall[:3] for wall in walls] + [wall[3:6] for wall in walls])
        assert (corners >= points.min(axis=0) - 0.05).all(), (corners.min(axis=0), points.min(axis=0))
        for _, *box in found["Bbox"]:
            x, y, z, angle, *size = map(float, box)
            along = np.array([[np.cos(angle), np.sin(angle), 0], [-np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
            own = (points - [x, y, z]) @ along.T
            assert (np.abs(own) <= np.array(size) / 2 + 0.15).all(axis=1).sum() > 100, "Layout.filter_empty_bboxes"
        with open(f"{EXPORT}/split.csv") as file:
            assert {row["id"]: row["split"] for row in csv.DictReader(file)}[scene] in ("train", "val")
    return f"{len(walls)} walls"


ROOM_TYPES = """living room,kitchen,bedroom,bathroom,balcony,corridor,dining room,study,studio,store room,garden,laundry room,office,basement,
garage,undefined""".replace("\n", "").split(",")


def vertices(lines):
    """Structured3D's `convert_lines_to_vertices`: lines by the numbers of their ends become a polygon."""
    polygon, left = list(lines[0]), [tuple(line) for line in lines[1:]]
    while left:
        (following,) = [line for line in left if polygon[-1] in line][:1]
        left.remove(following)
        vertex = following[0] if following[1] == polygon[-1] else following[1]
        if vertex in polygon:
            return polygon, left
        polygon.append(vertex)
    raise AssertionError("the lines do not close")


def structured3d():
    """Junctions lie on the planes of their lines, the lines of a plane are closed, and its own drawing of floor plans finds rooms and outline."""
    with open(f"{EXPORT}/scenes.csv") as file:
        folders = {row["scene"]: row["folder"] for row in csv.DictReader(file)}
    for scene in {at[0] for at in record()}:
        with open(f"{EXPORT}/{folders[scene]}/annotation_3d.json") as file:
            found = json.load(file)
        points = np.array([junction["coordinate"] for junction in found["junctions"]])
        ends, lines_of = np.array(found["lineJunctionMatrix"]), np.array(found["planeLineMatrix"])
        assert (ends.sum(axis=1) == 2).all() and ends.shape == (len(found["lines"]), len(points))
        for plane, lines in zip(found["planes"], lines_of, strict=True):
            of = ends[lines == 1]
            assert set(of.sum(axis=0)) <= {0, 2}, "every junction of a plane joins two of its lines"
            on = points[of.any(axis=0)]
            assert np.abs(on @ np.array(plane["normal"]) + plane["offset"]).max() < 1e-6
        of_type = lambda *types: [s for s in found["semantics"] if s["type"] in types]
        rooms = of_type(*ROOM_TYPES)
        assert len(rooms) == len(layout(scene)["rooms"]) == len(found["semantics"]) - len(of_type("door", "window", "outwall"))

        # visualize_floorplan.py: the lines of `outwall` on the floor, without those of doors and windows, are one polygon around all rooms.
        holes = {line for s in of_type("door", "window") for plane in s["planeID"] for line in np.nonzero(lines_of[plane])[0]}
        floor = np.isclose(points[:, 2], 0)
        (outwall,) = of_type("outwall")
        around = []
        for plane in outwall["planeID"]:
            pairs = [tuple(np.nonzero(ends[line])[0]) for line in np.nonzero(lines_of[plane])[0] if line not in holes]
            around += [pair for pair in pairs if floor[pair[0]] and floor[pair[1]]]
        outline = points[vertices(around)[0]][:, :2]
        for room in rooms:
            (plane,) = [p for p in room["planeID"] if found["planes"][p]["type"] == "floor"]
            corners = points[ends[lines_of[plane] == 1].any(axis=0)][:, :2]
            assert (corners.min(axis=0) > outline.min(axis=0)).all() and (corners.max(axis=0) < outline.max(axis=0)).all()

        with open(f"{EXPORT}/{folders[scene]}/bbox_3d.json") as file:
            boxes = {box["ID"]: box for box in json.load(file)}
        numbers = np.unique(array(f"{scenes_dir()}/{scene}/_detail/mesh/mesh_objects_sii.hdf5"))
        assert set(boxes) == set(numbers[numbers > 0].tolist())
        for box in boxes.values():
            basis = np.array(box["basis"])
            assert np.allclose(basis @ basis.T, np.eye(3)) and np.all(np.array(box["coeffs"]) >= 0) and len(box["centroid"]) == 3
    return f"{len(points)} junctions"


def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


if __name__ == "__main__":
    readers = {"colmap-text": colmap, "depth-png": depth_png}
    try:
        print(readers.get(sys.argv[1], globals().get(sys.argv[1]))())
    except ImportError as error:
        print(f"skipped: {error}")
        sys.exit(77)
