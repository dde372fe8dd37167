"""Errors are Python's exceptions, and say which file or name they are about."""

import shutil
import unittest

import enfilade

import datasets


class Errors(unittest.TestCase):
    def message(self, kind, action):
        with self.assertRaises(kind) as caught:
            action()
        return str(caught.exception)

    def copy(self):
        out = datasets.folder() / f"copy-{self._testMethodName}"
        shutil.copytree(datasets.as_hypersim(), out)
        return out

    def test_a_dataset_that_is_not_there(self):
        missing = datasets.folder() / "nothing"
        self.assertIn("nothing", self.message(FileNotFoundError, lambda: enfilade.Dataset(missing)))
        empty = datasets.folder() / "empty"
        empty.mkdir()
        self.assertIn("is not a dataset", self.message(ValueError, lambda: enfilade.Dataset(empty)))

    def test_a_file_that_is_gone_is_named(self):
        root = self.copy()
        frames = enfilade.Dataset(root, layers="depth_meters")
        path = datasets.file_of(root, frames[1], "depth_meters")
        path.unlink()
        self.assertIn(path.name, self.message(FileNotFoundError, lambda: frames[1]))
        self.assertIn(path.name, self.message(FileNotFoundError, lambda: list(frames.loader(threads=2))))
        self.assertEqual(len(enfilade.Dataset(root, layers="depth_meters")), 2)

    def test_a_file_that_is_damaged_is_named(self):
        root = self.copy()
        frames = enfilade.Dataset(root, layers="color")
        path = datasets.file_of(root, frames[0], "color")
        whole = path.read_bytes()
        path.write_bytes(whole[: len(whole) // 2])
        self.assertIn(path.name, self.message(enfilade.DamagedFileError, lambda: frames[0]))
        middle = len(whole) // 2
        path.write_bytes(whole[:middle] + bytes(64) + whole[middle + 64 :])
        self.assertIn(path.name, self.message(enfilade.DamagedFileError, lambda: frames[0]))
        self.assertTrue(issubclass(enfilade.DamagedFileError, OSError))

    def test_names_that_do_not_exist(self):
        open_with = lambda **options: enfilade.Dataset(datasets.made(), **options)
        self.assertIn("depth_meters", self.message(ValueError, lambda: open_with(layers="depth")))
        self.assertIn("home", self.message(ValueError, lambda: open_with(scenes="hom")))
        self.assertIn("cam_00", self.message(ValueError, lambda: open_with(cameras="cam_7")))
        self.assertIn("train", self.message(ValueError, lambda: open_with(split="training")))
        self.assertIn("optical_flow", self.message(ValueError, lambda: open_with(layers="optical_flow")))
        self.assertIn("center", self.message(ValueError, lambda: open_with(crop=(9, 9), crop_place="middle")))

    def test_a_split_that_is_not_there(self):
        root = self.copy()
        (root / "metadata_images_split_scene_v1.csv").unlink(missing_ok=True)
        message = self.message(FileNotFoundError, lambda: enfilade.Dataset(root, layers="color", split="train"))
        for part in ("metadata_images_split_scene_v1.csv", "evermotion_dataset/analysis", "enfilade partition"):
            self.assertIn(part, message)

    def test_images_without_detail_are_read_and_poses_asked_for_in_vain_are_told(self):
        root = self.copy()
        shutil.rmtree(root / "scenes/home/_detail")
        message = self.message(ValueError, lambda: enfilade.Dataset(root, layers="depth_meters"))
        for part in ("home/cam_00", "camera_keyframe_positions.hdf5", "_detail", "poses=False"):
            self.assertIn(part, message)
        frames = enfilade.Dataset(root, layers=["color", "depth_meters", "depth_z_meters"], poses=False)
        whole = enfilade.Dataset(datasets.as_hypersim(), layers=["color", "depth_meters", "depth_z_meters"])
        self.assertEqual(len(frames), 3)
        self.assertNotIn("K", frames[0])
        for layer in frames.layers:
            self.assertEqual(frames[1][layer].tobytes(), whole[1][layer].tobytes())

    def test_crops_that_do_not_fit(self):
        frames = enfilade.Dataset(datasets.made(), layers="color", crop=(141, 10))
        self.assertIn("140x200", self.message(ValueError, lambda: frames[0]))
        frames = enfilade.Dataset(datasets.made(), layers="color", crop=(10, 10), crop_place=(131, 0))
        self.assertIn("leaves the image", self.message(ValueError, lambda: frames[0]))


if __name__ == "__main__":
    unittest.main()
