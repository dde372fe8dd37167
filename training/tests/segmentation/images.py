"""Small data for the tests of segmentation."""

from pathlib import Path

import numpy as np
from PIL import Image

from enfilade_training.segmentation.config import Augment, Config, Data, Evaluation, Network, Train

CLASSES = 4
COLORS = np.array([[200, 40, 40], [40, 200, 40], [40, 40, 200], [200, 200, 40]])


def write_pairs(folder: Path, count: int, size: tuple[int, int] = (40, 48), classes: int = CLASSES, seed: int = 0) -> None:
    """Rectangles of classes 1 to `classes` in their own noisy colour, and a margin of 0, which is no class."""
    random = np.random.default_rng(seed)
    for kind in ("images", "labels"):
        (folder / kind).mkdir(parents=True, exist_ok=True)
    for i in range(count):
        labels = np.full(size, 1 + i % classes, dtype=np.uint8)
        for _ in range(6):
            y, x = random.integers(0, size[0] - 8), random.integers(0, size[1] - 8)
            labels[y : y + 16, x : x + 16] = random.integers(1, classes + 1)
        color = COLORS[(labels - 1) % len(COLORS)] + random.normal(0, 12, (*size, 3))
        labels[:, :2] = 0
        Image.fromarray(np.clip(color, 0, 255).astype(np.uint8)).save(folder / "images" / f"{i:03}.png")
        Image.fromarray(labels).save(folder / "labels" / f"{i:03}.png")


def config(folder: Path, **train: object) -> Config:
    """A run on pairs in `folder` that takes a second."""
    data = Data("pairs", folder)
    settings: dict = {"epochs": 4, "batch_size": 4, "workers": 0, "log_steps": 1, "warmup_epochs": 1.0}
    return Config(
        output=folder / "out",
        train_data=data,
        test_data=data,
        classes=CLASSES,
        network=Network(width=8, blocks=(1, 1, 1, 1)),
        augment=Augment(size=(32, 32)),
        train=Train(**(settings | train)),
        evaluation=Evaluation(every_epochs=2, pictures=1),
    )
