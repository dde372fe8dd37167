"""A run: a network, trained on pictures for a number of steps, which goes on where it was ended to the same bits."""

import json
import time
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable

import numpy as np
import torch
from torch.nn import functional as F

from ..common import checkpoints
from ..common.checkpoints import CheckpointError
from ..common.schedule import one_cycle_cosine, set_learning_rate
from .batches import batch, places
from .config import DEPTH, IMAGENET, Camera, Recipe, Study
from .network import UNet, imagenet_file, take_imagenet
from .pictures import VOID, Pictures

# How many losses a run keeps.
KEPT = 20
# Metres that a new network predicts everywhere.
FIRST_DEPTH_M = 2.5


@dataclass(frozen=True)
class Trained:
    """A network and how it came about. losses: [steps, mean loss by task since the entry before]; pictures: how many it was trained on."""

    network: UNet
    losses: list[list[Any]]
    pictures: int


def new_network(study: Study, seed: int, start: str) -> UNet:
    """A network with random weights, and of ImageNet in the encoder where `start` says so."""
    torch.manual_seed(seed)
    network = UNet(study.heads)
    if DEPTH in network.heads:
        torch.nn.init.constant_(network.heads[DEPTH].bias, float(np.log(FIRST_DEPTH_M)))
    if start == IMAGENET:
        take_imagenet(network.encoder, imagenet_file())
    return network


def loss(task: str, predicted: torch.Tensor, truth: torch.Tensor) -> torch.Tensor:
    """Cross-entropy of classes, or the mean absolute difference of the logarithms of depths, of the pixels that have a truth."""
    if task != DEPTH:
        known = (truth != VOID).sum().clamp(min=1)
        return F.cross_entropy(predicted.float(), truth.long(), ignore_index=VOID, reduction="sum") / known
    known = truth > 0
    distances = (predicted[:, 0].float() - truth.clamp(min=1e-3).log()).abs()
    return (distances * known).sum() / known.sum().clamp(min=1)


def device_of(study: Study) -> torch.device:
    """Where the study computes."""
    if study.device == "cuda" and not torch.cuda.is_available():
        raise ValueError("device is 'cuda', but torch finds no GPU; set it to 'cpu' or 'auto'")
    return torch.device("cuda" if study.device != "cpu" and torch.cuda.is_available() else "cpu")


def autocast(study: Study, device: torch.device) -> Any:
    """Where convolutions are computed in fewer bits, if the study asks for that."""
    return torch.autocast(device.type, dtype=torch.bfloat16) if study.precision == "bfloat16" else nullcontext()


def train(
    study: Study, recipe: Recipe, seed: int, key: str, folder: Path, pictures: Pictures, begin: Callable[[], UNet],
    *, camera: Camera | None = None, stop_after: int | None = None, say: Callable[[str], None] = lambda _: None,
) -> Trained:  # fmt: skip
    """Trains what `begin` gives, or goes on from `last.pt` of the folder, which also a finished run leaves.

    key: tells runs apart; a checkpoint of another is an error. stop_after: ends the run after so many steps in all, as an interruption would.
    """
    last, device = folder / "last.pt", device_of(study)
    state = checkpoints.load(last) if last.exists() else None
    if state is not None and state.get("key") != key:
        raise CheckpointError(f"{last}: is of another run, {state.get('key')!r}, expected {key!r}; delete it, or choose another output")
    network = UNet(study.heads) if state else begin()
    network, pictures = network.to(device, memory_format=torch.channels_last).train(), pictures.to(device)
    optimizer = torch.optim.AdamW(network.parameters(), lr=recipe.learning_rate, weight_decay=recipe.weight_decay)
    step, losses, sums, began = 0, [], torch.zeros(len(study.tasks)), time.process_time()
    if state is not None:
        network.load_state_dict(state["network"])
        step, losses, sums = state["step"], state["losses"], state["sums"]
        if step >= recipe.steps:
            return Trained(network, losses, len(pictures))
        optimizer.load_state_dict(state["optimizer"])
    first, every = step, max(1, recipe.steps // KEPT)
    weights = torch.tensor([study.depth_weight if task == DEPTH else 1.0 for task in study.tasks], device=device)
    while step < recipe.steps:
        chosen = places(seed, step, recipe.batch_size, len(pictures))
        images, truths = batch(pictures, chosen, seed, study.augment, study.tasks, camera)
        rate = one_cycle_cosine(step, base=recipe.learning_rate, epochs=recipe.steps, warmup_epochs=min(recipe.warmup_steps, recipe.steps))
        set_learning_rate(optimizer, rate)
        optimizer.zero_grad(set_to_none=True)
        with autocast(study, device):
            predicted = network(images)
        found = torch.stack([loss(task, predicted[task], truths[task]) for task in study.tasks])
        (found * weights).sum().backward()
        optimizer.step()
        step, sums = step + 1, sums + found.detach().cpu()
        if step % every == 0:
            _refuse_nan(sums, step, last)
            means = sums / every
            losses.append([step, {task: round(float(mean), 4) for task, mean in zip(study.tasks, means)}])
            sums = torch.zeros(len(study.tasks))
            cost = (time.process_time() - began) / (step - first) / recipe.batch_size
            say(f"  step {step} of {recipe.steps}: loss {json.dumps(losses[-1][1])}, {1000 * cost:.1f} ms of processor time per picture")
        stopped = stop_after is not None and step >= stop_after
        if step == recipe.steps or stopped or step % recipe.checkpoint_steps == 0:
            kept = {"key": key, "network": network.state_dict(), "step": step, "losses": losses, "sums": sums, "pictures": len(pictures)}
            # A finished run needs no more than its weights.
            checkpoints.save(last, kept if step == recipe.steps else kept | {"optimizer": optimizer.state_dict()})
        if stopped:
            break
    return Trained(network, losses, len(pictures))


def _refuse_nan(sums: torch.Tensor, step: int, last: Path) -> None:
    if not torch.isfinite(sums).all():
        raise FloatingPointError(f"the loss is no number before step {step}; the last checkpoint is {last}. Lower learning_rate of the recipe")
