"""Learning rates as functions of the progress alone, so that nothing of them needs to be kept when a run stops.

    for group in optimizer.param_groups:
        group["lr"] = one_cycle_cosine(epoch, base=0.01, epochs=100, warmup_epochs=3)
"""

import math
from typing import Sequence

from torch.optim import Optimizer


def one_cycle_cosine(epoch: float, *, base: float, epochs: float, warmup_epochs: float, start_factor: float = 1e-3) -> float:
    """The Hypersim paper's learning rate: a linear warm-up to `base`, then half a cosine down to zero.

    epoch: epochs finished so far, whole or in part. The first value is `start_factor` * `base`; zero would be reached at `epochs`.
    The same as torch's LinearLR followed by CosineAnnealingLR.
    """
    if epoch < warmup_epochs:
        return base * (start_factor + (1.0 - start_factor) * epoch / warmup_epochs)
    if epochs <= warmup_epochs:
        return base
    progress = min((epoch - warmup_epochs) / (epochs - warmup_epochs), 1.0)
    return base * 0.5 * (1.0 + math.cos(math.pi * progress))


def warmup_steps(
    iteration: int, *, base: float, warmup_iterations: int, milestones: Sequence[int], warmup_factor: float = 0.1, gamma: float = 0.1
) -> float:
    """Detectron2's learning rate (WarmupMultiStepLR): a linear warm-up, then a step down by `gamma` at each milestone.

    iteration: batches finished so far. The first value is `warmup_factor` * `base`.
    """
    warmup = 1.0
    if iteration < warmup_iterations:
        warmup = warmup_factor + (1.0 - warmup_factor) * iteration / warmup_iterations
    return base * warmup * gamma ** sum(iteration >= milestone for milestone in milestones)


def set_learning_rate(optimizer: Optimizer, rate: float) -> None:
    """Gives all groups of parameters this rate."""
    for group in optimizer.param_groups:
        group["lr"] = rate
