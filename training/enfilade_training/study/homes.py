"""The rendered homes of pre-training: made by `enfilade.run`, and packed as photographs are."""

import hashlib
import json
import tomllib
from pathlib import Path

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


def rendered(file: Path, folder: Path) -> Path:
    """Renders what the file says below `folder`, as far as it is not there yet, and gives the dataset's folder."""
    dataset = folder / file.stem
    enfilade.run(dataset, enfilade.Config.read(file))
    return dataset


def read(dataset: Path, size: tuple[int, int], cache: Path) -> Pictures:
    """All frames of a dataset at `size`, height and width of a whole frame. cache: a folder for packed pictures."""
    return kept(cache / f"{dataset.name}.pt", f"{_state(dataset)} {size}", lambda: _read(dataset, size))


def _read(dataset: Path, size: tuple[int, int]) -> Pictures:
    layers = ["color", "semantic", "depth_z_meters"]
    frames = enfilade.Dataset(dataset, layers=layers, resize=size, tone_map=True, mask=False, poses=False)
    color, labels, depths, names = [], [], [], []
    rows, columns = window(*size)
    for index in range(len(frames)):
        sample = frames[index]
        color.append(np.ascontiguousarray(sample["color"][rows, columns]))
        labels.append(sample["semantic"][rows, columns].astype(np.int16))
        depths.append(np.nan_to_num(sample["depth_z_meters"][rows, columns], nan=0.0, posinf=0.0).astype(np.float16))
        scene, camera, frame = frames.place(index)
        names.append(f"{scene}.{camera}.{frame:04}")
    if not names:
        raise ValueError(f"{dataset}: has no frames to learn from; see its report, and render it anew")
    return pack(color, labels, depths, names)


def _state(dataset: Path) -> str:
    """Changes when a file of the dataset is written anew."""
    files = sorted(path for path in dataset.rglob("*.hdf5"))
    seen = [(str(path.relative_to(dataset)), path.stat().st_size, path.stat().st_mtime_ns) for path in files]
    return hashlib.sha256(json.dumps(seen).encode()).hexdigest()[:16]
