"""Losses of shapes: chamfer distance, normals, edges, voxels and depth extent, as Mesh R-CNN and PyTorch3D define them."""

import torch
import torch.nn.functional as F

from .meshes import Meshes

# Distances of one block of the nearest-neighbour search: 16 million floats.
_BLOCK = 1 << 24


@torch.no_grad()
def nearest(points: torch.Tensor, others: torch.Tensor) -> torch.Tensor:
    """For each point (P x 3) the index of the nearest other (Q x 3)."""
    rows = max(_BLOCK // max(len(others), 1), 1)
    found = [torch.cdist(block, others, compute_mode="donot_use_mm_for_euclid_dist").argmin(dim=1) for block in points.split(rows)]
    return torch.cat(found)


def chamfer_and_normals(
    points: torch.Tensor, normals: torch.Tensor, true_points: torch.Tensor, true_normals: torch.Tensor, valid: torch.Tensor
) -> tuple[torch.Tensor, torch.Tensor]:
    """Mean squared distance to the nearest point of the other cloud, both ways, and the mean of 1 - |cos| between the normals there.

    Points and normals: N x P x 3 and N x Q x 3. valid: which of the N pairs count; the losses are means over these, or 0.
    """
    chamfer, turned = [], []
    for p, n, q, m, counts in zip(points, normals, true_points, true_normals, valid.tolist()):
        if not counts:
            continue
        there, back = nearest(p, q), nearest(q, p)
        chamfer.append((p - q[there]).square().sum(1).mean() + (q - p[back]).square().sum(1).mean())
        cosines = F.cosine_similarity(n, m[there], dim=1, eps=1e-6).abs(), F.cosine_similarity(m, n[back], dim=1, eps=1e-6).abs()
        turned.append((1 - cosines[0]).mean() + (1 - cosines[1]).mean())
    nothing = points.sum() * 0
    return (torch.stack(chamfer).mean(), torch.stack(turned).mean()) if chamfer else (nothing, nothing)


def edge_loss(meshes: Meshes) -> torch.Tensor:
    """Mean squared length of the edges of each mesh, averaged over meshes; empty ones count as 0."""
    edges, owner = meshes.edges()
    if not len(edges):
        return meshes.vertices.sum() * 0
    squared = (meshes.vertices[edges[:, 0]] - meshes.vertices[edges[:, 1]]).square().sum(1)
    counts = torch.bincount(owner, minlength=len(meshes))
    return (squared / counts[owner]).sum() / len(meshes)


def voxel_loss(logits: torch.Tensor, occupied: torch.Tensor) -> torch.Tensor:
    """Mean binary cross-entropy of voxels, both N x D x H x W."""
    return F.binary_cross_entropy_with_logits(logits, occupied) if len(logits) else logits.sum() * 0


def depth_loss(predicted: torch.Tensor, relative: torch.Tensor, heights: torch.Tensor) -> torch.Tensor:
    """Smooth L1 (beta 1) between the prediction and log(relative depth / height of the region), a mean over regions."""
    if not len(predicted):
        return predicted.sum() * 0
    return F.smooth_l1_loss(predicted, torch.log(relative / heights), beta=1.0)


def mesh_losses(
    stages: list[Meshes],
    truth: Meshes,
    samples: int,
    coordinate_limit: float,
    generator: torch.Generator | None = None,
) -> dict[str, torch.Tensor]:
    """Chamfer, normal and edge losses, summed over the stages of refinement.

    Where a point drawn from the true meshes is farther than `coordinate_limit` from the box's middle in a coordinate, a region was bad, and
    the losses are 0.
    """
    points, normals, there = truth.sample(samples, generator)
    sums = {"chamfer": 0.0, "normals": 0.0, "edge": 0.0}
    for stage in stages:
        drawn, drawn_normals, found = stage.sample(samples, generator)
        chamfer, turned = chamfer_and_normals(drawn, drawn_normals, points, normals, there & found)
        for name, value in (("chamfer", chamfer), ("normals", turned), ("edge", edge_loss(stage))):
            sums[name] = sums[name] + value
    bad = len(points) and bool(points.abs().max() > coordinate_limit)
    return {name: value * 0.0 if bad else value for name, value in sums.items()}
