"""Images, objects and shapes from Mesh R-CNN's JSON."""

import json
import logging
from functools import lru_cache
from pathlib import Path
from typing import Any, Iterator

import enfilade
import numpy as np
import torch
from PIL import Image, ImageOps
from torch.utils.data import DataLoader, Dataset

from . import frustum
from .config import Data

# Masks of these images of Pix3D belong to others; Mesh R-CNN leaves them out.
MISMATCHED = ("img/table/1749.jpg", "img/table/0045.png")
_log = logging.getLogger(__name__)


class DataError(ValueError):
    """A file of a data set that is not what it should be."""


class Shapes(Dataset):
    """The images of a file that have objects, in the order of their ids.

    Item (index, flip) is a pair: the image, float32, 3 x height x width, 0 to 1; and a dictionary with `boxes` (N x 4, left, upper, right, lower),
    `labels` (N, from 1), `masks` (N x height x width, uint8), `size` (height, width), `focal` (pixels) and `shapes`, of each object a dictionary
    with `vertices` (V x 3, camera space), `faces` (F x 3) and `voxels` (P x 3, middles of occupied voxels, camera space).
    """

    def __init__(self, files: list[Path] | tuple[Path, ...], settings: Data):
        self.images: list[dict[str, Any]] = []
        for file in files:
            self.images += _images(file, settings.root or file.parent, settings)
        if not self.images:
            names = ", ".join(str(file) for file in files)
            raise DataError(f"{names}: no image has an object to learn; lower min_visibility and min_pixels, set leaving to 'keep', or name other files")

    def __len__(self) -> int:
        return len(self.images)

    def __getitem__(self, item: int | tuple[int, bool]) -> tuple[torch.Tensor, dict[str, Any]]:
        index, flip = item if isinstance(item, tuple) else (item, False)
        image = self.images[index]
        pixels = torch.from_numpy(read_image(image["path"]))
        height, width = pixels.shape[1:]
        if (width, height) != (image["width"], image["height"]):
            raise DataError(f"{image['path']}: has {width}x{height} pixels, its JSON says {image['width']}x{image['height']}")
        objects = image["objects"]
        masks = np.stack([read_mask(o["mask"], width, height) for o in objects])
        target = {
            "boxes": torch.tensor([o["box"] for o in objects], dtype=torch.float32),
            "labels": torch.tensor([o["category"] for o in objects]),
            "masks": torch.from_numpy(masks.astype(np.uint8)),
            "size": (height, width),
            "focal": objects[0]["focal"],
            "shapes": [_shape(o) for o in objects],
        }
        return flipped(pixels, target) if flip else (pixels, target)


def flipped(pixels: torch.Tensor, target: dict[str, Any]) -> tuple[torch.Tensor, dict[str, Any]]:
    """The mirror image, with the mirror images of all shapes."""
    boxes, width = target["boxes"], pixels.shape[2]
    mirror = torch.tensor([-1.0, 1.0, 1.0])
    turned = {
        "boxes": torch.stack([width - boxes[:, 2], boxes[:, 1], width - boxes[:, 0], boxes[:, 3]], dim=1),
        "masks": target["masks"].flip(2),
        "shapes": [
            {"vertices": s["vertices"] * mirror, "faces": s["faces"].flip(1), "voxels": s["voxels"] * mirror} for s in target["shapes"]
        ],
    }
    return pixels.flip(2), target | turned


