"""A U-Net (Ronneberger et al. 2015) on the encoder of ResNet-34 (He et al. 2016).

The encoder is torchvision's resnet34 without its classifier: parameters have the same names and shapes, so that weights made for it
fit. The decoder doubles the size five times; each stage takes the encoder's features of that size in and has two convolutions with
batch normalisation. Widths of the decoder are those that are usual with this encoder: 256, 128, 64, 32 and 16 channels. In narrower
networks they shrink alike, but to no fewer than 16 channels, which the head needs to tell a dozen classes apart.
"""

from pathlib import Path
from typing import Any

import torch
from torch import nn
from torch.nn import functional as F
from torchvision.models.resnet import BasicBlock

from ..common import checkpoints
from ..common.checkpoints import CheckpointError
from .config import Network


# Channels of the decoder's narrowest stage.
LEAST = 16


class Encoder(nn.Module):
    """Features at a half, a quarter, an eighth, a sixteenth and a 32nd of the size."""

    def __init__(self, width: int, blocks: tuple[int, int, int, int]):
        super().__init__()
        self.conv1 = nn.Conv2d(3, width, 7, stride=2, padding=3, bias=False)
        self.bn1 = nn.BatchNorm2d(width)
        self.layer1 = _stage(width, width, blocks[0], 1)
        self.layer2 = _stage(width, 2 * width, blocks[1], 2)
        self.layer3 = _stage(2 * width, 4 * width, blocks[2], 2)
        self.layer4 = _stage(4 * width, 8 * width, blocks[3], 2)
        for module in self.modules():
            if isinstance(module, nn.Conv2d):
                nn.init.kaiming_normal_(module.weight, mode="fan_out", nonlinearity="relu")

    def forward(self, x: torch.Tensor) -> list[torch.Tensor]:
        """From the finest to the coarsest."""
        features = [F.relu(self.bn1(self.conv1(x)))]
        features.append(self.layer1(F.max_pool2d(features[0], 3, stride=2, padding=1)))
        for stage in (self.layer2, self.layer3, self.layer4):
            features.append(stage(features[-1]))
        return features


class Up(nn.Module):
    """To the size of the next finer features, which are taken in."""

    def __init__(self, inputs: int, skipped: int, outputs: int):
        super().__init__()
        self.first = _convolution(inputs + skipped, outputs)
        self.second = _convolution(outputs, outputs)

    def forward(self, x: torch.Tensor, skipped: torch.Tensor | None, size: torch.Size) -> torch.Tensor:
        """The features of that size."""
        x = F.interpolate(x, size=size, mode="nearest")
        return self.second(self.first(x if skipped is None else torch.cat([x, skipped], dim=1)))


class UNet(nn.Module):
    """Scores of classes for each pixel; images may be of any size."""

    def __init__(self, config: Network, classes: int):
        super().__init__()
        width = config.width
        self.encoder = Encoder(width, config.blocks)
        coarse_to_fine = [8 * width, 4 * width, 2 * width, width, width]
        decoder = [max(channels, LEAST) for channels in (4 * width, 2 * width, width, width // 2, width // 4)]
        skipped = [*coarse_to_fine[1:], 0]
        inputs = [coarse_to_fine[0], *decoder[:-1]]
        self.decoder = nn.ModuleList(Up(*sizes) for sizes in zip(inputs, skipped, decoder))
        self.head = nn.Conv2d(decoder[-1], classes, 3, padding=1)
        self.register_buffer("mean", torch.tensor(config.mean).view(3, 1, 1), persistent=False)
        self.register_buffer("std", torch.tensor(config.std).view(3, 1, 1), persistent=False)

    def forward(self, images: torch.Tensor) -> torch.Tensor:
        """images: uint8, or colours on [0, 1]; N x 3 x H x W. Scores: N x classes x H x W."""
        if images.dtype == torch.uint8:
            images = images.float() / 255.0
        features = self.encoder((images - self.mean) / self.std)
        x = features.pop()
        for stage in self.decoder:
            finer = features.pop() if features else None
            x = stage(x, finer, images.shape[2:] if finer is None else finer.shape[2:])
        return self.head(x)


def build(config: Network, classes: int) -> UNet:
    """A new network, its encoder with the weights that the settings name."""
    network = UNet(config, classes)
    if config.encoder_weights is not None:
        weights = {name: value for name, value in checkpoints.load(config.encoder_weights).items() if not name.startswith("fc.")}
        load(network.encoder, weights, config.encoder_weights, "resnet34 of torchvision")
    return network


def begin_with(network: UNet, path: Path) -> bool:
    """Takes the weights of a checkpoint; false when its head has other classes, so that the network keeps its new one."""
    state = checkpoints.load(path)
    weights = state.get("network")
    if not isinstance(weights, dict):
        raise CheckpointError(f"{path}: has no network; expected a checkpoint of a segmentation run, such as last.pt")
    same_head = weights.get("head.weight", torch.empty(0)).shape == network.head.weight.shape
    if not same_head:
        weights = weights | {"head.weight": network.head.weight.data, "head.bias": network.head.bias.data}
    load(network, weights, path, "the network that the settings describe")
    return same_head


def load(module: nn.Module, weights: dict[str, Any], path: Path, expected: str) -> None:
    try:
        module.load_state_dict(weights)
    except RuntimeError as error:
        first = [line.strip() for line in str(error).splitlines() if line.strip()]
        raise CheckpointError(f"{path}: the weights are not those of {expected} ({' '.join(first[1:3])})") from error


def _stage(inputs: int, outputs: int, blocks: int, stride: int) -> nn.Sequential:
    shortcut = None
    if stride != 1 or inputs != outputs:
        shortcut = nn.Sequential(nn.Conv2d(inputs, outputs, 1, stride=stride, bias=False), nn.BatchNorm2d(outputs))
    first = BasicBlock(inputs, outputs, stride, shortcut)
    return nn.Sequential(first, *(BasicBlock(outputs, outputs) for _ in range(blocks - 1)))


def _convolution(inputs: int, outputs: int) -> nn.Sequential:
    convolution = nn.Conv2d(inputs, outputs, 3, padding=1, bias=False)
    nn.init.kaiming_normal_(convolution.weight, mode="fan_out", nonlinearity="relu")
    return nn.Sequential(convolution, nn.BatchNorm2d(outputs), nn.ReLU(inplace=True))
