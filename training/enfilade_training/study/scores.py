"""Scores of predictions, image by image, and what resampling says about their differences.

Classes are counted over the pixels of all images together, as mean IoU is defined. Scores of depth are those of each image's pixels, and
means over images (Eigen et al. 2014). The bootstrap (Efron 1979) draws images and seeds anew, each with replacement; arms that are compared
get the same draws, so that what they have in common drops out.
"""

from dataclasses import dataclass
from typing import Sequence

import numpy as np

from .config import DEPTH
from .pictures import FARTHEST_M

SEMANTIC_SCORES = ("mean_iou", "pixel_accuracy")
DEPTH_SCORES = ("abs_rel", "delta1", "rmse_m", "abs_rel_aligned", "delta1_aligned", "rmse_m_aligned")
# Depths that are predicted nearer than this count as this (Eigen et al. 2014).
NEAREST_M = 1e-3


def names(task: str) -> tuple[str, ...]:
    """The scores of a task."""
    return DEPTH_SCORES if task == DEPTH else SEMANTIC_SCORES


def class_sums(confusion: np.ndarray) -> np.ndarray:
    """What scores of classes are made of: right, true and predicted pixels of each class. confusion: classes x classes; gives 3 x classes."""
    return np.stack([np.diagonal(confusion), confusion.sum(1), confusion.sum(0)]).astype(np.float64)


def depth_scores(predicted_m: np.ndarray, true_m: np.ndarray) -> np.ndarray:
    """DEPTH_SCORES of an image: mean relative error, share within a factor of 1.25, and root mean square error, plain and after the scale
    and the shift that least squares give. Where `true_m` is 0 there is no truth; without any, scores are NaN."""
    known = (true_m > 0) & (true_m <= FARTHEST_M)
    if not known.any():
        return np.full(len(DEPTH_SCORES), np.nan)
    truth, found = true_m[known].astype(np.float64), predicted_m[known].astype(np.float64)
    scale, shift = aligned(found, truth)
    return np.array([*_errors(found, truth), *_errors(scale * found + shift, truth)])


def aligned(found: np.ndarray, truth: np.ndarray) -> tuple[float, float]:
    """Scale and shift of `found` that are nearest to `truth` by least squares."""
    centred = found - found.mean()
    spread = float(np.square(centred).sum())
    scale = float((centred * (truth - truth.mean())).sum()) / spread if spread > 1e-12 * len(found) else 0.0
    return scale, float(truth.mean() - scale * found.mean())


def _errors(found: np.ndarray, truth: np.ndarray) -> tuple[float, float, float]:
    found = found.clip(NEAREST_M, FARTHEST_M)
    ratio = np.maximum(found / truth, truth / found)
    return float((np.abs(found - truth) / truth).mean()), float((ratio < 1.25).mean()), float(np.sqrt(np.square(found - truth).mean()))


def of_images(task: str, images: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """The task's scores, resamples x scores. images: of each image its class_sums or depth_scores; weights: resamples x images, how often
    each counts."""
    if task == DEPTH:
        known = np.isfinite(images)
        return (weights @ np.where(known, images, 0.0)) / np.maximum(weights @ known, 1e-12)
    right, true, predicted = np.moveaxis((weights @ images.reshape(len(images), -1)).reshape(len(weights), *images.shape[1:]), 1, 0)
    union = true + predicted - right
    iou = np.divide(right, union, out=np.full_like(right, np.nan), where=union > 0)
    return np.stack([np.nanmean(iou, axis=1), right.sum(1) / np.maximum(true.sum(1), 1.0)], axis=1)


def total(task: str, images: np.ndarray) -> dict[str, float]:
    """The scores of all images."""
    found = of_images(task, images, np.ones((1, len(images))))[0]
    return {name: float(value) for name, value in zip(names(task), found)}


@dataclass(frozen=True)
class Difference:
    """A mean and its 95 % interval."""

    mean: float
    low: float
    high: float


def differences(task: str, arm: Sequence[np.ndarray], other: Sequence[np.ndarray], resamples: int) -> dict[str, Difference]:
    """What `arm` scores more than `other`, by score: mean over seeds, and the 2.5 % and 97.5 % quantiles of the bootstrap.

    arm, other: images of each seed, of the same seeds in the same order.
    """
    random = np.random.Generator(np.random.PCG64(0))
    count, seeds = len(arm[0]), len(arm)
    weights = random.multinomial(count, np.full(count, 1.0 / count), size=resamples).astype(np.float64)
    gains = np.stack([of_images(task, a, weights) - of_images(task, b, weights) for a, b in zip(arm, other)])
    drawn = random.multinomial(seeds, np.full(seeds, 1.0 / seeds), size=resamples) / seeds
    means = np.einsum("rs,srk->rk", drawn, gains)
    low, high = np.quantile(means, (0.025, 0.975), axis=0)
    plain = np.mean([[total(task, a)[name] - total(task, b)[name] for name in names(task)] for a, b in zip(arm, other)], axis=0)
    return {name: Difference(float(plain[i]), float(low[i]), float(high[i])) for i, name in enumerate(names(task))}
