"""The settings of an experiment: the tables and keys of its TOML file, with Mesh R-CNN's values for Pix3D as defaults."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from ..common.config import ConfigError


@dataclass(frozen=True)
class Data:
    """Which images; files are Mesh R-CNN's JSON, as `enfilade export --format pix3d` and `enfilade import` write it.

    root: where paths in the files begin; their own folders unless given. min_visibility: objects of which less is seen are left out,
    where the file tells it. min_pixels: objects whose box has fewer pixels are left out of training. leaving: whether objects stay of which a
    vertex is behind the camera, nearer than 1 cm, or outside of the image; Mesh R-CNN keeps them on Pix3D, Roberts et al. drop them in rooms.
    """

    train: tuple[Path, ...] = ()
    evaluate: Path | None = None
    root: Path | None = None
    min_visibility: float = 0.0
    min_pixels: float = 0.0
    leaving: Literal["drop", "keep"] = "drop"
    flip: bool = True
    workers: int = 4


@dataclass(frozen=True)
class Network:
    """The network. weights: a file of torchvision, Detectron2 or Mesh R-CNN, or a checkpoint of an earlier run, to begin with; nothing is downloaded.

    weights_pixels: which images Detectron2's weights are for, blue first from 0 to 255 or red first and divided by ImageNet's deviation;
    unless given, as the file says, else blue first. stride_in_1x1: whether the blocks of 50 and 101 layers halve the size in their first
    convolution, as MSRA's weights and all of Detectron2's blue first do, or in the second, as torchvision's; unless given, as the weights want
    it. trainable_stages: of the backbone's five, those that learn; unless given 3 after `weights`, else 5. Batch statistics of a backbone that
    begins with weights stay as they are.
    """

    backbone: Literal["resnet18", "resnet34", "resnet50", "resnet101"] = "resnet50"
    weights: Path | None = None
    weights_pixels: Literal["bgr", "rgb"] | None = None
    stride_in_1x1: bool | None = None
    trainable_stages: int | None = None
    min_size: int = 800
    max_size: int = 1333
    anchors: tuple[int, ...] = (32, 64, 128, 256, 512)
    regions: int = 64
    head_width: int = 1024
    voxel_side: int = 24
    cubify_threshold: float = 0.2
    mesh_stages: int = 3
    mesh_convolutions: int = 3
    mesh_width: int = 128

    def __post_init__(self) -> None:
        if self.voxel_side < 4 or self.voxel_side % 2:
            raise ConfigError(f"voxel_side is {self.voxel_side}, expected an even number from 4 on")
        if len(self.anchors) != 5:
            raise ConfigError(f"anchors has {len(self.anchors)} sizes, expected one for each of the 5 levels")


@dataclass(frozen=True)
class Losses:
    """Weights of the losses, points drawn from each mesh, and the limit of true coordinates beyond which a batch teaches no meshes."""

    depth: float = 1.0
    voxel: float = 3.0
    chamfer: float = 1.0
    normals: float = 0.1
    edge: float = 1.0
    samples: int = 5000
    coordinate_limit: float = 5.0


@dataclass(frozen=True)
class Train:
    """How it learns. batch: images of all replicas together. learning_rate: 0.02, and 0.005 in pre-training.

    mixed_precision: bfloat16 where it is safe, on GPUs that have it; the authors' networks are trained in single precision.
    """

    iterations: int = 11000
    batch: int = 16
    learning_rate: float = 0.02
    warmup_iterations: int = 1000
    warmup_factor: float = 0.1
    milestones: tuple[int, ...] = (8000, 10000)
    momentum: float = 0.9
    weight_decay: float = 1e-4
    seed: int = 0
    device: Literal["auto", "cpu", "cuda"] = "auto"
    mixed_precision: bool = False
    checkpoint_every: int = 500
    log_every: int = 20


@dataclass(frozen=True)
class Evaluate:
    """How it is judged: Mesh R-CNN's rules. samples: points of either surface. score, detections: what the network keeps of an image."""

    samples: int = 10_000
    seed: int = 0
    score: float = 0.05
    detections: int = 100


@dataclass(frozen=True)
class Config:
    """An experiment. output: the folder for checkpoints, logs and results."""

    output: Path
    data: Data
    network: Network = field(default_factory=Network)
    losses: Losses = field(default_factory=Losses)
    train: Train = field(default_factory=Train)
    evaluate: Evaluate = field(default_factory=Evaluate)
