"""Random changes of an image and its classes: the paper's recipe, as torchvision's transforms do it.

All that is drawn for an image is a function of (seed, epoch, place in the dataset), so that neither the number of processes nor a run
that was resumed changes it.
"""

import math
from dataclasses import dataclass

import numpy as np
import torch
from torchvision.transforms.v2 import InterpolationMode
from torchvision.transforms.v2 import functional as T

from .config import Augment


@dataclass(frozen=True)
class Draw:
    """What was drawn for an image."""

    # First row and column, height and width of the crop.
    crop: tuple[int, int, int, int]
    flip: bool
    # The changes of colour that are made, in this order: ("hue", shift), ("saturation", factor), ("brightness", factor).
    jitter: tuple[tuple[str, float], ...]


def generator(seed: int, epoch: int, index: int, *stream: int) -> np.random.Generator:
    """The random numbers of an image. stream: tells apart what is drawn for other purposes."""
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence([seed, epoch, index, *stream])))


def draw(random: np.random.Generator, config: Augment, height: int, width: int) -> Draw:
    """Draws for an image of that size."""
    crop = _crop(random, config, height, width)
    flip = bool(random.random() < config.flip)
    shares = random.random(3)
    factors = (
        ("hue", random.uniform(-config.hue, config.hue)),
        ("saturation", random.uniform(*config.saturation)),
        ("brightness", random.uniform(*config.brightness)),
    )
    order = random.permutation(3)
    applied = shares < config.jitter if config.jitter_per_factor else np.full(3, shares[0] < config.jitter)
    return Draw(crop, flip, tuple(factors[i] for i in order if applied[i]))


def apply(drawn: Draw, size: tuple[int, int], image: torch.Tensor, classes: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
    """image: uint8, 3 x H x W. classes: integers, H x W, of which the nearest value is taken."""
    image = T.resized_crop(image, *drawn.crop, size=list(size), interpolation=InterpolationMode.BILINEAR, antialias=True)
    classes = T.resized_crop(classes[None], *drawn.crop, size=list(size), interpolation=InterpolationMode.NEAREST)[0]
    if drawn.flip:
        image, classes = T.horizontal_flip(image), T.horizontal_flip(classes)
    for name, value in drawn.jitter:
        image = {"hue": T.adjust_hue, "saturation": T.adjust_saturation, "brightness": T.adjust_brightness}[name](image, value)
    return image.contiguous(), classes.contiguous()


def _crop(random: np.random.Generator, config: Augment, height: int, width: int) -> tuple[int, int, int, int]:
    """As torchvision's RandomResizedCrop: up to ten tries, then the largest part in the middle that has an allowed ratio."""
    for _ in range(10):
        area = height * width * random.uniform(*config.scale)
        ratio = math.exp(random.uniform(math.log(config.ratio[0]), math.log(config.ratio[1])))
        w, h = round(math.sqrt(area * ratio)), round(math.sqrt(area / ratio))
        if 0 < w <= width and 0 < h <= height:
            return int(random.integers(height - h + 1)), int(random.integers(width - w + 1)), h, w
    low, high = config.ratio
    w = width if width / height <= high else min(width, round(height * high))
    h = height if width / height >= low else min(height, round(width / low))
    return (height - h) // 2, (width - w) // 2, h, w
