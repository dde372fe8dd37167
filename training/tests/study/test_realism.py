import tempfile
import unittest
from pathlib import Path

import numpy as np
import torch
from PIL import Image

from enfilade_training.study import realism


class KernelDistances(unittest.TestCase):
    def test_the_same_distribution_is_near_and_another_is_far(self) -> None:
        random = torch.Generator().manual_seed(2)
        a, b = (torch.randn(400, 16, generator=random) for _ in range(2))
        same, error = realism.kernel_distance(a, b)
        self.assertLess(abs(same), 5 * error + 0.06)
        farther = [realism.kernel_distance(a, b + shift)[0] for shift in (0.3, 0.6, 1.2)]
        self.assertEqual(farther, sorted(farther))
        self.assertGreater(farther[0], 3 * abs(same))

    def test_the_kernel_is_the_published_one(self) -> None:
        a, b = torch.tensor([[1.0, 2.0]]), torch.tensor([[3.0, 4.0]])
        self.assertAlmostEqual(float(realism._kernel(a, b)), (11 / 2 + 1) ** 3, places=4)


class Classifiers(unittest.TestCase):
    def test_what_differs_is_told_and_what_does_not_is_not(self) -> None:
        random = torch.Generator().manual_seed(4)
        features = torch.randn(300, 8, generator=random)
        is_home = torch.arange(300) < 150
        groups = [f"scene_{i // 10}" for i in range(300)]
        chance = realism.Told(features, is_home, groups)
        self.assertTrue(0.35 < chance.accuracy < 0.65, chance.accuracy)
        features[is_home, 3] += 6.0
        told = realism.Told(features, is_home, groups)
        self.assertGreater(told.accuracy, 0.97)
        self.assertGreater(told.area, 0.99)

    def test_evidence_of_places_has_the_score_as_its_mean(self) -> None:
        random = torch.Generator().manual_seed(5)
        maps = torch.randn(40, 6, 3, 4, generator=random)
        maps[:20, 1, 0, 2] += 9.0
        is_home = torch.arange(40) < 20
        told = realism.Told(maps.mean((2, 3)), is_home, [str(i) for i in range(40)])
        evidence = told.evidence(maps)
        scores = ((maps.mean((2, 3)) - told._center) / told._scale) @ told._weights + told._bias
        self.assertLess(float((evidence.mean((1, 2)) - scores).abs().max()), 1e-4)
        self.assertEqual(int(evidence[is_home].mean(0).argmax()), 2)


class Folders(unittest.TestCase):
    def test_pictures_are_brought_to_the_size_of_frames(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "a").mkdir()
            Image.fromarray(np.full((30, 40, 3), 90, dtype=np.uint8)).save(Path(folder) / "a" / "b.png")
            found = realism.pictures_in(Path(folder), (120, 160))
            self.assertEqual(found.shape, (1, 3, 107, 140))
            self.assertEqual(int(found.float().mean()), 90)
            with self.assertRaisesRegex(ValueError, "no .jpg"):
                realism.pictures_in(Path(folder) / "a" / "c", (120, 160))


if __name__ == "__main__":
    unittest.main()
