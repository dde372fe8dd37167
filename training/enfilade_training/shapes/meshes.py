"""Triangle meshes of different sizes as one batch, and points on them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterator, Sequence

import torch


@dataclass(frozen=True)
class Meshes:
    """Meshes one after the other.

    vertices: V x 3. faces: F x 3, whose corners count vertices of the whole batch. counts, face_counts: of each mesh.
    """

    vertices: torch.Tensor
    faces: torch.Tensor
    counts: tuple[int, ...]
    face_counts: tuple[int, ...]

    @staticmethod
    def of(meshes: Sequence[tuple[torch.Tensor, torch.Tensor]]) -> Meshes:
        """A batch of pairs of vertices and faces, whose corners count each mesh's own vertices."""
        if not meshes:
            return Meshes(torch.zeros(0, 3), torch.zeros(0, 3, dtype=torch.int64), (), ())
        counts = tuple(len(vertices) for vertices, _ in meshes)
        firsts = _firsts(counts)
        faces = [faces + first for (_, faces), first in zip(meshes, firsts)]
        return Meshes(torch.cat([vertices for vertices, _ in meshes]), torch.cat(faces), counts, tuple(len(f) for _, f in meshes))

    def __len__(self) -> int:
        return len(self.counts)

    def __iter__(self) -> Iterator[tuple[torch.Tensor, torch.Tensor]]:
        """Pairs of vertices and faces, as `of` takes them."""
        firsts = _firsts(self.counts)
        return (
            (vertices, faces - first)
            for vertices, faces, first in zip(self.vertices.split(self.counts), self.faces.split(self.face_counts), firsts)
        )

    def moved(self, vertices: torch.Tensor) -> Meshes:
        """The same faces between other vertices."""
        return Meshes(vertices, self.faces, self.counts, self.face_counts)

    def mesh_of_vertices(self) -> torch.Tensor:
        """The number of each vertex's mesh."""
        return _repeat(self.counts, self.vertices.device)

    def edges(self) -> tuple[torch.Tensor, torch.Tensor]:
        """Each edge once, as E x 2 vertices with the lower first, and the number of its mesh."""
        pairs = torch.cat([self.faces[:, [0, 1]], self.faces[:, [1, 2]], self.faces[:, [2, 0]]]).sort(dim=1).values
        pairs = torch.unique(pairs, dim=0) if len(pairs) else pairs
        return pairs, self.mesh_of_vertices()[pairs[:, 0]]

    def sample(self, count: int, generator: torch.Generator | None = None) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
        """Points that are uniform on each surface.

        Gives points and unit normals, both N x count x 3, through which gradients flow to the vertices, and whether each mesh has an area;
        of those that have none, points are 0.
        """
        points, normals, there = [], [], []
        for vertices, faces in self:
            corners = vertices[faces] if len(faces) else vertices.new_zeros(0, 3, 3)
            a, b, c = corners.unbind(1)
            crossed = torch.linalg.cross(b - a, c - a)
            areas = crossed.detach().norm(dim=1)
            there.append(bool(areas.sum() > 0) and bool(areas.sum().isfinite()))
            if not there[-1]:
                points.append(vertices.new_zeros(count, 3))
                normals.append(vertices.new_zeros(count, 3))
                continue
            chosen = _choose(areas, count, generator)
            root, v = (torch.rand(count, 1, device=vertices.device, dtype=vertices.dtype, generator=generator) for _ in range(2))
            root = root.sqrt()
            points.append(a[chosen] * (1 - root) + b[chosen] * (root * (1 - v)) + c[chosen] * (root * v))
            normals.append(torch.nn.functional.normalize(crossed[chosen], dim=1))
        flags = torch.tensor(there, dtype=torch.bool, device=self.vertices.device)
        if not points:
            return self.vertices.new_zeros(0, count, 3), self.vertices.new_zeros(0, count, 3), flags
        return torch.stack(points), torch.stack(normals), flags


def _choose(weights: torch.Tensor, count: int, generator: torch.Generator | None) -> torch.Tensor:
    """Indices in proportion to weights; torch.multinomial takes no more than 2^24 of them."""
    ends = weights.double().cumsum(0)
    u = torch.rand(count, device=weights.device, dtype=torch.float64, generator=generator) * ends[-1]
    return torch.searchsorted(ends, u, right=True).clamp(max=len(weights) - 1)


def _firsts(counts: Sequence[int]) -> list[int]:
    firsts = [0]
    for count in counts:
        firsts.append(firsts[-1] + count)
    return firsts[:-1]


def _repeat(counts: Sequence[int], device: torch.device) -> torch.Tensor:
    return torch.repeat_interleave(torch.arange(len(counts), device=device), torch.tensor(counts, dtype=torch.int64, device=device))


def icosphere(level: int, device: torch.device | str = "cpu") -> tuple[torch.Tensor, torch.Tensor]:
    """An icosahedron whose faces are divided `level` times, on the sphere of radius 1: what stands for a shape that was not found."""
    g = (1 + 5**0.5) / 2
    vertices = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    faces = [
        (0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
        (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1),
    ]  # fmt: skip
    points = torch.nn.functional.normalize(torch.tensor(vertices, dtype=torch.float64), dim=1)
    corners = torch.tensor(faces)
    for _ in range(level):
        sides = torch.cat([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]).sort(dim=1).values
        edges, which = torch.unique(sides, dim=0, return_inverse=True)
        ab, bc, ca = (which + len(points)).view(3, -1)
        points = torch.cat([points, torch.nn.functional.normalize(points[edges].mean(dim=1), dim=1)])
        a, b, c = corners.unbind(1)
        corners = torch.cat([torch.stack(t, dim=1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    return points.float().to(device), corners.to(device)
