"""What a network scores on photographs: predictions are enlarged bilinearly to the size of the labels."""

from dataclasses import dataclass

import enfilade
import numpy as np
import torch
from torch.nn import functional as F

from . import scores
from .config import DEPTH, HEADS, Study
from .pictures import VOID, Pictures
from .train import autocast, device_of

# Pictures that are predicted at a time.
AT_ONCE = 8


@dataclass(frozen=True)
class Judged:
    """Scores of a task. images: of each image what its scores are made of; confusion: of all pixels, true classes by predicted ones."""

    scores: dict[str, float]
    images: np.ndarray
    confusion: enfilade.Confusion | None


def judge(network: torch.nn.Module, pictures: Pictures, study: Study) -> dict[str, Judged]:
    """By task."""
    found: dict[str, list[np.ndarray]] = {task: [] for task in study.tasks}
    sums = {task: enfilade.Confusion(HEADS[task]) for task in study.tasks if task != DEPTH}
    for first in range(0, len(pictures), AT_ONCE):
        part = slice(first, first + AT_ONCE)
        predicted = predict(network, pictures, part, study)
        for task in study.tasks:
            if task == DEPTH:
                found[task] += [scores.depth_scores(a, b) for a, b in zip(predicted[task], pictures.depth_m[part].float().numpy())]
                continue
            for classes, truth in zip(predicted[task], pictures.classes(task, part).numpy()):
                confusion = enfilade.Confusion(HEADS[task])
                confusion.add(classes, truth, ignore=VOID)
                found[task].append(scores.class_sums(np.array(confusion.counts)))
                sums[task].merge(confusion)
    return {task: Judged(scores.total(task, np.stack(images)), np.stack(images), sums.get(task)) for task, images in found.items()}


def predict(network: torch.nn.Module, pictures: Pictures, part: slice, study: Study) -> dict[str, np.ndarray]:
    """By task, in the size of the labels: classes (uint8), or depth in metres."""
    device = device_of(study)
    network.to(device).eval()
    images = (pictures.color[part].float() / 255.0).to(device, memory_format=torch.channels_last)
    with torch.no_grad(), autocast(study, device):
        found = network(images)
    made = {}
    for task, values in found.items():
        values = F.interpolate(values.float(), size=pictures.depth_m.shape[1:], mode="bilinear", align_corners=False)
        made[task] = (values[:, 0].exp() if task == DEPTH else values.argmax(1).to(torch.uint8)).cpu().numpy()
    return made
