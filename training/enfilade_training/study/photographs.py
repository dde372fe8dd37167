"""NYUv2's labelled photographs (Silberman et al. 2012) at half size, in a folder:

- `rgb/NNNN.jpg`, 320 x 240;
- `depth_mm/NNNN.png`, planar depth in millimetres, 16 bits;
- `label40/NNNN.png`, NYU40's classes from 1, 0 for none; those of NYU13 follow from them;
- `split.json`, `{"train": ["0003", ...], "test": [...]}`: the published split, of 795 and 654.
"""

import hashlib
import json
from pathlib import Path

import numpy as np
from PIL import Image, UnidentifiedImageError

from .pictures import Pictures, kept, pack, window

HEIGHT, WIDTH = 240, 320
PARTS = {"rgb": ".jpg", "depth_mm": ".png", "label40": ".png"}
REMEDY = "docs/real.md describes the folder"


class Photographs:
    """The folder's photographs, whose colours are taken at `size`, height and width of a whole frame. cache: a folder for packed pictures."""

    def __init__(self, folder: Path, size: tuple[int, int], cache: Path):
        self._folder, self._size, self._cache = folder, size, cache
        if not folder.is_dir():
            raise FileNotFoundError(f"{folder}: there is no such folder, expected one of NYUv2's photographs; {REMEDY}")
        self.split = _split(folder / "split.json")
        self.digest = self._digest()

    def side(self, name: str) -> Pictures:
        """The pictures of "train" or "test"."""
        key = f"{self.digest} {self._size}"
        return kept(self._cache / f"photographs-{name}.pt", key, lambda: self._read(self.split[name]))

    def _read(self, names: list[str]) -> Pictures:
        color, labels, depths = [], [], []
        rows, columns = window(HEIGHT, WIDTH)
        inner = window(*self._size)
        height, width = inner[0].stop - inner[0].start, inner[1].stop - inner[1].start
        for name in names:
            image, depth_mm, found = (self._open(part, name) for part in PARTS)
            box = (columns.start, rows.start, columns.stop, rows.stop)
            color.append(np.array(image.convert("RGB").resize((width, height), Image.Resampling.BOX, box)))
            labels.append(np.array(found)[rows, columns])
            depths.append(np.array(depth_mm)[rows, columns].astype(np.float32) / 1000.0)
        return pack(color, labels, depths, names)

    def _open(self, part: str, name: str) -> Image.Image:
        path = self._path(part, name)
        try:
            image = Image.open(path)
            image.load()
        except (UnidentifiedImageError, OSError) as error:
            raise ValueError(f"{path}: is no picture, or damaged ({error}); {REMEDY}") from error
        if image.size != (WIDTH, HEIGHT):
            raise ValueError(f"{path}: has {image.width}x{image.height} pixels, expected {WIDTH}x{HEIGHT}; {REMEDY}")
        expected = {"rgb": ("RGB",), "depth_mm": ("I;16", "I"), "label40": ("L", "P")}[part]
        if image.mode not in expected:
            raise ValueError(f"{path}: is a picture of mode {image.mode}, expected {' or '.join(expected)}; {REMEDY}")
        return image

    def _path(self, part: str, name: str) -> Path:
        return self._folder / part / f"{name}{PARTS[part]}"

    def _digest(self) -> str:
        """Of all files' bytes: what tells one set of photographs from another."""
        digest = hashlib.sha256(json.dumps(self.split, sort_keys=True).encode())
        for name in [*self.split["train"], *self.split["test"]]:
            for part in PARTS:
                try:
                    digest.update(hashlib.sha256(self._path(part, name).read_bytes()).digest())
                except OSError as error:
                    reason = f"cannot be read ({error.strerror}), but split.json lists {name!r}"
                    raise ValueError(f"{self._path(part, name)}: {reason}; {REMEDY}") from error
        return digest.hexdigest()[:16]


def _split(path: Path) -> dict[str, list[str]]:
    try:
        split = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise ValueError(f"{path}: cannot be read as JSON ({error}); {REMEDY}") from error
    for side in ("train", "test"):
        names = split.get(side) if isinstance(split, dict) else None
        if not isinstance(names, list) or not names or not all(isinstance(name, str) and name.isalnum() for name in names):
            raise ValueError(f"{path}: {side!r} is {str(names)[:40]}, expected a list of names such as \"0003\"; {REMEDY}")
    both = sorted(set(split["train"]) & set(split["test"]))
    if both:
        raise ValueError(f"{path}: {both[0]!r} is in both train and test; {REMEDY}")
    return {side: list(split[side]) for side in ("train", "test")}
