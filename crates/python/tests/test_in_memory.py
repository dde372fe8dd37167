"""Scenes, cameras and frames in memory: the same arrays as on disk, without a disk."""

import io
import json
import os
import pickle
import signal
import sys
import threading
import types
import unittest
from unittest import mock

import enfilade
import numpy as np
from enfilade import _progress

import datasets

ROOM = """newmtl white
Kd 0.7 0.7 0.7
newmtl lamp
Kd 0 0 0
Ke 8 8 8
"""


def box_room(folder):
    """A room of 4 x 3 x 4 m whose ceiling shines, y up, without a camera."""
    folder.mkdir(exist_ok=True)
    (folder / "room.mtl").write_text(ROOM)
    corners = [(x, y, z) for x in (0, 4) for y in (0, 3) for z in (0, 4)]
    vertices = "".join(f"v {x} {y} {z}\n" for x, y, z in corners)
    walls = "usemtl white\no walls\nf 1 2 4 3\nf 5 7 8 6\nf 1 3 7 5\nf 2 6 8 4\no floor\nf 1 5 6 2\n"
    (folder / "room.obj").write_text("mtllib room.mtl\n" + vertices + walls + "usemtl lamp\no ceiling\nf 3 4 8 7\n")
    return folder / "room.obj"


def record(sample):
    """What the dataset knows of a sample's frame."""
    place = f"scenes/{sample['scene']}/_detail/{sample['camera']}/frames/frame.{sample['frame']:04}.json"
    return json.loads((datasets.made() / place).read_text())


