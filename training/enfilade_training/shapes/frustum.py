"""The frustum of a region of the image, and the box from -1 to 1 that the network works in.

The frustum is between the planes z_min and z_max and inside of the planes through the region's borders. The projective map that takes
its corners to those of the box is unique, and keeps straight lines straight. Mesh R-CNN estimates it from its corners
(`cuboid3D_to_unitbox3D`); here it is in closed form. Gkioxari et al. 2019, appendix.

A point of camera space (x left, y up, z forward) falls on the image at (w/2 - 1 - f x/z, h/2 - 1 - f y/z): Mesh R-CNN's convention, one
pixel beside that of the images. It stands on both sides of the network, so that predictions come out where they belong.
"""

import torch

# Mesh R-CNN counts the last pixel's column as w - 1 while its boxes count borders; see above.
PIXEL_SHIFT = 1.0
# Vertices that are nearer to the camera's plane than this leave the frustum, metres, as in `enfilade export`.
NEAR_M = 0.01
# How far beyond the image's border a vertex may fall, pixels: numbers in files are rounded.
BORDER_TOLERANCE_PX = 0.01


def _slopes(boxes: torch.Tensor, focal: torch.Tensor, sizes: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
    """x/z and y/z at the boxes' borders, N x 2 each: at the right and lower border, and at the left and upper border."""
    middle = sizes / 2 - PIXEL_SHIFT
    return (middle - boxes[:, 2:]) / focal, (middle - boxes[:, :2]) / focal


def to_box(points: torch.Tensor, depths: torch.Tensor, boxes: torch.Tensor, focal: torch.Tensor, sizes: torch.Tensor) -> torch.Tensor:
    """Points of camera space (N x P x 3) in the box of their region: x right, y down, z away; inside of the frustum from -1 to 1.

    depths: N x 2, z_min and z_max. boxes: N x 4, left, upper, right, lower, pixels. focal: N x 2, by x and y, pixels.
    sizes: N x 2, width and height of the image.
    """
    low, high = _slopes(boxes, focal, sizes)
    near, far = depths[:, None, 0], depths[:, None, 1]
    z = points[..., 2]
    across = (2 * points[..., :2] / z[..., None] - (low + high)[:, None]) / (high - low)[:, None]
    away = ((far + near) * z - 2 * near * far) / ((far - near) * z)
    return torch.cat([-across, away[..., None]], dim=-1)


def from_box(points: torch.Tensor, depths: torch.Tensor, boxes: torch.Tensor, focal: torch.Tensor, sizes: torch.Tensor) -> torch.Tensor:
    """The inverse of `to_box`."""
    low, high = _slopes(boxes, focal, sizes)
    near, far = depths[:, None, 0], depths[:, None, 1]
    z = 2 * near * far / ((far + near) - points[..., 2] * (far - near))
    across = (-points[..., :2] * (high - low)[:, None] + (low + high)[:, None]) / 2
    return torch.cat([across * z[..., None], z[..., None]], dim=-1)


def occupancy(points: torch.Tensor, side: int) -> torch.Tensor:
    """Which of side^3 voxels of the box (side x side x side, by z, y, x) hold one of the points (P x 3, as `to_box` gives them): 0 or 1.

    A coordinate v of camera space's direction is in voxel floor((v + 1) (side - 1) / 2), counted backward for x and y: Mesh R-CNN's
    `verts2voxel`.
    """
    places = points * torch.tensor([-1.0, -1.0, 1.0], device=points.device, dtype=points.dtype)
    cells = ((places + 1) * (side - 1) / 2).trunc().long()  # as a cast to integers rounds
    inside = ((cells >= 0) & (cells < side)).all(dim=1)
    x, y, z = cells[inside].unbind(1)
    voxels = torch.zeros(side, side, side, device=points.device)
    voxels[z, side - 1 - y, side - 1 - x] = 1.0
    return voxels


def leaves(points: torch.Tensor, focal: float, size: tuple[int, int], near: float) -> bool:
    """Whether one of the points (P x 3, camera space) is nearer than `near` or behind the camera, or falls outside of the image.

    focal: pixels. size: height and width of the image, in whose middle the principal point is; borders are counted as the image's, from 0
    to width and height. near: in the unit of the points.
    """
    if bool((points[:, 2] <= near).any()):
        return True
    middle = torch.tensor([size[1] / 2, size[0] / 2], dtype=points.dtype)
    return bool(((focal * points[:, :2] / points[:, 2:]).abs() > middle + BORDER_TOLERANCE_PX).any())


def relative_depth(vertices: torch.Tensor, focal: float) -> torch.Tensor:
    """Extent in depth over the depth of its middle, times the focal length: what the z head predicts per pixel of the box's height."""
    near, far = vertices[:, 2].min(), vertices[:, 2].max()
    return (far - near) / ((far + near) / 2) * focal


def depth_range(relative: torch.Tensor, middle: torch.Tensor, focal: torch.Tensor) -> torch.Tensor:
    """z_min and z_max (N x 2) of predictions of `relative_depth`, around the depth of the middle, which one image does not tell."""
    half = middle * relative / focal / 2
    return torch.stack([middle - half, middle + half], dim=1)
