"""The settings of the study; docs/real.md says what is compared and why."""

import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from ..common import config as settings
from ..segmentation.config import Augment

# What networks start from before they see photographs. RANDOM and IMAGENET are the arms without homes, each with the arm that adds homes to it.
RANDOM, IMAGENET = "random", "imagenet"
HOMES = {RANDOM: "homes", IMAGENET: "imagenet+homes"}
ARMS = (RANDOM, IMAGENET, *HOMES.values())
# What networks predict, all at once.
SEMANTICS, SEMANTICS40, DEPTH = "semantics", "semantics40", "depth"
# Channels of a task's head; depth is the logarithm of metres.
HEADS = {SEMANTICS: 13, SEMANTICS40: 40, DEPTH: 1}
# Height and width of which photographs have half the pixels of those at hand, and of which `size` is a multiple.
UNIT = (120, 160)


@dataclass(frozen=True)
class Recipe:
    """How weights are found: AdamW, with a linear warm-up and half a cosine down to zero."""

    steps: int
    batch_size: int = 16
    learning_rate: float = 3e-3
    warmup_steps: int = 50
    weight_decay: float = 0.01
    # Steps between checkpoints.
    checkpoint_steps: int = 100

    def __post_init__(self) -> None:
        for name in ("steps", "batch_size", "checkpoint_steps"):
            if getattr(self, name) < 1:
                raise ValueError(f"{name} is {getattr(self, name)}, expected at least 1")
        for name in ("learning_rate", "warmup_steps", "weight_decay"):
            if getattr(self, name) < 0:
                raise ValueError(f"{name} is {getattr(self, name)}, expected zero or more")


@dataclass(frozen=True)
class Camera:
    """How homes are photographed before networks see them, each number drawn within its bounds for every picture; the defaults leave them."""

    # How far the means of the channels are brought together: 0 leaves the colour of the light, 1 makes the mean grey.
    white_balance: tuple[float, float] = (0.0, 0.0)
    # The exponent of the tone curve, beside that of the tone map; more is darker and has more contrast.
    tone: tuple[float, float] = (1.0, 1.0)
    # A factor before the curve.
    gain: tuple[float, float] = (1.0, 1.0)
    # How much of the difference from the mean of 3 x 3 pixels is added.
    sharpening: tuple[float, float] = (0.0, 0.0)
    # Standard deviation of noise, of 0 to 1.
    noise: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        for name, (low, high) in vars(self).items():
            if not 0 <= low <= high:
                raise ValueError(f"{name} is {[low, high]}, expected two numbers of zero or more, the smaller first")

    def bounds(self) -> list[tuple[float, float]]:
        """In the order of its fields."""
        return list(vars(self).values())


@dataclass(frozen=True)
class Study:
    """What is compared."""

    # Folder of rendered homes and of runs.
    output: Path
    # Folder of NYUv2's photographs; `$NAME` at its beginning is a variable of the environment.
    photographs: str
    # What `enfilade run` renders.
    homes: Path
    pretraining: Recipe
    finetuning: Recipe
    # Those of its scenes that are made and learnt from; `*` stands for any run of characters. "*0" is a tenth of homes that are counted.
    scenes: str = "*"
    # Draws the frames of homes so that they are composed nearly as the training photographs are, as `composition` says. Of their labels and
    # depths the means are used, also in arms that see no photograph.
    composed: bool = False
    # Height and width at which networks see whole frames.
    size: tuple[int, int] = UNIT
    tasks: tuple[Literal["semantics", "semantics40", "depth"], ...] = (SEMANTICS, DEPTH)
    # Of the loss of depth, beside 1 for that of classes: with 1 short runs hardly learn depth, with 3 they learn classes worse.
    depth_weight: float = 2.0
    arms: tuple[Literal["random", "imagenet", "homes", "imagenet+homes"], ...] = ARMS
    # Shares of the training photographs.
    fractions: tuple[float, ...] = (0.1, 0.25, 0.5, 1.0)
    # Runs of each arm and share, with the seeds 0, 1, ...
    seeds: int = 3
    augment: Augment = field(default_factory=lambda: Augment(size=(96, 96)))
    # Of homes alone.
    camera: Camera = field(default_factory=Camera)
    # Of the bootstrap.
    resamples: int = 2000
    # Where and how it is computed. Sums are added in another order by other threads and devices, so that last digits differ.
    threads: int = 1
    device: Literal["auto", "cpu", "cuda"] = "auto"
    # bfloat16 is for GPUs; processors are slower with it.
    precision: Literal["float32", "bfloat16"] = "float32"

    def __post_init__(self) -> None:
        if self.seeds < 1 or self.threads < 1 or self.resamples < 1:
            raise ValueError(f"seeds, threads and resamples are {self.seeds}, {self.threads} and {self.resamples}, expected at least 1")
        if self.size[0] < 1 or self.size[0] % UNIT[0] or self.size[0] * UNIT[1] != self.size[1] * UNIT[0]:
            raise ValueError(f"size is {list(self.size)}, expected a multiple of {list(UNIT)}, height and width")
        if not self.depth_weight > 0:
            raise ValueError(f"depth_weight is {self.depth_weight}, expected a number above zero")
        for name in ("tasks", "arms", "fractions"):
            values = getattr(self, name)
            if not values or len(set(values)) != len(values):
                raise ValueError(f"{name} is {list(values)}, expected one or more, each once")
        if not all(0 < fraction <= 1 for fraction in self.fractions):
            raise ValueError(f"fractions is {list(self.fractions)}, expected shares above 0 and up to 1")

    @property
    def heads(self) -> dict[str, int]:
        """Channels by task."""
        return {task: HEADS[task] for task in self.tasks}

    def photographs_folder(self) -> Path:
        """The folder of photographs.

        Raises ConfigError where the variable that names it is not set.
        """
        first, slash, rest = self.photographs.partition("/")
        if not first.startswith("$"):
            return Path(self.photographs)
        value = os.environ.get(first[1:])
        if not value:
            raise settings.ConfigError(
                f"photographs is {self.photographs}, but the variable {first[1:]} is not set; set it to the folder of NYUv2's labelled "
                "photographs, with rgb, depth_mm, label40 and split.json, which docs/real.md describes"
            )
        return Path(value + slash + rest)


def meaning(study: Study, recipe: Recipe) -> dict[str, Any]:
    """The settings on which weights depend, beside the data, as plain data."""
    plain = settings.to_dict(study)
    steps = settings.to_dict(recipe)
    del steps["checkpoint_steps"]
    return {key: plain[key] for key in ("size", "tasks", "depth_weight", "augment", "precision")} | {"recipe": steps}
