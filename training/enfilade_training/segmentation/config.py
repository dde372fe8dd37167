"""The settings of a segmentation experiment; defaults are the paper's recipe, and docs/training.md says where each value comes from."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal


@dataclass(frozen=True)
class Data:
    """Images with classes."""

    # enfilade: a dataset of enfilade, or Hypersim's release. nyuv2: nyu_depth_v2_labeled.mat. pairs: folders of images and PNG labels.
    kind: Literal["enfilade", "nyuv2", "pairs"]
    # Folder of the dataset; of nyuv2 the file.
    path: Path
    split: Literal["train", "val", "test"] | None = None
    # enfilade: names, in which `*` stands for any run of characters; all unless given.
    scenes: tuple[str, ...] = ()
    cameras: tuple[str, ...] = ()
    # enfilade: another metadata_camera_parameters.csv.
    camera_table: Path | None = None
    # pairs: folders below `path`, and how the label files' numbers count.
    images: str = "images"
    labels: str = "labels"
    # pairs: the first class, and the number that means "no class" besides all that are out of range.
    first_class: int = 1
    # nyuv2: takes a file with other than the 1449 published images.
    partial: bool = False
    # Only the first so many images in an order by `subset_seed`: for experiments with a part of the data.
    limit: int | None = None
    subset_seed: int = 0

    def __post_init__(self) -> None:
        if self.kind == "nyuv2" and self.split == "val":
            raise ValueError("split is 'val', but NYUv2's published split has 'train' and 'test' only")
        if self.kind == "pairs" and self.split is not None:
            raise ValueError("split: folders of pairs have none; name the folders of one side by `images` and `labels`")
        if self.limit is not None and self.limit < 1:
            raise ValueError(f"limit is {self.limit}, expected at least 1")


@dataclass(frozen=True)
class Network:
    """A U-Net on the encoder of ResNet-34."""

    # Channels of the first stage; 64 is ResNet-34.
    width: int = 64
    # Residual blocks of the four stages.
    blocks: tuple[int, int, int, int] = (3, 4, 6, 3)
    # A state dictionary of torchvision's resnet34 for the encoder, such as ImageNet's.
    encoder_weights: Path | None = None
    # Subtracted from and divided into colours on [0, 1]: ImageNet's, as torchvision's weights expect.
    mean: tuple[float, float, float] = (0.485, 0.456, 0.406)
    std: tuple[float, float, float] = (0.229, 0.224, 0.225)

    def __post_init__(self) -> None:
        if self.width < 4 or self.width % 4 != 0:
            raise ValueError(f"width is {self.width}, expected a multiple of 4")
        if min(self.blocks) < 1:
            raise ValueError(f"blocks is {self.blocks}, expected at least one block per stage")


@dataclass(frozen=True)
class Augment:
    """What is done to images in training."""

    # Height and width after the random crop.
    size: tuple[int, int] = (512, 512)
    # Bounds of the crop's share of the image's area, and of its width over its height.
    scale: tuple[float, float] = (0.08, 1.0)
    ratio: tuple[float, float] = (0.75, 1.33)
    flip: float = 0.5
    # Hue is turned by up to so much of the whole circle; saturation and brightness are multiplied by a factor within these bounds.
    hue: float = 0.375
    saturation: tuple[float, float] = (0.25, 1.75)
    brightness: tuple[float, float] = (0.25, 1.75)
    jitter: float = 0.5
    # Whether each of the three is applied with that probability, or all together or none.
    jitter_per_factor: bool = True

    def __post_init__(self) -> None:
        for name in ("scale", "ratio", "saturation", "brightness"):
            low, high = getattr(self, name)
            if not 0 <= low <= high or (name in ("scale", "ratio") and low == 0):
                raise ValueError(f"{name} is {[low, high]}, expected two numbers above zero, the smaller first")
        if self.scale[1] > 1:
            raise ValueError(f"scale is {list(self.scale)}, expected shares of the image, at most 1")
        if not 0 <= self.hue <= 0.5:
            raise ValueError(f"hue is {self.hue}, expected 0 to 0.5")
        for name in ("flip", "jitter"):
            if not 0 <= getattr(self, name) <= 1:
                raise ValueError(f"{name} is {getattr(self, name)}, expected a probability")
        if min(self.size) < 1:
            raise ValueError(f"size is {list(self.size)}, expected height and width")


@dataclass(frozen=True)
class Train:
    """How weights are found."""

    epochs: int = 100
    # Images per step over all replicas; the paper has 8 replicas with 8 each.
    batch_size: int = 64
    optimizer: Literal["sgd", "adam"] = "sgd"
    # Of the one-cycle cosine.
    learning_rate: float = 0.01
    warmup_epochs: float = 3.0
    # Whether the rate changes after each epoch or after each step.
    schedule_by: Literal["epoch", "step"] = "epoch"
    momentum: float = 0.9
    weight_decay: float = 1e-4
    # float32, unless asked for otherwise. auto: bfloat16 on GPUs that have it, else float16 with scaled gradients on GPUs, else float32.
    precision: Literal["auto", "float32", "bfloat16", "float16"] = "float32"
    # A checkpoint to begin with: fine-tuning. The head is new where it has other classes.
    init_from: Path | None = None
    # Drops the images of an epoch that fill no batch; otherwise the batch is filled with images of the epoch's beginning.
    drop_last: bool = True
    # Processes per replica that prepare images; 0 prepares them in the replica itself.
    workers: int = 4
    # Steps between checkpoints within an epoch; at the end of an epoch there always is one.
    checkpoint_steps: int | None = None
    # Steps between lines of the log.
    log_steps: int = 10

    def __post_init__(self) -> None:
        for name in ("epochs", "batch_size", "log_steps"):
            if getattr(self, name) < 1:
                raise ValueError(f"{name} is {getattr(self, name)}, expected at least 1")
        if self.checkpoint_steps is not None and self.checkpoint_steps < 1:
            raise ValueError(f"checkpoint_steps is {self.checkpoint_steps}, expected at least 1")
        for name in ("learning_rate", "warmup_epochs", "momentum", "weight_decay", "workers"):
            if getattr(self, name) < 0:
                raise ValueError(f"{name} is {getattr(self, name)}, expected zero or more")


@dataclass(frozen=True)
class Evaluation:
    """How networks are judged: whole images in their own size, unlabelled pixels left out."""

    # Epochs between evaluations in training; there is one at the end in any case. 0 evaluates at the end alone.
    every_epochs: int = 10
    # Images per step and replica.
    batch_size: int = 4
    # Pictures that are shown in TensorBoard.
    pictures: int = 4


@dataclass(frozen=True)
class Config:
    """An experiment."""

    # Folder of checkpoints and logs.
    output: Path
    train_data: Data
    # What networks are judged by; they are not judged in training without it.
    test_data: Data | None = None
    # NYU's sets of classes, or for `pairs` any number.
    classes: int = 13
    seed: int = 0
    device: Literal["auto", "cpu", "cuda"] = "auto"
    network: Network = field(default_factory=Network)
    augment: Augment = field(default_factory=Augment)
    train: Train = field(default_factory=Train)
    evaluation: Evaluation = field(default_factory=Evaluation)

    def __post_init__(self) -> None:
        for data in filter(None, (self.train_data, self.test_data)):
            known = {"enfilade": (13, 40), "nyuv2": (13, 40, 894)}.get(data.kind)
            if known and self.classes not in known:
                raise ValueError(f"classes is {self.classes}, but {data.kind} has sets of {', '.join(map(str, known))} classes")
        if self.classes < 2:
            raise ValueError(f"classes is {self.classes}, expected at least 2")
