import dataclasses
import os
import pickle
import tempfile
import unittest
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torchvision.models import resnet18

from enfilade_training.common import pickles
from enfilade_training.common.checkpoints import CheckpointError
from enfilade_training.shapes import config as shape_config
from enfilade_training.shapes.cubify import cubify
from enfilade_training.shapes.detector import STRIDES, halve_in_1x1
from enfilade_training.shapes.evaluate import restored
from enfilade_training.shapes.model import build
from enfilade_training.shapes.weights import load_weights, read
from tests.shapes import detectron2

NETWORK = shape_config.Network(
    backbone="resnet18", min_size=96, max_size=96, head_width=16, voxel_side=12, mesh_stages=2, mesh_convolutions=2, mesh_width=16
)
LOGGER = "enfilade_training.shapes.weights"


def published(backbone: str = "resnet18", classes: int = 9) -> detectron2.Tensors:
    return detectron2.mesh_r_cnn(backbone, classes, width=16, voxel_side=12, stages=2, convolutions=2, mesh_width=16)


def made(**changes: Any) -> torch.nn.Module:
    return build(dataclasses.replace(NETWORK, **changes), shape_config.Losses(), shape_config.Evaluate()).eval()


class RunsCode:
    """What unpickles by making a folder."""

    def __init__(self, folder: str):
        self.folder = folder

    def __reduce__(self) -> tuple[Any, ...]:
        return os.mkdir, (self.folder,)


class Temporary(unittest.TestCase):
    def setUp(self) -> None:
        torch.set_num_threads(1)
        torch.manual_seed(0)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def near(self, found: torch.Tensor, expected: torch.Tensor) -> None:
        self.assertGreater(float(expected.std()), 1e-3)
        torch.testing.assert_close(found, expected, rtol=1e-3, atol=1e-3 * float(expected.abs().max()))


