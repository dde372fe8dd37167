"""Values are those of the files, bit by bit; what is derived from them is what its definition says."""

import csv
import shutil
import unittest

import enfilade
import h5py
import numpy as np

import datasets


def same_bits(a, b):
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


class StoredValues(unittest.TestCase):
    def check(self, root):
        frames = enfilade.Dataset(root, stored=True, poses=False)
        for sample in frames:
            for layer in frames.layers:
                expected = datasets.read(datasets.file_of(root, sample, layer))
                self.assertTrue(same_bits(sample[layer], expected), layer)
        return frames

    def test_every_layer_of_ours_is_what_h5py_reads(self):
        frames = self.check(datasets.made())
        self.assertEqual(len(frames), 3)
        self.assertIn("semantic", frames.layers)

    def test_every_layer_of_the_release_is_what_h5py_reads(self):
        frames = self.check(datasets.as_hypersim())
        self.assertEqual(len(frames), 3)
        self.assertEqual(frames[0]["depth_meters"].dtype, np.float16)

    def test_hypersims_own_frame_is_what_h5py_reads(self):
        if datasets.real() is None:
            self.skipTest("ENFILADE_SCENES is not set")
        self.check(datasets.real())

    def test_a_repacked_copy_has_the_same_values(self):
        copy = datasets.folder() / "repacked"
        counts = enfilade.repack(datasets.as_hypersim(), copy)
        before, after = (enfilade.Dataset(root, stored=True) for root in (datasets.as_hypersim(), copy))
        self.assertEqual(counts["files"], len(before) * len(before.layers))
        self.assertEqual(before.layers, after.layers)
        for old, new in zip(before, after, strict=True):
            for key in [*before.layers, "mask", "K", "world_from_camera"]:
                self.assertTrue(same_bits(old[key], new[key]), key)
        ours = datasets.folder() / "repacked-ours"
        enfilade.repack(datasets.made(), ours, layers="position")
        # Hypersim's positions are in asset units, ours in metres.
        for root, unit in ((copy, None), (ours, "m")):
            with h5py.File(datasets.file_of(root, after[0], "position"), "r") as file:
                self.assertEqual(file["dataset"].attrs.get("unit"), unit)

    def test_only_a_copy_is_replaced_by_a_repacked_one(self):
        made, other, copy = datasets.made(), datasets.folder() / "finished", datasets.folder() / "repacked-again"
        shutil.copytree(made, other)
        table = (other / "metadata_camera_parameters.csv").read_bytes()
        with self.assertRaisesRegex(ValueError, "finished .*not made by `repack`"):
            enfilade.repack(datasets.as_hypersim(), other)
        self.assertEqual((other / "metadata_camera_parameters.csv").read_bytes(), table)
        enfilade.repack(made, copy)
        enfilade.repack(datasets.as_hypersim(), copy, layers=["color", "depth_meters"])
        self.assertEqual(enfilade.Dataset(copy).layers, ["color", "depth_meters"])

    def test_crops_are_parts_of_the_whole(self):
        for root in (datasets.made(), datasets.as_hypersim()):
            whole = enfilade.Dataset(root)
            for place in ("center", "random", (3, 129)):
                crop = enfilade.Dataset(root, crop=(100, 70), crop_place=place, seed=5)
                for a, b in zip(whole, crop, strict=True):
                    top, left, height, width = b["window"]
                    self.assertEqual((height, width), (100, 70))
                    for key in [*whole.layers, "mask"]:
                        part = np.ascontiguousarray(a[key][top : top + height, left : left + width])
                        self.assertTrue(same_bits(part, b[key]), key)


