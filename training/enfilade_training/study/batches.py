"""Batches as networks see them in training: crops of pictures, changed at random by the paper's augmentation.

What is drawn for a picture is a function of (seed, epoch, place), by `segmentation.augment`. Here it is applied to packed pictures: colours
change by one matrix per picture, in which hue is turned in the plane of YIQ's chrominance, and values are clamped once at the end. Classes
and depths are taken where networks predict them, at half of the crop's size. A crop that is enlarged by s shows things as a lens of s times
the focal length would, in front of which they would be 1 / s as far: depths are divided by s (Eigen et al. 2014).
"""

import math

import numpy as np
import torch
from torch.nn import functional as F

from ..segmentation import augment
from ..segmentation.config import Augment
from . import camera as cameras
from .config import DEPTH, Camera
from .pictures import LUMA, Pictures

# Luma and chrominance of RGB (NTSC 1953).
YIQ = np.array([LUMA, [0.596, -0.274, -0.322], [0.211, -0.523, 0.312]])
RGB = np.linalg.inv(YIQ)


def places(seed: int, step: int, batch_size: int, count: int) -> list[tuple[int, int]]:
    """The batch of a step as (epoch, index): every epoch has each of `count` pictures once, in an order by seed and epoch."""
    found: list[tuple[int, int]] = []
    for epoch in range(step * batch_size // count, ((step + 1) * batch_size - 1) // count + 1):
        order = np.random.Generator(np.random.PCG64(np.random.SeedSequence([seed, epoch]))).permutation(count)
        first = max(0, step * batch_size - epoch * count)
        found += [(epoch, int(index)) for index in order[first : (step + 1) * batch_size - epoch * count]]
    return found


def batch(
    pictures: Pictures, chosen: list[tuple[int, int]], seed: int, config: Augment, tasks: tuple[str, ...], camera: Camera | None = None
) -> tuple[torch.Tensor, dict[str, torch.Tensor]]:
    """Colours on [0, 1], N x 3 x the augmentation's size, and the truth by task at half of it: classes, or depth in metres; where pictures are.

    camera: photographs the pictures anew, before all else.
    """
    height, width = config.size
    half = -(-height // 2), -(-width // 2)
    colors, matrices, truths = [], [], {task: [] for task in tasks}
    for epoch, index in chosen:
        whole = pictures.color.shape[2:]
        drawn = augment.draw(augment.generator(seed, epoch, index), config, *whole)
        top, left, rows, columns = drawn.crop
        frame = pictures.color[index]
        if camera is not None:
            frame = cameras.photographed(camera, cameras.generator(seed, epoch, index), frame)
        part = frame[None, :, top : top + rows, left : left + columns]
        image = F.interpolate(part, size=config.size, mode="bilinear", antialias=True)[0]
        matrices.append(torch.from_numpy(color_matrix(drawn.jitter)).float())
        colors.append(image.flip(2) if drawn.flip else image)
        y = _nearest(top, rows, half[0], whole[0], pictures.depth_m.shape[1]).to(frame.device)
        x = _nearest(left, columns, half[1], whole[1], pictures.depth_m.shape[2]).to(frame.device)
        if drawn.flip:
            x = x.flip(0)
        for task in tasks:
            if task == DEPTH:
                enlarged = math.sqrt(height * width / (rows * columns))
                truths[task].append(pictures.depth_m[index][y[:, None], x].float() / enlarged)
            else:
                truths[task].append(pictures.classes(task, index)[y[:, None], x])
    flat = torch.stack(colors).float().flatten(2) / 255.0
    images = torch.bmm(torch.stack(matrices).to(flat.device), flat).clamp(0.0, 1.0).view(len(chosen), 3, height, width)
    return images.contiguous(memory_format=torch.channels_last), {task: torch.stack(found) for task, found in truths.items()}


def color_matrix(jitter: tuple[tuple[str, float], ...]) -> np.ndarray:
    """3 x 3: what `segmentation.augment` drew, as one change of colours."""
    matrix = np.eye(3)
    for name, value in jitter:
        if name == "hue":
            cos, sin = math.cos(2.0 * math.pi * value), math.sin(2.0 * math.pi * value)
            change = RGB @ np.array([[1.0, 0.0, 0.0], [0.0, cos, -sin], [0.0, sin, cos]]) @ YIQ
        elif name == "saturation":
            change = value * np.eye(3) + (1.0 - value) * np.tile(YIQ[0], (3, 1))
        else:
            change = value * np.eye(3)
        matrix = change @ matrix
    return matrix


def _nearest(first: int, count: int, size: int, colors: int, labels: int) -> torch.Tensor:
    """The rows of labels, of which there are `labels` beside `colors` rows of colours, at the centres of `size` rows of a crop."""
    at = first + (torch.arange(size) + 0.5) * count / size
    return (at * labels / colors).long().clamp(max=labels - 1)
