import dataclasses
import unittest

import numpy as np
import torch
from torchvision.transforms import v2

from enfilade_training.segmentation import augment
from enfilade_training.segmentation.augment import Draw
from enfilade_training.segmentation.config import Augment

PAPER = Augment()
DRAWS = 4000


def draws(config: Augment = PAPER, height: int = 480, width: int = 640, count: int = DRAWS) -> list[Draw]:
    return [augment.draw(augment.generator(1, 0, i), config, height, width) for i in range(count)]


def flat(color: tuple[int, int, int]) -> torch.Tensor:
    return torch.tensor(color, dtype=torch.uint8).view(3, 1, 1).expand(3, 4, 4).contiguous()


class Drawing(unittest.TestCase):
    def test_it_is_a_function_of_seed_epoch_and_place(self) -> None:
        def one(*place: int) -> Draw:
            return augment.draw(augment.generator(*place), PAPER, 480, 640)

        self.assertEqual(one(1, 2, 3), one(1, 2, 3))
        self.assertEqual(len({one(s, e, i) for s in range(3) for e in range(3) for i in range(3)}), 27)

    def test_crops_are_those_of_the_recipe(self) -> None:
        found = np.array([d.crop for d in draws()], dtype=float)
        top, left, height, width = found.T
        self.assertTrue((top >= 0).all() and (left >= 0).all() and (top + height <= 480).all() and (left + width <= 640).all())
        share, ratio = height * width / (480 * 640), width / height
        # Sides are whole pixels.
        self.assertTrue(share.min() > 0.079 and share.max() <= 1.0)
        self.assertTrue(ratio.min() > 0.74 and ratio.max() < 1.35)
        self.assertTrue(share.min() < 0.1 and share.max() > 0.95 and ratio.min() < 0.77 and ratio.max() > 1.31)

    def test_crops_are_distributed_as_torchvisions(self) -> None:
        torch.manual_seed(0)
        transform = v2.RandomResizedCrop(512, scale=PAPER.scale, ratio=PAPER.ratio)
        image = torch.zeros(3, 480, 640, dtype=torch.uint8)
        theirs = [transform.make_params([image]) if hasattr(transform, "make_params") else transform._get_params([image]) for _ in range(DRAWS)]
        reference = np.array([[p["top"], p["left"], p["height"], p["width"]] for p in theirs], dtype=float)
        ours = np.array([d.crop for d in draws()], dtype=float)
        for column in range(4):
            # Two-sample Kolmogorov-Smirnov: 1.95 sqrt(2 / n) is the bound of one in a thousand.
            both = np.sort(np.concatenate([ours[:, column], reference[:, column]]))
            a, b = (np.searchsorted(np.sort(sample[:, column]), both, side="right") / DRAWS for sample in (ours, reference))
            self.assertLess(np.abs(a - b).max(), 1.95 * (2 / DRAWS) ** 0.5)

    def test_images_that_are_too_long_are_cropped_in_the_middle(self) -> None:
        thin = Augment(scale=(1.0, 1.0))
        self.assertEqual(augment.draw(augment.generator(0, 0, 0), thin, 100, 1000).crop, (0, (1000 - 133) // 2, 100, 133))
        self.assertEqual(augment.draw(augment.generator(0, 0, 0), thin, 1000, 90).crop, ((1000 - 120) // 2, 0, 120, 90))

    def test_half_of_the_images_are_flipped(self) -> None:
        self.assertAlmostEqual(np.mean([d.flip for d in draws()]), 0.5, delta=4 * 0.5 / DRAWS**0.5)

    def test_each_factor_is_changed_with_its_own_probability_and_within_its_bounds(self) -> None:
        found = draws()
        bound = 4 * 0.5 / DRAWS**0.5
        for name, low, high in [("hue", -0.375, 0.375), ("saturation", 0.25, 1.75), ("brightness", 0.25, 1.75)]:
            values = np.array([value for d in found for key, value in d.jitter if key == name])
            self.assertAlmostEqual(len(values) / DRAWS, 0.5, delta=bound)
            self.assertTrue(low <= values.min() < low + 0.02 and high - 0.02 < values.max() <= high)
        both = np.mean([{"hue", "brightness"} <= {key for key, _ in d.jitter} for d in found])
        self.assertAlmostEqual(both, 0.25, delta=bound)
        # Their order is drawn too.
        firsts = [d.jitter[0][0] for d in found if len(d.jitter) == 3]
        self.assertEqual(set(firsts), {"hue", "saturation", "brightness"})

    def test_all_factors_may_be_changed_together(self) -> None:
        counts = [len(d.jitter) for d in draws(dataclasses.replace(PAPER, jitter_per_factor=False))]
        self.assertEqual(set(counts), {0, 3})
        self.assertAlmostEqual(np.mean(np.array(counts) == 3), 0.5, delta=4 * 0.5 / DRAWS**0.5)


class Applying(unittest.TestCase):
    def test_without_a_change_the_image_stays(self) -> None:
        image = torch.randint(0, 256, (3, 24, 32), dtype=torch.uint8)
        classes = torch.randint(-1, 13, (24, 32))
        same = augment.apply(Draw((0, 0, 24, 32), False, ()), (24, 32), image, classes)
        self.assertTrue(torch.equal(same[0], image) and torch.equal(same[1], classes))
        flipped = augment.apply(Draw((0, 0, 24, 32), True, ()), (24, 32), image, classes)
        self.assertTrue(torch.equal(flipped[0], image.flip(-1)) and torch.equal(flipped[1], classes.flip(-1)))

    def test_image_and_classes_stay_together(self) -> None:
        # Blocks of 8 x 8 pixels whose colour is their class; away from their borders both must agree.
        classes = torch.arange(12).view(3, 4).repeat_interleave(8, 0).repeat_interleave(8, 1)
        image = (classes * 20).to(torch.uint8).expand(3, 24, 32)
        for i in range(50):
            drawn = dataclasses.replace(augment.draw(augment.generator(2, 0, i), PAPER, 24, 32), jitter=())
            seen, found = augment.apply(drawn, (64, 64), image, classes)
            self.assertEqual((seen.shape, found.shape, seen.dtype, found.dtype), ((3, 64, 64), (64, 64), torch.uint8, torch.int64))
            self.assertTrue(set(found.unique().tolist()) <= set(range(12)))
            agree = (seen[0].float() / 20 - found).abs() < 0.1
            self.assertGreater(float(agree.float().mean()), 0.5)
            distance = (seen[0].float() / 20 - found).abs()
            # Interpolation mixes neighbours; nowhere does a class lie off the colours around it.
            self.assertLessEqual(float(distance.max()), 5.0)

    def test_labels_and_void_are_never_mixed(self) -> None:
        classes = torch.where(torch.rand(24, 32, generator=torch.Generator().manual_seed(0)) < 0.5, -1, 893)
        image = torch.zeros(3, 24, 32, dtype=torch.uint8)
        found = augment.apply(Draw((3, 5, 13, 17), True, ()), (40, 40), image, classes)[1]
        self.assertEqual(set(found.unique().tolist()), {-1, 893})

    def test_known_changes_of_colour(self) -> None:
        def changed(name: str, value: float, color: tuple[int, int, int]) -> list[int]:
            drawn = Draw((0, 0, 4, 4), False, ((name, value),))
            return augment.apply(drawn, (4, 4), flat(color), torch.zeros(4, 4, dtype=torch.int64))[0][:, 0, 0].tolist()

        self.assertEqual(changed("brightness", 0.5, (200, 100, 40)), [100, 50, 20])
        self.assertEqual(changed("brightness", 1.75, (200, 100, 40)), [255, 175, 70])
        self.assertEqual(changed("hue", 1 / 3, (255, 0, 0)), [0, 255, 0])
        self.assertEqual(changed("hue", -1 / 3, (255, 0, 0)), [0, 0, 255])
        grey = changed("saturation", 0.0, (200, 100, 40))
        # ITU-R 601 luma.
        self.assertTrue(all(abs(v - (0.2989 * 200 + 0.587 * 100 + 0.114 * 40)) <= 1 for v in grey))
        self.assertEqual(changed("saturation", 1.75, (90, 90, 90)), [90, 90, 90])


if __name__ == "__main__":
    unittest.main()
