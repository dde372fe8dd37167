import math
import unittest

import torch

from enfilade_training.study import composition
from enfilade_training.study.pictures import VOID, Pictures


def picture(rows: list[list[int]], depth_m: list[float]) -> Pictures:
    """Rows of NYU40's classes from 0, each with one depth."""
    classes = torch.tensor([rows], dtype=torch.uint8)
    depth = torch.tensor(depth_m).half()[None, :, None].expand(1, len(rows), len(rows[0]))
    return Pictures(torch.zeros(1, 3, 1, 1, dtype=torch.uint8), classes, depth.contiguous(), ["a"])


class Compositions(unittest.TestCase):
    def test_shares_are_of_what_has_a_class_in_each_third(self) -> None:
        # NYU40's wall, floor and bed are the 12th, the 5th and the 1st of NYU13's classes.
        found = composition.composition(picture([[0, 0], [0, VOID], [1, 3]], [1.0, 2.0, 4.0]))[0].view(3, 14)
        self.assertEqual([float(found[i, 11]) for i in range(3)], [1.0, 1.0, 0.0])
        self.assertEqual((float(found[2, 4]), float(found[2, 0])), (0.5, 0.5))
        for third, depth_m in enumerate([1.0, 2.0, 4.0]):
            self.assertAlmostEqual(float(found[third, 13]), math.log(depth_m), places=6)

    def test_weights_meet_the_mean_and_are_no_more_different_than_that_takes(self) -> None:
        random = torch.Generator().manual_seed(3)
        found = torch.rand(4000, 3, generator=random, dtype=torch.double)
        wanted = torch.tensor([[0.6, 0.5, 0.5]], dtype=torch.double).expand(7, 3)
        weights = composition.weights(found, wanted)
        self.assertAlmostEqual(float(weights.sum()), 1.0, places=9)
        mean = weights @ found
        # What is asked for is met by 1 / (1 + RIDGE): variances of the scaled values are 1.
        self.assertAlmostEqual(float(mean[0]), 0.5 + 0.1 / (1.0 + composition.RIDGE), delta=0.01)
        self.assertAlmostEqual(float(mean[1]), 0.5, delta=0.01)
        self.assertGreater(1.0 / float(weights.square().sum()), 3500)
        # Those that are composed as asked for already weigh the same.
        same = composition.weights(found, found)
        self.assertLess(float((same * 4000 - 1.0).abs().max()), 1e-6)

    def test_each_is_drawn_as_often_as_its_share_says(self) -> None:
        drawn = composition.systematic(torch.tensor([0.45, 0.0, 0.35, 0.2, 0.0], dtype=torch.double))
        self.assertEqual(drawn.tolist(), [0, 0, 2, 2, 3])


if __name__ == "__main__":
    unittest.main()
