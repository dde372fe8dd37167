import unittest

import enfilade
import torch

from enfilade_training.shapes.cubify import cubify
from enfilade_training.shapes.heads import DepthHead, GraphConvolution, MeshHead, VoxelHead, vert_align
from enfilade_training.shapes.losses import mesh_losses
from enfilade_training.shapes.meshes import Meshes, icosphere


class HeadTests(unittest.TestCase):
    def setUp(self) -> None:
        torch.set_num_threads(1)
        torch.manual_seed(0)

    def test_features_under_vertices_are_those_of_a_linear_map(self) -> None:
        at = torch.linspace(-1, 1, 7, dtype=torch.float64)
        ramp = torch.stack([at[None, :].expand(5, 7), torch.linspace(-1, 1, 5, dtype=torch.float64)[:, None].expand(5, 7)])[None]
        vertices = torch.tensor([[0.3, -0.7, 5.0], [-1.0, 1.0, 0.0], [1.7, -3.0, 0.0]], dtype=torch.float64)
        found = vert_align(ramp, Meshes.of([(vertices, torch.zeros(0, 3, dtype=torch.int64))]))
        self.assertTrue(torch.allclose(found, vertices[:, :2].clamp(-1, 1)))

    def test_each_mesh_has_the_features_of_its_own_region(self) -> None:
        maps = torch.arange(3.0).view(3, 1, 1, 1).expand(3, 1, 4, 4)
        points = [(torch.zeros(n, 3), torch.zeros(0, 3, dtype=torch.int64)) for n in (2, 0, 1)]
        self.assertEqual(vert_align(maps, Meshes.of(points))[:, 0].tolist(), [0.0, 0.0, 2.0])

    def test_gradients_of_features_under_vertices_are_finite_differences(self) -> None:
        map_ = torch.rand(1, 2, 4, 4, dtype=torch.float64, requires_grad=True)
        vertices = (torch.rand(5, 3, dtype=torch.float64) - 0.5).requires_grad_()
        faces = torch.zeros(0, 3, dtype=torch.int64)
        self.assertTrue(torch.autograd.gradcheck(lambda m, v: vert_align(m, Meshes.of([(v, faces)])), (map_, vertices)))

    def test_a_graph_convolution_is_the_published_sum(self) -> None:
        layer = GraphConvolution(3, 2).double()
        x = torch.rand(4, 3, dtype=torch.float64, requires_grad=True)
        edges = torch.tensor([[0, 1], [0, 2], [1, 2]])
        neighbours = {0: [1, 2], 1: [0, 2], 2: [0, 1], 3: []}
        for i, found in enumerate(layer(x, edges)):
            expected = layer.own(x[i]) + sum(layer.neighbours(x[j]) for j in neighbours[i])
            self.assertTrue(torch.allclose(found, expected))
        self.assertTrue(torch.autograd.gradcheck(lambda y: layer(y, edges), (x,)))

    def test_heads_have_the_published_shapes_and_sizes(self) -> None:
        self.assertEqual(VoxelHead(256, 24)(torch.zeros(2, 256, 12, 12)).shape, (2, 24, 24, 24))
        self.assertEqual(DepthHead(256, 7, 9)(torch.zeros(2, 256, 7, 7)).shape, (2, 9))
        head = MeshHead(256)
        self.assertEqual([len(stage.convolutions) for stage in head.stages], [3, 3, 3])
        # Bottleneck 256 x 128, offset 131 x 3, and two matrices for each of (131 or 259, 131, 131) x 128; each with its bias.
        layer = lambda n, m: (n + 1) * m
        stage = lambda first: layer(256, 128) + layer(131, 3) + 2 * (layer(first, 128) + 2 * layer(131, 128))
        self.assertEqual(sum(p.numel() for p in head.parameters()), stage(131) + 2 * stage(259))

    def test_a_new_mesh_head_moves_nothing_and_keeps_the_faces(self) -> None:
        start = Meshes.of([icosphere(1), icosphere(0)])
        for stage in MeshHead(4, width=8)(torch.rand(2, 4, 6, 6), start):
            self.assertTrue(torch.equal(stage.vertices, start.vertices))
            self.assertIs(stage.faces, start.faces)

    def test_no_regions_and_empty_meshes_pass_through_with_gradients(self) -> None:
        head = MeshHead(4, width=8)
        for count in (0, 2):
            stages = head(torch.rand(count, 4, 6, 6), cubify(torch.zeros(count, 4, 4, 4), 0.5))
            truth = Meshes.of([icosphere(0)] * count)
            total = sum(mesh_losses(stages, truth, 10, 5.0).values())
            total.backward()
            self.assertEqual(float(total), 0.0)
            self.assertTrue(all(p.grad is not None for p in head.stages[0].offset.parameters()))

    def test_a_few_steps_bring_a_cubified_shape_nearer_to_the_true_one(self) -> None:
        ball, faces = icosphere(3)
        truth = Meshes.of([(ball * torch.tensor([0.9, 0.35, 0.6]), faces)])
        at = torch.linspace(-1, 1, 12)
        start = cubify(((at[:, None, None] ** 2 + at[None, :, None] ** 2 + at[None, None, :] ** 2) < 0.5).float()[None], 0.5)
        features = torch.rand(1, 8, 14, 14)
        head = MeshHead(8, stages=2, convolutions=2, width=32)
        optimizer = torch.optim.Adam(head.parameters(), lr=2e-3)

        def f1(vertices: torch.Tensor) -> float:
            arrays = [(m.vertices.detach().double().numpy(), m.faces.numpy()) for m in (start.moved(vertices), truth)]
            return enfilade.compare_meshes(arrays[0], arrays[1], samples=4000)["f1"][0.3]

        before = f1(start.vertices)
        for _ in range(80):
            stages = head(features, start)
            found = mesh_losses(stages, truth, 600, 5.0)
            optimizer.zero_grad()
            (10 * found["chamfer"] + 0.1 * found["normals"] + found["edge"]).backward()
            optimizer.step()
        after = f1(head(features, start)[-1].vertices)
        self.assertGreater(after, before + 20, f"F1 {before:.1f} -> {after:.1f}")
        self.assertGreater(after, 80)
