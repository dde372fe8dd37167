import math
import unittest

import torch

from enfilade_training.shapes import losses
from enfilade_training.shapes.meshes import Meshes, icosphere


def sphere(radius: float, count: int, seed: int) -> tuple[torch.Tensor, torch.Tensor]:
    directions = torch.nn.functional.normalize(torch.randn(count, 3, generator=torch.Generator().manual_seed(seed), dtype=torch.float64), dim=1)
    return radius * directions, directions


def plane(z: float) -> tuple[torch.Tensor, torch.Tensor]:
    at = torch.arange(8, dtype=torch.float64)
    points = torch.cartesian_prod(at, at, torch.tensor([z], dtype=torch.float64))
    return points, torch.tensor([0.0, 0.0, 1.0], dtype=torch.float64).expand(64, 3)


def compared(a: tuple[torch.Tensor, torch.Tensor], b: tuple[torch.Tensor, torch.Tensor]) -> tuple[float, float]:
    found = losses.chamfer_and_normals(a[0][None], a[1][None], b[0][None], b[1][None], torch.tensor([True]))
    return float(found[0]), float(found[1])


class LossTests(unittest.TestCase):
    def setUp(self) -> None:
        torch.set_num_threads(1)

    def test_shifted_planes_are_their_shift_apart(self) -> None:
        chamfer, normals = compared(plane(0.0), plane(0.25))
        self.assertAlmostEqual(chamfer, 2 * 0.25**2, places=12)
        self.assertAlmostEqual(normals, 0.0, places=12)

    def test_spheres_of_one_middle_are_their_radii_apart(self) -> None:
        directions = sphere(1.0, 3000, 1)
        larger = 1.2 * directions[0], -directions[1]  # which way normals point does not matter
        chamfer, normals = compared(directions, larger)
        self.assertAlmostEqual(chamfer, 2 * 0.2**2, delta=1e-3)
        self.assertAlmostEqual(normals, 0.0, delta=1e-2)

    def test_the_chamfer_distance_is_the_published_formula(self) -> None:
        (p, n), (q, m) = sphere(1.0, 40, 1), sphere(0.7, 55, 2)
        squared = (p[:, None] - q[None]).square().sum(-1)
        cosines = n @ m.T
        expected = squared.min(1).values.mean() + squared.min(0).values.mean()
        turned = (1 - cosines[range(40), squared.argmin(1)].abs()).mean() + (1 - cosines[squared.argmin(0), range(55)].abs()).mean()
        chamfer, normals = compared((p, n), (q, m))
        self.assertAlmostEqual(chamfer, float(expected), places=12)
        self.assertAlmostEqual(normals, float(turned), places=12)

    def test_planes_at_right_angles_have_the_largest_normal_loss(self) -> None:
        points, normals = plane(0.0)
        self.assertAlmostEqual(compared((points, normals), (points, normals.roll(1, dims=1)))[1], 2.0, places=12)

    def test_pairs_that_do_not_count_are_left_out_of_the_mean(self) -> None:
        a, b = plane(0.0), plane(0.5)
        points, normals = torch.stack([a[0], a[0]]), torch.stack([a[1], a[1]])
        others = torch.stack([b[0], b[0] * math.nan])
        chamfer, _ = losses.chamfer_and_normals(points, normals, others, normals, torch.tensor([True, False]))
        self.assertAlmostEqual(float(chamfer), 0.5, places=12)
        nothing = losses.chamfer_and_normals(points, normals, others, normals, torch.tensor([False, False]))
        self.assertEqual([float(v) for v in nothing], [0.0, 0.0])

    def test_gradients_of_the_chamfer_distance_are_finite_differences(self) -> None:
        (p, n), (q, m) = sphere(1.0, 12, 3), sphere(0.8, 10, 4)
        p, n = p.requires_grad_(), (n * 1.3).requires_grad_()

        def loss(points: torch.Tensor, normals: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
            return losses.chamfer_and_normals(points[None], normals[None], q[None], m[None], torch.tensor([True]))

        self.assertTrue(torch.autograd.gradcheck(loss, (p, n)))

    def test_the_edge_loss_of_a_regular_mesh_is_its_edges_square(self) -> None:
        tetrahedron = torch.tensor([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1.0]], dtype=torch.float64)
        faces = torch.tensor([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
        one = Meshes.of([(tetrahedron, faces)])
        self.assertAlmostEqual(float(losses.edge_loss(one)), 8.0, places=12)
        # The mean is over the edges of each mesh, then over meshes.
        ball, corners = icosphere(0)
        edge = float((ball[0] - ball[11]).square().sum())
        two = Meshes.of([(tetrahedron, faces), (ball.double(), corners)])
        self.assertAlmostEqual(float(losses.edge_loss(two)), (8.0 + edge) / 2, places=6)
        empty = torch.zeros(0, 3, dtype=torch.float64), torch.zeros(0, 3, dtype=torch.int64)
        self.assertAlmostEqual(float(losses.edge_loss(Meshes.of([(tetrahedron, faces), empty]))), 4.0, places=12)

    def test_gradients_of_the_edge_loss_are_finite_differences(self) -> None:
        vertices, faces = icosphere(0)
        moved = vertices.double().requires_grad_()
        self.assertTrue(torch.autograd.gradcheck(lambda v: losses.edge_loss(Meshes.of([(v, faces)])), (moved,)))

    def test_the_voxel_loss_is_the_mean_cross_entropy(self) -> None:
        logits = torch.tensor([[[[0.3, -1.2]]]], dtype=torch.float64, requires_grad=True)
        truth = torch.tensor([[[[1.0, 0.0]]]], dtype=torch.float64)
        expected = (math.log(1 + math.exp(-0.3)) + math.log(1 + math.exp(-1.2))) / 2
        self.assertAlmostEqual(float(losses.voxel_loss(logits, truth)), expected, places=12)
        self.assertTrue(torch.autograd.gradcheck(lambda x: losses.voxel_loss(x, truth), (logits,)))

    def test_the_depth_loss_is_smooth_l1_of_the_logarithm(self) -> None:
        predicted = torch.tensor([0.2, 3.0], dtype=torch.float64, requires_grad=True)
        relative, heights = torch.tensor([50.0, 80.0], dtype=torch.float64), torch.tensor([50.0, 80.0], dtype=torch.float64)
        expected = (0.5 * 0.2**2 + (3.0 - 0.5)) / 2
        self.assertAlmostEqual(float(losses.depth_loss(predicted, relative, heights)), expected, places=12)
        self.assertTrue(torch.autograd.gradcheck(lambda x: losses.depth_loss(x, relative, heights), (predicted,)))
        self.assertEqual(float(losses.depth_loss(predicted[:0], relative[:0], heights[:0])), 0.0)

    def test_a_batch_with_a_bad_region_teaches_no_meshes(self) -> None:
        ball, faces = icosphere(1)
        found = [Meshes.of([((0.5 * ball).requires_grad_(), faces)])]
        near = losses.mesh_losses(found, Meshes.of([(ball, faces)]), 100, 5.0)
        far = losses.mesh_losses(found, Meshes.of([(9 * ball, faces)]), 100, 5.0)
        self.assertGreater(float(near["chamfer"]), 0.3)
        self.assertEqual({float(value) for value in far.values()}, {0.0})
