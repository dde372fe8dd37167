import tempfile
import unittest
from pathlib import Path

import torch

from enfilade_training.study import gap, train
from enfilade_training.study.photographs import Photographs
from enfilade_training.study.pictures import VOID, Pictures
from tests.study import nyu


def flat(classes: list[int]) -> Pictures:
    """A picture with as many pixels of NYU40's classes as are listed."""
    return Pictures(torch.zeros(1, 3, 1, 1, dtype=torch.uint8), torch.tensor([[classes]], dtype=torch.uint8), torch.zeros(1, 1, 1), ["a"])


class Gap(unittest.TestCase):
    def setUp(self) -> None:
        torch.set_num_threads(1)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.study = nyu.study(Path(folder.name), "device=cpu")
        self.pictures = Photographs(nyu.write(Path(folder.name) / "nyu"), self.study.size, Path(folder.name) / "packed").side("train")
        self.network = train.new_network(self.study, 1, "random")

    def test_looks_are_the_statistics_of_the_pictures(self) -> None:
        made = gap.with_looks_of(self.network, self.pictures, self.study)
        # All six are one batch: what the first layer of normalisation sees has the mean and the variance that it keeps.
        stem = self.network.encoder.stem
        with torch.no_grad():
            seen = stem[0](self.pictures.color.float() / 255.0 * 2.0 - 1.0)
        kept = made.encoder.stem[1]
        self.assertTrue(torch.allclose(kept.running_mean, seen.mean((0, 2, 3)), atol=1e-5))
        self.assertTrue(torch.allclose(kept.running_var, seen.var((0, 2, 3)), rtol=1e-4))
        self.assertFalse(made.training)
        # The network itself stays as it is.
        self.assertTrue(torch.equal(stem[1].running_mean, torch.zeros(32)))

    def test_frequencies_change_the_odds_by_what_is_more_frequent(self) -> None:
        # NYU40's wall is the 12th of NYU13's classes, and its floor the 5th, both counted from 1.
        homes, photographs = flat([0, 0, 0, 1, VOID]), flat([0, 1, 1, 1])
        made = gap.with_frequencies_of(self.network, homes, photographs)
        change = (made.heads["semantics"].bias - self.network.heads["semantics"].bias).detach()
        self.assertAlmostEqual(float(change[11].exp()), 1 / 3, places=5)
        self.assertAlmostEqual(float(change[4].exp()), 3.0, places=5)
        self.assertEqual(float(change[0]), 0.0)


if __name__ == "__main__":
    unittest.main()
