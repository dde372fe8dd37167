import json
import os
import tempfile
import unittest
from pathlib import Path

import enfilade
import numpy as np
import torch
from PIL import Image

from enfilade_training.study import homes, pictures
from enfilade_training.study.photographs import Photographs
from tests.study import nyu

SIZE = (120, 160)


class Windows(unittest.TestCase):
    def test_it_is_eigens_crop_at_every_size(self) -> None:
        self.assertEqual(pictures.window(240, 320), (slice(22, 236), slice(20, 300)))
        self.assertEqual(pictures.window(120, 160), (slice(11, 118), slice(10, 150)))
        with self.assertRaisesRegex(ValueError, "100 rows and 160 columns, expected a multiple of 120 and 160"):
            pictures.window(100, 160)


class Choices(unittest.TestCase):
    def test_as_many_as_asked_for_are_chosen_evenly(self) -> None:
        self.assertEqual(pictures.evenly(12, 3), [2, 6, 10])
        self.assertEqual(len(set(pictures.evenly(795, 16))), 16)
        self.assertEqual(pictures.evenly(2, 8), [0, 1])
        self.assertEqual(pictures.evenly(5, 0), [])


class Folders(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.nyu = nyu.write(self.folder / "nyu", train=2, test=1)

    def read(self) -> Photographs:
        return Photographs(self.nyu, SIZE, self.folder / "packed")

    def test_a_side_has_the_pictures_of_the_split_inside_of_the_frame(self) -> None:
        side = self.read().side("train")
        self.assertEqual(side.names, ["0001", "0002"])
        self.assertEqual((side.color.shape, side.classes40.shape, side.depth_m.shape), ((2, 3, 107, 140), (2, 214, 280), (2, 214, 280)))
        labels = np.array(Image.open(self.nyu / "label40" / "0002.png"))[22:236, 20:300]
        np.testing.assert_array_equal(side.classes40[1].numpy(), labels - 1)
        depth = np.array(Image.open(self.nyu / "depth_mm" / "0002.png"))[22:236, 20:300] / 1000.0
        np.testing.assert_allclose(side.depth_m[1].numpy(), depth, rtol=1e-3)
        color = np.array(Image.open(self.nyu / "rgb" / "0002.jpg"))[22:236, 20:300].astype(float)
        means = color.reshape(107, 2, 140, 2, 3).mean((1, 3)).transpose(2, 0, 1)
        self.assertLessEqual(np.abs(side.color[1].numpy() - means).max(), 1.0)

    def test_classes_are_nyu40s_from_zero_and_nyu13_follows(self) -> None:
        packed = pictures.pack([np.zeros((1, 4, 3), np.uint8)], [np.array([[0, 1, 40, 41]])], [np.array([[0.0, 2.0, np.nan, 11.0]])], ["a"])
        self.assertEqual(packed.classes("semantics40", 0).tolist(), [[pictures.VOID, 0, 39, pictures.VOID]])
        thirteen = [enfilade.NYU13_OF_NYU40[i] - 1 for i in (1, 40)]
        self.assertEqual(packed.classes("semantics", 0).tolist(), [[pictures.VOID, *thirteen, pictures.VOID]])
        # What is no number, or farther than 10 m, is no depth.
        self.assertEqual(packed.depth_m.tolist(), [[[0.0, 2.0, 0.0, 0.0]]])

    def test_they_are_packed_once_until_a_file_changes(self) -> None:
        first = self.read().side("test")
        path = self.folder / "packed" / "photographs-test.pt"
        written = path.stat().st_mtime_ns
        self.assertTrue(torch.equal(self.read().side("test").color, first.color))
        self.assertEqual(path.stat().st_mtime_ns, written)
        Image.fromarray(np.full((240, 320, 3), 7, np.uint8)).save(self.nyu / "rgb" / "0003.jpg")
        self.assertEqual(int(self.read().side("test").color.float().mean()), 7)

    def test_errors_name_the_file_and_what_was_expected(self) -> None:
        with self.assertRaisesRegex(FileNotFoundError, "nowhere: there is no such folder.*docs/real.md"):
            Photographs(self.folder / "nowhere", SIZE, self.folder)
        Image.fromarray(np.zeros((120, 160), np.uint8)).save(self.nyu / "label40" / "0001.png")
        with self.assertRaisesRegex(ValueError, "label40/0001.png: has 160x120 pixels, expected 320x240"):
            self.read().side("train")
        Image.fromarray(np.zeros((240, 320, 3), np.uint8)).save(self.nyu / "label40" / "0001.png")
        with self.assertRaisesRegex(ValueError, "label40/0001.png: is a picture of mode RGB, expected L or P"):
            self.read().side("train")
        (self.nyu / "label40" / "0001.png").unlink()
        with self.assertRaisesRegex(ValueError, "label40/0001.png: cannot be read .*split.json lists '0001'"):
            self.read()

    def test_splits_that_are_none_are_refused(self) -> None:
        for split, said in [({"train": ["0001"]}, "'test' is None"), ({"train": ["0001"], "test": ["0001"]}, "in both"), ({"train": ["../a"], "test": ["0003"]}, "'train' is"), ([], "'train' is")]:
            (self.nyu / "split.json").write_text(json.dumps(split))
            with self.assertRaisesRegex(ValueError, f"split.json: .*{said}"):
                self.read()


@unittest.skipUnless(os.environ.get("ENFILADE_REAL"), "ENFILADE_REAL names no folder of NYUv2's photographs")
class Real(unittest.TestCase):
    def test_the_photographs_have_the_published_split_and_both_sets_of_classes_agree(self) -> None:
        folder = Path(os.environ["ENFILADE_REAL"])
        with tempfile.TemporaryDirectory() as packed:
            photographs = Photographs(folder, SIZE, Path(packed))
        self.assertEqual({side: len(names) for side, names in photographs.split.items()}, {"train": 795, "test": 654})
        table = pictures.nyu13().numpy()
        for name in photographs.split["train"][::40] + photographs.split["test"][::40]:
            labels40, labels13 = (np.array(Image.open(folder / part / f"{name}.png")) for part in ("label40", "label13"))
            np.testing.assert_array_equal(table[labels40 - 1], labels13 - 1, err_msg=name)


class Homes(unittest.TestCase):
    def test_scenes_that_fail_are_told_and_left_out(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            folder, said = Path(name), []
            home = """[[scene]]\nname = "{}"\nhome = {{ seed = 1, rooms = ["toilet"], clutter = 0 }}\ncameras = ["{}"]\n"""
            (folder / "two.toml").write_text("frames = 1\n[render]\nsize = [160, 120]\nsamples = 1\n" + home.format("a", "toilet_1") + home.format("b", "nowhere"))
            there = homes.rendered(folder / "two.toml", folder, "*", said.append)
            self.assertEqual(there.failed, ("b",))
            self.assertIn("1 of 2 scenes failed, and are left out:\nb: ", said[0])
            self.assertEqual(homes.read(there, SIZE, folder).names, ["a.cam_00.0000"])
            with self.assertRaisesRegex(enfilade.StageError, "^b: "):
                homes.rendered(folder / "two.toml", folder, "b", said.append)

    def test_the_digest_is_of_what_the_file_says(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "homes.toml"
            file.write_text("frames = 3\n")
            first = homes.digest(file)
            file.write_text("# A comment.\nframes = 3\n")
            self.assertEqual(homes.digest(file), first)
            file.write_text("frames = 4\n")
            self.assertNotEqual(homes.digest(file), first)
            with self.assertRaisesRegex(ValueError, "other.toml: cannot be read"):
                homes.digest(Path(folder) / "other.toml")


if __name__ == "__main__":
    unittest.main()
