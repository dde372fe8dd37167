import tempfile
import unittest
from pathlib import Path

import torch
import torchvision

from enfilade_training.common import checkpoints
from enfilade_training.common.checkpoints import CheckpointError
from enfilade_training.segmentation import network
from enfilade_training.segmentation.config import Network

SMALL = Network(width=8, blocks=(1, 1, 1, 1))


class UNet(unittest.TestCase):
    def setUp(self) -> None:
        torch.set_num_threads(1)
        torch.manual_seed(0)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_the_encoder_is_torchvisions_resnet34(self) -> None:
        theirs = torchvision.models.resnet34().eval()
        ours = network.Encoder(64, (3, 4, 6, 3)).eval()
        weights = {name: value for name, value in theirs.state_dict().items() if not name.startswith("fc.")}
        ours.load_state_dict(weights)
        images = torch.randn(1, 3, 64, 64)
        x = theirs.maxpool(theirs.relu(theirs.bn1(theirs.conv1(images))))
        expected = theirs.layer4(theirs.layer3(theirs.layer2(theirs.layer1(x))))
        self.assertTrue(torch.equal(ours(images)[-1], expected))

    def test_it_has_as_many_parameters_as_its_description_says(self) -> None:
        unet = network.UNet(Network(), 13)
        count = sum(p.numel() for p in unet.parameters())
        # ResNet-34 without its classifier, 21,284,672; the decoder's convolutions and normalisations; the head.
        stages = [(512 + 256, 256), (256 + 128, 128), (128 + 64, 64), (64 + 64, 32), (32, 16)]
        decoder = sum(9 * i * o + 9 * o * o + 4 * o for i, o in stages)
        self.assertEqual(count, 21_284_672 + decoder + 9 * 16 * 13 + 13)

    def test_images_may_have_any_size(self) -> None:
        unet = network.UNet(SMALL, 5).eval()
        for height, width in [(32, 32), (48, 33), (65, 40), (1, 1)]:
            images = torch.randint(0, 256, (2, 3, height, width), dtype=torch.uint8)
            self.assertEqual(unet(images).shape, (2, 5, height, width))

    def test_bytes_and_colours_on_the_unit_interval_are_alike(self) -> None:
        unet = network.UNet(SMALL, 5).eval()
        images = torch.randint(0, 256, (1, 3, 32, 32), dtype=torch.uint8)
        torch.testing.assert_close(unet(images), unet(images.float() / 255.0))

    def test_the_gradient_reaches_every_parameter(self) -> None:
        unet = network.UNet(SMALL, 5)
        unet(torch.randn(2, 3, 64, 64)).square().sum().backward()
        for name, parameter in unet.named_parameters():
            self.assertIsNotNone(parameter.grad, name)
            self.assertGreater(float(parameter.grad.abs().sum()), 0.0, name)

    def test_the_gradient_is_that_of_finite_differences(self) -> None:
        unet = network.UNet(Network(width=4, blocks=(1, 1, 1, 1)), 2).double().eval()
        images = torch.rand(1, 3, 32, 32, dtype=torch.float64, requires_grad=True)
        loss = unet(images).square().mean()
        (gradient,) = torch.autograd.grad(loss, images)
        direction = torch.randn_like(images)
        h = 1e-6
        with torch.no_grad():
            slope = (unet(images + h * direction).square().mean() - unet(images - h * direction).square().mean()) / (2 * h)
        self.assertAlmostEqual(float((gradient * direction).sum()), float(slope), delta=1e-6 * max(1.0, abs(float(slope))))

    def test_weights_of_an_encoder_are_taken(self) -> None:
        path, theirs = self.folder / "resnet34.pth", torchvision.models.resnet34()
        torch.save(theirs.state_dict(), path)
        unet = network.build(Network(encoder_weights=path), 13)
        self.assertTrue(torch.equal(unet.encoder.layer3[2].conv1.weight, theirs.layer3[2].conv1.weight))
        with self.assertRaisesRegex(CheckpointError, "resnet34.pth: the weights are not those of resnet34"):
            network.build(Network(width=32, encoder_weights=path), 13)

    def test_fine_tuning_takes_all_weights_but_those_of_other_classes(self) -> None:
        path, trained = self.folder / "last.pt", network.UNet(SMALL, 5)
        checkpoints.save(path, {"network": trained.state_dict()})
        for classes, same in [(5, True), (7, False)]:
            begun = network.UNet(SMALL, classes)
            own_head = begun.head.weight.clone()
            self.assertEqual(network.begin_with(begun, path), same)
            self.assertTrue(torch.equal(begun.decoder[2].first[0].weight, trained.decoder[2].first[0].weight))
            self.assertTrue(torch.equal(begun.head.weight, trained.head.weight if same else own_head))
        with self.assertRaisesRegex(CheckpointError, "not those of the network that the settings describe"):
            network.begin_with(network.UNet(Network(width=16, blocks=(1, 1, 1, 1)), 5), path)
        checkpoints.save(path, {"weights": {}})
        with self.assertRaisesRegex(CheckpointError, "has no network"):
            network.begin_with(network.UNet(SMALL, 5), path)


if __name__ == "__main__":
    unittest.main()