class DerivedValues(unittest.TestCase):
    def test_positions_project_onto_their_pixels(self):
        """K and pose say where a surface point falls, also of crops and other sizes."""
        for root in (datasets.made(), datasets.as_hypersim()):
            for options in ({}, {"crop": (90, 120), "crop_place": "random"}, {"crop": (100, 100), "resize": (50, 50)}):
                sample = enfilade.Dataset(root, layers=["position", "depth_z_meters"], **options)[1]
                camera_from_world = np.linalg.inv(sample["world_from_camera"])
                points = sample["position"].astype(np.float64) @ camera_from_world[:3, :3].T + camera_from_world[:3, 3]
                pixels = points @ sample["K"].T
                pixels = pixels[..., :2] / pixels[..., 2:]
                rows, columns = np.indices(points.shape[:2])
                mask = sample["mask"]
                # Positions in float16 are coarse, and the nearest value is up to half a pixel off where two are one.
                bound = 0.01 if root == datasets.made() and "resize" not in options else 1.5
                self.assertGreater(mask.mean(), 0.9)
                self.assertLess(np.abs(pixels[..., 0] - columns)[mask].max(), bound)
                self.assertLess(np.abs(pixels[..., 1] - rows)[mask].max(), bound)
                self.assertLess(np.abs(points[..., 2] - sample["depth_z_meters"])[mask].max(), 0.02)

    def test_hypersims_depth_is_metric_and_planar_depth_is_computed(self):
        if datasets.real() is None:
            self.skipTest("ENFILADE_SCENES is not set")
        sample = enfilade.Dataset(datasets.real(), layers=["depth_meters", "depth_z_meters"])[0]
        distance = datasets.read(datasets.file_of(datasets.real(), sample, "depth_meters")).astype(np.float64)
        rows, columns = np.indices(distance.shape)
        rays = np.stack([columns, rows, np.ones_like(rows)], -1) @ np.linalg.inv(sample["K"]).T
        planar = distance / np.linalg.norm(rays, axis=-1)
        self.assertTrue(np.array_equal(sample["depth_meters"], distance.astype(np.float32)))
        self.assertLess(np.abs(sample["depth_z_meters"] - planar)[sample["mask"]].max(), 1e-5)

    def test_hypersims_own_camera_sees_the_angles_that_its_table_says(self):
        """This scene's image plane is tilted, so K is that of a turned pinhole, and the angles between rays are what can be compared."""
        if datasets.real() is None:
            self.skipTest("ENFILADE_SCENES is not set")
        sample = enfilade.Dataset(datasets.real(), layers=["depth_meters"])[0]
        with open(datasets.real() / "metadata_camera_parameters.csv") as file:
            row = next(row for row in csv.DictReader(file) if row["scene_name"] == sample["scene"])
        cam_from_uv = np.array([[float(row[f"M_cam_from_uv_{i}{j}"]) for j in range(3)] for i in range(3)])
        pixels = np.array([[0, 0, 1], [1023, 0, 1], [300, 700, 1], [1023, 767, 1]], dtype=float)
        uv = np.stack([2 * (pixels[:, 0] + 0.5) / 1024 - 1, 1 - 2 * (pixels[:, 1] + 0.5) / 768, np.ones(4)], -1)
        expected, found = uv @ cam_from_uv.T, pixels @ np.linalg.inv(sample["K"]).T
        expected, found = (rays / np.linalg.norm(rays, axis=1, keepdims=True) for rays in (expected, found))
        self.assertLess(np.abs(expected @ expected.T - found @ found.T).max(), 1e-9)

    def test_masks_are_true_where_all_layers_have_values(self):
        sample = enfilade.Dataset(datasets.made(), layers=["depth_meters", "normal_world"])[0]
        expected = np.isfinite(sample["depth_meters"]) & np.isfinite(sample["normal_world"]).all(-1)
        self.assertEqual(sample["mask"].dtype, bool)
        self.assertTrue(np.array_equal(sample["mask"], expected))

    def test_areas_with_a_value_that_is_none_are_masked(self):
        root = datasets.folder() / "infinite"
        shutil.copytree(datasets.as_hypersim(), root)
        sample = enfilade.Dataset(root, layers=["color"])[0]
        with h5py.File(datasets.file_of(root, sample, "color"), "r+") as file:
            file["dataset"][2, 4] = np.inf
        half = enfilade.Dataset(root, layers=["color"], resize=(70, 100))[0]
        self.assertFalse(half["mask"][1, 2])
        self.assertTrue(np.array_equal(half["mask"], np.isfinite(half["color"]).all(-1)))

    def test_averages_keep_the_mean_and_numbers_stay_numbers(self):
        whole = enfilade.Dataset(datasets.made(), layers=["color", "semantic"], stored=True)[0]
        half = enfilade.Dataset(datasets.made(), layers=["color", "semantic"], resize=(70, 100))[0]
        means = whole["color"].astype(np.float64).reshape(70, 2, 100, 2, 3).mean((1, 3))
        self.assertLess((np.abs(half["color"] - means) / (means + 1e-3)).max(), 1e-3)
        self.assertTrue(np.array_equal(half["semantic"], whole["semantic"][1::2, 1::2]))

    def test_the_tone_map_is_hypersims(self):
        for root in (datasets.made(), datasets.as_hypersim()):
            layers = ["color", "render_entity_id"]
            raw = enfilade.Dataset(root, layers=layers, stored=True)[0]
            color = raw["color"].astype(np.float64)
            brightness = (color @ [0.3, 0.59, 0.11])[raw["render_entity_id"] != -1]
            scale = 0.8**2.2 / np.percentile(brightness, 90)
            expected = np.minimum(1, np.maximum(0, scale * color) ** (1 / 2.2))
            shown = enfilade.Dataset(root, layers="color", tone_map=True)[0]["color"]
            self.assertEqual(shown.dtype, np.uint8)
            self.assertLess(np.abs(shown - 255 * expected).max(), 0.51)
            part = enfilade.Dataset(root, layers="color", tone_map=True, crop=(30, 40), crop_place=(60, 90))[0]["color"]
            self.assertTrue(np.array_equal(part, shown[60:90, 90:130]))


if __name__ == "__main__":
    unittest.main()