class DetectronTests(Temporary):
    @torch.no_grad()
    def test_the_backbone_computes_as_detectron2s_does_wherever_its_stride_is(self) -> None:
        tensors = published("resnet50")
        file = detectron2.write(self.folder / "model.pkl", tensors)
        pixels = torch.randint(0, 256, (1, 3, 64, 96)).float()  # red, green and blue
        found = {}
        for chosen in (None, False):
            network = made(backbone="resnet50", weights=file, stride_in_1x1=chosen)
            found[chosen] = network.backbone(network.transform.normalize(pixels[0] / 255)[None])
            expected = detectron2.pyramid(tensors, "resnet50", pixels.flip(1), stride_in_1x1=chosen is None)
            self.assertEqual(len(found[chosen]), 5)
            for one, other in zip(found[chosen].values(), expected):
                self.near(one, other)
        self.assertGreater(float((found[None]["0"] - found[False]["0"]).abs().max()), 0.1)

    @torch.no_grad()
    def test_the_heads_compute_as_those_of_detectron2_and_mesh_r_cnn(self) -> None:
        tensors = published()
        network = made(weights=detectron2.write(self.folder / "model.pkl", tensors))
        level, heads = torch.randn(1, 256, 8, 8), network.roi_heads
        (logits,), (deltas,) = network.rpn.head([level])
        for found, expected in zip((logits, deltas), detectron2.proposals(tensors, level)):
            self.near(found, expected)
        small, large = torch.randn(3, 256, 7, 7), torch.randn(2, 256, 14, 14)
        scores, boxes = heads.box_predictor(heads.box_head(small))
        x = detectron2.two_layers(tensors, "box_head.fc", small)
        expected = detectron2.linear(tensors, "roi_heads.box_predictor.cls_score", x)
        self.near(scores, torch.cat([expected[:, 9:], expected[:, :9]], dim=1))  # background is the last there
        self.near(boxes[:, 4:], detectron2.linear(tensors, "roi_heads.box_predictor.bbox_pred", x))
        self.near(heads.mask_predictor(heads.mask_head(large))[:, 1:], detectron2.upsampled(tensors, "mask_head", "mask_fcn", large))
        expected = detectron2.linear(tensors, "roi_heads.z_head.z_pred", detectron2.two_layers(tensors, "z_head.z_fc", small))
        self.near(heads.depth_head(small), expected)
        self.near(heads.voxel_head(small[:, :, :6, :6]), detectron2.upsampled(tensors, "voxel_head", "voxel_fcn", small[:, :, :6, :6]))

    @torch.no_grad()
    def test_meshes_are_refined_as_by_mesh_r_cnn(self) -> None:
        tensors = published()
        network = made(weights=detectron2.write(self.folder / "model.pkl", tensors))
        voxels = torch.zeros(1, 4, 4, 4)
        voxels[0, 1:3, 1:3, 1:4] = 1.0
        mesh = cubify(voxels, 0.5)
        edges, _ = mesh.edges()
        neighbours = torch.zeros(len(mesh.vertices), len(mesh.vertices))
        neighbours[edges[:, 0], edges[:, 1]] = neighbours[edges[:, 1], edges[:, 0]] = 1.0
        seen = torch.randn(256)
        found = network.roi_heads.mesh_head(seen.view(1, 256, 1, 1).expand(1, 256, 14, 14), mesh)[-1]
        self.near(found.vertices, detectron2.refined(tensors, seen.expand(len(mesh.vertices), 256), mesh.vertices, neighbours, 2, 2))

    def test_every_tensor_of_mesh_r_cnn_finds_its_place_and_every_place_is_filled(self) -> None:
        tensors = published()
        extra = {f"proposal_generator.anchor_generator.cell_anchors.{i}": torch.zeros(3, 4) for i in range(5)}
        extra |= {"pixel_mean": detectron2.PIXEL_MEAN.view(3, 1, 1), "pixel_std": torch.ones(3, 1, 1)}
        file = self.folder / "meshrcnn.pth"
        torch.save({"model": tensors | extra, "iteration": 11000}, file, _use_new_zipfile_serialization=False)
        network = made(weights=detectron2.write(self.folder / "model.pkl", published()))
        with self.assertLogs(LOGGER, "INFO") as told:
            self.assertEqual(load_weights(network, file), (len(tensors), []))
        self.assertEqual(told.output, [f"INFO:{LOGGER}:{file}: {len(tensors)} of {len(tensors)} tensors taken"])
        # Such a file can be judged as it is; a network that could learn has counters of batches besides.
        config = shape_config.Config(self.folder, shape_config.Data(), NETWORK)
        again = restored(config, file).state_dict()
        self.assertTrue(all(torch.equal(value, again[name]) for name, value in network.state_dict().items()))
        self.assertTrue(bool(again[STRIDES]))
        del tensors["roi_heads.z_head.z_pred.bias"]
        torch.save({"model": tensors}, file)
        with self.assertRaisesRegex(CheckpointError, "1 tensors of the network are missing .*depth_head.predictor.bias"):
            restored(config, file)

    def test_layers_for_cocos_classes_are_told_and_begin_anew(self) -> None:
        file = detectron2.write(self.folder / "coco.pkl", published(classes=80))
        with self.assertLogs(LOGGER, "INFO") as told:
            made(weights=file)
        of_classes = ["roi_heads.box_predictor.bbox_pred", "roi_heads.box_predictor.cls_score", "roi_heads.mask_head.predictor", "roi_heads.z_head.z_pred"]
        names = ", ".join(f"{name}.{kind}" for name in of_classes for kind in ("bias", "weight"))
        self.assertTrue(told.output[1].endswith("has nothing for roi_heads.box_predictor, roi_heads.depth_head, roi_heads.mask_predictor"))
        self.assertTrue(told.output[2].endswith(f"8 tensors find no place: {names}"), told.output[2])

    def test_torchvisions_resnet_by_detectron2s_names_is_torchvisions(self) -> None:
        state = resnet18().state_dict()
        torch.save(state, self.folder / "resnet18.pth")
        converted = {}
        for name, value in state.items():  # detectron2's tools/convert-torchvision-to-d2.py
            name = name if "layer" in name else f"stem.{name}"
            for i in range(1, 5):
                name = name.replace(f"layer{i}", f"res{i + 1}").replace(f"bn{i}", f"conv{i}.norm")
            converted[name.replace("downsample.0", "shortcut").replace("downsample.1", "shortcut.norm")] = value
        file = detectron2.write(self.folder / "R-18.pkl", converted, __author__="torchvision", matching_heuristics=True)
        found, expected = read(file), read(self.folder / "resnet18.pth")
        self.assertEqual((found.stride_in_1x1, expected.stride_in_1x1), (False, False))
        for name, value in expected.state.items():
            if not name.startswith("backbone.body.fc."):
                self.assertTrue(torch.equal(found.state[name], value), name)
        self.assertEqual([old for old in found.names.values() if "fc" in old], ["stem.fc.weight", "stem.fc.bias"])

    def test_msras_resnet_by_caffe2s_names_is_detectron2s(self) -> None:
        make = detectron2.Maker(3)
        detectron2.body(make, "resnet50", prefix="")
        old = {}
        kinds = {"weight": "gamma", "bias": "beta", "running_mean": "running_mean", "running_var": "running_var"}
        for name, value in make.made.items():
            layer, _, kind = name.rpartition(".")
            caffe = layer.replace(".norm", "_bn").replace("stem.", "").replace(".shortcut", "_branch1").replace(".", "_")
            for i, letter in enumerate("abc", 1):
                caffe = caffe.replace(f"_conv{i}", f"_branch2{letter}")
            old[f"{caffe}_{kinds[kind]}" if ".norm" in name else f"{caffe}_w"] = value.numpy()
        self.assertIn("res2_0_branch2a_bn_gamma", old)
        with (self.folder / "R-50.pkl").open("wb") as file:
            pickle.dump(old | {"fc1000_w": np.zeros((2, 2), np.float32)}, file, protocol=2)
        found, expected = read(self.folder / "R-50.pkl"), read(detectron2.write(self.folder / "d2.pkl", make.made))
        self.assertEqual((found.stride_in_1x1, expected.stride_in_1x1), (True, True))
        self.assertEqual(found.names.pop("fc1000_w"), "fc1000_w")
        self.assertTrue(all(torch.equal(found.state[name], value) for name, value in expected.state.items()))
        self.assertEqual(found.names.keys(), expected.names.keys())
        # Older files only scale and shift.
        bare = {name.replace("gamma", "s").replace("beta", "b"): value for name, value in old.items() if "running" not in name}
        with (self.folder / "older.pkl").open("wb") as file:
            pickle.dump({"blobs": bare | {"conv1_w_momentum": np.zeros(1)}}, file, protocol=2)
        found = read(self.folder / "older.pkl")
        self.assertEqual(found.state.keys(), expected.state.keys())
        self.assertTrue(torch.equal(found.state["backbone.body.layer1.0.bn2.running_var"], torch.ones(64)))

    def test_a_files_pixels_decide_unless_the_settings_do(self) -> None:
        make = detectron2.Maker(4)
        detectron2.body(make, "resnet18")
        weight = make.made["backbone.bottom_up.stem.conv1.weight"]
        red_first = {"pixel_mean": detectron2.PIXEL_MEAN.flip(0), "pixel_std": torch.tensor([58.395, 57.12, 57.375])}
        found = read(detectron2.write(self.folder / "rgb.pkl", make.made | red_first))
        self.assertFalse(found.stride_in_1x1)
        torch.testing.assert_close(found.state["backbone.body.conv1.weight"], weight)
        plain = detectron2.write(self.folder / "plain.pkl", make.made)
        torch.testing.assert_close(read(plain, pixels="rgb").state["backbone.body.conv1.weight"], weight)
        self.assertTrue(read(plain, stride_in_1x1=True, pixels="rgb").stride_in_1x1)
        odd = detectron2.write(self.folder / "odd.pkl", make.made | {"pixel_mean": torch.tensor([127.5, 127.5, 127.5])})
        with self.assertRaisesRegex(CheckpointError, "pixel_mean is 127.5, 127.5, 127.5, expected ImageNet's"):
            read(odd)

    def test_a_backbone_of_another_depth_is_refused(self) -> None:
        file = detectron2.write(self.folder / "model.pkl", published())
        with self.assertRaisesRegex(CheckpointError, "of the backbone, and not backbone.body.layer1.2.conv1.weight; set network.backbone"):
            made(backbone="resnet34", weights=file)

    def test_where_blocks_halve_the_size_is_kept_in_checkpoints(self) -> None:
        one, other = (made(backbone="resnet50").backbone.body for _ in range(2))
        strides = lambda body: (body.layer2[0].conv1.stride, body.layer2[0].conv2.stride, body.layer2[1].conv2.stride)  # noqa: E731
        self.assertEqual(strides(one), ((1, 1), (2, 2), (1, 1)))
        halve_in_1x1(one, True)
        self.assertEqual(strides(one), ((2, 2), (1, 1), (1, 1)))
        other.load_state_dict(one.state_dict())
        self.assertEqual(strides(other), strides(one))


