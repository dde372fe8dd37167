"""AP of boxes, masks and meshes by Mesh R-CNN's rules; overlaps, F1 and AP are computed by the module `enfilade`."""

from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

import enfilade
import numpy as np
import torch
from torchvision.ops import box_iou

from ..common import checkpoints, distributed
from . import frustum
from .config import Config
from .data import Shapes
from .meshes import icosphere
from .model import build
from .weights import load_weights

# The rules look only at detections that overlap an object by more than this.
FILTER_IOU = 0.3


def evaluate(config: Config, replica: distributed.Replica, checkpoint: Path) -> dict[str, Any]:
    """Judges a checkpoint on the images of `data.evaluate`: `box_ap`, `mask_ap`, `mesh_ap` in 0 to 1, and the same by category."""
    network = restored(config, checkpoint).to(replica.device).eval()
    assert config.data.evaluate is not None
    # `min_pixels` is a matter of training.
    shapes = Shapes([config.data.evaluate], replace(config.data, min_pixels=0.0))
    rows, truths = [], Counter()
    for index in range(replica.rank, len(shapes), replica.count):
        image, target = shapes[index]
        with torch.inference_mode():
            found = network([image.to(replica.device)])[0]
        found = {key: value.cpu() if isinstance(value, torch.Tensor) else value for key, value in found.items()}
        found["meshes"] = [(vertices.cpu(), faces.cpu()) for vertices, faces in found["meshes"]]
        rows += judge(found, target, config.evaluate.samples, config.evaluate.seed + index)
        truths.update(target["labels"].tolist())
    rows = [row for part in replica.gather(rows) for row in part]
    truths = sum(replica.gather(truths), Counter())
    return enfilade.shape_precision(rows, dict(truths))


def restored(config: Config, checkpoint: Path) -> torch.nn.Module:
    """The network of a checkpoint, or of a file that Mesh R-CNN's authors published."""
    # What it began with is in the checkpoint; whether its statistics are frozen is a matter of training.
    network = build(replace(config.network, weights=None), config.losses, config.evaluate)
    _, kept = load_weights(network, checkpoint, config.network.stride_in_1x1, config.network.weights_pixels)
    missing = [name for name in kept if not name.endswith("num_batches_tracked")]
    if missing:
        problem = f"{len(missing)} tensors of the network are missing or have another shape, {missing[0]} among them"
        raise checkpoints.CheckpointError(f"{checkpoint}: {problem}; set [network] as it was trained")
    return network


def judge(found: dict[str, Any], target: dict[str, Any], samples: int, seed: int) -> list[dict[str, Any]]:
    """The rows of `enfilade.judge_shapes` of one image.

    found: what the network gives, in pixels of the original image. Where in depth an object stands cannot be seen in one image: as in the
    original, the middle of the true object's depth is given.
    """
    truths = [
        {
            "category": int(label),
            "box": box.tolist(),
            "mask": mask.numpy() > 0,
            "mesh": _arrays(shape["vertices"], shape["faces"]),
        }
        for label, box, mask, shape in zip(target["labels"], target["boxes"], target["masks"], target["shapes"])
    ]
    if not len(found["boxes"]):
        return []
    overlap, owner = box_iou(found["boxes"], target["boxes"]).max(dim=1)
    kept = (overlap > FILTER_IOU - 1e-3).nonzero()[:, 0].tolist()  # the rule itself is the module's
    middles = torch.stack([(s["vertices"][:, 2].min() + s["vertices"][:, 2].max()) / 2 for s in target["shapes"]])
    detections = []
    for i in kept:
        vertices, faces = placed(found, i, middles[owner[i]], target["focal"], target["size"])
        detections.append(
            {
                "score": float(found["scores"][i]),
                "category": int(found["labels"][i]),
                "box": found["boxes"][i].tolist(),
                "mask": (found["masks"][i, 0] >= 0.5).numpy(),
                "mesh": _arrays(vertices, faces),
            }
        )
    return enfilade.judge_shapes(truths, detections, filter_iou=FILTER_IOU, samples=samples, seed=seed)


def placed(found: dict[str, Any], i: int, middle: torch.Tensor, focal: float, size: tuple[int, int]) -> tuple[torch.Tensor, torch.Tensor]:
    """The mesh of the i-th detection in camera space, whose middle is `middle` deep; a sphere where no voxel was found.

    As in the original, the sphere is finer where nothing in the image has a voxel.
    """
    vertices, faces = found["meshes"][i]
    if not len(vertices):
        vertices, faces = icosphere(3 if any(len(points) for points, _ in found["meshes"]) else 4)
    box = found["boxes"][i : i + 1]
    relative = found["extent"][i : i + 1] * (box[:, 3] - box[:, 1])
    depths = frustum.depth_range(relative, middle.view(1), torch.tensor(focal))
    sizes = torch.tensor([[size[1], size[0]]], dtype=torch.float32)
    return frustum.from_box(vertices[None].float(), depths, box, torch.full((1, 2), focal), sizes)[0], faces


def _arrays(vertices: torch.Tensor, faces: torch.Tensor) -> tuple[np.ndarray, np.ndarray]:
    return vertices.double().numpy(), faces.long().numpy()
