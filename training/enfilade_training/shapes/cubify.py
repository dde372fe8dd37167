"""From probabilities of voxels to the meshes of their surfaces. Gkioxari et al. 2019, algorithm 1."""

import torch

from .meshes import Meshes

# Of each direction to a neighbour (z, y, x) the corners of the face between, counted so that the normal points to the neighbour.
_FACES = {
    (-1, 0, 0): ((0, 0, 0), (0, 1, 0), (0, 1, 1), (0, 0, 1)),
    (1, 0, 0): ((1, 0, 0), (1, 0, 1), (1, 1, 1), (1, 1, 0)),
    (0, -1, 0): ((0, 0, 0), (0, 0, 1), (1, 0, 1), (1, 0, 0)),
    (0, 1, 0): ((0, 1, 0), (1, 1, 0), (1, 1, 1), (0, 1, 1)),
    (0, 0, -1): ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)),
    (0, 0, 1): ((0, 0, 1), (0, 1, 1), (1, 1, 1), (1, 0, 1)),
}


@torch.no_grad()
def cubify(voxels: torch.Tensor, threshold: float) -> Meshes:
    """The faces between voxels from `threshold` on and all others, two triangles each; corners that voxels share are one vertex.

    voxels: N x D x H x W, by z, y, x. Voxel i reaches from 2i/(W-1) - 1 to 2(i+1)/(W-1) - 1, as in PyTorch3D's "topleft" alignment and
    in `frustum.occupancy`, so that the last one reaches beyond 1. A mesh without voxels is empty.
    """
    count, *sides = voxels.shape
    depth, height, width = sides
    occupied = voxels >= threshold
    padded = torch.nn.functional.pad(occupied, (1,) * 6)
    quads = []
    for (dz, dy, dx), corners in _FACES.items():
        neighbour = padded[:, 1 + dz : 1 + dz + depth, 1 + dy : 1 + dy + height, 1 + dx : 1 + dx + width]
        n, z, y, x = (occupied & ~neighbour).nonzero(as_tuple=True)
        keys = [((n * (depth + 1) + z + cz) * (height + 1) + y + cy) * (width + 1) + x + cx for cz, cy, cx in corners]
        quads.append(torch.stack(keys, dim=1))
    quads = torch.cat(quads)
    corners, index = torch.unique(quads, return_inverse=True)
    per_mesh = (depth + 1) * (height + 1) * (width + 1)
    # Faces by mesh, and within a mesh by direction.
    owner = quads[:, 0] // per_mesh
    index = index[torch.argsort(owner, stable=True)]
    faces = torch.stack([index[:, [0, 1, 2]], index[:, [0, 2, 3]]], dim=1).view(-1, 3)
    x, y, z = corners % (width + 1), corners // (width + 1) % (height + 1), corners // ((width + 1) * (height + 1)) % (depth + 1)
    places = [2.0 * at / max(side - 1, 1) - 1.0 for at, side in ((x, width), (y, height), (z, depth))]
    vertices = torch.stack(places, dim=1).to(voxels.dtype if voxels.dtype == torch.float64 else torch.float32)
    counts = torch.bincount(corners // per_mesh, minlength=count).tolist()
    face_counts = (2 * torch.bincount(owner, minlength=count)).tolist()
    return Meshes(vertices, faces, tuple(counts), tuple(face_counts))
