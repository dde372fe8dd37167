import unittest

import numpy as np
import torch

from enfilade_training.segmentation.config import Augment
from enfilade_training.study import batches, camera
from enfilade_training.study.config import Camera
from enfilade_training.study.pictures import pack


class Photographed(unittest.TestCase):
    def setUp(self) -> None:
        random = np.random.default_rng(0)
        self.color = (random.integers(40, 200, (48, 64, 3)) * [1.0, 0.8, 0.5]).astype(np.uint8)
        self.frame = torch.from_numpy(self.color.transpose(2, 0, 1).copy())

    def taken(self, config: Camera, epoch: int = 0) -> np.ndarray:
        return camera.photographed(config, camera.generator(0, epoch, 0), self.frame).numpy()

    def test_a_camera_that_does_nothing_leaves_frames(self) -> None:
        np.testing.assert_allclose(self.taken(Camera()), self.frame.numpy(), atol=1e-4)

    def test_a_full_balance_makes_the_mean_grey(self) -> None:
        means = self.taken(Camera(white_balance=(1.0, 1.0))).mean((1, 2))
        luma = float(np.dot([0.299, 0.587, 0.114], self.frame.numpy().mean((1, 2))))
        np.testing.assert_allclose(means, luma, rtol=2e-2)

    def test_the_curve_is_a_power_of_what_the_gain_gives(self) -> None:
        expected = 255.0 * np.clip(1.2 * self.frame.numpy() / 255.0, 0, 1) ** 1.8
        np.testing.assert_allclose(self.taken(Camera(tone=(1.8, 1.8), gain=(1.2, 1.2))), expected, atol=1e-3)

    def test_sharpening_leaves_flat_pictures_and_noise_has_its_deviation(self) -> None:
        self.frame = torch.full((3, 48, 64), 100, dtype=torch.uint8)
        np.testing.assert_allclose(self.taken(Camera(sharpening=(2.0, 2.0))), 100.0, atol=1e-3)
        self.assertAlmostEqual(self.taken(Camera(noise=(0.02, 0.02))).std() / 255.0, 0.02, delta=1e-3)

    def test_what_is_drawn_depends_on_the_epoch_and_not_on_the_batch(self) -> None:
        config = Camera(tone=(1.0, 2.0), noise=(0.0, 0.1))
        np.testing.assert_array_equal(self.taken(config), self.taken(config))
        self.assertGreater(np.abs(self.taken(config) - self.taken(config, 1)).max(), 1.0)
        pictures = pack([self.color], [np.ones((48, 64), np.int16)], [np.ones((48, 64))], ["a"])
        still = Augment(size=(48, 64), scale=(1.0, 1.0), ratio=(4 / 3, 4 / 3), flip=0.0, jitter=0.0)
        image = batches.batch(pictures, [(0, 0)], 0, still, ("semantics",), config)[0][0].numpy()
        np.testing.assert_allclose(255.0 * image, self.taken(config), atol=1e-3)

    def test_bounds_that_are_none_are_refused(self) -> None:
        with self.assertRaisesRegex(ValueError, "tone is .2.0, 1.0., expected two numbers"):
            Camera(tone=(2.0, 1.0))


if __name__ == "__main__":
    unittest.main()
