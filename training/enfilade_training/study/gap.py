"""Where a network that has seen homes alone loses on photographs: with what homes and photographs differ in taken out, one thing at a time.

Looks: the means and variances of batch normalisation are those of the photographs (Li et al. 2016, "Revisiting batch normalization").
Frequencies: the odds of classes are multiplied by how much more frequent they are in photographs (Saerens et al. 2002). What is left to the
score on homes themselves is in neither: other things, and other shapes of the same. No weight learns from photographs.
"""

import copy
from dataclasses import replace
from typing import Any

import numpy as np
import torch
from torch import nn

from . import camera as cameras
from .config import HEADS, SEMANTICS, Study
from .judge import judge
from .pictures import Pictures, shares
from .train import device_of

# Of the pixels, the share that a class has at least, so that one which homes lack is not thought to be infinitely more frequent.
RAREST = 1e-4
# Pictures of a batch of which statistics are taken, and the most that are.
BATCH, MOST = 32, 1024


def cases(network: nn.Module, homes: Pictures, photographs: Pictures, plain: dict[str, Any], study: Study) -> dict[str, dict[str, Any]]:
    """Scores by case and task. plain: those of the photographs as they are."""
    seen = photographed(homes, study)
    looks = with_looks_of(network, photographs, study)
    found = {
        "homes, as it has learnt from them": _scores(network, seen, study),
        "the same, with looks taken anew": _scores(with_looks_of(network, seen, study), seen, study),
        "photographs": plain,
        "photographs, by their looks": _scores(looks, photographs, study),
    }
    if SEMANTICS in study.tasks:
        classes = replace(study, tasks=(SEMANTICS,))
        for name, one in (("photographs, by their frequencies", network), ("photographs, by both", looks)):
            found[name] = _scores(with_frequencies_of(one, homes, photographs), photographs, classes)
    return found


def photographed(homes: Pictures, study: Study) -> Pictures:
    """The homes as the study's camera makes them in the first epoch."""
    frames = [cameras.photographed(study.camera, cameras.generator(0, 0, i), frame) for i, frame in enumerate(homes.color)]
    return Pictures(torch.stack(frames).round().to(torch.uint8), homes.classes40, homes.depth_m, homes.names)


def with_looks_of(network: nn.Module, pictures: Pictures, study: Study) -> nn.Module:
    """A copy whose batch normalisation has the means and variances of the pictures."""
    device = device_of(study)
    made = copy.deepcopy(network).to(device).train()
    for layer in made.modules():
        if isinstance(layer, nn.BatchNorm2d):
            layer.reset_running_stats()
            layer.momentum = None  # The mean over all batches.
    # Neighbours are often of one room: batches are drawn, all of one size.
    order = np.random.Generator(np.random.PCG64(0)).permutation(len(pictures))[:MOST]
    size = min(BATCH, len(order))
    with torch.no_grad():
        for first in range(0, len(order) - size + 1, size):
            images = pictures.color[torch.from_numpy(order[first : first + size])].float() / 255.0
            made(images.to(device, memory_format=torch.channels_last))
    return made.eval()


def with_frequencies_of(network: nn.Module, homes: Pictures, photographs: Pictures) -> nn.Module:
    """A copy that expects the 13 classes as often as they are in photographs, where `network` expects them as often as in homes."""
    made: Any = copy.deepcopy(network)
    here, there = (torch.tensor(rounded_shares(pictures, SEMANTICS)).clamp(min=RAREST) for pictures in (homes, photographs))
    bias = made.heads[SEMANTICS].bias
    bias.data += (there / here).log().to(bias)
    return made


def rounded_shares(pictures: Pictures, task: str) -> list[float]:
    """Of the pixels with a class, which share has each."""
    return [round(float(share), 5) for share in shares(pictures.classes(task, slice(None)), HEADS[task])]


def _scores(network: nn.Module, pictures: Pictures, study: Study) -> dict[str, dict[str, float]]:
    return {task: of.scores for task, of in judge(network, pictures, study).items()}
