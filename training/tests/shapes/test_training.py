import dataclasses
import hashlib
import json
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import torch
from torch import nn
from torchvision.models.detection.image_list import ImageList

from enfilade_training.common import checkpoints, config as settings, logs
from enfilade_training.common.distributed import Replica
from enfilade_training.shapes import config as shape_config
from enfilade_training.shapes.__main__ import main
from enfilade_training.shapes.config import Config
from enfilade_training.shapes.evaluate import evaluate
from enfilade_training.shapes.detector import STRIDES, IgnoringMatcher
from enfilade_training.shapes.model import build
from enfilade_training.shapes.train import learning_rate, step, train
from enfilade_training.shapes.weights import load_weights
from tests.ranks import run_on_ranks
from tests.shapes import rooms

ONE = Replica(0, 1, torch.device("cpu"))
CONFIGS = Path(__file__).resolve().parents[2] / "configs"
LOSSES = ["loss_classifier", "loss_box_reg", "loss_mask", "loss_depth", "loss_voxel", "loss_chamfer", "loss_normals", "loss_edge"]
LOSSES += ["loss_objectness", "loss_rpn_box_reg"]
# What depends on the number of classes.
OF_CLASSES = ("box_predictor.cls_score", "box_predictor.bbox_pred", "mask_predictor.mask_fcn_logits")


def small(folder: Path, **changes: object) -> Config:
    """A small network on the two images of `rooms`."""
    data = shape_config.Data(train=(folder / "pix3d_all.json",), evaluate=folder / "pix3d_all.json", workers=0)
    network = shape_config.Network(
        backbone="resnet18", min_size=96, max_size=96, anchors=(16, 32, 64, 96, 128), regions=16, head_width=32, voxel_side=12,
        mesh_stages=2, mesh_convolutions=1, mesh_width=16,
    )  # fmt: skip
    options = {"iterations": 4, "batch": 2, "learning_rate": 0.005, "warmup_iterations": 2, "milestones": (3,), "device": "cpu"}
    options |= {"log_every": 1, "checkpoint_every": 2}
    evaluation = shape_config.Evaluate(samples=1000, detections=5)
    return Config(
        folder / "run", data, network, shape_config.Losses(samples=100), shape_config.Train(**options | changes), evaluation
    )


def as_published(network: nn.Module) -> dict[str, torch.Tensor]:
    """The network's tensors by the names of torchvision's file for COCO, which has 91 classes and no heads for shapes."""
    old = {}
    for name, value in network.state_dict().items():
        if any(f".{head}_head." in name for head in ("depth", "voxel", "mesh")) or name.endswith(("num_batches_tracked", STRIDES)):
            continue
        if "blocks." in name or "rpn.head.conv." in name:
            name = name.replace(".0.0.", ".") if "rpn" in name else name.replace(".0.weight", ".weight").replace(".0.bias", ".bias")
        elif ".mask_head." in name:
            before, number, _, kind = name.rsplit(".", 3)
            name = f"{before}.mask_fcn{int(number) + 1}.{kind}"
        elif any(part in name for part in OF_CLASSES):
            value = torch.zeros(4 * 91 if "bbox_pred" in name else 91, *value.shape[1:])
        old[name] = value
    return old


def train_on_ranks(replica: Replica, rooms_in: str) -> list[float]:
    """The sum of every tenth tensor of a run on several replicas."""
    config = dataclasses.replace(small(Path(rooms_in)), output=Path(rooms_in) / "ranks")
    path = train(config, replica, until=2)
    state = checkpoints.load(path)["network"]
    return [float(value.double().sum()) for value in list(state.values())[::10]]


