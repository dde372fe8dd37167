"""A small folder in the layout of NYUv2's photographs at half size: noise in rectangles of a few classes, and planes of depth."""

import json
from pathlib import Path

import numpy as np
from PIL import Image

from enfilade_training.common import config as settings
from enfilade_training.study.config import Study
from tests.ranks import ROOT

STUDY = ROOT / "studies" / "nyuv2.toml"
# NYU40's wall, floor, bed and chair.
CLASSES = (1, 2, 4, 5)


def write(folder: Path, train: int = 6, test: int = 4, seed: int = 0) -> Path:
    """Gives the folder."""
    random = np.random.default_rng(seed)
    names = [f"{i + 1:04}" for i in range(train + test)]
    for part in ("rgb", "depth_mm", "label40", "label13"):
        (folder / part).mkdir(parents=True, exist_ok=True)
    for name in names:
        labels = np.full((240, 320), random.choice(CLASSES), dtype=np.uint8)
        for _ in range(4):
            y, x = random.integers(0, 200), random.integers(0, 260)
            labels[y : y + 90, x : x + 90] = random.choice(CLASSES)
        labels[:40], labels[:, -40:] = 0, 0
        color = np.array([[0, 0, 0], [200, 190, 180], [120, 80, 50], [0, 0, 0], [60, 90, 200], [180, 40, 40]])[labels] + random.normal(0, 9, (240, 320, 3))
        depth = np.linspace(4500, 900, 240)[:, None] + 100.0 * labels
        Image.fromarray(color.clip(0, 255).astype(np.uint8)).save(folder / "rgb" / f"{name}.jpg", quality=90)
        Image.fromarray(depth.astype(np.uint16)).save(folder / "depth_mm" / f"{name}.png")
        Image.fromarray(labels).save(folder / "label40" / f"{name}.png")
        Image.fromarray(labels).save(folder / "label13" / f"{name}.png")
    split = {"train": names[:train], "test": names[train:]}
    (folder / "split.json").write_text(json.dumps(split), encoding="utf-8")
    return folder


def options(folder: Path, *more: str) -> list[str]:
    """Settings that make an afternoon's study one of seconds, for photographs in `folder`/nyu and homes of `folder`/homes.toml."""
    found = [str(STUDY)]
    small = ["seeds=2", "augment.size=[32, 32]", 'arms=["random", "homes"]', "fractions=[0.5, 1.0]", "resamples=50"]
    small += [f"{run}.{key}" for run in ("pretraining", "finetuning") for key in ("steps=2", "batch_size=2", "warmup_steps=1")]
    small += [f"output={folder / 'out'}", f"photographs={folder / 'nyu'}", f"homes={folder / 'homes.toml'}"]
    for override in (*small, *more):
        found += ["--set", override]
    return found


def study(folder: Path, *more: str) -> Study:
    """The settings of `options`."""
    arguments = options(folder, *more)
    return settings.read(Study, arguments[0], arguments[2::2])
