import math
import unittest

import enfilade
import numpy as np
import torch
from torchvision.transforms.v2 import functional as T

from enfilade_training.segmentation.config import Augment
from enfilade_training.study import batches
from enfilade_training.study.pictures import pack

STILL = Augment(size=(64, 96), scale=(1.0, 1.0), ratio=(1.5, 1.5), flip=0.0, jitter=0.0)
TASKS = ("semantics", "semantics40", "depth")


class Places(unittest.TestCase):
    def test_every_epoch_has_every_picture_once(self) -> None:
        found = [place for step in range(14) for place in batches.places(3, step, 4, 7)]
        self.assertEqual(len(found), 14 * 4)
        for epoch in range(8):
            self.assertEqual(sorted(index for e, index in found if e == epoch), list(range(7)))
        self.assertEqual([epoch for epoch, _ in found], sorted(epoch for epoch, _ in found))

    def test_a_batch_may_be_larger_than_the_pictures(self) -> None:
        self.assertEqual([epoch for epoch, _ in batches.places(0, 0, 5, 2)], [0, 0, 1, 1, 2])


class Batches(unittest.TestCase):
    def setUp(self) -> None:
        random = np.random.default_rng(0)
        self.color = random.integers(0, 256, (64, 96, 3), dtype=np.uint8)
        self.labels = np.repeat(np.repeat(random.integers(0, 41, (32, 48)), 4, 0), 4, 1)
        self.depth = np.linspace(1.0, 3.0, 128)[:, None] + np.linspace(0.0, 2.0, 192)
        self.pictures = pack([self.color], [self.labels], [self.depth], ["a"])

    def batch(self, config: Augment, epoch: int = 0) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        images, truths = batches.batch(self.pictures, [(epoch, 0)], 0, config, TASKS)
        return images[0].numpy(), {task: values[0].numpy() for task, values in truths.items()}

    def test_a_whole_picture_is_itself_and_its_truth_lies_where_it_is_predicted(self) -> None:
        image, truths = self.batch(STILL)
        np.testing.assert_allclose(image, self.color.transpose(2, 0, 1) / 255.0, atol=1e-6)
        known = np.where(self.labels[::4, ::4] > 0, self.labels[::4, ::4] - 1, 255)
        np.testing.assert_array_equal(truths["semantics40"], known)
        thirteen = np.array([enfilade.NYU13_OF_NYU40[i + 1] - 1 for i in range(40)])
        np.testing.assert_array_equal(truths["semantics"][known < 255], thirteen[known[known < 255]])
        # The centre of a pixel of half the size lies between labels; the next one counts.
        np.testing.assert_allclose(truths["depth"], self.depth[2::4, 2::4], rtol=1e-3)

    def test_mirrored_pictures_have_mirrored_truth(self) -> None:
        image, truths = self.batch(Augment(size=(64, 96), scale=(1.0, 1.0), ratio=(1.5, 1.5), flip=1.0, jitter=0.0))
        np.testing.assert_allclose(image[:, :, ::-1], self.color.transpose(2, 0, 1) / 255.0, atol=1e-6)
        np.testing.assert_array_equal(truths["semantics40"][:, ::-1], self.batch(STILL)[1]["semantics40"])

    def test_what_is_enlarged_is_nearer(self) -> None:
        self.pictures = pack([self.color], [self.labels], [np.full((128, 192), 3.0)], ["a"])
        quarter = Augment(size=(64, 96), scale=(0.25, 0.25), ratio=(1.5, 1.5), jitter=0.0)
        np.testing.assert_allclose(self.batch(quarter)[1]["depth"], 3.0 / 2.0, rtol=1e-3)

    def test_what_is_drawn_depends_on_seed_epoch_and_place_alone(self) -> None:
        config = Augment(size=(32, 32))
        both, _ = batches.batch(self.pictures, [(1, 0), (2, 0)], 0, config, TASKS)
        np.testing.assert_array_equal(self.batch(config, 2)[0], both[1].numpy())
        self.assertFalse(torch.equal(both[0], both[1]))


class Colors(unittest.TestCase):
    def test_saturation_and_brightness_are_torchvisions(self) -> None:
        image = 0.2 + 0.5 * torch.rand(3, 8, 8, generator=torch.Generator().manual_seed(0))
        for name, theirs in (("saturation", T.adjust_saturation), ("brightness", T.adjust_brightness)):
            matrix = torch.from_numpy(batches.color_matrix(((name, 0.7),))).float()
            torch.testing.assert_close((matrix @ image.flatten(1)).view(3, 8, 8), theirs(image, 0.7), atol=2e-3, rtol=0)

    def test_hue_keeps_greys_and_brightness_and_goes_around(self) -> None:
        turned = batches.color_matrix((("hue", 0.3),))
        np.testing.assert_allclose(turned @ np.ones(3), np.ones(3), atol=5e-3)
        np.testing.assert_allclose(batches.YIQ[0] @ turned, batches.YIQ[0], atol=1e-9)
        np.testing.assert_allclose(np.linalg.matrix_power(batches.color_matrix((("hue", 0.25),)), 4), np.eye(3), atol=1e-9)

    def test_changes_are_made_in_their_order(self) -> None:
        both = batches.color_matrix((("hue", 0.1), ("saturation", 0.5)))
        np.testing.assert_allclose(both, batches.color_matrix((("saturation", 0.5),)) @ batches.color_matrix((("hue", 0.1),)))
        self.assertTrue(math.isclose(batches.color_matrix(())[0, 0], 1.0))


if __name__ == "__main__":
    unittest.main()
