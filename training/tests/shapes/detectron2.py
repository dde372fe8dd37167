"""Tensors by the names of Detectron2 and Mesh R-CNN, and what these compute with them, written from their sources.

Of Detectron2 `modeling/backbone/resnet.py`, `fpn.py`, `proposal_generator/rpn.py`, `roi_heads/{box_head,fast_rcnn,mask_head}.py`; of Mesh
R-CNN `modeling/roi_heads/{z_head,voxel_head,mesh_head}.py`.
"""

import pickle
from pathlib import Path

import torch
import torch.nn.functional as F

BLOCKS = {"resnet18": (2, 2, 2, 2), "resnet50": (3, 4, 6, 3)}
PIXEL_MEAN = torch.tensor([103.53, 116.28, 123.675])  # blue, green, red
Tensors = dict[str, torch.Tensor]


class Maker:
    """Random tensors whose layers keep the size of what they are given."""

    def __init__(self, seed: int):
        self.made: Tensors = {}
        self._random = torch.Generator().manual_seed(seed)

    def layer(self, name: str, *shape: int, norm: bool = False, inputs: int | None = None) -> None:
        """A convolution or linear layer, with bias, or with frozen batch statistics instead."""
        inputs = inputs or torch.Size(shape[1:]).numel()
        self.made[f"{name}.weight"] = torch.randn(shape, generator=self._random) * (2 / inputs) ** 0.5
        if not norm:
            self.made[f"{name}.bias"] = 0.1 * torch.randn(shape[0], generator=self._random)
            return
        for kind, low, high in (("weight", 0.5, 1.0), ("bias", -0.1, 0.1), ("running_mean", -0.1, 0.1), ("running_var", 0.5, 1.5)):
            self.made[f"{name}.norm.{kind}"] = low + (high - low) * torch.rand(shape[0], generator=self._random)


def body(make: Maker, backbone: str, prefix: str = "backbone.bottom_up.") -> None:
    """A ResNet; its first convolution takes colours up to 255."""
    make.layer(f"{prefix}stem.conv1", 64, 3, 7, 7, norm=True)
    make.made[f"{prefix}stem.conv1.weight"] /= 60
    deep, inputs = backbone == "resnet50", 64
    for stage, blocks in enumerate(BLOCKS[backbone], 2):
        inner = 64 << (stage - 2)
        outputs = 4 * inner if deep else inner
        for i in range(blocks):
            block = f"{prefix}res{stage}.{i}"
            if inputs != outputs:
                make.layer(f"{block}.shortcut", outputs, inputs, 1, 1, norm=True)
            sides = [(inner, inputs, 1), (inner, inner, 3), (outputs, inner, 1)] if deep else [(inner, inputs, 3), (inner, inner, 3)]
            for number, (o, n, side) in enumerate(sides, 1):
                make.layer(f"{block}.conv{number}", o, n, side, side, norm=True)
            inputs = outputs


def mesh_r_cnn(backbone: str, classes: int, width: int, voxel_side: int, stages: int, convolutions: int, mesh_width: int, seed: int = 0) -> Tensors:
    """All tensors of the network of a Mesh R-CNN."""
    make = Maker(seed)
    body(make, backbone)
    for level in range(2, 6):
        make.layer(f"backbone.fpn_lateral{level}", 256, 64 << (level - 2 if backbone == "resnet18" else level), 1, 1)
        make.layer(f"backbone.fpn_output{level}", 256, 256, 3, 3)
    for name, outputs, side in (("conv", 256, 3), ("objectness_logits", 3, 1), ("anchor_deltas", 12, 1)):
        make.layer(f"proposal_generator.rpn_head.{name}", outputs, 256, side, side)
    for head, prefix in (("box_head", "fc"), ("z_head", "z_fc")):
        make.layer(f"roi_heads.{head}.{prefix}1", width, 256 * 49)
        make.layer(f"roi_heads.{head}.{prefix}2", width, width)
    make.layer("roi_heads.z_head.z_pred", classes, width)
    make.layer("roi_heads.box_predictor.cls_score", classes + 1, width)
    make.layer("roi_heads.box_predictor.bbox_pred", 4 * classes, width)
    for head, prefix, outputs in (("mask_head", "mask_fcn", classes), ("voxel_head", "voxel_fcn", voxel_side)):
        for i in range(1, 5):
            make.layer(f"roi_heads.{head}.{prefix}{i}", 256, 256, 3, 3)
        make.layer(f"roi_heads.{head}.deconv", 256, 256, 2, 2, inputs=256)
        make.layer(f"roi_heads.{head}.predictor", outputs, 256, 1, 1)
    for i in range(stages):
        stage = f"roi_heads.mesh_head.stages.{i}"
        make.layer(f"{stage}.bottleneck", mesh_width, 256)
        make.layer(f"{stage}.verts_offset", 3, mesh_width + 3)
        for j in range(convolutions):
            known = mesh_width if i and not j else 0
            for part in ("w0", "w1"):
                make.layer(f"{stage}.gconvs.{j}.{part}", mesh_width, mesh_width + known + 3)
    return make.made


