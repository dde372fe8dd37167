"""From where, and of what, homes and photographs are taken: `python -m enfilade_training.study.views training/studies/nyuv2.toml`

Of the *training* photographs and of the homes' frames: height, pitch and roll of the camera, distances by thirds of the picture, and what is
seen in each third. The plan's mode `photos` has its numbers from here: `--table` prints them.
"""

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path

import enfilade
import numpy as np

from ..common import checkpoints
from ..common import config as settings
from .config import Study
from .pictures import VOID, Pictures, nyu13
from .runs import Maker

# NYU40's classes from 0: a floor; walls, floors, doors, windows, blinds, curtains and ceilings, which are no things.
FLOOR, SURROUNDINGS = 1, (0, 1, 7, 8, 12, 15, 21)
# Focal lengths and centre of NYUv2's photographs, in widths of the picture, whose height is three quarters of that.
FOCAL, CENTER = (259.43 / 320, 259.73 / 320), (162.54 / 320, 126.62 / 320)
# The part of a picture that is taken begins here, in widths of the picture.
ORIGIN = (20 / 320, 22 / 320)
# A floor is fitted where this share of the pixels shows one, to those within so many metres, which is this share of them at least.
FLOOR_SHARE, FLOOR_M, FLOOR_FITS = 0.01, 0.04, 0.6
# Planes tried for a floor.
TRIES = 150
# Nearer surfaces count as this far away, metres.
NEAREST_M = 0.3
# What is compared of a composition, in the order of the planner's table.
VALUES = ("upper third, m", "middle third, m", "lower third, m", "sides over middle", "things, %")


@dataclass(frozen=True)
class Views:
    """cameras: N x 3, height above the floor in metres, pitch and roll in degrees, of the pictures that show enough floor. compositions: N x 5,
    the mean logarithms of depths by thirds, by how much that of the outer quarters exceeds that of the inner half, the share of things.
    classes: 3 x 13, the share of each of NYU13's classes in each third."""

    cameras: np.ndarray
    compositions: np.ndarray
    classes: np.ndarray


def views(pictures: Pictures) -> Views:
    """Of all pictures."""
    cameras, compositions = [], []
    classes = np.zeros((3, len(enfilade.NYU13)))
    table = nyu13().numpy()
    for index in range(len(pictures)):
        depth_m, found = pictures.depth_m[index].numpy().astype(np.float64), pictures.classes40[index].numpy()
        camera = camera_above_floor(depth_m, found)
        cameras += [camera] if camera else []
        compositions.append(composition(depth_m, found))
        for third, part in enumerate(np.array_split(table[found], 3)):
            classes[third] += np.bincount(part[part != VOID], minlength=classes.shape[1])
    return Views(np.array(cameras).reshape(-1, 3), np.array(compositions), classes / classes.sum(1, keepdims=True).clip(1))


def composition(depth_m: np.ndarray, classes40: np.ndarray) -> list[float]:
    """A row of `Views.compositions`; values of nothing are not numbers."""
    known = np.where(depth_m > 0, np.log(depth_m.clip(NEAREST_M)), np.nan)
    thirds = [mean(part) for part in np.array_split(known, 3)]
    left, *inner, right = np.array_split(known, 4, axis=1)
    labelled = classes40 != VOID
    things = np.mean(~np.isin(classes40[labelled], SURROUNDINGS)) if labelled.any() else np.nan
    return [*thirds, mean(np.stack([mean(left), mean(right)])) - mean(np.concatenate(inner, axis=1)), float(things)]


def mean(values: np.ndarray) -> float:
    """Of those that are numbers."""
    return float(np.nanmean(values)) if np.isfinite(values).any() else float("nan")