class Rendered(unittest.TestCase):
    def test_frames_are_those_of_a_run_bit_by_bit(self):
        samples = list(enfilade.Dataset(datasets.made()))
        settings = datasets.small_config().to_dict()["scenes"][0]
        scene = enfilade.Scene.home(**settings["source"]["home"])
        cameras = [enfilade.Camera(s["K"], datasets.SIZE, s["world_from_camera"], name=s["camera"]) for s in samples]
        frames = enfilade.render(scene, cameras, samples=2, seed=record(samples[0])["seed"], progress=False)
        for frame, sample in zip(frames, samples, strict=True):
            self.assertEqual(list(frame), list(sample))
            for key, value in sample.items():
                if isinstance(value, np.ndarray):
                    self.assertEqual((frame[key].dtype, frame[key].shape), (value.dtype, value.shape), key)
                    # OpenCV's axes do not keep the sign of a zero in the rotation.
                    found, expected = (v + v.dtype.type(0) if key.endswith("_cam") else v for v in (frame[key], value))
                    self.assertTrue(found.tobytes() == expected.tobytes(), key)
                else:
                    self.assertEqual(frame[key], value, key)

    def test_a_file_is_read_and_seen_from_a_place_that_is_found(self):
        scene = enfilade.Scene.read(box_room(datasets.folder() / "box"), up_axis="y", progress=False)
        self.assertEqual((scene.name, scene.triangles, scene.cameras), ("room", 12, []))
        np.testing.assert_allclose(scene.bounds[1] - scene.bounds[0], [4, 4, 3], atol=1e-6)
        self.assertEqual(len(scene.parts), len(scene.labels))
        camera = scene.camera(size=(32, 24))
        self.assertTrue((scene.bounds[0] < camera.position).all() and (camera.position < scene.bounds[1]).all(), camera)
        frame = enfilade.render(scene, camera, samples=2, layers=["color", "depth_z_meters", "normal_world", "material_id"])
        self.assertIsInstance(frame, dict)
        self.assertEqual(list(frame)[:4], ["color", "depth_z_meters", "normal_world", "material_id"])
        self.assertTrue(frame["mask"].all() and (frame["color"] > 0).any())
        # Points of the depth, unprojected by K and pose, lie on the walls.
        rows, columns = np.mgrid[0:24, 0:32]
        rays = np.stack([columns, rows, np.ones_like(rows)], -1) @ np.linalg.inv(frame["K"]).T
        pose = frame["world_from_camera"]
        points = (rays * frame["depth_z_meters"][..., None]) @ pose[:3, :3].T + pose[:3, 3]
        off = np.minimum(abs(points - scene.bounds[0]), abs(points - scene.bounds[1])).min(-1)
        self.assertLess(off.max(), 1e-4)

    def test_the_same_arguments_give_the_same_bytes_and_another_seed_another_picture(self):
        scene = enfilade.Scene.read(box_room(datasets.folder() / "box"), up_axis="y")
        camera = enfilade.Camera.look_at(scene.bounds.mean(0), scene.bounds[0], (32, 24))
        first, second, other = (enfilade.render(scene, camera, samples=2, seed=seed)["color"].tobytes() for seed in (1, 1, 2))
        self.assertEqual(first, second)
        self.assertNotEqual(first, other)

    def test_what_cannot_be_rendered_is_refused_with_a_reason(self):
        scene = enfilade.Scene.read(box_room(datasets.folder() / "box"), up_axis="y")
        camera = enfilade.Camera.look_at((0, 0, 1), (1, 0, 1))
        cases = [
            ({"layers": "colour"}, "there is no layer"),
            ({"layers": []}, "no layers were asked for"),
            ({"layers": "color_rendered", "denoise": False}, "without denoising, color is the rendered layer"),
            ({"samples": 0}, "samples must be at least 1, found 0"),
            ({"noise": 2.0}, "noise must lie between 0 and 1"),
            ({"quality": "best"}, "expected one of draft"),
        ]
        for arguments, said in cases:
            with self.assertRaisesRegex(ValueError, said):
                enfilade.render(scene, camera, **arguments)
        with self.assertRaisesRegex(ValueError, "there is no camera"):
            enfilade.render(scene, [])
        with self.assertRaisesRegex(ValueError, "no camera \"east\""):
            scene.camera("east")
        with self.assertRaisesRegex(RuntimeError, "gone.glb"):
            enfilade.Scene.read("gone.glb")

    @unittest.skipIf(os.name == "nt", "Windows has no signal that a process can send to itself so")
    def test_rendering_can_be_interrupted_and_done_again(self):
        scene = enfilade.Scene.read(box_room(datasets.folder() / "box"), up_axis="y")
        camera = enfilade.Camera.look_at(scene.bounds.mean(0), scene.bounds[0], (64, 48))
        threading.Timer(1.0, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            enfilade.render(scene, camera, samples=1 << 20, progress=False)
        self.assertEqual(enfilade.render(scene, camera, samples=1)["color"].shape, (48, 64, 3))

    def test_a_scene_is_saved_and_read_again(self):
        scene = enfilade.Scene.home(rooms=["toilet"], seed=3)
        path = datasets.folder() / "toilet.scene"
        self.assertEqual(scene.save(path), [])
        again = enfilade.Scene.read(path)
        self.assertEqual((again.parts.names, again.materials, again.summary), (scene.parts.names, scene.materials, scene.summary))
        np.testing.assert_array_equal(again.labels, scene.labels)
        with self.assertRaisesRegex(ValueError, "end it with one of .scene"):
            scene.save(datasets.folder() / "toilet.txt")


class Cameras(unittest.TestCase):
    def test_looking_at_something_puts_it_in_the_middle(self):
        camera = enfilade.Camera.look_at((1, 2, 1.5), (3, 5, 1), (64, 48), 90)
        np.testing.assert_allclose(camera.K, [[32, 0, 31.5], [0, 32, 23.5], [0, 0, 1]], atol=1e-12)
        x, y, depth = camera.K @ (np.linalg.inv(camera.world_from_camera) @ [3, 5, 1, 1])[:3]
        np.testing.assert_allclose([x / depth, y / depth], [31.5, 23.5], atol=1e-9)
        # What is above is above: row numbers grow downward.
        x, y, depth = camera.K @ (np.linalg.inv(camera.world_from_camera) @ [3, 5, 2, 1])[:3]
        self.assertLess(y / depth, 23.5)

    def test_cameras_come_back_from_pickle_with_every_model(self):
        pose, k = enfilade.Camera.look_at((0, 0, 1), (1, 1, 1)).world_from_camera, [[50, 0, 31], [0, 50, 23], [0, 0, 1]]
        lens = {"f_number": 2.8, "focal_length_mm": 35.0, "focus_distance_m": 2.0}
        cameras = [
            enfilade.Camera(k, (64, 48), pose, lens=lens, name="a"),
            enfilade.Camera(k, (64, 48), pose, model="radial_tangential", distortion=[-0.1, 0.01, 0, 0]),
            enfilade.Camera(k, (64, 48), pose, model="fisheye", distortion=[0.01, 0, 0, 0]),
            enfilade.Camera(None, (64, 32), pose, model="equirectangular"),
        ]
        for camera in cameras:
            again = pickle.loads(pickle.dumps(camera))
            self.assertEqual((repr(again), again.size, again.distortion), (repr(camera), camera.size, camera.distortion))
            np.testing.assert_array_equal(again.world_from_camera, camera.world_from_camera)
        self.assertIsNone(cameras[-1].K)

    def test_cameras_that_are_none_are_refused_with_what_is_wrong(self):
        pose, k = np.eye(4), [[50, 0, 31], [0, 50, 23], [0, 0, 1]]
        cases = [
            (lambda: enfilade.Camera(np.eye(4), (64, 48), pose), "K has the shape .*expected 3 x 3"),
            (lambda: enfilade.Camera(np.transpose(k), (64, 48), pose), "transposed"),
            (lambda: enfilade.Camera(k, (64, 48), 2 * pose), "expected a rotation"),
            (lambda: enfilade.Camera(k, (64, 48), pose @ np.diag([1, 1, -1, 1])), "expected a rotation"),
            (lambda: enfilade.Camera(k, (0, 48), pose), "at least one pixel"),
            (lambda: enfilade.Camera(None, (64, 48), pose), "K is None"),
            (lambda: enfilade.Camera(k, (64, 48), pose, model="pin"), "model is \"pin\""),
            (lambda: enfilade.Camera(k, (64, 48), pose, lens={"focus": 2}), "unknown field `focus`"),
            (lambda: enfilade.Camera.look_at((0, 0, 0), (0, 0, 1)), "no view from"),
            (lambda: enfilade.Camera.look_at((0, 0, 0), (0, 1, 0), fov_x_deg=180), "between 0 and 180"),
        ]
        for make, said in cases:
            with self.assertRaisesRegex(ValueError, said):
                make()


class Shown(unittest.TestCase):
    def test_scenes_frames_and_datasets_are_shown_in_notebooks(self):
        scene = enfilade.Scene.read(box_room(datasets.folder() / "box"), up_axis="y")
        self.assertIn("<svg", scene._repr_html_())
        self.assertIn("12 triangles", scene._repr_html_())
        frame = enfilade.render(scene, scene.camera(size=(32, 24)), samples=1)
        self.assertTrue(frame._repr_png_().startswith(b"\x89PNG") and frame.png("semantic").startswith(b"\x89PNG"))
        shown = frame._repr_html_()
        for expected in ("data:image/jpeg", "normal_world", "depth_meters", "float16"):
            self.assertIn(expected, shown)
        with self.assertRaisesRegex(ValueError, "cannot show 'material_id'; it has: color"):
            frame.png("material_id")
        self.assertIsNone(enfilade.render(scene, scene.camera(size=(32, 24)), samples=1, layers="valid")._repr_png_())
        shown = enfilade.Dataset(datasets.made())._repr_html_()
        for expected in ("<td>home</td>", "data:image/png", "140 x 200 x 3"):
            self.assertIn(expected, shown)

    def test_progress_is_a_line_where_tqdm_is_not_installed(self):
        with mock.patch.dict(sys.modules, {"tqdm": None, "tqdm.auto": None}), mock.patch("sys.stderr", io.StringIO()) as said:
            bar = _progress.bar(True, "render")
            bar.update("frame 1 of 2", 250, 1000)
            bar.close(True)
        self.assertEqual(said.getvalue(), "\rrender: frame 1 of 2 25 %\rrender: done             \n")

    def test_progress_is_a_bar_of_tqdm_where_that_is_installed(self):
        made = []

        class Bar:
            def __init__(self, total, desc, bar_format):
                self.total, self.n, self.said, self.closed = total, 0, [desc], False
                made.append(self)

            def set_description(self, text, refresh):
                self.said.append(text)

            def reset(self, total):
                self.total = total

            def refresh(self):
                pass

            def close(self):
                self.closed = True

        fake = types.ModuleType("tqdm.auto")
        fake.tqdm = Bar
        with mock.patch.dict(sys.modules, {"tqdm": types.ModuleType("tqdm"), "tqdm.auto": fake}):
            enfilade.run(datasets.folder() / "watched", enfilade.Config.demo(frames=1, size=(64, 48), samples=256), progress=True)
        (bar,) = made
        self.assertTrue(bar.closed and bar.n == bar.total)
        self.assertTrue(any(text.startswith("run: home: ") for text in bar.said), bar.said)

    def test_progress_is_silent_unless_someone_watches(self):
        with mock.patch("sys.stderr", io.StringIO()) as said:
            self.assertIsNone(_progress.bar(None, "render"))
            self.assertIsNone(_progress.bar(False, "render"))
        self.assertEqual(said.getvalue(), "")


if __name__ == "__main__":
    unittest.main()
