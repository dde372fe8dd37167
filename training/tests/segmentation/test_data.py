import dataclasses
import tempfile
import unittest
from pathlib import Path

import enfilade
import numpy as np
import torch
from PIL import Image

from enfilade_training.common.distributed import Replica
from enfilade_training.segmentation import data, evaluate
from enfilade_training.segmentation.config import Data
from tests import nyu_file
from tests.segmentation.homes import rendered
from tests.segmentation.images import CLASSES, config, write_pairs


class Sources(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_frames_of_enfilade_are_tone_mapped_and_their_classes_mapped(self) -> None:
        frames = enfilade.Dataset(rendered(), layers=["color", "semantic"], tone_map=True)
        forty, thirteen = (data.open_source(Data("enfilade", rendered()), classes) for classes in (40, 13))
        self.assertEqual((len(forty), thirteen.name(3)), (8, "home.cam_00.0003"))
        for i in range(8):
            expected = frames[i]
            for source in (forty, thirteen):
                image, classes = source[i]
                np.testing.assert_array_equal(image, expected["color"])
                self.assertEqual((image.dtype, classes.dtype), (np.uint8, np.int64))
            fine, coarse = forty[i][1], thirteen[i][1]
            np.testing.assert_array_equal(fine, np.where(expected["semantic"] >= 1, expected["semantic"] - 1, -1))
            of_nyu40 = np.array(enfilade.NYU13_OF_NYU40[1:] + (0,)) - 1
            np.testing.assert_array_equal(coarse, of_nyu40[fine])

    def test_nyuv2_has_its_split_and_its_classes(self) -> None:
        path, random = self.folder / "nyu.mat", np.random.default_rng(0)
        images = random.integers(0, 256, (9, 12, 16, 3), dtype=np.uint8)
        # 5 is "chair", 21 "wall", 11 "floor", 0 is no class.
        labels = random.choice(np.array([0, 5, 21, 11]), (9, 12, 16))
        nyu_file.write(path, images, labels)
        for split, frames in [("train", [3, 4, 5, 6, 7, 8]), ("test", [1, 2, 9])]:
            source = data.open_source(Data("nyuv2", path, split, partial=True), 13)
            self.assertEqual([source.name(i) for i in range(len(source))], [f"nyuv2.{frame:04}" for frame in frames])
            for i, frame in enumerate(frames):
                image, classes = source[i]
                np.testing.assert_array_equal(image, images[frame - 1])
                names = ["void", *enfilade.NYU13]
                of_label = {0: "void", 5: "chair", 21: "wall", 11: "floor"}
                expected = np.vectorize(lambda label: names.index(of_label[label]) - 1)(labels[frame - 1])
                np.testing.assert_array_equal(classes, expected)

    def test_pairs_are_read_and_other_values_are_no_class(self) -> None:
        write_pairs(self.folder, 2)
        source = data.open_source(Data("pairs", self.folder), CLASSES)
        _, classes = source[0]
        stored = np.array(Image.open(self.folder / "labels" / "000.png")).astype(int)
        np.testing.assert_array_equal(classes, stored - 1)
        self.assertEqual(set(classes[:, :2].ravel()), {data.VOID})
        _, fewer = data.open_source(Data("pairs", self.folder), 2)[0]
        np.testing.assert_array_equal(fewer, np.where(stored <= 2, stored - 1, data.VOID))
        _, from_zero = data.open_source(Data("pairs", self.folder, first_class=0), CLASSES + 1)[0]
        np.testing.assert_array_equal(from_zero, stored)

    def test_palettes_and_sixteen_bits_are_classes(self) -> None:
        write_pairs(self.folder, 1)
        path, values = self.folder / "labels" / "000.png", np.arange(40 * 48).reshape(40, 48) % 300
        Image.fromarray(values.astype(np.uint16)).save(path)
        _, classes = data.open_source(Data("pairs", self.folder, first_class=0), 300)[0]
        np.testing.assert_array_equal(classes, values)
        palette = Image.fromarray((values % 5).astype(np.uint8), mode="P")
        palette.putpalette([255, 0, 0, 0, 255, 0, 0, 0, 255, 9, 9, 9, 7, 7, 7])
        palette.save(path)
        _, classes = data.open_source(Data("pairs", self.folder, first_class=0), 5)[0]
        np.testing.assert_array_equal(classes, values % 5)

    def test_wrong_pairs_are_named(self) -> None:
        with self.assertRaisesRegex(FileNotFoundError, "images: there is no such folder"):
            data.open_source(Data("pairs", self.folder), CLASSES)
        write_pairs(self.folder, 2)
        label = self.folder / "labels" / "001.png"
        source = data.open_source(Data("pairs", self.folder), CLASSES)
        for wrong, said in [(Image.new("RGB", (48, 40)), "mode RGB, expected one channel"), (Image.new("L", (40, 48)), "48x40 pixels, its image 40x48")]:
            wrong.save(label)
            with self.assertRaisesRegex(ValueError, f"001.png: .*{said}"):
                source[1]
        label.write_bytes(b"nothing")
        with self.assertRaisesRegex(ValueError, "001.png: is no picture"):
            source[1]
        label.unlink()
        with self.assertRaisesRegex(FileNotFoundError, "001.png: there are no labels for 001.png"):
            data.open_source(Data("pairs", self.folder), CLASSES)

    def test_a_part_of_the_data_is_chosen_by_its_seed(self) -> None:
        write_pairs(self.folder, 9)
        whole = Data("pairs", self.folder)
        names = [[part.name(i) for i in range(len(part))] for part in (data.open_source(dataclasses.replace(whole, limit=4, subset_seed=seed), CLASSES) for seed in (1, 1, 2))]
        self.assertEqual((len(names[0]), names[0], names[0] == names[2]), (4, names[1], False))
        with self.assertRaisesRegex(ValueError, "limit is 10, but there are 9"):
            data.open_source(dataclasses.replace(whole, limit=10), CLASSES)

    def test_settings_that_fit_no_dataset_are_refused(self) -> None:
        for wrong in [{"kind": "nyuv2", "split": "val"}, {"kind": "pairs", "split": "train"}, {"kind": "pairs", "limit": 0}]:
            with self.assertRaises(ValueError):
                Data(path=self.folder, **wrong)
        with self.assertRaisesRegex(ValueError, "classes is 894, but enfilade has sets of 13, 40"):
            dataclasses.replace(config(self.folder), train_data=Data("enfilade", self.folder), classes=894)


class Batches(unittest.TestCase):
    def test_every_image_comes_once_in_another_order_each_epoch(self) -> None:
        epochs = [data.batches(5, epoch, 20, 4, True) for epoch in range(3)]
        for found in epochs:
            self.assertEqual(sorted(sum(found, [])), list(range(20)))
        self.assertEqual(len({str(found) for found in epochs}), 3)
        self.assertEqual(epochs[1], data.batches(5, 1, 20, 4, True))
        self.assertNotEqual(epochs[1], data.batches(6, 1, 20, 4, True))

    def test_what_fills_no_batch_is_dropped_or_filled_up(self) -> None:
        self.assertEqual([len(batch) for batch in data.batches(0, 0, 795, 64, True)], [64] * 12)
        filled = data.batches(0, 0, 795, 64, False)
        self.assertEqual(([len(batch) for batch in filled], set(sum(filled, []))), ([64] * 13, set(range(795))))
        self.assertEqual([len(batch) for batch in data.batches(0, 0, 3, 8, False)], [8])
        with self.assertRaisesRegex(ValueError, "there are 3 images, but a batch has 8"):
            data.batches(0, 0, 3, 8, True)


class Judging(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        write_pairs(self.folder, 5)
        write_pairs(self.folder, 1, size=(24, 56), seed=9)

    def test_scores_are_those_of_all_labelled_pixels_whatever_the_images_sizes(self) -> None:
        settings = config(self.folder)
        source = data.open_source(settings.train_data, CLASSES)

        class Constant(torch.nn.Module):
            def forward(self, images: torch.Tensor) -> torch.Tensor:
                return torch.tensor([0.0, 1.0, 0.0, 0.0]).view(1, 4, 1, 1).expand(len(images), 4, *images.shape[2:])

        found = evaluate.evaluate(Constant(), source, settings, Replica(0, 1, torch.device("cpu")))
        truth = np.concatenate([source[i][1].ravel() for i in range(len(source))])
        labelled = truth[truth >= 0]
        self.assertEqual(found.pixels, len(labelled))
        share = float(np.mean(labelled == 1))
        self.assertAlmostEqual(found.pixel_accuracy, share)
        self.assertAlmostEqual(found.mean_iou, share / 4)

    def test_colours_tell_classes_apart_and_void_is_black(self) -> None:
        for classes in (4, 13, 40):
            palette = evaluate.palette(classes)
            self.assertEqual((palette.shape, len({tuple(color) for color in palette.tolist()})), ((classes, 3), classes))
        np.testing.assert_array_equal(evaluate.palette(13)[11], enfilade.NYU40_COLORS[0])
        shown = evaluate.colored(np.array([[0, -1, 99]]), 4)
        self.assertEqual((shown.dtype, shown[0, 1].tolist(), shown[0, 2].tolist()), (np.uint8, [0, 0, 0], [0, 0, 0]))


if __name__ == "__main__":
    unittest.main()
