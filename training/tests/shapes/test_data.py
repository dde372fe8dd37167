import base64
import json
import tempfile
import unittest
from pathlib import Path

import numpy as np
import torch
from PIL import Image

from enfilade_training.shapes.config import Data
from enfilade_training.shapes.data import DataError, Order, Shapes, read_image, read_obj, read_voxels
from tests.shapes import rooms

# What scipy 1.17's `savemat(file, {"other": 1.0, "voxel": voxel}, do_compression=True)` writes behind its header.
PACKED = (
    "DwAAACkAAAB4nONjYGBwAGI2IOaA0iDACuUzImGQWH5JRmoRkOaEykPAB3sATzQD2g8AAAA9AAAAeJzjY2BgkGBkYGAD0hxAzMkAAaxAzMMAEYdhEGCEypXlV6TmAGkm"
    "IL7BgAYYGRnRhTDAYFODAwAAJpQDfw=="
)


class DataTests(unittest.TestCase):
    def setUp(self) -> None:
        torch.set_num_threads(1)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.file = rooms.write(self.folder, rooms.TWO)

    def shapes(self, **settings: object) -> Shapes:
        return Shapes([self.file], Data(**settings))

    def test_shapes_fall_on_the_image_where_their_masks_are(self) -> None:
        for index in range(2):
            for flip in (False, True):
                image, target = self.shapes()[index, flip]
                self.assertEqual((image.shape, target["masks"].dtype), ((3, rooms.SIZE, rooms.SIZE), torch.uint8))
                for box, mask, shape in zip(target["boxes"], target["masks"], target["shapes"]):
                    for points, slack in ((shape["vertices"], 1.5), (shape["voxels"], 4.0)):
                        pixels = rooms.SIZE / 2 - target["focal"] * points[:, :2] / points[:, 2:]
                        around = torch.cat([pixels.min(0).values, pixels.max(0).values])
                        self.assertTrue(torch.allclose(around, box, atol=slack), f"{around} {box}")
                    rows, columns = mask.nonzero().unbind(1)
                    seen = torch.stack([columns.min(), rows.min(), columns.max() + 1, rows.max() + 1]).float()
                    self.assertTrue(torch.equal(seen, box))

    def test_a_flip_keeps_faces_outward(self) -> None:
        def volume(shape: dict[str, torch.Tensor]) -> float:
            a, b, c = shape["vertices"][shape["faces"]].unbind(1)
            return float((a * torch.linalg.cross(b, c)).sum() / 6)

        plain, mirrored = (self.shapes()[0, flip][1]["shapes"][0] for flip in (False, True))
        self.assertAlmostEqual(volume(plain), volume(mirrored), places=5)

    def test_voxels_are_scaled_and_turned_as_models_are(self) -> None:
        name = "chair_000"
        points, (vertices, _) = read_voxels(self.folder / f"model/{name}/voxel.mat"), read_obj(self.folder / f"model/{name}/model.obj")
        self.assertTrue(np.allclose(np.ptp(points, axis=0), np.ptp(vertices, axis=0), atol=0.08), np.ptp(points, axis=0))
        self.assertAlmostEqual(np.linalg.norm(points, axis=1).max(), 0.5, places=6)

    def test_voxels_of_scipys_files_are_turned_as_mesh_r_cnn_turns_them(self) -> None:
        voxel = np.zeros((6, 6, 6), dtype=np.uint8)
        voxel[1:4, 2, 0:5] = 1
        path = self.folder / "packed.mat"
        path.write_bytes(b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM" + base64.b64decode(PACKED))
        turned = np.rot90(voxel, k=3, axes=(1, 2))  # Mesh R-CNN's read_voxel
        cells = np.argwhere(turned > 0).astype(np.float64)
        cells -= (cells.max(0) + cells.min(0)) / 2
        expected = cells / (2 * np.linalg.norm(cells, axis=1).max())
        self.assertTrue(np.allclose(read_voxels(path), expected, atol=1e-6))

    def test_polygons_become_fans_and_negative_corners_count_back(self) -> None:
        path = self.folder / "quad.obj"
        path.write_text("v 0 0 0\nv 1 0 0\nvt 0 0\nv 1 1 0\nv 0 1 0\nf 1/1 2/1 3/1 4/1\nf -4 -3 -1\n")
        self.assertEqual(read_obj(path)[1].tolist(), [[0, 1, 2], [0, 2, 3], [0, 1, 3]])

    def test_objects_can_be_left_out_by_size(self) -> None:
        self.assertEqual([len(image["objects"]) for image in self.shapes().images], [1, 2])
        with self.assertRaisesRegex(DataError, "no image has an object"):
            self.shapes(min_pixels=1e6)

    def test_objects_that_leave_the_frustum_are_left_out_whatever_the_file_says(self) -> None:
        def changed(**change: object) -> list[int]:
            document = json.loads(self.file.read_text())
            document["annotations"][1] |= change
            (self.folder / "changed.json").write_text(json.dumps(document))
            kinds = [Shapes([self.folder / "changed.json"], Data(leaving=leaving)) for leaving in ("drop", "keep")]
            return [sum(len(image["objects"]) for image in kind.images) for kind in kinds]

        self.assertEqual(changed(), [3, 3])
        self.assertEqual(changed(leaves_frustum=False, meters_per_unit=1.2), [3, 3])
        self.assertEqual(changed(trans_mat=[0.7, 0.2, 2.2]), [2, 3])
        self.assertEqual(changed(trans_mat=[0.7, 0.2, 2.2], leaves_frustum=False), [2, 3])
        self.assertEqual(changed(leaves_frustum=True), [2, 3])
        # 2.2 units are nearer than 1 cm where a unit is 4 mm.
        self.assertEqual(changed(meters_per_unit=0.004), [2, 3])
        self.assertEqual(changed(iscrowd=1), [2, 2])
        with self.assertLogs("enfilade_training.shapes.data", "INFO") as told:
            changed(leaves_frustum=True)
        self.assertIn("changed.json: 1 objects leave the frustum and are left out, 2 stay", told.output[0])

    def test_pictures_are_turned_as_their_cameras_say(self) -> None:
        picture = Image.new("RGB", (8, 4))
        picture.putpixel((0, 0), (255, 0, 0))
        exif = Image.Exif()
        exif[274] = 6  # the camera was turned by a quarter
        picture.save(self.folder / "turned.png", exif=exif)
        found = read_image(self.folder / "turned.png")
        self.assertEqual((found.shape, found[:, 0, 3].tolist()), ((3, 8, 4), [1.0, 0.0, 0.0]))

    def test_broken_files_are_explained(self) -> None:
        with self.assertRaisesRegex(DataError, "cannot be read"):
            Shapes([self.folder / "nothing.json"], Data())
        (self.folder / "other.json").write_text("{}")
        with self.assertRaisesRegex(DataError, "is not Mesh R-CNN's JSON"):
            Shapes([self.folder / "other.json"], Data())
        document = json.loads(self.file.read_text())
        del document["annotations"][0]["K"]
        (self.folder / "other.json").write_text(json.dumps(document))
        with self.assertRaisesRegex(DataError, r"annotation 1 is not Mesh R-CNN's \(KeyError\('K'\)\)"):
            Shapes([self.folder / "other.json"], Data())
        (self.folder / "broken.obj").write_text("v 0 0 0\nf 1 2 3\n")
        with self.assertRaisesRegex(DataError, "some corners are missing"):
            read_obj(self.folder / "broken.obj")


class OrderTests(unittest.TestCase):
    def test_an_epoch_has_every_image_once(self) -> None:
        order = Order(12, 4, seed=3, flip=True)
        epochs = [sorted(i for b in range(3 * e, 3 * e + 3) for i, _ in order.batch(b)) for e in range(2)]
        self.assertEqual(epochs, [list(range(12))] * 2)
        self.assertNotEqual(order.batch(0), order.batch(3))
        self.assertEqual({flip for b in range(3) for _, flip in order.batch(b)}, {False, True})
        self.assertEqual({flip for b in range(3) for _, flip in Order(12, 4, 3, False).batch(b)}, {False})

    def test_replicas_share_the_batch_of_one(self) -> None:
        alone = Order(10, 6, 1, True).batch(4)
        shared = [Order(10, 6, 1, True, rank, 3).batch(4) for rank in range(3)]
        self.assertEqual(sum(shared, []), alone)
        with self.assertRaisesRegex(DataError, "6 images cannot be divided among 4"):
            Order(10, 6, 1, True, 0, 4)
