import unittest

import enfilade
import numpy as np

from enfilade_training.study import scores


class Classes(unittest.TestCase):
    def test_scores_are_the_modules_of_all_pixels_together(self) -> None:
        random = np.random.default_rng(0)
        images, whole = [], enfilade.Confusion(5)
        for _ in range(6):
            truth = random.integers(0, 4, (20, 20))  # Class 4 occurs nowhere.
            found = np.where(random.random((20, 20)) < 0.6, truth, random.integers(0, 4, (20, 20)))
            one = enfilade.Confusion(5)
            one.add(found, truth)
            whole.merge(one)
            images.append(scores.class_sums(np.array(one.counts)))
        found_scores = scores.total("semantics", np.stack(images))
        self.assertAlmostEqual(found_scores["mean_iou"], whole.mean_iou)
        self.assertAlmostEqual(found_scores["pixel_accuracy"], whole.pixel_accuracy)

    def test_a_case_by_hand(self) -> None:
        # Of 4 pixels of class 0 three are right, of 2 of class 1 both: IoU of 3 / 4 and 2 / 3.
        images = scores.class_sums(np.array([[3, 1], [0, 2]]))[None]
        self.assertEqual(images[0].tolist(), [[3, 2], [4, 2], [3, 3]])
        self.assertAlmostEqual(scores.total("semantics", images)["mean_iou"], (3 / 4 + 2 / 3) / 2)
        self.assertAlmostEqual(scores.total("semantics", images)["pixel_accuracy"], 5 / 6)


class Depths(unittest.TestCase):
    def test_a_case_by_hand(self) -> None:
        truth, found = np.array([[2.0, 4.0], [0.0, 11.0]]), np.array([[3.0, 4.0], [5.0, 5.0]])
        values = dict(zip(scores.DEPTH_SCORES, scores.depth_scores(found, truth)))
        # Two pixels count: 3 for 2, and 4 for 4.
        self.assertAlmostEqual(values["abs_rel"], 0.25)
        self.assertAlmostEqual(values["delta1"], 0.5)
        self.assertAlmostEqual(values["rmse_m"], np.sqrt(0.5))
        # A line goes through two points.
        self.assertAlmostEqual(values["rmse_m_aligned"], 0.0)
        self.assertAlmostEqual(values["delta1_aligned"], 1.0)

    def test_scale_and_shift_are_those_of_least_squares(self) -> None:
        random = np.random.default_rng(1)
        found = random.uniform(1, 5, 50)
        truth = 0.5 * found + 1.5 + random.normal(0, 0.1, 50)
        np.testing.assert_allclose(scores.aligned(found, truth), np.polyfit(found, truth, 1))
        # Where everything is as far, the mean is all that can be told.
        self.assertEqual(scores.aligned(np.full(3, 2.0), np.array([1.0, 2.0, 6.0])), (0.0, 3.0))

    def test_depths_are_capped(self) -> None:
        values = scores.depth_scores(np.array([50.0, -1.0]), np.array([10.0, 1.0]))
        self.assertAlmostEqual(values[0], (0.0 + 0.999) / 2)

    def test_images_without_truth_do_not_count(self) -> None:
        nothing = scores.depth_scores(np.ones((2, 2)), np.zeros((2, 2)))
        one = scores.depth_scores(np.full((2, 2), 2.0), np.ones((2, 2)))
        self.assertAlmostEqual(scores.total("depth", np.stack([nothing, one]))["abs_rel"], 1.0)


class Bootstrap(unittest.TestCase):
    def images(self, values: np.ndarray) -> np.ndarray:
        return np.repeat(values[:, None], len(scores.DEPTH_SCORES), axis=1)

    def test_the_interval_of_a_mean_is_the_normal_one(self) -> None:
        random = np.random.default_rng(0)
        gains = random.normal(0.3, 1.0, 400)
        noise = random.normal(0.0, 50.0, 400)
        found = scores.differences("depth", [self.images(noise + gains)], [self.images(noise)], 4000)["abs_rel"]
        half = 1.96 * gains.std() / 20
        # What both have in common drops out, however large it is.
        self.assertAlmostEqual(found.mean, gains.mean())
        self.assertAlmostEqual(found.low, gains.mean() - half, delta=0.1 * half)
        self.assertAlmostEqual(found.high, gains.mean() + half, delta=0.1 * half)

    def test_seeds_are_drawn_too(self) -> None:
        zero = self.images(np.zeros(10))
        arm = [self.images(np.full(10, value)) for value in (1.0, 2.0, 6.0)]
        found = scores.differences("depth", arm, [zero] * 3, 4000)["abs_rel"]
        self.assertAlmostEqual(found.mean, 3.0)
        # One in 27 draws is three times the same seed.
        self.assertEqual((found.low, found.high), (1.0, 6.0))


if __name__ == "__main__":
    unittest.main()