def camera_above_floor(depth_m: np.ndarray, classes40: np.ndarray) -> tuple[float, float, float] | None:
    """Height in metres, pitch and roll in degrees, by the plane of the floor (RANSAC, Fischler & Bolles 1981, then least squares); None
    where too little floor is seen, or what is labelled so is no plane."""
    width = depth_m.shape[1] / (280 / 320)
    rows, columns = np.nonzero((classes40 == FLOOR) & (depth_m > 0))
    if len(rows) < FLOOR_SHARE * depth_m.size:
        return None
    z = depth_m[rows, columns]
    x = ((columns + 0.5) / width + ORIGIN[0] - CENTER[0]) / FOCAL[0] * z
    y = ((rows + 0.5) / width + ORIGIN[1] - CENTER[1]) / FOCAL[1] * z
    points = np.stack([x, y, z], 1)
    random = np.random.Generator(np.random.PCG64(0))
    best = np.zeros(len(points), dtype=bool)
    for _ in range(TRIES):
        a, b, c = points[random.integers(len(points), size=3)]
        normal = np.cross(b - a, c - a)
        length = np.linalg.norm(normal)
        # y leads down, and a floor is below the camera.
        if length > 1e-6 and abs(normal[1]) > 0.5 * length:
            near = np.abs((points - a) @ normal) < FLOOR_M * length
            best = near if near.sum() > best.sum() else best
    if best.sum() < max(FLOOR_FITS * len(points), 3):
        return None
    center = points[best].mean(0)
    up = np.linalg.svd(points[best] - center, full_matrices=False)[2][2]
    up = -up if up[1] > 0 else up
    degrees = np.degrees
    return float(-(center @ up)), float(degrees(np.arcsin(up[2].clip(-1, 1)))), float(degrees(np.arctan2(up[0], -up[1])))


def whitening(compositions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Their mean, and the inverse of the lower Cholesky factor of their covariance."""
    whole = compositions[np.isfinite(compositions).all(1)]
    return whole.mean(0), np.linalg.inv(np.linalg.cholesky(np.cov(whole.T)))


def lines(homes: Views, photographs: Views) -> list[str]:
    """The comparison, as Markdown."""
    made = ["| mean ± standard deviation | homes | photographs |", "|---|---|---|"]
    both = (homes, photographs)
    for column, name in enumerate(("height of the camera, m", "pitch, degrees", "roll, degrees")):
        made.append(f"| {name} | {' | '.join(spread(of.cameras[:, column], 2 if column == 0 else 1) for of in both)} |")
    for column, name in enumerate(VALUES):
        made.append(f"| {name} | {' | '.join(shown(of.compositions[:, column], column) for of in both)} |")
    made += ["", "| share of pixels, % | homes: upper | middle | lower | all | photographs: upper | middle | lower | all |", "|---" * 9 + "|"]
    for index, name in enumerate(enfilade.NYU13):
        cells = [f"{100 * value:.1f}" for of in both for value in (*of.classes[:, index], of.classes[:, index].mean())]
        made.append(f"| {name} | {' | '.join(cells)} |")
    apart = np.abs(homes.classes.mean(0) - photographs.classes.mean(0)).sum() / 2
    thirds = np.abs(homes.classes - photographs.classes).sum(1).mean() / 2
    made += ["", f"Of the pixels, {100 * apart:.1f} % would need another class for the same shares, {100 * thirds:.1f} % for the same in each third."]
    return made


def spread(values: np.ndarray, digits: int) -> str:
    """Mean and standard deviation."""
    return f"{np.nanmean(values):.{digits}f} ± {np.nanstd(values):.{digits}f}" if len(values) else "–"


def shown(values: np.ndarray, column: int) -> str:
    """A column of compositions: distances as geometric means and factors, shares in percent."""
    if column < 3:
        return f"{np.exp(np.nanmean(values)):.2f}, by a factor of {np.exp(np.nanstd(values)):.2f}"
    return spread(100 * values, 1) if column == 4 else spread(values, 2)


def main(arguments: list[str] | None = None) -> int:
    """Compares, and prints; gives the exit status, which is 2 for what the user can mend."""
    parser = argparse.ArgumentParser(prog="python -m enfilade_training.study.views", description=__doc__.splitlines()[0])
    parser.add_argument("study", type=Path, help="settings, a TOML file such as training/studies/nyuv2.toml")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="another value of a setting, such as homes=other.toml")
    parser.add_argument("--table", action="store_true", help="prints the photographs' mean composition and its whitening, and no homes")
    options = parser.parse_args(arguments)
    try:
        maker = Maker(settings.read(Study, options.study, options.set), lambda line: print(line, flush=True))
        photographs = views(maker.pictures("train"))
        if options.table:
            center, rows = whitening(photographs.compositions)
            print("mean", np.round(center, 3).tolist(), *("row", *(np.round(row, 3).tolist() for row in rows)), sep="\n")
        else:
            print("\n".join(lines(views(maker.pictures("homes")), photographs)))
    except (ValueError, OSError, checkpoints.CheckpointError, enfilade.StageError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
