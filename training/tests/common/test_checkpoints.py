import os
import random
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np
import torch

from enfilade_training.common import checkpoints
from enfilade_training.common.checkpoints import CheckpointError


class Checkpoints(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "runs" / "last.pt"

    def test_what_is_saved_comes_back(self) -> None:
        state = {"weights": torch.arange(6.0).reshape(2, 3), "epoch": 3, "best": 0.5, "names": ["a", None], "nested": {"x": True}}
        checkpoints.save(self.path, state)
        found = checkpoints.load(self.path)
        self.assertTrue(torch.equal(found.pop("weights"), state.pop("weights")))
        self.assertEqual(found, state)

    def test_a_save_that_fails_leaves_the_old_file_and_nothing_else(self) -> None:
        checkpoints.save(self.path, {"epoch": 1})
        with mock.patch.object(os, "replace", side_effect=OSError("disk full")), self.assertRaises(OSError):
            checkpoints.save(self.path, {"epoch": 2})
        self.assertEqual(checkpoints.load(self.path), {"epoch": 1})
        self.assertEqual([path.name for path in self.path.parent.iterdir()], ["last.pt"])

    def test_random_numbers_go_on_where_they_were(self) -> None:
        def draw() -> list[float]:
            return [random.random(), random.gauss(0, 1), float(np.random.rand()), float(np.random.randn()), float(torch.rand(()))]

        checkpoints.seed_everything(7)
        draw()
        checkpoints.save(self.path, checkpoints.random_state())
        expected = draw()
        checkpoints.seed_everything(8)
        checkpoints.set_random_state(checkpoints.load(self.path))
        self.assertEqual(draw(), expected)

    def test_missing_damaged_and_foreign_files_are_named(self) -> None:
        with self.assertRaisesRegex(CheckpointError, "last.pt: there is no such checkpoint"):
            checkpoints.load(self.path)
        checkpoints.save(self.path, {"weights": torch.zeros(100)})
        whole = self.path.read_bytes()
        for damaged in [b"", b"no checkpoint", whole[: len(whole) // 2]]:
            self.path.write_bytes(damaged)
            with self.assertRaisesRegex(CheckpointError, "last.pt: is no checkpoint, or damaged"):
                checkpoints.load(self.path)
        torch.save([1, 2], self.path)
        with self.assertRaisesRegex(CheckpointError, "holds list"):
            checkpoints.load(self.path)

    def test_code_in_a_checkpoint_is_refused(self) -> None:
        self.path.parent.mkdir(parents=True)
        torch.save({"bad": _Code()}, self.path)
        with self.assertRaisesRegex(CheckpointError, "last.pt"):
            checkpoints.load(self.path)


class _Code:
    def __reduce__(self) -> tuple:
        return (os.getcwd, ())


if __name__ == "__main__":
    unittest.main()
