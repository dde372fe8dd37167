import unittest

import torch

from enfilade_training.shapes import frustum

BOXES = torch.tensor([[20.0, 30.0, 60.0, 90.0], [5.0, 10.0, 90.0, 40.0]], dtype=torch.float64)
DEPTHS = torch.tensor([[1.5, 2.5], [0.7, 4.0]], dtype=torch.float64)
FOCAL = torch.tensor([[120.0, 110.0], [200.0, 200.0]], dtype=torch.float64)
SIZES = torch.tensor([[100.0, 120.0], [100.0, 120.0]], dtype=torch.float64)
CAMERA = (DEPTHS, BOXES, FOCAL, SIZES)


def pixels(points: torch.Tensor) -> torch.Tensor:
    """Where Mesh R-CNN lets points of camera space fall."""
    return (SIZES / 2 - 1)[:, None] - FOCAL[:, None] * points[..., :2] / points[..., 2:]


class FrustumTests(unittest.TestCase):
    def setUp(self) -> None:
        torch.set_num_threads(1)

    def test_the_corners_of_the_frustum_become_those_of_the_box(self) -> None:
        corners = torch.cartesian_prod(*[torch.tensor([-1.0, 1.0], dtype=torch.float64)] * 3).expand(2, 8, 3)
        placed = frustum.from_box(corners, *CAMERA)
        for box, depths, seen, points, corner in zip(BOXES, DEPTHS, pixels(placed), placed, corners):
            right, lower, far = (corner > 0).T
            self.assertTrue(torch.allclose(points[:, 2], torch.where(far, depths[1], depths[0])))
            self.assertTrue(torch.allclose(seen[:, 0], torch.where(right, box[2], box[0])))
            self.assertTrue(torch.allclose(seen[:, 1], torch.where(lower, box[3], box[1])))

    def test_there_and_back_is_nothing(self) -> None:
        points = torch.rand(2, 50, 3, dtype=torch.float64, generator=torch.Generator().manual_seed(1)) * 3 - 1.2
        back = frustum.to_box(frustum.from_box(points, *CAMERA), *CAMERA)
        self.assertTrue(torch.allclose(back, points, atol=1e-10))

    def test_the_map_is_the_homography_of_four_corners(self) -> None:
        # In the plane of x and z the map is projective, so it is the one that takes the four corners to those of the square.
        low, high = (SIZES[0, 0] / 2 - 1 - BOXES[0, 2]) / FOCAL[0, 0], (SIZES[0, 0] / 2 - 1 - BOXES[0, 0]) / FOCAL[0, 0]
        source = [(s * z, z) for z in DEPTHS[0].tolist() for s in (float(low), float(high))]
        target = [(x, z) for z in (-1.0, 1.0) for x in (-1.0, 1.0)]
        rows, values = [], []
        for (x, z), (u, v) in zip(source, target):
            rows += [[x, z, 1, 0, 0, 0, -u * x, -u * z], [0, 0, 0, x, z, 1, -v * x, -v * z]]
            values += [u, v]
        h = torch.linalg.solve(torch.tensor(rows, dtype=torch.float64), torch.tensor(values, dtype=torch.float64))
        h = torch.cat([h, torch.ones(1, dtype=torch.float64)]).view(3, 3)
        points = torch.tensor([[0.05, 0.1, 1.7], [-0.2, 0.0, 2.2]], dtype=torch.float64)
        mapped = torch.stack([points[:, 0], points[:, 2], torch.ones(2, dtype=torch.float64)], dim=1) @ h.T
        found = frustum.to_box(points[None], *(part[:1] for part in CAMERA))[0]
        self.assertTrue(torch.allclose(-found[:, 0], mapped[:, 0] / mapped[:, 2]))
        self.assertTrue(torch.allclose(found[:, 2], mapped[:, 1] / mapped[:, 2]))

    def test_gradients_of_placing_are_finite_differences(self) -> None:
        points = torch.rand(2, 4, 3, dtype=torch.float64, generator=torch.Generator().manual_seed(2)).requires_grad_()
        self.assertTrue(torch.autograd.gradcheck(lambda p: frustum.from_box(p, *CAMERA), (points,)))

    def test_unit_and_focal_length_do_not_matter_where_the_picture_is_the_same(self) -> None:
        points = frustum.from_box(torch.rand(2, 9, 3, dtype=torch.float64), *CAMERA)
        larger = frustum.to_box(7 * points, 7 * DEPTHS, BOXES, FOCAL, SIZES)
        self.assertTrue(torch.allclose(larger, frustum.to_box(points, *CAMERA)))

    def test_occupancy_counts_backward_across_and_forward_away(self) -> None:
        # Camera's x and y at -0.99 are cell 0 of 5, so the last after turning; z at 0.6 is cell floor(3.2).
        voxels = frustum.occupancy(torch.tensor([[0.99, 0.99, 0.6], [0.0, 5.0, 0.0], [0.0, 0.0, 1.6]]), 5)
        self.assertEqual(voxels.nonzero().tolist(), [[3, 4, 4]])

    def test_what_is_near_or_beyond_a_border_leaves_the_frustum(self) -> None:
        # An image of 60 x 100 pixels, focal length 50: at depth 2, x is within 2 and y within 1.2.
        def leaves(*point: float, near: float = 0.01) -> bool:
            points = torch.tensor([[0.0, 0.0, 2.0], list(point)], dtype=torch.float64)
            return frustum.leaves(points, 50.0, (60, 100), near)

        inside = [(2.0, 1.2, 2.0), (-2.0, -1.2, 2.0), (0.0, 0.0, 0.02), (2.00001, 0.0, 2.0)]  # the last by rounding
        self.assertEqual([leaves(*point) for point in inside], [False] * 4)
        outside = [(2.01, 0.0, 2.0), (-2.01, 0.0, 2.0), (0.0, 1.21, 2.0), (0.0, -1.21, 2.0), (0.0, 0.0, 0.01), (0.0, 0.0, -2.0)]
        self.assertEqual([leaves(*point) for point in outside], [True] * 6)
        self.assertTrue(leaves(0.0, 0.0, 0.02, near=0.02))

    def test_extent_in_depth_comes_back(self) -> None:
        vertices = torch.tensor([[0.0, 0.0, 1.5], [0.0, 0.0, 2.5]])
        relative = frustum.relative_depth(vertices, 110.0)
        self.assertAlmostEqual(float(relative), 55.0, places=4)
        found = frustum.depth_range(relative[None], torch.tensor([2.0]), torch.tensor(110.0))
        self.assertTrue(torch.allclose(found, torch.tensor([[1.5, 2.5]])))