def _images(file: Path, root: Path, settings: Data) -> list[dict[str, Any]]:
    try:
        document = json.loads(file.read_text(encoding="utf-8"))
        entries = {image["id"]: image for image in document["images"]}
        annotations = document["annotations"]
    except OSError as error:
        raise DataError(f"{file}: cannot be read ({error.strerror})") from error
    except (ValueError, KeyError, TypeError) as error:
        raise DataError(f"{file}: is not Mesh R-CNN's JSON ({error!r}); write one with enfilade export --format pix3d") from error
    objects: dict[int, list[dict[str, Any]]] = {}
    left = 0
    for annotation in annotations:
        try:
            wanted, leaves = _takes_part(file, annotation, entries, root, settings)
            left += leaves
            if wanted and not leaves:
                objects.setdefault(annotation["image_id"], []).append(_object(annotation, root))
        except (KeyError, IndexError, TypeError) as error:
            raise DataError(f"{file}: annotation {annotation.get('id')} is not Mesh R-CNN's ({error!r}); write it with enfilade import or export") from error
    if left:
        _log.info("%s: %d objects leave the frustum and are left out, %d stay (data.leaving)", file, left, sum(map(len, objects.values())))
    return [
        {
            "id": id,
            "name": image["file_name"],
            "path": root / image["file_name"],
            "width": image["width"],
            "height": image["height"],
            "objects": objects[id],
        }
        for id, image in sorted(entries.items())
        if id in objects
    ]


def _takes_part(
    file: Path, annotation: dict[str, Any], images: dict[int, dict[str, Any]], root: Path, settings: Data
) -> tuple[bool, bool]:
    """Whether an object is wanted, and whether it is left out because it leaves the frustum."""
    image = images.get(annotation["image_id"])
    if image is None:
        raise DataError(f"{file}: annotation {annotation['id']} is of image {annotation['image_id']}, which is not there")
    x, y, width, height = annotation["bbox"]
    hidden = annotation.get("visibility", 1.0) < settings.min_visibility or width * height < max(settings.min_pixels, 1.0)
    hidden |= x >= image["width"] or y >= image["height"] or x + width <= 0 or y + height <= 0
    if hidden or annotation.get("iscrowd") or image["file_name"] in MISMATCHED:
        return False, False
    return True, settings.leaving == "drop" and _leaves(annotation, image, root)


def _object(annotation: dict[str, Any], root: Path) -> dict[str, Any]:
    x, y, width, height = annotation["bbox"]
    return {
        "category": annotation["category_id"],
        "box": [x, y, x + width, y + height],
        "focal": float(annotation["K"][0]),
        "mask": root / annotation["segmentation"],
        "model": root / annotation["model"],
        "voxel": root / annotation["voxel"],
        "rotation": annotation["rot_mat"],
        "translation": annotation["trans_mat"],
    }


def _leaves(annotation: dict[str, Any], image: dict[str, Any], root: Path) -> bool:
    """Whether the object's mesh leaves the image or the space before the camera; where the file does not say so, its geometry does."""
    if annotation.get("leaves_frustum"):
        return True
    vertices = _placed(read_obj(root / annotation["model"])[0], annotation["rot_mat"], annotation["trans_mat"])
    # Where the model's unit is not told, it is taken to be about a metre.
    near = frustum.NEAR_M / annotation.get("meters_per_unit", 1.0)
    return frustum.leaves(vertices, float(annotation["K"][0]), (image["height"], image["width"]), near)


def _placed(points: np.ndarray, rotation: list[list[float]], translation: list[float]) -> torch.Tensor:
    """Points of a model in camera space, float64."""
    turn, move = (torch.tensor(values, dtype=torch.float64) for values in (rotation, translation))
    return torch.from_numpy(points) @ turn.T + move


def _shape(described: dict[str, Any]) -> dict[str, torch.Tensor]:
    vertices, faces = read_obj(described["model"])
    pose = described["rotation"], described["translation"]
    placed = [_placed(points, *pose).float() for points in (vertices, read_voxels(described["voxel"]))]
    return {"vertices": placed[0], "faces": torch.from_numpy(faces), "voxels": placed[1]}


def read_image(path: Path) -> np.ndarray:
    """A picture as float32, 3 x height x width, 0 to 1, turned as its camera says (EXIF)."""
    try:
        with Image.open(path) as picture:
            upright = ImageOps.exif_transpose(picture).convert("RGB")
            return np.ascontiguousarray(np.asarray(upright, dtype=np.float32).transpose(2, 0, 1) / 255)
    except OSError as error:
        raise DataError(f"{path}: cannot be read as a picture ({error})") from error


