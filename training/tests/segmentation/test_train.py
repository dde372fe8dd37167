import dataclasses
import shutil
import tempfile
import unittest
from pathlib import Path
from typing import Any
from unittest import mock

import torch
from torch.nn import functional as F

from enfilade_training.common import checkpoints, logs
from enfilade_training.common.checkpoints import CheckpointError
from enfilade_training.common.config import ConfigError
from enfilade_training.common.distributed import Replica, join
from enfilade_training.common.schedule import one_cycle_cosine
from enfilade_training.segmentation import train
from enfilade_training.segmentation.config import Config
from tests.ranks import run_on_ranks
from tests.segmentation.images import config, write_pairs

ONE = Replica(0, 1, torch.device("cpu"))
IMAGES = 9


def run(replica: Replica, settings: Config, stops: list[int | None]) -> dict[str, Any]:
    """Runs that are ended after these numbers of steps, each going on where the one before it was; copies of their checkpoints stay."""
    for stop in stops:
        scores = train.train(settings, replica, stop_after=stop)
        if stop is not None and replica.is_first:
            shutil.copy(settings.output / "last.pt", settings.output / f"after{stop}.pt")
    return scores


class Training(unittest.TestCase):
    def setUp(self) -> None:
        torch.set_num_threads(1)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        write_pairs(self.folder, IMAGES)

    def state(self, settings: Config) -> dict[str, Any]:
        return checkpoints.load(settings.output / "last.pt")

    def named(self, name: str, settings: Config) -> Config:
        return dataclasses.replace(settings, output=self.folder / name)

    def assert_equal_runs(self, a: Config, b: Config) -> None:
        one, other = self.state(a), self.state(b)
        for part in ("network", "optimizer", "random", "epoch", "step", "steps", "loss_sum", "pixel_sum", "scores"):
            self.assert_same(one[part], other[part], part)
        lines = [(settings.output / "metrics.jsonl").read_bytes() for settings in (a, b)]
        self.assertEqual(*lines)

    def assert_same(self, a: Any, b: Any, name: str) -> None:
        if isinstance(a, torch.Tensor):
            self.assertTrue(torch.equal(a, b), name)
        elif isinstance(a, dict):
            self.assertEqual(a.keys(), b.keys(), name)
            for key in a:
                self.assert_same(a[key], b[key], f"{name}.{key}")
        elif isinstance(a, list):
            self.assertEqual(len(a), len(b), name)
            for i, (x, y) in enumerate(zip(a, b)):
                self.assert_same(x, y, f"{name}.{i}")
        else:
            self.assertEqual(a, b, name)

    def test_the_loss_is_the_mean_of_cross_entropy_over_labelled_pixels(self) -> None:
        run = train._Run(config(self.folder), ONE, lambda _: None)
        images = torch.randint(0, 256, (2, 3, 32, 32), dtype=torch.uint8)
        classes = torch.randint(-1, 4, (2, 32, 32))
        run.network.train()
        probabilities = F.softmax(run.network(images).detach(), dim=1)
        of_truth = probabilities.gather(1, classes.clamp(min=0)[:, None])[:, 0]
        expected = -of_truth.log()[classes >= 0].mean()
        loss, pixels = run.one_step(images, classes, 0.0)
        self.assertAlmostEqual(loss, float(expected), places=5)
        self.assertEqual(pixels, int((classes >= 0).sum()))

    def test_the_gradient_at_the_scores_is_that_of_the_formula(self) -> None:
        # softmax - one-hot over the number of labelled pixels, and nothing where there is no class.
        scores = torch.randn(1, 3, 2, 2, dtype=torch.float64, requires_grad=True)
        classes = torch.tensor([[[0, 2], [-1, 1]]])
        (F.cross_entropy(scores, classes, ignore_index=-1, reduction="sum") / 3).backward()
        truth = F.one_hot(classes.clamp(min=0), 3).permute(0, 3, 1, 2)
        expected = (F.softmax(scores.detach(), 1) - truth) * (classes >= 0)[:, None] / 3
        torch.testing.assert_close(scores.grad, expected)

    def test_steps_and_rates_are_the_recipes(self) -> None:
        settings = config(self.folder, drop_last=False)
        train.train(settings, ONE)
        lines = [line for line in logs.read(settings.output / "metrics.jsonl") if line["kind"] == "train"]
        self.assertEqual([line["epoch"] for line in lines], [e for e in range(4) for _ in range(3)])
        for line in lines:
            self.assertEqual(line["learning_rate"], one_cycle_cosine(line["epoch"], base=0.01, epochs=4, warmup_epochs=1))
        by_step = self.named("by_step", config(self.folder, schedule_by="step"))
        train.train(by_step, ONE, stop_after=3)
        rates = [line["learning_rate"] for line in logs.read(by_step.output / "metrics.jsonl") if line["kind"] == "train"]
        self.assertEqual(rates, [one_cycle_cosine(i / 2, base=0.01, epochs=4, warmup_epochs=1) for i in range(3)])

    def test_a_resumed_run_equals_an_uninterrupted_one(self) -> None:
        whole = self.named("whole", config(self.folder, checkpoint_steps=3))
        run(ONE, whole, [None])
        # Ended within an epoch, at the end of one, and not at all.
        parts = self.named("parts", config(self.folder, checkpoint_steps=3))
        run(ONE, parts, [3, 4, 7, None])
        self.assert_equal_runs(whole, parts)
        self.assertEqual(self.state(parts)["steps"], 8)

    def test_workers_change_nothing(self) -> None:
        alone = self.named("alone", config(self.folder))
        helped = self.named("helped", config(self.folder, workers=2))
        run(ONE, alone, [None])
        run(ONE, helped, [3, None])
        self.assert_equal_runs(alone, helped)

    def test_two_replicas_resume_to_the_bit_and_train_like_one(self) -> None:
        settings = {name: self.named(name, config(self.folder)) for name in ("whole", "parts", "one")}
        for name, stops in [("whole", [None]), ("parts", [1, 3, None])]:
            with tempfile.TemporaryDirectory() as folder:
                scores = run_on_ranks("tests.segmentation.test_train", "run", 2, Path(folder), settings=settings[name], stops=stops)
            self.assertEqual(scores[0], scores[1])
        self.assert_equal_runs(settings["whole"], settings["parts"])
        self.assertEqual(len(self.state(settings["whole"])["random"]), 2)
        # After the first step: the same statistics, and the same gradients, which are what the momentum consists of.
        run(ONE, settings["one"], [1])
        one, two = (checkpoints.load(settings[name].output / "after1.pt") for name in ("one", "parts"))
        self.assertEqual(one["pixel_sum"], two["pixel_sum"])
        self.assertAlmostEqual(one["loss_sum"] / one["pixel_sum"], two["loss_sum"] / two["pixel_sum"], places=5)
        for name, value in one["network"].items():
            torch.testing.assert_close(two["network"][name], value, rtol=1e-3, atol=1e-4, msg=lambda text: f"{name}: {text}")
        for i, state in one["optimizer"]["state"].items():
            gradient, other = state["momentum_buffer"], two["optimizer"]["state"][i]["momentum_buffer"]
            self.assertLess(float((gradient - other).norm()), 2e-3 * float(gradient.norm()) + 1e-6)

    def test_fine_tuning_begins_with_trained_weights_and_its_own_schedule(self) -> None:
        before = self.named("before", config(self.folder))
        run(ONE, before, [None])
        said: list[str] = []
        tuned = self.named("tuned", config(self.folder, init_from=before.output / "last.pt"))
        for settings, expected in [(tuned, "last.pt"), (dataclasses.replace(self.named("other", tuned), classes=3), "a new head for 3 classes")]:
            begun = train._Run(settings, ONE, said.append)
            self.assertIn(expected, said[-1])
            self.assertEqual((begun.steps, begun.learning_rate()), (0, 0.01 * 1e-3))
            trained = self.state(before)["network"]["encoder.layer4.0.conv2.weight"]
            self.assertTrue(torch.equal(begun.network.encoder.layer4[0].conv2.weight, trained))

    def test_half_precision_trains_and_float16_asks_for_a_gpu(self) -> None:
        settings = config(self.folder, precision="bfloat16")
        train.train(settings, ONE, stop_after=2)
        self.assertEqual(self.state(settings)["network"]["head.weight"].dtype, torch.float32)
        with self.assertRaisesRegex(ConfigError, "float16.*needs a GPU"):
            train.train(self.named("half", config(self.folder, precision="float16")), ONE)

    def test_a_gpu_that_emulates_bfloat16_computes_in_float16(self) -> None:
        for native, expected in ((True, torch.bfloat16), (False, torch.float16)):
            with mock.patch("torch.cuda.is_bf16_supported", lambda including_emulation=True: native or including_emulation):
                self.assertEqual(train.precision(config(self.folder, precision="auto"), torch.device("cuda")), expected)
                self.assertEqual(train.precision(config(self.folder), torch.device("cuda")), torch.float32)

    def test_adam_trains_too(self) -> None:
        settings = config(self.folder, optimizer="adam")
        run(ONE, settings, [3, None])
        self.assertIn("exp_avg", self.state(settings)["optimizer"]["state"][0])

    def test_other_settings_do_not_resume(self) -> None:
        settings = config(self.folder)
        train.train(settings, ONE, stop_after=1)
        other = config(self.folder, learning_rate=0.02, workers=1)
        with self.assertRaisesRegex(CheckpointError, r"last.pt: .*other settings \(train.learning_rate\)"):
            train.train(other, ONE)
        write_pairs(self.folder, IMAGES + 1)
        with self.assertRaisesRegex(CheckpointError, "has 9 images, the dataset now 10"):
            train.train(settings, ONE)
        checkpoints.save(settings.output / "last.pt", {"format": 99})
        with self.assertRaisesRegex(CheckpointError, "of format 99, expected 1"):
            train.train(settings, ONE)

    def test_batches_that_do_not_fit_are_refused(self) -> None:
        with self.assertRaisesRegex(ConfigError, "batch_size is 4, expected a multiple of the 3 replicas"):
            train.train(config(self.folder), Replica(0, 3, torch.device("cpu")))
        with self.assertRaisesRegex(ValueError, "there are 9 images, but a batch has 10"):
            train.train(config(self.folder, batch_size=10), ONE)

    def test_a_loss_that_is_no_number_ends_the_run(self) -> None:
        settings = config(self.folder, learning_rate=1e30, warmup_epochs=0.0)
        with self.assertRaisesRegex(FloatingPointError, "no number at step .*train.learning_rate"):
            train.train(settings, ONE)


class Joined(unittest.TestCase):
    def test_without_torchrun_a_run_is_one_replica(self) -> None:
        with join("cpu") as replica:
            self.assertEqual(replica, ONE)


if __name__ == "__main__":
    unittest.main()
