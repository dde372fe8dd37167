"""How far homes are from photographs, and in what: `python -m enfilade_training.study.realism training/studies/nyuv2.toml`

Three measures on the *training* photographs: the kernel distance of features of a network that knows ImageNet (KID, Bińkowski et al. 2018),
what is in view and from where (`views`), and how well a linear classifier tells homes from photographs by these features, and by what.
Appearance and layout foretell transfer together, not alone. `--others NAME=FOLDER` adds pictures for comparison to the first measure.
"""

import argparse
import sys
from pathlib import Path
from typing import Any

import enfilade
import numpy as np
import torch
from PIL import Image

from ..common import checkpoints
from ..common import config as settings
from . import gap, views
from .config import SEMANTICS, Study
from .network import Encoder, imagenet_file, take_imagenet
from .pictures import VOID, Pictures, evenly, window
from .runs import Maker

# Pictures of a batch.
BATCH = 32
# Pairs of subsets for a kernel distance, and pictures of each: the published numbers.
SUBSETS, SUBSET = 100, 100
# Parts for cross-validation, and the weight of the squared weights, of standardised features.
FOLDS, RIDGE = 5, 1e-2
# Frames of homes on the sheet, and columns of it.
SHOWN, COLUMNS = 12, 4


class Features:
    """What an encoder with ImageNet's weights finds in pictures."""

    def __init__(self) -> None:
        self._encoder = Encoder()
        take_imagenet(self._encoder, imagenet_file())
        self._encoder.eval()

    def maps(self, color: torch.Tensor) -> torch.Tensor:
        """color: uint8, N x 3 x H x W. Gives N x 320 x H / 32 x W / 32, rounded up."""
        found = []
        with torch.no_grad():
            for part in color.split(BATCH):
                found.append(self._encoder(part.float() / 127.5 - 1.0)[-1])
        return torch.cat(found)


def kernel_distance(ours: torch.Tensor, theirs: torch.Tensor) -> tuple[float, float]:
    """The squared maximum mean discrepancy of two lists of features with the kernel (a · b / d + 1)³, unbiased; mean and standard error over
    pairs of subsets."""
    random = np.random.Generator(np.random.PCG64(0))
    size = min(SUBSET, len(ours), len(theirs))
    found = []
    for _ in range(SUBSETS):
        a, b = (of[torch.from_numpy(random.permutation(len(of))[:size])].double() for of in (ours, theirs))
        within = sum(float(kernel.sum() - kernel.diagonal().sum()) for kernel in (_kernel(a, a), _kernel(b, b)))
        found.append(within / (size * (size - 1)) - 2.0 * float(_kernel(a, b).mean()))
    return float(np.mean(found)), float(np.std(found)) / SUBSETS**0.5


def _kernel(a: torch.Tensor, b: torch.Tensor) -> torch.Tensor:
    return (a @ b.T / a.shape[1] + 1.0) ** 3


class Told:
    """A linear classifier of mean features, logistic regression: above 0 is a home. scores: of all, each by a classifier that has not seen
    its part; groups of one part belong together, such as the frames of a scene."""

    def __init__(self, features: torch.Tensor, is_home: torch.Tensor, groups: list[str]):
        self._center, self._scale = features.mean(0), features.std(0) + 1e-6
        values = (features - self._center) / self._scale
        names = sorted(set(groups))
        part = torch.tensor([names.index(group) % FOLDS for group in groups])
        self.scores = torch.zeros(len(values))
        for fold in range(FOLDS):
            weights, bias = _fitted(values[part != fold], is_home[part != fold])
            self.scores[part == fold] = values[part == fold] @ weights + bias
        self._weights, self._bias = _fitted(values, is_home)
        self.area = _area(self.scores[is_home], self.scores[~is_home])
        self.accuracy = 0.5 * float((self.scores[is_home] > 0).float().mean() + (self.scores[~is_home] <= 0).float().mean())

    def evidence(self, maps: torch.Tensor) -> torch.Tensor:
        """N x H x W: what each place adds to the score, whose mean it is."""
        values = (maps - self._center[:, None, None]) / self._scale[:, None, None]
        return (values * self._weights[:, None, None]).sum(1) + self._bias