def write(path: Path, tensors: Tensors, **more: object) -> Path:
    """A file of Detectron2's collection."""
    with path.open("wb") as file:
        pickle.dump({"model": {name: value.numpy() for name, value in tensors.items()}, "__author__": "Detectron2 Model Zoo"} | more, file)
    return path


def convolved(tensors: Tensors, name: str, x: torch.Tensor, stride: int = 1) -> torch.Tensor:
    """A convolution, with its bias or its frozen statistics."""
    weight = tensors[f"{name}.weight"]
    x = F.conv2d(x, weight, tensors.get(f"{name}.bias"), stride, weight.shape[-1] // 2)
    if f"{name}.norm.weight" not in tensors:
        return x
    mean, variance, scale, shift = (tensors[f"{name}.norm.{kind}"] for kind in ("running_mean", "running_var", "weight", "bias"))
    return F.batch_norm(x, mean, variance, scale, shift, eps=1e-5)


def linear(tensors: Tensors, name: str, x: torch.Tensor) -> torch.Tensor:
    return F.linear(x, tensors[f"{name}.weight"], tensors[f"{name}.bias"])


def pyramid(tensors: Tensors, backbone: str, images: torch.Tensor, stride_in_1x1: bool) -> list[torch.Tensor]:
    """The levels 2 to 6. images: N x 3 x H x W, blue, green and red from 0 to 255."""
    x = F.relu(convolved(tensors, "backbone.bottom_up.stem.conv1", images - PIXEL_MEAN[:, None, None], 2))
    x, found = F.max_pool2d(x, 3, 2, 1), []
    for stage, blocks in enumerate(BLOCKS[backbone], 2):
        for i in range(blocks):
            block, stride = f"backbone.bottom_up.res{stage}.{i}", 2 if stage > 2 and i == 0 else 1
            strides = [stride, 1] if backbone == "resnet18" else [stride, 1, 1] if stride_in_1x1 else [1, stride, 1]
            out = x
            for number, step in enumerate(strides, 1):
                out = convolved(tensors, f"{block}.conv{number}", out, step)
                out = out if number == len(strides) else F.relu(out)
            kept = convolved(tensors, f"{block}.shortcut", x, stride) if f"{block}.shortcut.weight" in tensors else x
            x = F.relu(out + kept)
        found.append(x)
    levels, above = [], None
    for level in (5, 4, 3, 2):
        side = convolved(tensors, f"backbone.fpn_lateral{level}", found[level - 2])
        above = side if above is None else side + F.interpolate(above, scale_factor=2.0, mode="nearest")
        levels.insert(0, convolved(tensors, f"backbone.fpn_output{level}", above))
    return [*levels, F.max_pool2d(levels[-1], 1, 2, 0)]


def proposals(tensors: Tensors, level: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
    """Logits and deltas of anchors."""
    head = "proposal_generator.rpn_head"
    x = F.relu(convolved(tensors, f"{head}.conv", level))
    return convolved(tensors, f"{head}.objectness_logits", x), convolved(tensors, f"{head}.anchor_deltas", x)


def two_layers(tensors: Tensors, head: str, regions: torch.Tensor) -> torch.Tensor:
    """head: `box_head.fc` or `z_head.z_fc`."""
    x = regions.flatten(1)
    for i in (1, 2):
        x = F.relu(linear(tensors, f"roi_heads.{head}{i}", x))
    return x


def upsampled(tensors: Tensors, head: str, prefix: str, regions: torch.Tensor) -> torch.Tensor:
    """Masks of the classes without background, or layers of voxels: logits."""
    x = regions
    for i in range(1, 5):
        x = F.relu(convolved(tensors, f"roi_heads.{head}.{prefix}{i}", x))
    x = F.conv_transpose2d(x, tensors[f"roi_heads.{head}.deconv.weight"], tensors[f"roi_heads.{head}.deconv.bias"], 2)
    return convolved(tensors, f"roi_heads.{head}.predictor", F.relu(x))


def refined(tensors: Tensors, seen: torch.Tensor, vertices: torch.Tensor, neighbours: torch.Tensor, stages: int, convolutions: int) -> torch.Tensor:
    """Vertices after all stages. seen: V x 256, the image's features under each. neighbours: V x V, 1 where an edge is."""
    known = None
    for i in range(stages):
        stage = f"roi_heads.mesh_head.stages.{i}"
        x = torch.cat([F.relu(linear(tensors, f"{stage}.bottleneck", seen)), vertices], dim=1)
        x = x if known is None else torch.cat([known, x], dim=1)
        for j in range(convolutions):
            own, sent = (linear(tensors, f"{stage}.gconvs.{j}.{part}", x) for part in ("w0", "w1"))
            known = F.relu(own + neighbours @ sent)
            x = torch.cat([known, vertices], dim=1)
        vertices = vertices + torch.tanh(linear(tensors, f"{stage}.verts_offset", x))
    return vertices
