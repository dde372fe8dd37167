import pickle
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import enfilade
import numpy as np

import nyu_file

HEIGHT, WIDTH = 24, 32


def first_color(dataset):
    return dataset[0]["color"]


class NyuV2(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "nyu_depth_v2_labeled.mat"

    def make(self, count=5, **options):
        made = nyu_file.arrays(count, HEIGHT, WIDTH)
        nyu_file.write(self.path, *made, **options)
        return made

    def open(self, **options):
        return enfilade.NyuV2(self.path, partial=True, **options)

    def check(self, dataset, color, depth, labels):
        self.assertEqual(len(dataset), len(color))
        for i, sample in enumerate(dataset[i] for i in range(len(dataset))):
            np.testing.assert_array_equal(sample["color"], color[i])
            np.testing.assert_array_equal(sample["depth_z_meters"], depth[i])
            expected = labels[i].astype(np.int16)
            np.testing.assert_array_equal(sample["semantic"], np.where(expected == 0, -1, expected))
            self.assertEqual([sample[name].dtype for name in ("color", "depth_z_meters", "semantic")], [np.uint8, np.float32, np.int16])
            self.assertEqual((sample["scene"], sample["frame"], sample["index"]), (nyu_file.SCENES[i % 5], i + 1, i))
            self.assertTrue(sample["mask"].all())

    def test_samples_are_upright_whatever_the_storage(self):
        cases = [
            {},
            {"chunks": (16, 12)},
            {"chunks": (7, 24)},
            {"chunks": (32, 24), "shuffle": True},
            {"compression": None},
            {"userblock": 0},
            {"userblock": 1024},
            {"more_groups": 100},
            {"libver": "earliest"},
        ]
        for options in cases:
            with self.subTest(**options):
                self.path.unlink(missing_ok=True)
                made = self.make(**options)
                self.check(self.open(classes=894), *made)

    def test_chunks_of_several_images_are_cut(self):
        made = nyu_file.arrays(40, HEIGHT, WIDTH)
        nyu_file.write(self.path, *made)
        import h5py

        with h5py.File(self.path) as file:
            self.assertGreater(file["labels"].chunks[0], 1)
        self.check(self.open(classes=894), *made)

    def test_classes_are_mapped_by_the_published_tables(self):
        _, _, labels = self.make()
        fine, forty, thirteen = (np.stack([sample["semantic"] for sample in self.open(classes=n)]) for n in (894, 40, 13))
        self.assertEqual((forty.min(), forty.max(), thirteen.min(), thirteen.max()), (-1, 40, -1, 13))
        np.testing.assert_array_equal(fine == -1, labels == 0)
        for mapped in (forty, thirteen):
            np.testing.assert_array_equal(mapped == -1, labels == 0)
        of_nyu40 = np.array(enfilade.NYU13_OF_NYU40)
        np.testing.assert_array_equal(thirteen, np.where(forty >= 1, of_nyu40[np.maximum(forty, 0)], -1))
        names = self.open(classes=894).class_names
        self.assertEqual((len(names), names[4], names[20]), (894, "chair", "wall"))
        self.assertEqual(set(forty[labels == 5]) | {5}, {5})
        self.assertEqual(set(forty[labels == 21]) | {1}, {1})
        self.assertEqual((enfilade.NYU40[4], enfilade.NYU13[3], of_nyu40[5]), ("chair", "chair", 4))
        self.assertEqual((len(enfilade.NYU40), len(enfilade.NYU13), len(enfilade.NYU40_COLORS)), (40, 13, 40))

    def test_the_split_is_the_published_one(self):
        self.make(count=16, chunks=(32, 24))
        frames = {side: [sample["frame"] for sample in self.open(split=side)] for side in ("train", "test")}
        self.assertEqual(frames["test"], [1, 2, 9, 14, 15, 16])
        self.assertEqual(frames["train"], [3, 4, 5, 6, 7, 8, 10, 11, 12, 13])
        part = self.open(split="test")
        self.assertEqual([part.frame(i) for i in (2, -1)], [9, 16])

    def test_the_whole_file_has_795_and_654_images(self):
        color = np.zeros((1449, 2, 2, 3), dtype=np.uint8)
        color[:, 0, 0, 0] = np.arange(1449) % 256
        nyu_file.write(self.path, color, np.ones((1449, 2, 2), dtype=np.float32), np.ones((1449, 2, 2), dtype=np.uint16))
        sides = [enfilade.NyuV2(self.path, split=side) for side in ("train", "test", None)]
        self.assertEqual([len(side) for side in sides], [795, 654, 1449])
        for side in sides:
            for i in (0, len(side) // 2, len(side) - 1):
                self.assertEqual(side[i]["color"][0, 0, 0], (side.frame(i) - 1) % 256)

    def test_layers_can_be_chosen(self):
        self.make()
        dataset = self.open(layers=["semantic"])
        self.assertEqual(dataset.layers, ["semantic"])
        self.assertNotIn("color", dataset[0])

    def test_several_samples_are_those_one_by_one(self):
        color, _, _ = self.make()
        dataset = self.open()
        for index, sample in zip([4, 0, -1], dataset.__getitems__([4, 0, -1])):
            np.testing.assert_array_equal(sample["color"], color[index])

    def test_a_subclass_gives_its_own_samples_in_batches_too(self):
        class Named(enfilade.NyuV2):
            def __getitem__(self, index):
                return super().__getitem__(index) | {"name": f"image {self.frame(index)}"}

        self.make()
        self.assertEqual([sample["name"] for sample in Named(self.path, partial=True).__getitems__([4, -5])], ["image 5", "image 1"])

    def test_threads_and_processes_read_at_the_same_time(self):
        color, _, _ = self.make(chunks=(16, 12))
        dataset = self.open()
        with ThreadPoolExecutor(4) as pool:
            for i, sample in enumerate(pool.map(dataset.__getitem__, [i % 5 for i in range(40)])):
                np.testing.assert_array_equal(sample["color"], color[i % 5])
        for method in ("fork", "spawn"):
            with get_context(method).Pool(2) as pool:
                for found in pool.map(first_color, [dataset] * 4):
                    np.testing.assert_array_equal(found, color[0])

    def test_it_can_be_pickled(self):
        self.make()
        dataset = self.open(split="train", classes=13, layers="semantic")
        again = pickle.loads(pickle.dumps(dataset))
        self.assertEqual(repr(again), repr(dataset))
        np.testing.assert_array_equal(again[0]["semantic"], dataset[0]["semantic"])

    def test_wrong_arguments_and_files_are_named(self):
        self.make()
        cases = [
            ({}, ValueError, "5 images, expected the 1449 that are published"),
            ({"partial": True, "classes": 14}, ValueError, "classes is 14; expected 894, 40 or 13"),
            ({"partial": True, "split": "val"}, ValueError, "expected \"train\" or \"test\""),
            ({"partial": True, "layers": ["normal_cam"]}, ValueError, "it has color, depth_z_meters and semantic"),
        ]
        for options, error, said in cases:
            with self.assertRaisesRegex(error, said):
                enfilade.NyuV2(self.path, **options)
        with self.assertRaisesRegex(IndexError, "index 5 of a dataset of 5"):
            self.open()[5]
        with self.assertRaises(FileNotFoundError):
            enfilade.NyuV2(self.path.with_name("nothing.mat"))

    def test_files_of_another_form_are_refused_with_what_to_do(self):
        color, depth, labels = nyu_file.arrays(3, HEIGHT, WIDTH)
        cases = [
            ({"libver": "latest"}, enfilade.DamagedFileError, "superblock of version .*, expected 0 or 1"),
            ({"compression": "lzf"}, enfilade.DamagedFileError, "filters .*expected deflate"),
        ]
        for options, error, said in cases:
            self.path.unlink(missing_ok=True)
            if options.get("compression") == "lzf":
                import h5py

                nyu_file.write(self.path, color, depth, labels)
                with h5py.File(self.path, "a") as file:
                    del file["images"]
                    file.create_dataset("images", data=color.transpose(0, 3, 2, 1), compression="lzf")
            else:
                nyu_file.write(self.path, color, depth, labels, **options)
            with self.assertRaisesRegex(error, said):
                self.open()
        self.path.unlink()
        nyu_file.write(self.path, color, depth, labels[..., None].repeat(2, -1)[..., 0][:2])
        with self.assertRaisesRegex(ValueError, "semantic has .* other layers have"):
            self.open()
        self.path.unlink()
        nyu_file.write(self.path, color, depth.astype(np.float64), labels)
        with self.assertRaisesRegex(ValueError, "\"depths\" is F64 .* expected F32"):
            self.open()
        self.path.write_bytes(b"MATLAB 5.0 MAT-file" * 100)
        with self.assertRaisesRegex(enfilade.DamagedFileError, "holds no HDF5"):
            self.open()

    def test_damage_is_an_error_and_never_a_crash(self):
        self.make(chunks=(16, 12))
        whole = self.path.read_bytes()
        for length in range(0, len(whole), 397):
            self.path.write_bytes(whole[:length])
            with self.assertRaises((enfilade.DamagedFileError, ValueError)):
                [sample for sample in self.open()]
        for at in [*range(512, 4000, 7), *range(4000, len(whole), 301)]:
            altered = bytearray(whole)
            altered[at] ^= 0xFF
            self.path.write_bytes(altered)
            try:
                [sample for sample in self.open()]
            except (enfilade.DamagedFileError, ValueError):
                pass


if __name__ == "__main__":
    unittest.main()
