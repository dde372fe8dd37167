"""Images with classes, from the datasets that there are, and the order in which a run sees them.

Whatever the dataset, an image is uint8, height x width x 3, and its classes are int64, height x width, from 0, with `VOID` where there
is none. Files are decoded and tone-mapped by the module `enfilade`, outside of the interpreter's lock.
"""

from pathlib import Path
from typing import Any, Iterator, Protocol

import enfilade
import numpy as np
import torch
from PIL import Image, UnidentifiedImageError
from torch.utils.data import DataLoader, Dataset

from . import augment
from .config import Augment, Config, Data

# What stands for "no class"; such pixels count neither in the loss nor in scores.
VOID = -1


class Source(Protocol):
    """Images with classes."""

    def __len__(self) -> int: ...

    def __getitem__(self, index: int) -> tuple[np.ndarray, np.ndarray]:
        """The image and its classes."""

    def name(self, index: int) -> str:
        """What the image is called, fit for a file's name."""


def open_source(data: Data, classes: int) -> Source:
    """The images that the settings describe."""
    opened: Source
    if data.kind == "enfilade":
        opened = _Rendered(data, classes)
    elif data.kind == "nyuv2":
        opened = _Nyu(data, classes)
    else:
        opened = Pairs(data.path / data.images, data.path / data.labels, classes, data.first_class)
    return opened if data.limit is None else _Part(opened, data.limit, data.subset_seed)


def class_names(data: Data, classes: int) -> list[str]:
    """Names of the classes."""
    if data.kind == "pairs":
        return [f"class {i + data.first_class}" for i in range(classes)]
    if classes in (13, 40):
        return list(enfilade.NYU13 if classes == 13 else enfilade.NYU40)
    return [f"NYU {i + 1}" for i in range(classes)]


class _Rendered:
    """Frames of enfilade or of Hypersim's release, tone-mapped."""

    def __init__(self, data: Data, classes: int):
        self._frames = enfilade.Dataset(
            data.path,
            layers=["color", "semantic"],
            scenes=list(data.scenes) or None,
            cameras=list(data.cameras) or None,
            split=data.split,
            tone_map=True,
            mask=False,
            poses=False,
            camera_table=data.camera_table,
        )
        of_nyu40 = np.array(enfilade.NYU13_OF_NYU40 if classes == 13 else [0, *range(1, 41)], dtype=np.int64) - 1
        self._class = np.maximum(of_nyu40, VOID)

    def __len__(self) -> int:
        return len(self._frames)

    def __getitem__(self, index: int) -> tuple[np.ndarray, np.ndarray]:
        sample = self._frames[index]
        semantic = sample["semantic"]
        known = (semantic >= 1) & (semantic <= 40)
        return sample["color"], self._class[np.where(known, semantic, 0)]

    def name(self, index: int) -> str:
        scene, camera, frame = self._frames.place(index)
        return f"{scene}.{camera}.{frame:04}"


class _Nyu:
    """NYUv2's published file."""

    def __init__(self, data: Data, classes: int):
        self._images = enfilade.NyuV2(
            data.path, split=data.split, classes=classes, layers=["color", "semantic"], partial=data.partial
        )

    def __len__(self) -> int:
        return len(self._images)

    def __getitem__(self, index: int) -> tuple[np.ndarray, np.ndarray]:
        sample = self._images[index]
        semantic = sample["semantic"].astype(np.int64)
        return sample["color"], np.where(semantic >= 1, semantic - 1, VOID)

    def name(self, index: int) -> str:
        return f"nyuv2.{self._images.frame(index):04}"


class Pairs:
    """A folder of pictures, and one of PNG files of the same names whose values are classes.

    A label file has one channel of 8 or 16 bits, or a palette, whose indices count. Class `first_class` becomes 0; values outside of the
    `classes` from there are "no class".
    """

    def __init__(self, images: Path, labels: Path, classes: int, first_class: int):
        self._classes, self._first = classes, first_class
        for folder in (images, labels):
            if not folder.is_dir():
                raise FileNotFoundError(f"{folder}: there is no such folder; set path, images and labels of the data")
        kinds = {".png", ".jpg", ".jpeg"}
        self._images = sorted(path for path in images.iterdir() if path.suffix.lower() in kinds)
        if not self._images:
            raise ValueError(f"{images}: has no pictures, expected PNG or JPEG files")
        self._labels = [labels / f"{path.stem}.png" for path in self._images]
        for image, label in zip(self._images, self._labels):
            if not label.is_file():
                raise FileNotFoundError(f"{label}: there are no labels for {image.name}; labels are PNG files of the same name")

    def __len__(self) -> int:
        return len(self._images)

    def __getitem__(self, index: int) -> tuple[np.ndarray, np.ndarray]:
        image, found = np.array(_open(self._images[index]).convert("RGB")), _open(self._labels[index])
        if found.mode not in ("L", "P", "I", "I;16", "1"):
            raise ValueError(f"{self._labels[index]}: is a picture of mode {found.mode}, expected one channel or a palette of classes")
        values = np.array(found).astype(np.int64)
        if values.shape != image.shape[:2]:
            sizes = f"{values.shape[0]}x{values.shape[1]} pixels, its image {image.shape[0]}x{image.shape[1]}"
            raise ValueError(f"{self._labels[index]}: has {sizes}; expected the same size")
        classes = values - self._first
        return image, np.where((classes >= 0) & (classes < self._classes), classes, VOID)

    def name(self, index: int) -> str:
        return self._images[index].stem


