"""Pictures with classes and depth, decoded once and kept packed, so that training does not wait for files.

Photographs have a white frame. Of all pictures, the part is taken in which NYUv2 is evaluated (Eigen et al. 2014's crop): rows 22 to 235
and columns 20 to 299 of 240 x 320, and as much of other sizes.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Sequence

import enfilade
import numpy as np
import torch

from ..common import checkpoints
from .config import SEMANTICS40, UNIT

# What stands for "no class".
VOID = 255
# Metres beyond which there is no depth, in training and in scores.
FARTHEST_M = 10.0
# The weights of red, green and blue in luma (NTSC 1953).
LUMA = (0.299, 0.587, 0.114)
# Raised when what is packed changes its meaning.
FORMAT = 1


@dataclass(frozen=True)
class Pictures:
    """Packed pictures, whose classes and depths may be finer than their colours."""

    # uint8, N x 3 x H x W.
    color: torch.Tensor
    # uint8, N x H' x W': NYU40's classes from 0, and VOID.
    classes40: torch.Tensor
    # float16, N x H' x W': planar depth, 0 where there is none.
    depth_m: torch.Tensor
    names: list[str]

    def __len__(self) -> int:
        return len(self.names)

    def to(self, device: torch.device) -> "Pictures":
        """The same there."""
        return Pictures(self.color.to(device), self.classes40.to(device), self.depth_m.to(device), self.names)

    def classes(self, task: str, index: int | slice) -> torch.Tensor:
        """uint8: the classes of a task, from 0, and VOID."""
        found = self.classes40[index]
        return found if task == SEMANTICS40 else nyu13().to(found.device)[found.long()]


def nyu13() -> torch.Tensor:
    """NYU13's class of each of NYU40's, both from 0; VOID of VOID and all other numbers."""
    table = torch.full((256,), VOID, dtype=torch.uint8)
    table[:40] = torch.tensor([value - 1 if value >= 1 else VOID for value in enfilade.NYU13_OF_NYU40[1:]], dtype=torch.uint8)
    return table


def shares(classes: torch.Tensor, count: int) -> torch.Tensor:
    """float64: of the pixels with one of `count` classes, which share has each."""
    counts = torch.bincount(classes.flatten().long(), minlength=256)[:count].double()
    return counts / counts.sum().clamp(min=1.0)


def evenly(total: int, count: int) -> list[int]:
    """Indices of `count` of `total` things, or of all where they are fewer: the middles of as many equal parts."""
    count = min(count, total)
    return [(2 * i + 1) * total // (2 * count) for i in range(count)]


def window(height: int, width: int) -> tuple[slice, slice]:
    """Rows and columns of the part that is taken of a picture of a multiple of UNIT."""
    if height % UNIT[0] or height * UNIT[1] != width * UNIT[0]:
        raise ValueError(f"a picture has {height} rows and {width} columns, expected a multiple of {UNIT[0]} and {UNIT[1]}")
    scale = height // UNIT[0]
    return slice(11 * scale, 118 * scale), slice(10 * scale, 150 * scale)


def pack(color: Sequence[np.ndarray], labels: Sequence[np.ndarray], depth_m: Sequence[np.ndarray], names: list[str]) -> Pictures:
    """color: uint8, H x W x 3. labels: NYU40's numbers from 1; others are "no class". depth_m: what is no number or too far is none."""
    classes = [np.where((found >= 1) & (found <= 40), found - 1, VOID).astype(np.uint8) for found in labels]
    depths = [np.where((found > 0) & (found <= FARTHEST_M), found, 0).astype(np.float16) for found in depth_m]
    colors = np.ascontiguousarray(np.stack(color).transpose(0, 3, 1, 2))
    return Pictures(torch.from_numpy(colors), torch.from_numpy(np.stack(classes)), torch.from_numpy(np.stack(depths)), names)


def kept(path: Path, key: str, make: Callable[[], Pictures]) -> Pictures:
    """What `make` gives, from `path` where it was made from the same files before. key: tells them apart."""
    if path.is_file():
        state = checkpoints.load(path, remedy="delete it; it is made again")
        if (state.get("format"), state.get("key")) == (FORMAT, key):
            return Pictures(state["color"], state["classes40"], state["depth_m"], state["names"])
    made = make()
    checkpoints.save(path, {"format": FORMAT, "key": key, **vars(made)})
    return made