class PickleTests(Temporary):
    def write(self, value: object, protocol: int = 4) -> Path:
        path = self.folder / "weights.pkl"
        path.write_bytes(pickle.dumps(value, protocol=protocol))
        return path

    def test_arrays_are_read_from_all_forms_of_pickles(self) -> None:
        arrays = {"a": np.arange(6, dtype=np.float32).reshape(2, 3), "b": np.asfortranarray(np.eye(3)), "c": np.float64(2.5), "d": "text"}
        for protocol in range(2, 6):
            found = pickles.load(self.write(arrays, protocol))
            self.assertEqual(found.keys(), arrays.keys())
            self.assertTrue(all(np.array_equal(found[name], value) for name, value in arrays.items()), protocol)

    def test_what_would_run_code_is_refused(self) -> None:
        marker = self.folder / "ran"
        for value in (RunsCode(str(marker)), {"model": {"a": np.zeros(2), "b": RunsCode(str(marker))}}):
            with self.assertRaisesRegex(CheckpointError, r"weights.pkl: is refused, or damaged \(it asks for .*mkdir, which could run code\)"):
                read(self.write(value))
        torch.save({"model": RunsCode(str(marker))}, self.folder / "weights.pth")
        with self.assertRaisesRegex(CheckpointError, "holds tensors and plain data alone"):
            read(self.folder / "weights.pth")
        self.assertFalse(marker.exists())

    def test_damaged_files_are_explained(self) -> None:
        path = self.write({"model": {"a": np.zeros(100)}})
        path.write_bytes(path.read_bytes()[:60])
        with self.assertRaisesRegex(CheckpointError, "is refused, or damaged"):
            read(path)
        with self.assertRaisesRegex(CheckpointError, "holds list, expected a dictionary"):
            read(self.write([1, 2]))
        with self.assertRaisesRegex(CheckpointError, "nothing.pkl: cannot be read"):
            read(self.folder / "nothing.pkl")
