"""Where a network that has seen homes alone loses on photographs: with what homes and photographs differ in taken out, one thing at a time.

Looks: the means and variances of batch normalisation are those of the photographs (Li et al. 2016, "Revisiting batch normalization").
Frequencies: the odds of classes are multiplied by how much more frequent they are in photographs (Saerens et al. 2002). What is left to the
score on homes themselves is in neither: other things, and other shapes of the same. No weight learns from photographs.
"""

import copy
from typing import Any

import torch
from torch import nn

from .config import HEADS, SEMANTICS, Study
from .judge import AT_ONCE, judge
from .pictures import Pictures
from .train import device_of

# Of the pixels, the share that a class has at least, so that one which homes lack is not thought to be infinitely more frequent.
RAREST = 1e-4


def steps(network: nn.Module, homes: Pictures, photographs: Pictures, study: Study) -> dict[str, dict[str, dict[str, float]]]:
    """Scores by task, of homes and of photographs, as they are and with what differs taken out."""
    found = {}
    looks = with_looks_of(network, photographs, study)
    cases: list[tuple[str, nn.Module, Pictures]] = [
        ("homes, which it has seen", network, homes),
        ("photographs", network, photographs),
        ("photographs, by their looks", looks, photographs),
    ]
    if SEMANTICS in study.tasks:
        cases.append(("photographs, by their frequencies", with_frequencies_of(network, homes, photographs), photographs))
        cases.append(("photographs, by both", with_frequencies_of(looks, homes, photographs), photographs))
    for name, judged, pictures in cases:
        found[name] = {task: of.scores for task, of in judge(judged, pictures, study).items()}
    return found


def with_looks_of(network: nn.Module, pictures: Pictures, study: Study) -> nn.Module:
    """A copy whose batch normalisation has the means and variances of the pictures."""
    made, device = copy.deepcopy(network).to(device_of(study)).train(), device_of(study)
    for layer in made.modules():
        if isinstance(layer, nn.BatchNorm2d):
            layer.reset_running_stats()
            layer.momentum = None  # The mean over all batches.
    with torch.no_grad():
        for first in range(0, len(pictures), AT_ONCE):
            made((pictures.color[first : first + AT_ONCE].float() / 255.0).to(device, memory_format=torch.channels_last))
    return made.eval()


def with_frequencies_of(network: nn.Module, homes: Pictures, photographs: Pictures) -> nn.Module:
    """A copy that expects the 13 classes as often as they are in photographs, where `network` expects them as often as in homes."""
    made: Any = copy.deepcopy(network)
    here, there = (torch.tensor(shares(pictures, SEMANTICS)).clamp(min=RAREST) for pictures in (homes, photographs))
    bias = made.heads[SEMANTICS].bias
    bias.data += (there / here).log().to(bias)
    return made


def shares(pictures: Pictures, task: str) -> list[float]:
    """Of the pixels with a class, which share has each."""
    counts = torch.bincount(pictures.classes(task, slice(None)).flatten().long(), minlength=256)[: HEADS[task]].double()
    return [round(float(share), 5) for share in counts / counts.sum().clamp(min=1.0)]