def read_mask(path: Path, width: int, height: int) -> np.ndarray:
    """A mask, height x width, true where the picture is above 0."""
    try:
        with Image.open(path) as picture:
            mask = np.asarray(picture.convert("L")) > 0
    except OSError as error:
        raise DataError(f"{path}: cannot be read as a picture ({error})") from error
    if mask.shape != (height, width):
        raise DataError(f"{path}: has {mask.shape[1]}x{mask.shape[0]} pixels, its image {width}x{height}")
    return mask


@lru_cache(maxsize=1024)
def read_voxels(path: Path) -> np.ndarray:
    """The middles of a model's voxels, N x 3."""
    return enfilade.read_voxels(path).astype(np.float64)


@lru_cache(maxsize=1024)
def read_obj(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (float64, V x 3) and triangles (int64, F x 3, from 0) of an OBJ file; polygons become fans."""
    vertices: list[list[float]] = []
    faces: list[tuple[int, int, int]] = []
    try:
        with path.open(encoding="utf-8", errors="replace") as lines:
            for number, line in enumerate(lines, 1):
                words = line.split()
                if words[:1] == ["v"]:
                    vertices.append([float(word) for word in words[1:4]])
                elif words[:1] == ["f"]:
                    corners = [int(word.split("/")[0]) for word in words[1:]]
                    corners = [corner - 1 if corner > 0 else len(vertices) + corner for corner in corners]
                    faces += [(corners[0], b, c) for b, c in zip(corners[1:], corners[2:])]
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error.strerror})") from error
    except ValueError as error:
        raise DataError(f"{path}, line {number}: {error}; expected numbers of an OBJ file") from error
    points, corners = np.array(vertices, dtype=np.float64).reshape(-1, 3), np.array(faces, dtype=np.int64).reshape(-1, 3)
    if not len(corners) or corners.min() < 0 or corners.max() >= len(points):
        raise DataError(f"{path}: has {len(points)} vertices and {len(corners)} triangles, of which some corners are missing")
    return points, corners


class Order:
    """Which images, and whether mirrored, stand in each batch: a function of seed, iteration and rank alone."""

    def __init__(self, count: int, batch: int, seed: int, flip: bool, rank: int = 0, replicas: int = 1):
        if batch % replicas:
            raise DataError(f"a batch of {batch} images cannot be divided among {replicas} replicas; choose a multiple")
        self._count, self._batch, self._seed, self._flip = count, batch, seed, flip
        self._rank, self._replicas = rank, replicas
        self._epoch, self._order, self._flips = -1, [], []

    def batch(self, iteration: int) -> list[tuple[int, bool]]:
        """The part of the batch of one iteration, counted from 0, that is this replica's."""
        own = self._batch // self._replicas
        first = iteration * self._batch + self._rank * own
        return [self._at(position) for position in range(first, first + own)]

    def _at(self, position: int) -> tuple[int, bool]:
        epoch, place = divmod(position, self._count)
        if epoch != self._epoch:
            generator = torch.Generator().manual_seed(self._seed * 1_000_003 + epoch)
            self._order = torch.randperm(self._count, generator=generator).tolist()
            self._flips = (torch.rand(self._count, generator=generator) < 0.5).tolist()
            self._epoch = epoch
        return self._order[place], self._flip and self._flips[place]


def batches(shapes: Shapes, order: Order, iterations: range, workers: int) -> Iterator[list[tuple[torch.Tensor, dict[str, Any]]]]:
    """The batches of these iterations, read by worker processes."""
    plan = [order.batch(iteration) for iteration in iterations]
    return iter(DataLoader(shapes, batch_sampler=plan, num_workers=workers, collate_fn=list, persistent_workers=False))