def _open(path: Path) -> Image.Image:
    try:
        image = Image.open(path)
        image.load()
    except (UnidentifiedImageError, OSError) as error:
        raise ValueError(f"{path}: is no picture, or damaged ({error})") from error
    return image


class _Part:
    """Some images of a source."""

    def __init__(self, whole: Source, limit: int, seed: int):
        if limit > len(whole):
            raise ValueError(f"limit is {limit}, but there are {len(whole)} images")
        order = np.random.Generator(np.random.PCG64(seed)).permutation(len(whole))
        self._whole, self._indices = whole, sorted(int(i) for i in order[:limit])

    def __len__(self) -> int:
        return len(self._indices)

    def __getitem__(self, index: int) -> tuple[np.ndarray, np.ndarray]:
        return self._whole[self._indices[index]]

    def name(self, index: int) -> str:
        return self._whole.name(self._indices[index])


def batches(seed: int, epoch: int, count: int, batch_size: int, drop_last: bool) -> list[list[int]]:
    """The images of each batch of an epoch: every image once, in an order by seed and epoch.

    What fills no batch is dropped, or filled up with images of the epoch's beginning.
    """
    order = np.random.Generator(np.random.PCG64(np.random.SeedSequence([seed, epoch]))).permutation(count).tolist()
    whole = count // batch_size
    if drop_last and whole == 0:
        raise ValueError(
            f"there are {count} images, but a batch has {batch_size}; set train.batch_size to at most {count}, or train.drop_last=false"
        )
    if not drop_last and count % batch_size:
        missing = batch_size - count % batch_size
        order += (order * (missing // count + 1))[:missing]
        whole += 1
    return [order[i * batch_size : (i + 1) * batch_size] for i in range(whole)]


class Training(Dataset):
    """Images as a run sees them: item (epoch, index) is an image and its classes, changed at random by just that."""

    def __init__(self, source: Source, config: Augment, seed: int):
        self._source, self._config, self._seed = source, config, seed

    def __len__(self) -> int:
        return len(self._source)

    def __getitem__(self, place: tuple[int, int]) -> tuple[torch.Tensor, torch.Tensor]:
        epoch, index = place
        image, classes = tensors(*self._source[index])
        drawn = augment.draw(augment.generator(self._seed, epoch, index), self._config, *classes.shape)
        return augment.apply(drawn, self._config.size, image, classes)


class _Whole(Dataset):
    def __init__(self, source: Source):
        self._source = source

    def __getitem__(self, index: int) -> tuple[torch.Tensor, torch.Tensor]:
        return tensors(*self._source[index])


def tensors(image: np.ndarray, classes: np.ndarray) -> tuple[torch.Tensor, torch.Tensor]:
    """uint8, 3 x height x width, and int64, height x width."""
    return torch.from_numpy(np.ascontiguousarray(image)).permute(2, 0, 1), torch.from_numpy(np.ascontiguousarray(classes))


def training_loader(config: Config, source: Source, rank: int, count: int, epoch: int, step: int) -> Iterator[Any]:
    """This replica's parts of the batches of a run, from a step of an epoch on to the run's end."""
    share = config.train.batch_size // count

    def places() -> Iterator[list[tuple[int, int]]]:
        for e in range(epoch, config.train.epochs):
            first = step if e == epoch else 0
            for batch in batches(config.seed, e, len(source), config.train.batch_size, config.train.drop_last)[first:]:
                yield [(e, index) for index in batch[rank * share : (rank + 1) * share]]

    dataset = Training(source, config.augment, config.seed)
    workers = config.train.workers
    # The loader draws a seed for its workers, whose random numbers are not used: it must not draw from those that checkpoints keep.
    seeds = torch.Generator().manual_seed(config.seed)
    pinned = torch.cuda.is_available()
    return iter(DataLoader(dataset, batch_sampler=_Places(places), num_workers=workers, pin_memory=pinned, generator=seeds))


class _Places:
    def __init__(self, make: Any):
        self._make = make

    def __iter__(self) -> Iterator[list[tuple[int, int]]]:
        return self._make()


def evaluation_loader(source: Source, indices: list[int], batch_size: int, workers: int) -> DataLoader:
    """Lists of images and their classes, unchanged."""
    seeds = torch.Generator().manual_seed(0)
    groups = [indices[i : i + batch_size] for i in range(0, len(indices), batch_size)]
    return DataLoader(_Whole(source), batch_sampler=groups, num_workers=workers, collate_fn=list, generator=seeds)
