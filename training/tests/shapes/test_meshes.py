import unittest

import torch

from enfilade_training.shapes.cubify import cubify
from enfilade_training.shapes.meshes import Meshes, icosphere


def topology(vertices: torch.Tensor, faces: torch.Tensor) -> tuple[int, set[int]]:
    """Euler's number, and how many faces meet at an edge."""
    edges = torch.cat([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).sort(dim=1).values
    unique, counts = torch.unique(edges, dim=0, return_counts=True)
    return len(vertices) - len(unique) + len(faces), set(counts.tolist())


def volume(vertices: torch.Tensor, faces: torch.Tensor) -> float:
    a, b, c = vertices[faces].unbind(1)
    return float((a * torch.linalg.cross(b, c)).sum() / 6)


class CubifyTests(unittest.TestCase):
    def setUp(self) -> None:
        torch.set_num_threads(1)

    def test_counts_of_small_shapes_are_known(self) -> None:
        voxels = torch.zeros(4, 4, 4, 4)
        voxels[0, 1, 1, 1] = 1  # a cube
        voxels[1, 1, 1, 1:3] = 1  # two that share a face
        voxels[2, 1:3, 1:3, 1:3] = 1  # eight
        self.assertEqual(cubify(voxels, 0.5).counts, (8, 12, 26, 0))
        self.assertEqual(cubify(voxels, 0.5).face_counts, (12, 20, 48, 0))

    def test_a_ball_is_a_closed_sphere_with_outward_faces(self) -> None:
        at = torch.arange(24) - 11.5
        ball = ((at[:, None, None] ** 2 + at[None, :, None] ** 2 + at[None, None, :] ** 2) < 10.3**2).float()[None]
        (vertices, faces), = cubify(ball, 0.2)
        self.assertEqual(topology(vertices, faces), (2, {2}))
        self.assertEqual(len(faces), 2 * (len(vertices) - 2))
        # As many voxels as the surface encloses, each (2/23)^3 large. Box space is x right, y down, z away, which is right-handed.
        self.assertAlmostEqual(volume(vertices, faces), float(ball.sum()) * (2 / 23) ** 3, places=4)

    def test_a_ring_has_eulers_number_zero(self) -> None:
        ring = torch.zeros(1, 3, 5, 5)
        ring[0, 1, 1:4, 1:4] = 1
        ring[0, 1, 2, 2] = 0
        (vertices, faces), = cubify(ring, 0.5)
        self.assertEqual(topology(vertices, faces), (0, {2}))

    def test_voxels_lie_where_occupancy_puts_them(self) -> None:
        voxels = torch.zeros(1, 3, 5, 9)
        voxels[0, 1, 2, 4] = 1
        (vertices, _), = cubify(voxels, 0.5)
        self.assertEqual(vertices.min(0).values.tolist(), [0.0, 0.0, 0.0])
        self.assertEqual(vertices.max(0).values.tolist(), [0.25, 0.5, 1.0])

    def test_each_mesh_of_a_batch_is_the_same_alone(self) -> None:
        voxels = torch.rand(3, 6, 6, 6, generator=torch.Generator().manual_seed(1))
        for alone, (vertices, faces) in zip(voxels, cubify(voxels, 0.6)):
            (own_vertices, own_faces), = cubify(alone[None], 0.6)
            self.assertTrue(torch.equal(vertices, own_vertices))
            self.assertTrue(torch.equal(faces, own_faces))


class MeshesTests(unittest.TestCase):
    def setUp(self) -> None:
        torch.set_num_threads(1)

    def test_a_batch_gives_its_meshes_back(self) -> None:
        meshes = [icosphere(0), (torch.zeros(0, 3), torch.zeros(0, 3, dtype=torch.int64)), icosphere(1)]
        for (vertices, faces), (found_vertices, found_faces) in zip(meshes, Meshes.of(meshes)):
            self.assertTrue(torch.equal(vertices, found_vertices) and torch.equal(faces, found_faces))
        self.assertEqual(len(Meshes.of([])), 0)

    def test_an_icosphere_is_a_sphere(self) -> None:
        for level, count in enumerate((12, 42, 162, 642)):
            vertices, faces = icosphere(level)
            self.assertEqual((len(vertices), len(faces), topology(vertices, faces)), (count, 20 * 4**level, (2, {2})))
            self.assertTrue(torch.allclose(vertices.norm(dim=1), torch.ones(count)))
            self.assertGreater(volume(vertices, faces), 2.5)
        self.assertAlmostEqual(volume(*icosphere(5)), 4.18879, places=1)

    def test_edges_are_there_once(self) -> None:
        edges, owner = Meshes.of([icosphere(0), icosphere(0)]).edges()
        self.assertEqual((len(edges), owner.tolist()), (60, [0] * 30 + [1] * 30))
        self.assertTrue(bool((edges[:, 0] < edges[:, 1]).all()))

    def test_points_are_uniform_by_area_and_normals_stand_on_the_faces(self) -> None:
        vertices = torch.tensor([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 3, 1], [1, 0, 1.0]])
        mesh = Meshes.of([(vertices, torch.tensor([[0, 1, 2], [3, 4, 5]]))])
        points, normals, there = mesh.sample(20000, torch.Generator().manual_seed(2))
        upper = points[0, :, 2] > 0.5
        self.assertAlmostEqual(float(upper.float().mean()), 0.75, delta=0.02)
        self.assertTrue(torch.allclose(points[0, upper].mean(0), torch.tensor([1 / 3, 1, 1.0]), atol=0.02))
        self.assertTrue(torch.equal(normals[0, :, 2], torch.where(upper, -1.0, 1.0)))
        self.assertEqual(there.tolist(), [True])

    def test_gradients_flow_from_points_to_vertices(self) -> None:
        vertices, faces = icosphere(0)
        vertices = vertices.double().requires_grad_()

        def drawn(v: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
            points, normals, _ = Meshes.of([(v, faces)]).sample(5, torch.Generator().manual_seed(7))
            return points, normals

        # Which face a point is on does not move with the vertices: their areas are the same on every side of a step this small.
        self.assertTrue(torch.autograd.gradcheck(drawn, (vertices,)))

    def test_meshes_without_area_are_told(self) -> None:
        flat = torch.zeros(3, 3), torch.tensor([[0, 1, 2]])
        empty = torch.zeros(0, 3), torch.zeros(0, 3, dtype=torch.int64)
        points, _, there = Meshes.of([flat, icosphere(0), empty]).sample(4)
        self.assertEqual((there.tolist(), points.shape), ([False, True, False], (3, 4, 3)))
