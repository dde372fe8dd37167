"""The training run: the paper's recipe in one piece, which goes on where it was ended."""

import time
from contextlib import nullcontext
from pathlib import Path
from typing import Any, Callable, ContextManager

import torch
from torch import nn
from torch.nn import functional as F

from ..common import checkpoints
from ..common import config as settings
from ..common.checkpoints import CheckpointError
from ..common.config import ConfigError
from ..common.distributed import Replica, has_bfloat16, unwrapped
from ..common.logs import Logs
from ..common.schedule import one_cycle_cosine, set_learning_rate
from . import evaluate, network
from .config import Config
from .data import VOID, Source, batches, open_source, training_loader

# Raised when what a checkpoint holds changes its meaning.
FORMAT = 1
# Settings that may differ when a run goes on: they change no weight.
FREE = {"output", "device", "train.workers", "train.checkpoint_steps", "evaluation.pictures", "evaluation.batch_size"}


def train(config: Config, replica: Replica, *, stop_after: int | None = None, say: Callable[[str], None] = lambda _: None) -> dict[str, Any]:
    """Trains, from the beginning or from `last.pt` of the output folder, and gives the last scores.

    stop_after: ends the run after so many steps in all, with a checkpoint, as an interruption would.
    """
    run = _Run(config, replica, say)
    with Logs(config.output, run.steps) if replica.is_first else nullcontext() as logs:
        run.go(logs, stop_after)
    return run.scores


class _Run:
    def __init__(self, config: Config, replica: Replica, say: Callable[[str], None]):
        self.config, self.replica, self.say = config, replica, say
        if config.train.batch_size % replica.count != 0:
            raise ConfigError(f"train.batch_size is {config.train.batch_size}, expected a multiple of the {replica.count} replicas")
        self.source = open_source(config.train_data, config.classes)
        self.judged = None if config.test_data is None else open_source(config.test_data, config.classes)
        self.per_epoch = len(batches(config.seed, 0, len(self.source), config.train.batch_size, config.train.drop_last))
        # What a run consists of; a checkpoint has all of it.
        self.epoch = self.step = self.steps = 0
        self.loss_sum = self.pixel_sum = 0.0
        self.scores: dict[str, Any] = {}
        self.last = config.output / "last.pt"
        checkpoints.seed_everything(config.seed)
        bare = network.build(config.network, config.classes)
        state = checkpoints.load(self.last) if self.last.exists() else None
        if state is None and config.train.init_from is not None:
            same = network.begin_with(bare, config.train.init_from)
            say(f"weights of {config.train.init_from}" + ("" if same else f", with a new head for {config.classes} classes"))
        self.network = replica.parallel(bare)
        self.optimizer = optimizer(self.network, config)
        self.precision = precision(config, replica.device)
        self.scaler = torch.amp.GradScaler("cuda", enabled=self.precision is torch.float16)
        if state is not None:
            self.resume(state)

    def go(self, logs: Logs | None, stop_after: int | None) -> None:
        """The steps that are left."""
        config, replica = self.config, self.replica
        loader = training_loader(config, self.source, replica.rank, replica.count, self.epoch, self.step)
        self.network.train()
        began, first = time.monotonic(), self.steps
        while self.epoch < config.train.epochs:
            images, classes = (part.to(replica.device, non_blocking=True) for part in next(loader))
            rate = self.learning_rate()
            loss, pixels = self.one_step(images, classes, rate)
            self.step, self.steps = self.step + 1, self.steps + 1
            self.loss_sum, self.pixel_sum = self.loss_sum + loss * pixels, self.pixel_sum + pixels
            if logs and self.steps % config.train.log_steps == 0:
                logs.write("train", self.steps, {"epoch": self.epoch, "loss": loss, "learning_rate": rate})
                logs.scalar("images_per_second", self.steps, config.train.batch_size * (self.steps - first) / (time.monotonic() - began))
            ended = self.step == self.per_epoch
            if ended:
                self.end_epoch(logs)
            stopped = stop_after is not None and self.steps >= stop_after
            every = config.train.checkpoint_steps
            if ended or stopped or (every is not None and self.steps % every == 0):
                self.save()
            if stopped:
                return

    def learning_rate(self) -> float:
        """Of the step that is next."""
        train, fraction = self.config.train, self.step / self.per_epoch if self.config.train.schedule_by == "step" else 0.0
        return one_cycle_cosine(
            self.epoch + fraction, base=train.learning_rate, epochs=train.epochs, warmup_epochs=train.warmup_epochs
        )

    def one_step(self, images: torch.Tensor, classes: torch.Tensor, rate: float) -> tuple[float, float]:
        """Changes the weights; gives the mean loss of the labelled pixels of all replicas, and their number."""
        set_learning_rate(self.optimizer, rate)
        self.optimizer.zero_grad(set_to_none=True)
        pixels = self.replica.sum((classes != VOID).sum().float())
        with self.autocast():
            scores = self.network(images)
        share = F.cross_entropy(scores.float(), classes, ignore_index=VOID, reduction="sum") / pixels.clamp(min=1.0)
        # Gradients are averaged over replicas; their sum is that of the mean over all pixels.
        self.scaler.scale(share * self.replica.count).backward()
        self.scaler.step(self.optimizer)
        self.scaler.update()
        loss = float(self.replica.sum(share.detach()))
        if loss != loss:
            raise FloatingPointError(
                f"the loss is no number at step {self.steps + 1}; the last checkpoint is {self.last}. "
                "Lower train.learning_rate, or set train.precision='float32'"
            )
        return loss, float(pixels)

    def autocast(self) -> ContextManager[Any]:
        """Where matrices are multiplied in fewer bits."""
        if self.precision is torch.float32:
            return nullcontext()
        return torch.autocast(self.replica.device.type, dtype=self.precision)

    def end_epoch(self, logs: Logs | None) -> None:
        """Reports the epoch, judges the network when it is time, and begins the next."""
        mean = self.loss_sum / max(self.pixel_sum, 1.0)
        if logs:
            logs.write("epoch", self.steps, {"epoch": self.epoch, "loss": mean})
        self.epoch, self.step, self.loss_sum, self.pixel_sum = self.epoch + 1, 0, 0.0, 0.0
        every, last = self.config.evaluation.every_epochs, self.epoch == self.config.train.epochs
        told = f"epoch {self.epoch} of {self.config.train.epochs}: loss {mean:.4f}"
        if self.judged is not None and (last or (every and self.epoch % every == 0)):
            self.judge(self.judged, logs)
            told += f", mean IoU {self.scores['mean_iou'] or 0.0:.4f}"
        self.say(told)

    def judge(self, source: Source, logs: Logs | None) -> None:
        bare = unwrapped(self.network)
        confusion = evaluate.evaluate(bare, source, self.config, self.replica)
        self.scores = evaluate.report(confusion, self.config)
        if logs:
            logs.write("test", self.steps, {"epoch": self.epoch, **self.scores})
            shown = evaluate.pictures(bare, source, self.config.evaluation.pictures, self.replica.device, self.config.classes)
            for name, picture in shown:
                logs.picture(f"test/{name}", self.steps, torch.from_numpy(picture).permute(2, 0, 1))

    def save(self) -> None:
        """Writes `last.pt`."""
        random = self.replica.gather(checkpoints.random_state())
        if self.replica.is_first:
            bare = unwrapped(self.network)
            # Sorted by nothing but the network's own order, so that the number of replicas does not show.
            state = {
                "format": FORMAT,
                "config": settings.to_dict(self.config),
                "network": bare.state_dict(),
                "optimizer": self.optimizer.state_dict(),
                "scaler": self.scaler.state_dict(),
                "epoch": self.epoch,
                "step": self.step,
                "steps": self.steps,
                "loss_sum": self.loss_sum,
                "pixel_sum": self.pixel_sum,
                "scores": self.scores,
                "images": len(self.source),
                "random": random,
            }
            checkpoints.save(self.last, state)
        self.replica.wait()

    def resume(self, state: dict[str, Any]) -> None:
        """Goes on from a checkpoint. The order of the data follows from seed, epoch and step."""
        check_format(state, self.last)
        found = settings.differences(state["config"], settings.to_dict(self.config))
        changed = [key for key in found if key not in FREE]
        if changed:
            raise CheckpointError(
                f"{self.last}: the run there has other settings ({', '.join(changed)}); set them as they were, or choose another output"
            )
        if state["images"] != len(self.source):
            raise CheckpointError(f"{self.last}: the run there has {state['images']} images, the dataset now {len(self.source)}")
        unwrapped(self.network).load_state_dict(state["network"])
        self.optimizer.load_state_dict(state["optimizer"])
        self.scaler.load_state_dict(state["scaler"])
        for name in ("epoch", "step", "steps", "loss_sum", "pixel_sum", "scores"):
            setattr(self, name, state[name])
        checkpoints.set_random_state(state["random"][self.replica.rank % len(state["random"])])
        self.say(f"goes on from {self.last}, step {self.steps}")


