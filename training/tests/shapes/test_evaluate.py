import tempfile
import unittest
from pathlib import Path
from typing import Any

import enfilade
import numpy as np
import torch

from enfilade_training.shapes import frustum
from enfilade_training.shapes.config import Data
from enfilade_training.shapes.data import Shapes
from enfilade_training.shapes.evaluate import judge, placed
from enfilade_training.shapes.meshes import icosphere
from tests.shapes import rooms


def perfect(target: dict[str, Any]) -> dict[str, Any]:
    """What a network would give that knows the truth."""
    found: dict[str, Any] = {"boxes": target["boxes"], "labels": target["labels"], "masks": target["masks"][:, None].float(), "meshes": []}
    found["scores"] = torch.linspace(0.9, 0.8, len(target["boxes"]))
    extents = []
    for box, shape in zip(target["boxes"], target["shapes"]):
        vertices, (height, width) = shape["vertices"], target["size"]
        depths = torch.stack([vertices[:, 2].min(), vertices[:, 2].max()])[None]
        camera = (depths, box[None], torch.full((1, 2), target["focal"]), torch.tensor([[float(width), float(height)]]))
        found["meshes"].append((frustum.to_box(vertices[None], *camera)[0], shape["faces"]))
        extents.append(frustum.relative_depth(vertices, target["focal"]) / (box[3] - box[1]))
    found["extent"] = torch.stack(extents)
    return found


def chosen(found: dict[str, Any], indices: list[int]) -> dict[str, Any]:
    return {key: [value[i] for i in indices] if key == "meshes" else value[indices] for key, value in found.items()}


class EvaluationTests(unittest.TestCase):
    def setUp(self) -> None:
        torch.set_num_threads(1)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        file = rooms.write(Path(folder.name), rooms.TWO)
        self.target = Shapes([file], Data())[1][1]

    def precision(self, found: dict[str, Any]) -> dict[str, Any]:
        return enfilade.shape_precision(judge(found, self.target, 10_000, 1), {7: 1, 6: 1})

    def test_the_truth_has_full_precision(self) -> None:
        rows = judge(perfect(self.target), self.target, 10_000, 1)
        self.assertEqual([row["truth"] for row in rows], [0, 1])
        self.assertTrue(all(row["f1"] > 0.97 and row["box_iou"] == 1 and row["mask_iou"] == 1 for row in rows), rows)
        found = self.precision(perfect(self.target))
        self.assertEqual([found[name] for name in ("box_ap", "mask_ap", "mesh_ap", "truths")], [1, 1, 1, 2])

    def test_predictions_come_back_to_camera_space(self) -> None:
        found = perfect(self.target)
        for i, shape in enumerate(self.target["shapes"]):
            middle = (shape["vertices"][:, 2].min() + shape["vertices"][:, 2].max()) / 2
            vertices, _ = placed(found, i, middle, self.target["focal"], self.target["size"])
            self.assertTrue(torch.allclose(vertices, shape["vertices"], atol=1e-4))

    def test_a_missing_object_costs_its_category(self) -> None:
        found = self.precision(chosen(perfect(self.target), [0]))
        self.assertEqual((found["box_ap"], found["mesh_ap"]), (0.5, 0.5))
        self.assertEqual([found["categories"][name]["box_ap"] for name in ("sofa", "table")], [0, 1])
        self.assertEqual(self.precision(chosen(perfect(self.target), []))["box_ap"], 0)

    def test_a_wrong_class_and_a_wrong_shape_cost_what_they_should(self) -> None:
        found = perfect(self.target)
        found["labels"] = torch.tensor([3, int(found["labels"][1])])
        vertices, faces = found["meshes"][1]
        found["meshes"][1] = (vertices * torch.tensor([0.05, 0.05, 1.0]), faces)
        got = self.precision(found)["categories"]
        self.assertEqual(got["table"] | {"truths": 0}, {"box_ap": 0, "mask_ap": 0, "mesh_ap": 0, "truths": 0})
        self.assertEqual(got["sofa"] | {"truths": 0}, {"box_ap": 1, "mask_ap": 1, "mesh_ap": 0, "truths": 0})

    def test_a_shape_that_was_not_found_is_a_sphere(self) -> None:
        found = perfect(self.target)
        found["meshes"][0] = (torch.zeros(0, 3), torch.zeros(0, 3, dtype=torch.int64))
        vertices, faces = placed(found, 0, torch.tensor(2.0), self.target["focal"], self.target["size"])
        self.assertEqual((len(vertices), len(faces)), (len(icosphere(3)[0]), 1280))

    def test_a_shape_agrees_with_itself(self) -> None:
        shape = self.target["shapes"][0]
        mesh = shape["vertices"].double().numpy(), shape["faces"].numpy()
        found = enfilade.compare_meshes(mesh, mesh)
        self.assertGreater(found["f1"][0.3], 99)
        self.assertLess(found["chamfer_l2"], 0.1)
        with self.assertRaisesRegex(ValueError, "there are 8 vertices"):
            enfilade.compare_meshes((mesh[0], mesh[1] + 1), mesh)
        with self.assertRaisesRegex(ValueError, "no area"):
            enfilade.compare_meshes(mesh, (np.zeros((3, 3)), mesh[1][:0]))
