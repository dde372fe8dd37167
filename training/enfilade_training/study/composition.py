"""Draws pictures so that they are composed as others are: the same classes above, in the middle and below, and at the same distances.

Rendered views look at walls and windows more often than people do who take photographs, and at large furniture less. Each picture gets a
weight, exp(a linear function of its composition), by which the weighted mean comes near to that of the other pictures: of all weights those
that are nearest to equal ones for how near it comes (maximum entropy with a quadratic price; Jaynes 1957, Dudík et al. 2004). Pictures are
then drawn by systematic sampling. Of the others nothing is used but the mean.
"""

import math
from typing import Callable

import numpy as np
import torch

from .config import HEADS, SEMANTICS
from .pictures import Pictures, shares

# Parts of a picture of which each is compared, one above the other.
PARTS = 3
# How dear weights are that differ: with less the means are met more closely, by fewer pictures. Chosen on training photographs.
RIDGE = 0.6
# Of deviations from the mean, in standard deviations, that count in full: a picture that is like no other should not decide.
FARTHEST = 6.0
# On all of which it depends what is drawn.
SETTINGS = (PARTS, RIDGE, FARTHEST)


def drawn(pictures: Pictures, others: Pictures, say: Callable[[str], None] = lambda _: None) -> Pictures:
    """As many pictures, of which some are there several times and others not at all, composed in the mean nearly as `others`."""
    found = weights(composition(pictures), composition(others))
    chosen = torch.from_numpy(systematic(found))
    names = [pictures.names[index] for index in chosen]
    worth = float(1.0 / found.square().sum())
    say(f"  {len(set(names))} of {len(pictures)} frames, drawn as photographs are composed; they are worth {worth:.0f} of equal weights")
    return Pictures(pictures.color[chosen], pictures.classes40[chosen], pictures.depth_m[chosen], names)


def composition(pictures: Pictures) -> torch.Tensor:
    """float64, N x 3 (13 + 1): of each part the share of each of NYU13's classes, and the mean logarithm of the depth in metres."""
    found = []
    for i in range(len(pictures)):
        row = []
        for classes, depth in zip(pictures.classes(SEMANTICS, i).tensor_split(PARTS), pictures.depth_m[i].tensor_split(PARTS)):
            known = depth[depth > 0].double()
            row += [shares(classes, HEADS[SEMANTICS]), known.log().mean()[None] if len(known) else torch.full((1,), math.nan).double()]
        found.append(torch.cat(row))
    made = torch.stack(found)
    # Where nothing has a depth, that of the other pictures.
    return torch.where(made.isnan(), made.nanmean(0), made).nan_to_num()


def weights(found: torch.Tensor, wanted: torch.Tensor) -> torch.Tensor:
    """Of each row of `found`, with the sum 1: their weighted mean is near to the mean of `wanted`."""
    apart = ((found - wanted.mean(0)) / (found.std(0) + 1e-3)).clamp(-FARTHEST, FARTHEST)
    slopes = torch.zeros(found.shape[1], dtype=torch.double, requires_grad=True)
    search = torch.optim.LBFGS([slopes], max_iter=500, line_search_fn="strong_wolfe")

    def dual() -> torch.Tensor:
        search.zero_grad()
        value = torch.logsumexp(apart @ slopes, 0) + RIDGE / 2.0 * slopes.square().sum()
        value.backward()
        return value

    search.step(dual)
    return torch.softmax(apart @ slopes, 0).detach()


def systematic(parts: torch.Tensor) -> np.ndarray:
    """Indices in ascending order, as many as there are parts; each as often as its part of the sum says, to within one."""
    count = len(parts)
    ends = np.cumsum(parts.numpy() / float(parts.sum()))
    return np.searchsorted(ends, (np.arange(count) + 0.5) / count).clip(0, count - 1)