def optimizer(network: nn.Module, config: Config) -> torch.optim.Optimizer:
    """What changes the weights; its rate is set before each step."""
    train = config.train
    if train.optimizer == "adam":
        return torch.optim.Adam(network.parameters(), lr=train.learning_rate, weight_decay=train.weight_decay)
    return torch.optim.SGD(network.parameters(), lr=train.learning_rate, momentum=train.momentum, weight_decay=train.weight_decay)


def precision(config: Config, device: torch.device) -> torch.dtype:
    """The type in which convolutions are computed."""
    asked = config.train.precision
    if asked == "float16" and device.type != "cuda":
        raise ConfigError("train.precision is 'float16', which needs a GPU; set it to 'auto', 'bfloat16' or 'float32'")
    if asked == "auto":
        if device.type != "cuda":
            return torch.float32
        return torch.bfloat16 if has_bfloat16(device) else torch.float16
    return {"float32": torch.float32, "bfloat16": torch.bfloat16, "float16": torch.float16}[asked]


def check_format(state: dict[str, Any], path: Path) -> None:
    """Refuses what is no checkpoint of this program."""
    if state.get("format") != FORMAT or "network" not in state:
        raise CheckpointError(f"{path}: is of format {state.get('format')}, expected {FORMAT}; it was not written by this version")


def trained(config: Config, path: Path, device: torch.device) -> network.UNet:
    """The network of a checkpoint, which must have the classes and the width of the settings."""
    state = checkpoints.load(path, device)
    check_format(state, path)
    made = network.UNet(config.network, config.classes).to(device)
    network.load(made, state["network"], path, "the network that the settings describe")
    return made.eval()
