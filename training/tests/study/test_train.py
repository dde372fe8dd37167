import math
import tempfile
import unittest
from pathlib import Path

import torch

from enfilade_training.common import checkpoints
from enfilade_training.common.checkpoints import CheckpointError
from enfilade_training.study import train
from enfilade_training.study.photographs import Photographs
from enfilade_training.study.pictures import VOID
from enfilade_training.study.runs import subset
from tests.study import nyu


class Losses(unittest.TestCase):
    def test_classes_have_the_mean_cross_entropy_of_labelled_pixels(self) -> None:
        scores = torch.tensor([[[[2.0, 0.0, 5.0]], [[0.0, 1.0, 0.0]]]])
        truth = torch.tensor([[[0, 0, VOID]]], dtype=torch.uint8)
        expected = (math.log(1 + math.exp(-2.0)) + math.log(1 + math.exp(1.0))) / 2
        self.assertAlmostEqual(float(train.loss("semantics", scores, truth)), expected, places=6)

    def test_depths_have_the_mean_difference_of_logarithms(self) -> None:
        predicted = torch.tensor([[[[math.log(4.0), math.log(1.0), 7.0]]]])
        truth = torch.tensor([[[2.0, 3.0, 0.0]]])
        self.assertAlmostEqual(float(train.loss("depth", predicted, truth)), (math.log(2.0) + math.log(3.0)) / 2, places=6)

    def test_without_truth_there_is_no_loss(self) -> None:
        self.assertEqual(float(train.loss("semantics", torch.randn(1, 2, 1, 1), torch.full((1, 1, 1), VOID, dtype=torch.uint8))), 0.0)
        self.assertEqual(float(train.loss("depth", torch.randn(1, 1, 1, 1), torch.zeros(1, 1, 1))), 0.0)


class Runs(unittest.TestCase):
    def setUp(self) -> None:
        torch.set_num_threads(1)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.study = nyu.study(self.folder, "finetuning.steps=5", "finetuning.checkpoint_steps=2", "finetuning.batch_size=4", "device=cpu")
        photographs = Photographs(nyu.write(self.folder / "nyu"), self.study.size, self.folder / "packed")
        self.pictures = photographs.side("train")

    def train(self, name: str, stop_after: int | None = None, key: str = "key") -> train.Trained:
        study = self.study
        begin = lambda: train.new_network(study, 1, "random")  # noqa: E731
        return train.train(study, study.finetuning, 1, key, self.folder / name, self.pictures, begin, stop_after=stop_after)

    def test_a_run_that_was_ended_goes_on_to_the_same_bits(self) -> None:
        whole = self.train("whole")
        for end in (1, 2, 3):
            self.train("ended", stop_after=end)
        ended = self.train("ended")
        self.assertEqual(whole.losses, ended.losses)
        self.assertEqual([step for step, _ in whole.losses], [1, 2, 3, 4, 5])
        for (name, a), b in zip(whole.network.state_dict().items(), ended.network.state_dict().values()):
            self.assertTrue(torch.equal(a, b), name)
        one, other = (checkpoints.load(self.folder / name / "last.pt") for name in ("whole", "ended"))
        self.assertEqual(one.keys(), other.keys())
        self.assertNotIn("optimizer", one)

    def test_a_finished_run_is_not_made_again(self) -> None:
        self.train("whole")
        written = (self.folder / "whole" / "last.pt").stat().st_mtime_ns
        self.train("whole")
        self.assertEqual((self.folder / "whole" / "last.pt").stat().st_mtime_ns, written)

    def test_a_checkpoint_of_another_run_is_refused(self) -> None:
        self.train("whole", stop_after=1)
        with self.assertRaisesRegex(CheckpointError, "last.pt: is of another run, 'key', expected 'other'"):
            self.train("whole", key="other")

    def test_smaller_shares_are_part_of_larger_ones(self) -> None:
        shares = [set(subset(795, fraction, 2)) for fraction in (0.1, 0.25, 0.5, 1.0)]
        self.assertEqual([len(share) for share in shares], [80, 199, 398, 795])
        self.assertTrue(all(a < b for a, b in zip(shares, shares[1:])))
        self.assertNotEqual(shares[0], set(subset(795, 0.1, 3)))


if __name__ == "__main__":
    unittest.main()
