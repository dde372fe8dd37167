"""Training: iterations of one batch each, from a checkpoint where there is one.

A run is a function of its settings and the number of replicas: which images, their flips, the regions and the points that are drawn are seeded by
the iteration. So a run that goes on from a checkpoint equals one that was never interrupted: on processors to the bit, while GPUs add up in
an order that changes from run to run.
"""

import time
from pathlib import Path
from typing import Any

import torch
from torch.nn.modules.batchnorm import _BatchNorm

from ..common import checkpoints, config as settings, distributed, logs, schedule
from .config import Config
from .data import Order, Shapes, batches
from .detector import STRIDES
from .model import build, to_device

LAST = "last.pt"


class TrainingError(RuntimeError):
    """Training that cannot go on."""


def train(config: Config, replica: distributed.Replica, until: int | None = None) -> Path:
    """Trains to the last iteration, or to `until` of them, and gives the checkpoint."""
    options, path = config.train, config.output / LAST
    torch.manual_seed(options.seed)
    shapes = Shapes(config.data.train, config.data)
    network = replica.parallel(build(config.network, config.losses, config.evaluate))
    optimizer = torch.optim.SGD(parameters(network, options.weight_decay), lr=options.learning_rate, momentum=options.momentum)
    done = _resume(path, config, network, optimizer, replica) if path.is_file() else 0
    end = options.iterations if until is None else min(until, options.iterations)
    order = Order(len(shapes), options.batch, options.seed, config.data.flip, replica.rank, replica.count)
    writer = logs.Logs(config.output, done) if replica.is_first else None
    began = time.monotonic()
    network.train()
    try:
        for iteration, batch in zip(range(done, end), batches(shapes, order, range(done, end), config.data.workers)):
            schedule.set_learning_rate(optimizer, learning_rate(config, iteration))
            losses = step(network, optimizer, batch, _seed(options.seed, iteration, replica.rank), replica, options.mixed_precision)
            finished = iteration + 1
            if writer and (finished % options.log_every == 0 or finished == end):
                values = {name: float(value) for name, value in losses.items()}
                writer.write("train", finished, values | {"loss": sum(values.values()), "learning_rate": learning_rate(config, iteration)})
                writer.scalar("speed/images_per_second", finished, (finished - done) * options.batch / (time.monotonic() - began))
            if replica.is_first and (finished % options.checkpoint_every == 0 or finished == end):
                state = {
                    "kind": "shapes",
                    "iteration": finished,
                    "network": distributed.unwrapped(network).state_dict(),
                    "optimizer": optimizer.state_dict(),
                    "config": settings.to_dict(config),
                }
                checkpoints.save(path, state)
    finally:
        if writer:
            writer.close()
    replica.wait()
    return path


def parameters(network: torch.nn.Module, weight_decay: float) -> list[dict[str, Any]]:
    """What learns, in groups: scales and shifts of batch normalisation do not decay, as in Detectron2."""
    of_norms = {p for layer in network.modules() if isinstance(layer, _BatchNorm) for p in layer.parameters(recurse=False)}
    learning = [p for p in network.parameters() if p.requires_grad]
    groups = [
        {"params": [p for p in learning if p not in of_norms], "weight_decay": weight_decay},
        {"params": [p for p in learning if p in of_norms], "weight_decay": 0.0},
    ]
    return [group for group in groups if group["params"]]


def learning_rate(config: Config, iteration: int) -> float:
    """The rate of an iteration, counted from 0."""
    options = config.train
    return schedule.warmup_steps(
        iteration,
        base=options.learning_rate,
        warmup_iterations=options.warmup_iterations,
        warmup_factor=options.warmup_factor,
        milestones=options.milestones,
    )


def step(
    network: torch.nn.Module,
    optimizer: torch.optim.Optimizer,
    batch: list[tuple[torch.Tensor, dict[str, Any]]],
    seed: int,
    replica: distributed.Replica,
    mixed_precision: bool,
) -> dict[str, torch.Tensor]:
    """One step down the gradient. Gives the losses, already weighted."""
    torch.manual_seed(seed)
    images = [image.to(replica.device) for image, _ in batch]
    targets = [to_device(target, replica.device) for _, target in batch]
    with torch.autocast(replica.device.type, dtype=torch.bfloat16, enabled=mixed_precision and distributed.has_bfloat16(replica.device)):
        losses = network(images, targets)
    total = sum(losses.values())
    if not torch.isfinite(total):
        told = ", ".join(f"{name} {float(value):.4g}" for name, value in losses.items())
        raise TrainingError(f"a loss is not finite ({told}); lower the learning rate, or lengthen the warm-up")
    optimizer.zero_grad(set_to_none=True)
    total.backward()
    optimizer.step()
    return {name: value.detach() for name, value in losses.items()}


def _seed(seed: int, iteration: int, rank: int) -> int:
    return (seed * 1_000_003 + iteration) * 4096 + rank


def _resume(
    path: Path, config: Config, network: torch.nn.Module, optimizer: torch.optim.Optimizer, replica: distributed.Replica
) -> int:
    state = checkpoints.load(path, replica.device)
    if state.get("kind") != "shapes":
        raise checkpoints.CheckpointError(f"{path}: is no checkpoint of the shape experiment; choose another output")
    changed = settings.differences(state["config"], settings.to_dict(config))
    free = {"output", "data.workers", "data.evaluate", "train.device", "train.checkpoint_every", "train.log_every"}
    changed = [key for key in changed if key not in free and not key.startswith("evaluate.")]
    if changed:
        raise checkpoints.CheckpointError(f"{path}: was made with other settings of {', '.join(changed)}; set them back, or choose another output")
    # Runs of the first version had no such tensor; their blocks were torchvision's.
    state["network"].setdefault(STRIDES, torch.tensor(False))
    distributed.unwrapped(network).load_state_dict(state["network"])
    optimizer.load_state_dict(state["optimizer"])
    return state["iteration"]
