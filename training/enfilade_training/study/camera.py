"""What a cheap camera makes of a rendered frame, so that homes look like photographs to a network.

Rendered frames have the tone map of Hypersim: no black, little contrast, and the colour of the lamps. A depth camera's photographs are
balanced to grey, contrasty, sharpened and noisy. How much of each is drawn for every picture anew, so that networks learn to do without it.
"""

import numpy as np
import torch
from torch.nn import functional as F

from ..segmentation import augment
from .config import Camera
from .pictures import LUMA

# Told apart from what augmentation draws of the same seed, epoch and place.
STREAM = 1


def generator(seed: int, epoch: int, index: int) -> np.random.Generator:
    """The random numbers of a picture."""
    return augment.generator(seed, epoch, index, STREAM)


def photographed(camera: Camera, random: np.random.Generator, frame: torch.Tensor) -> torch.Tensor:
    """A frame as such a camera gives it. frame: uint8, 3 x H x W; gives floats of 0 to 255."""
    balance, tone, gain, sharpening, noise = (random.uniform(*bounds) for bounds in camera.bounds())
    image = frame.float() / 255.0

    # The grey world: means of the channels become as equal as the camera makes them.
    means = image.mean((1, 2)).clamp(min=1e-3)
    image = image * ((torch.tensor(LUMA, device=image.device) * means).sum() / means).pow(balance)[:, None, None]

    # The tone curve and the exposure, then sharpening by what a blurred picture lacks.
    image = (gain * image).clamp(0.0, 1.0).pow(tone)
    if sharpening > 0.0:
        around = F.avg_pool2d(F.pad(image[None], (1, 1, 1, 1), mode="replicate"), 3, stride=1)[0]
        image = image + sharpening * (image - around)
    if noise > 0.0:
        image = image + noise * torch.from_numpy(random.standard_normal(image.shape, dtype=np.float32)).to(image.device)
    return image.clamp(0.0, 1.0) * 255.0
