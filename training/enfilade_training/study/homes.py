"""The rendered homes of pre-training: made by `enfilade.run`, and packed as photographs are."""

import hashlib
import json
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

import enfilade
import numpy as np

from ..common.config import ConfigError
from .pictures import Pictures, kept, pack, window


def digest(file: Path) -> str:
    """Of what a dataset.toml says, which is what tells one set of homes from another; comments are no part of it."""
    try:
        said = tomllib.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise ConfigError(f"{file}: cannot be read ({error.strerror}); homes names the dataset.toml of pre-training") from error
    except ValueError as error:
        raise ConfigError(f"{file}: is no TOML ({error})") from error
    return hashlib.sha256(json.dumps(said, sort_keys=True, default=str).encode()).hexdigest()[:16]


@dataclass(frozen=True)
class Homes:
    """A dataset. scenes: its scenes that are learnt from, in which `*` stands for any run of characters; failed: those that are left out."""

    dataset: Path
    scenes: str
    failed: tuple[str, ...]


def rendered(file: Path, folder: Path, scenes: str, say: Callable[[str], None]) -> Homes:
    """Renders what the file says below `folder`, as far as it is not there yet. Scenes that fail are told by `say`; if all do, it is an error."""
    dataset, config = folder / file.stem, enfilade.Config.read(file)
    try:
        enfilade.run(dataset, config, scenes=scenes)
    except enfilade.StageError as error:
        failed = tuple(name for name in config.scenes if any(line.startswith(f"{name}: ") for line in str(error).splitlines()))
        finished = [scene["scene"] for scene in error.summary["scenes"] if scene["scene"] not in failed]
        if not failed or not finished:
            raise
        say(f"{len(failed)} of {len(failed) + len(finished)} scenes failed, and are left out:\n{error}")
        return Homes(dataset, scenes, failed)
    return Homes(dataset, scenes, ())


def read(homes: Homes, size: tuple[int, int], cache: Path) -> Pictures:
    """The frames at `size`, height and width of a whole frame. cache: a folder for packed pictures."""
    key = f"{_state(homes.dataset)} {homes.scenes} {homes.failed} {size}"
    return kept(cache / f"{homes.dataset.name}.pt", key, lambda: _read(homes, size))


def _read(homes: Homes, size: tuple[int, int]) -> Pictures:
    layers = ["color", "semantic", "depth_z_meters"]
    frames = enfilade.Dataset(homes.dataset, layers=layers, scenes=homes.scenes, resize=size, tone_map=True, mask=False, poses=False)
    color, labels, depths, names = [], [], [], []
    rows, columns = window(*size)
    for index in range(len(frames)):
        scene, camera, frame = frames.place(index)
        if scene in homes.failed:
            continue
        sample = frames[index]
        color.append(np.ascontiguousarray(sample["color"][rows, columns]))
        labels.append(sample["semantic"][rows, columns].astype(np.int16))
        depths.append(np.nan_to_num(sample["depth_z_meters"][rows, columns], nan=0.0, posinf=0.0).astype(np.float16))
        names.append(f"{scene}.{camera}.{frame:04}")
    if not names:
        raise ValueError(f"{homes.dataset}: has no frames to learn from; see its report, and render it anew")
    return pack(color, labels, depths, names)


def _state(dataset: Path) -> str:
    """Changes when a file of the dataset is written anew."""
    files = sorted(path for path in dataset.rglob("*.hdf5"))
    seen = [(str(path.relative_to(dataset)), path.stat().st_size, path.stat().st_mtime_ns) for path in files]
    return hashlib.sha256(json.dumps(seen).encode()).hexdigest()[:16]