def _fitted(values: torch.Tensor, is_home: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
    """Both kinds weigh the same."""
    weights, bias = torch.zeros(values.shape[1], requires_grad=True), torch.zeros(1, requires_grad=True)
    share = torch.where(is_home, 0.5 / is_home.sum().clamp(min=1), 0.5 / (~is_home).sum().clamp(min=1))
    search = torch.optim.LBFGS([weights, bias], max_iter=300, line_search_fn="strong_wolfe")

    def loss() -> torch.Tensor:
        search.zero_grad()
        each = torch.nn.functional.binary_cross_entropy_with_logits(values @ weights + bias, is_home.float(), reduction="none")
        value = (share * each).sum() + 0.5 * RIDGE * weights.square().sum()
        value.backward()
        return value

    search.step(loss)
    return weights.detach(), bias.detach()


def _area(above: torch.Tensor, below: torch.Tensor) -> float:
    """The share of pairs in which the first is greater (the area under the ROC curve)."""
    pairs = above[:, None] - below[None]
    return float((pairs > 0).float().mean() + 0.5 * (pairs == 0).float().mean())


def report(homes: Pictures, photographs: Pictures, others: dict[str, torch.Tensor], study: Study) -> tuple[list[str], Image.Image]:
    """The page, as Markdown, and a sheet of homes with what tells them."""
    features = Features()
    seen = gap.photographed(homes, study)
    maps = {name: features.maps(color) for name, color in {"homes": homes.color, "seen": seen.color, "photographs": photographs.color}.items()}
    # Photographs have the mean 0 and the deviation 1 in every feature.
    center, scale = maps["photographs"].mean((2, 3)).mean(0), maps["photographs"].mean((2, 3)).std(0) + 1e-6

    def standard(found: torch.Tensor) -> torch.Tensor:
        return (found.mean((2, 3)) - center) / scale

    mean = {name: standard(found) for name, found in maps.items()}
    even, odd = mean["photographs"][::2], mean["photographs"][1::2]
    rows = [("photographs, one half and the other", even, odd), ("homes, as the study's camera takes them", mean["seen"], mean["photographs"])]
    rows.append(("homes, as rendered", mean["homes"], mean["photographs"]))
    rows += [(name, standard(features.maps(color)), mean["photographs"]) for name, color in others.items()]
    made = ["## Appearance", "", "| pictures | number | kernel distance to photographs |", "|---|---|---|"]
    made += [f"| {name} | {len(of)} | {value:.2f} ± {error:.2f} |" for name, of, to in rows for value, error in [kernel_distance(of, to)]]

    made += ["", "## What is in view", "", *views.lines(views.views(homes), views.views(photographs))]

    is_home = torch.arange(len(homes) + len(photographs)) < len(homes)
    groups = [name.split(".")[0] for name in homes.names] + photographs.names
    both = torch.cat([maps["seen"], maps["photographs"]])
    told = Told(both.mean((2, 3)), is_home, groups)
    evidence = told.evidence(both)
    made += ["", "## What tells them apart", "", f"A linear classifier of the features tells homes from photographs in {100 * told.accuracy:.1f} % of the cases"]
    made += [f"(area under the curve {told.area:.4f}). Evidence for a home, in units of its score, where there is", "", "| class | in homes | in photographs |", "|---|---|---|"]
    by_class = [_by_class(evidence[part], pictures) for part, pictures in ((is_home, homes), (~is_home, photographs))]
    order = np.argsort(-np.nan_to_num(by_class[0], nan=-1e9))
    shown = [[f"{of[i]:.2f}" if np.isfinite(of[i]) else "–" for of in by_class] for i in order]
    made += [f"| {enfilade.NYU13[i]} | {here} | {there} |" for i, (here, there) in zip(order, shown)]
    return made, _sheet(seen, evidence[is_home], told.scores[is_home])


def _by_class(evidence: torch.Tensor, pictures: Pictures) -> np.ndarray:
    """Mean evidence at the pixels of each of NYU13's classes; not a number where there are none."""
    sums, counts = np.zeros(len(enfilade.NYU13)), np.zeros(len(enfilade.NYU13))
    for index in range(len(pictures)):
        classes = pictures.classes(SEMANTICS, index).numpy()
        values = _enlarged(evidence[index], classes.shape)
        known = classes != VOID
        sums += np.bincount(classes[known], values[known], minlength=len(sums))
        counts += np.bincount(classes[known], minlength=len(sums))
    return np.where(counts > 0, sums / np.maximum(counts, 1), np.nan)


def _enlarged(values: torch.Tensor, shape: tuple[int, ...]) -> np.ndarray:
    return torch.nn.functional.interpolate(values[None, None], size=shape, mode="bilinear", align_corners=False)[0, 0].numpy()


def _sheet(pictures: Pictures, evidence: torch.Tensor, scores: torch.Tensor) -> Image.Image:
    """Homes from the plainest to the one most like a photograph, each beside its evidence: red for a home, blue for a photograph."""
    order = torch.argsort(scores, descending=True)
    tiles = []
    for index in order[evenly(len(order), SHOWN)]:
        color = pictures.color[index].permute(1, 2, 0).numpy().astype(np.float32)
        value = np.clip(_enlarged(evidence[index], color.shape[:2]) / 4.0, -1.0, 1.0)[..., None]
        tint = np.where(value > 0, np.array([255, 40, 20], dtype=np.float32), np.array([30, 80, 255], dtype=np.float32))
        tiles.append(np.concatenate([color, color * (1 - 0.7 * np.abs(value)) + 0.7 * np.abs(value) * tint], axis=1))
    tiles += [np.zeros_like(tiles[0])] * (-len(tiles) % COLUMNS)
    rows = [np.concatenate(tiles[i : i + COLUMNS], axis=1) for i in range(0, len(tiles), COLUMNS)]
    return Image.fromarray(np.concatenate(rows).round().astype(np.uint8))


def pictures_in(folder: Path, size: tuple[int, int]) -> torch.Tensor:
    """uint8, N x 3 x H x W: the JPEG and PNG files below a folder, brought to `size` of whole frames, in the part that is taken of all."""
    rows, columns = window(*size)
    found = []
    for path in sorted(path for end in ("jpg", "jpeg", "png") for path in folder.rglob(f"*.{end}")):
        with Image.open(path) as image:
            whole = np.array(image.convert("RGB").resize((size[1], size[0]), Image.Resampling.BOX))
        found.append(np.ascontiguousarray(whole[rows, columns].transpose(2, 0, 1)))
    if not found:
        raise ValueError(f"{folder}: has no .jpg and no .png files, expected pictures")
    return torch.from_numpy(np.stack(found))


def main(arguments: list[str] | None = None) -> int:
    """Measures, and prints or writes the page; gives the exit status, which is 2 for what the user can mend."""
    parser = argparse.ArgumentParser(prog="python -m enfilade_training.study.realism", description=__doc__.splitlines()[0])
    parser.add_argument("study", type=Path, help="settings, a TOML file such as training/studies/nyuv2.toml")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="another value of a setting, such as homes=other.toml")
    parser.add_argument("--others", action="append", default=[], metavar="NAME=FOLDER", help="pictures to compare with photographs as well")
    parser.add_argument("--to", type=Path, metavar="FOLDER", help="writes realism.md and realism.jpg there; the picture shows homes alone")
    options = parser.parse_args(arguments)
    try:
        study: Any = settings.read(Study, options.study, options.set)
        torch.set_num_threads(study.threads)
        maker = Maker(study, lambda line: print(line, flush=True))
        others = {}
        for word in options.others:
            name, equals, folder = word.partition("=")
            if not equals:
                raise ValueError(f"--others {word}: expected NAME=FOLDER")
            others[name] = pictures_in(Path(folder), study.size)
        page, sheet = report(maker.pictures("homes"), maker.pictures("train"), others, study)
        print("\n".join(page))
        if options.to:
            options.to.mkdir(parents=True, exist_ok=True)
            sheet.save(options.to / "realism.jpg", quality=85)
            (options.to / "realism.md").write_text("\n".join(_page(page, study)) + "\n", encoding="utf-8")
    except (ValueError, OSError, checkpoints.CheckpointError, enfilade.StageError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


def _page(found: list[str], study: Study) -> list[str]:
    head = ["# How far homes are from photographs", "", f"Made by `python -m enfilade_training.study.realism training/studies/nyuv2.toml`, on the frames of `{study.homes.name}` and"]
    head += ["NYUv2's 795 training photographs. [What the measures are](../real.md#the-dial-of-realism).", ""]
    sheet = ["", "![frames of homes, and what tells them from photographs](realism.jpg)", ""]
    return [*head, *found, *sheet, "*Homes, from the most to the least easily told: red places speak for a home, blue ones for a photograph.*"]


if __name__ == "__main__":
    sys.exit(main())