class TrainingTests(unittest.TestCase):
    def setUp(self) -> None:
        torch.set_num_threads(1)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        rooms.write(self.folder, rooms.TWO)

    def test_a_resumed_run_equals_an_uninterrupted_one(self) -> None:
        whole = small(self.folder)
        parts = dataclasses.replace(whole, output=self.folder / "parts")
        one = checkpoints.load(train(whole, ONE))
        train(parts, ONE, until=2)
        two = checkpoints.load(train(parts, ONE))
        self.assertEqual(one["iteration"], 4)
        for name, value in one["network"].items():
            self.assertTrue(torch.equal(value, two["network"][name]), name)
        lines = [logs.read(config.output / "metrics.jsonl") for config in (whole, parts)]
        self.assertEqual(lines[0], lines[1])
        for line in lines[0]:
            self.assertTrue(all(torch.isfinite(torch.tensor(line[name])) for name in LOSSES), line)
        self.assertEqual([round(line["learning_rate"], 6) for line in lines[0]], [0.0005, 0.00275, 0.005, 0.0005])
        with self.assertRaisesRegex(checkpoints.CheckpointError, "other settings of train.seed"):
            train(dataclasses.replace(parts, train=dataclasses.replace(parts.train, seed=1)), ONE)

    def test_every_parameter_that_learns_has_a_gradient(self) -> None:
        config = small(self.folder)
        torch.manual_seed(1)
        network = build(config.network, config.losses, config.evaluate)
        from enfilade_training.shapes.data import Shapes

        batch = [Shapes(config.data.train, config.data)[i, False] for i in range(2)]
        optimizer = torch.optim.SGD(network.parameters(), lr=0.001)
        losses = step(network.train(), optimizer, batch, 1, ONE, mixed_precision=True)
        self.assertEqual(sorted(losses), sorted(LOSSES))
        self.assertEqual([name for name, p in network.named_parameters() if p.grad is None], [])
        # A new voxel head says 1/2 everywhere: 3 log 2. A new mesh head leaves the cubified box, which is twice as large as the region.
        self.assertAlmostEqual(float(losses["loss_voxel"]), 3 * 0.6931, delta=0.02)
        self.assertGreater(float(losses["loss_chamfer"]), 0.1)
        # Images without a region that holds an object.
        network.roi_heads.proposal_matcher = IgnoringMatcher(1.1, 0.5, 0.2, allow_low_quality_matches=False)
        losses = step(network, optimizer, batch, 1, ONE, mixed_precision=False)
        self.assertEqual([float(losses[name]) for name in LOSSES[2:8]], [0.0] * 6)
        self.assertEqual([name for name, p in network.named_parameters() if p.grad is None], [])

    def test_replicas_end_with_the_same_network(self) -> None:
        sums = run_on_ranks("tests.shapes.test_training", "train_on_ranks", 2, self.folder, rooms_in=str(self.folder))
        self.assertEqual(sums[0], sums[1])

    def test_the_program_trains_evaluates_and_predicts(self) -> None:
        data, output = json.dumps(str(self.folder / "pix3d_all.json")), json.dumps(str(self.folder / "cli"))
        file = self.folder / "config.toml"
        plain = settings.to_dict(small(self.folder))
        sections = [f"output = {output}", "[data]", f"train = [{data}]", f"evaluate = {data}", "workers = 0"]
        for table in ("network", "losses", "train", "evaluate"):
            sections.append(f"[{table}]")
            sections += [f"{key} = {json.dumps(value)}" for key, value in plain[table].items() if value is not None]
        file.write_text("\n".join(sections))
        self.assertEqual(main(["train", str(file), "--set", "train.iterations=2", "--set", "evaluate.score=0.0"]), 0)
        found = json.loads((self.folder / "cli/evaluation.json").read_text())
        self.assertEqual((found["truths"], sorted(found["categories"])), (3, ["chair", "sofa", "table"]))
        self.assertTrue(all(0 <= found[name] <= 1 for name in ("box_ap", "mask_ap", "mesh_ap")))
        shown = self.folder / "shown"
        command = ["predict", str(file), "--image", str(self.folder / "1.png"), "--focal", "110", "--score", "0.0", "-o", str(shown)]
        self.assertEqual(main([*command, "--set", "evaluate.score=0.0"]), 0)
        objects = json.loads((shown / "objects.json").read_text())["objects"]
        self.assertTrue(objects and all((shown / o["mesh"]).read_text().startswith("v ") for o in objects))
        self.assertEqual(main(["evaluate", str(file), "--checkpoint", str(self.folder / "nothing.pt")]), 1)
        self.assertEqual(main(["train", str(file), "--set", "train.stepz=2"]), 2)

    def test_small_objects_are_judged_though_training_leaves_them_out(self) -> None:
        config = small(self.folder)
        path = train(config, ONE, until=1)
        strict = dataclasses.replace(config, data=dataclasses.replace(config.data, min_pixels=1e6))
        self.assertEqual(evaluate(strict, ONE, path)["truths"], 3)

    def test_proposals_are_in_single_precision_whatever_features_are(self) -> None:
        config = small(self.folder)
        torch.manual_seed(3)
        network = build(config.network, config.losses, config.evaluate).eval()
        images = ImageList(torch.zeros(1, 3, 64, 1344), [(64, 1344)])
        features = {str(i): torch.randn(1, 256, 64 // stride, 1344 // stride).bfloat16() for i, stride in enumerate((4, 8, 16, 32, 64))}
        with torch.no_grad():
            (expected,), _ = network.rpn(images, {level: feature.float() for level, feature in features.items()})
            with torch.autocast("cpu", dtype=torch.bfloat16):
                (found,), _ = network.rpn(images, features)
        self.assertEqual(found.dtype, torch.float32)
        self.assertGreater(float(found[:, 2].max()), 1200)
        torch.testing.assert_close(found, expected)

    def test_weights_by_torchvisions_old_names_find_their_places(self) -> None:
        config = small(self.folder)
        torch.manual_seed(4)
        old = as_published(build(config.network, config.losses, config.evaluate))
        for name in ("backbone.fpn.inner_blocks.0.weight", "backbone.fpn.layer_blocks.3.bias", "rpn.head.conv.weight"):
            self.assertIn(name, old)
        self.assertTrue({f"roi_heads.mask_head.mask_fcn{i}.{kind}" for i in range(1, 5) for kind in ("weight", "bias")} <= old.keys())
        file = self.folder / "coco.pth"
        torch.save(old, file)
        network = build(config.network, config.losses, config.evaluate)
        with self.assertLogs("enfilade_training.shapes.weights", "INFO") as told:
            taken, kept = load_weights(network, file)
        new = [name for name in network.state_dict() if any(f".{head}_head." in name for head in ("depth", "voxel", "mesh"))]
        by_class = [f"roi_heads.{part}.{kind}" for part in OF_CLASSES for kind in ("weight", "bias")]
        counters = [name for name in network.state_dict() if name.endswith("num_batches_tracked")]
        self.assertEqual((taken, kept), (len(old) - len(by_class), sorted(new + by_class + counters)))
        self.assertTrue(torch.equal(network.rpn.head.conv[0][0].weight, old["rpn.head.conv.weight"]))
        self.assertTrue(torch.equal(network.roi_heads.mask_head[3][0].bias, old["roi_heads.mask_head.mask_fcn4.bias"]))
        self.assertIn(f"{len(by_class)} tensors find no place: {', '.join(sorted(by_class))}", told.output[-1])

    def test_the_network_for_coco_computes_as_it_was_trained(self) -> None:
        config = small(self.folder)
        old = as_published(build(config.network, config.losses, config.evaluate))
        bn1 = {kind: old[f"backbone.body.bn1.{kind}"] for kind in ("weight", "bias", "running_mean", "running_var")}
        # Far below the epsilon, which then decides.
        bn1["running_var"] *= 1e-9
        file, images = self.folder / "coco.pth", 1e-5 * torch.randn(1, 64, 4, 4)
        torch.save(old, file)
        frozen = dataclasses.replace(config.network, weights=file)
        with mock.patch("enfilade_training.shapes.weights.COCO_V1", hashlib.sha256(file.read_bytes()).hexdigest()):
            network = build(frozen, config.losses, config.evaluate)
        expected = images / bn1["running_var"].sqrt()[:, None, None]
        torch.testing.assert_close(network.backbone.body.bn1(images), expected)
        # Judging builds layers that can learn, and has the weights of a checkpoint.
        again = build(config.network, config.losses, config.evaluate).eval()
        again.load_state_dict(network.state_dict(), strict=False)
        torch.testing.assert_close(again.backbone.body.bn1(images).detach(), expected)
        # Other files with these names keep their scales.
        network = build(frozen, config.losses, config.evaluate)
        self.assertTrue(torch.equal(network.backbone.body.bn1.weight, bn1["weight"]))

    def test_weights_are_taken_where_they_fit(self) -> None:
        config = small(self.folder)
        torch.manual_seed(2)
        other = build(config.network, config.losses, config.evaluate)
        body = {name.removeprefix("backbone.body."): value for name, value in other.state_dict().items() if "backbone.body" in name}
        torch.save(body, self.folder / "resnet.pt")
        network = build(dataclasses.replace(config.network, weights=self.folder / "resnet.pt"), config.losses, config.evaluate)
        self.assertTrue(torch.equal(network.backbone.body.conv1.weight, other.backbone.body.conv1.weight))
        self.assertFalse(any(p.requires_grad for p in network.backbone.body.layer1.parameters()))
        self.assertTrue(all(p.requires_grad for p in network.backbone.body.layer2.parameters()))
        checkpoints.save(self.folder / "run.pt", {"network": other.state_dict()})
        taken, kept = load_weights(network, self.folder / "run.pt")
        self.assertEqual(kept, [])
        torch.save({"nothing": torch.zeros(1)}, self.folder / "strange.pt")
        with self.assertRaisesRegex(checkpoints.CheckpointError, "none of its 1 tensors fits"):
            load_weights(network, self.folder / "strange.pt")


class RecipeTests(unittest.TestCase):
    def test_the_learning_rate_is_detectron2s(self) -> None:
        config = Config(Path("out"), shape_config.Data())
        rates = [learning_rate(config, i) for i in (0, 500, 1000, 7999, 8000, 9999, 10000, 10999)]
        for found, expected in zip(rates, [0.002, 0.011, 0.02, 0.02, 0.002, 0.002, 0.0002, 0.0002]):
            self.assertAlmostEqual(found, expected)

    def test_the_files_of_settings_have_mesh_r_cnns_recipe(self) -> None:
        found = {path.name: settings.read(Config, path) for path in CONFIGS.glob("shapes-*.toml")}
        self.assertEqual(sorted(found), ["shapes-pix3d-finetune.toml", "shapes-pix3d-scratch.toml", "shapes-pretrain-enfilade.toml", "shapes-tiny.toml"])
        for name, config in found.items():
            if name == "shapes-tiny.toml":
                continue
            pretraining = "pretrain" in name
            self.assertEqual(config.train, shape_config.Train(learning_rate=0.005 if pretraining else 0.02))
            self.assertEqual(config.losses, shape_config.Losses())
            self.assertEqual(dataclasses.replace(config.network, weights=None), shape_config.Network())
        self.assertIsNotNone(found["shapes-pix3d-finetune.toml"].network.weights)
