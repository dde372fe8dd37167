"""Weights to begin with: torchvision's, Detectron2's and Mesh R-CNN's files, and checkpoints of our own.

Names become ours. The network takes red, green and blue from 0 to 1, less ImageNet's mean, divided by its deviation. Detectron2's takes
blue, green and red from 0 to 255 less the same mean; its first convolution is changed so that it gives the same. Background is the first
class here and the last one there. How the names there are made is in its `modeling` and `checkpoint/c2_model_loading.py`, and in Mesh
R-CNN's `modeling/roi_heads`.
"""

import hashlib
import logging
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable

import numpy as np
import torch
from torch import nn

from ..common import checkpoints, pickles
from .detector import STRIDES, halve_in_1x1

# How the SHA-256 of torchvision's Mask R-CNN for COCO begins, as in the file's published name.
COCO_V1 = "bf2d0c1e"
# ImageNet's mean and deviation of red, green and blue, 0 to 1, that the network's images are brought to.
MEAN, DEVIATION = (0.485, 0.456, 0.406), (0.229, 0.224, 0.225)
# How far a file's mean may be from ImageNet's, of 255.
_MEAN_TOLERANCE = 0.01
# What is added to variances in batch normalisation.
_EPS = 1e-5
# How files of torch begin: the archive's mark, and the number that pickles of torch before 1.6 begin with.
_TORCH = (b"PK\x03\x04", b"\x80\x02\x8a\x0al\xfc\x9cF\xf9 j\xa8P\x19")
_CONV1 = "backbone.body.conv1.weight"
_log = logging.getLogger(__name__)

# Detectron2's and Mesh R-CNN's names to ours; each name goes through all of them.
_DETECTRON2: tuple[tuple[str, str | Callable[[re.Match[str]], str]], ...] = (
    (r"^(stem|res[2-5])\.", r"backbone.bottom_up.\1."),
    (r"^backbone\.bottom_up\.stem\.conv1\.norm\.", "backbone.body.bn1."),
    (r"^backbone\.bottom_up\.stem\.conv1\.", "backbone.body.conv1."),
    (r"^backbone\.bottom_up\.res([2-5])\.", lambda m: f"backbone.body.layer{int(m[1]) - 1}."),
    (r"^(backbone\.body\.layer\d\.\d+)\.conv([123])\.norm\.", r"\1.bn\2."),
    (r"^(backbone\.body\.layer\d\.\d+)\.shortcut\.norm\.", r"\1.downsample.1."),
    (r"^(backbone\.body\.layer\d\.\d+)\.shortcut\.", r"\1.downsample.0."),
    (r"^backbone\.fpn_lateral([2-5])\.", lambda m: f"backbone.fpn.inner_blocks.{int(m[1]) - 2}.0."),
    (r"^backbone\.fpn_output([2-5])\.", lambda m: f"backbone.fpn.layer_blocks.{int(m[1]) - 2}.0."),
    (r"^proposal_generator\.rpn_head\.conv\.", "rpn.head.conv.0.0."),
    (r"^proposal_generator\.rpn_head\.objectness_logits\.", "rpn.head.cls_logits."),
    (r"^proposal_generator\.rpn_head\.anchor_deltas\.", "rpn.head.bbox_pred."),
    (r"^roi_heads\.box_head\.fc([12])\.", lambda m: f"roi_heads.box_head.fc{int(m[1]) + 5}."),
    (r"^roi_heads\.mask_head\.mask_fcn(\d+)\.", lambda m: f"roi_heads.mask_head.{int(m[1]) - 1}.0."),
    (r"^roi_heads\.mask_head\.deconv\.", "roi_heads.mask_predictor.conv5_mask."),
    (r"^roi_heads\.mask_head\.predictor\.", "roi_heads.mask_predictor.mask_fcn_logits."),
    (r"^roi_heads\.z_head\.z_fc(\d+)\.", lambda m: f"roi_heads.depth_head.layers.{2 * int(m[1]) - 1}."),
    (r"^roi_heads\.z_head\.z_pred\.", "roi_heads.depth_head.predictor."),
    (r"^roi_heads\.voxel_head\.voxel_fcn(\d+)\.", lambda m: f"roi_heads.voxel_head.layers.{2 * int(m[1]) - 2}."),
    (r"^roi_heads\.voxel_head\.deconv\.", "roi_heads.voxel_head.layers.8."),
    (r"^(roi_heads\.mesh_head\.stages\.\d+)\.verts_offset\.", r"\1.offset."),
    (r"^(roi_heads\.mesh_head\.stages\.\d+)\.gconvs\.(\d+)\.w0\.", r"\1.convolutions.\2.own."),
    (r"^(roi_heads\.mesh_head\.stages\.\d+)\.gconvs\.(\d+)\.w1\.", r"\1.convolutions.\2.neighbours."),
)
# Caffe2's names of a ResNet's layers to Detectron2's.
_CAFFE2 = (
    (r"^conv1_w$", "stem.conv1.weight"),
    (r"^(?:res_)?conv1_bn_", "stem.conv1.norm."),
    (r"^res([2-5])_(\d+)_branch1_bn_", r"res\1.\2.shortcut.norm."),
    (r"^res([2-5])_(\d+)_branch1_w$", r"res\1.\2.shortcut.weight"),
    (r"^res([2-5])_(\d+)_branch2([abc])_bn_", lambda m: f"res{m[1]}.{m[2]}.conv{'abc'.index(m[3]) + 1}.norm."),
    (r"^res([2-5])_(\d+)_branch2([abc])_w$", lambda m: f"res{m[1]}.{m[2]}.conv{'abc'.index(m[3]) + 1}.weight"),
    (r"\.norm\.(?:s|gamma)$", ".norm.weight"),
    (r"\.norm\.(?:b|beta)$", ".norm.bias"),
    (r"\.norm\.(?:rm|running_mean)$", ".norm.running_mean"),
    (r"\.norm\.(?:riv|running_var)$", ".norm.running_var"),
)
# What torchvision from 0.13 on calls a tensor; the files that it publishes are older.
_TORCHVISION = (
    (r"(fpn\.(?:inner|layer)_blocks\.\d+)\.(weight|bias)$", r"\1.0.\2"),
    (r"(rpn\.head\.conv)\.(weight|bias)$", r"\1.0.0.\2"),
    (r"(mask_head)\.mask_fcn(\d+)\.(weight|bias)$", lambda m: f"{m[1]}.{int(m[2]) - 1}.0.{m[3]}"),
)


@dataclass(frozen=True)
class Weights:
    """Tensors by our names, the file's own name of each, and what the file's network does otherwise."""

    state: dict[str, torch.Tensor]
    names: dict[str, str]
    stride_in_1x1: bool


def load_weights(model: nn.Module, path: Path, stride_in_1x1: bool | None = None, pixels: str | None = None) -> tuple[int, list[str]]:
    """Takes what fits from a file, and tells what does not. Layers for other numbers of classes stay as they are.

    stride_in_1x1, pixels: as in `config.Network`; unless given, what the file says. Gives how many tensors were taken, and the names of the
    model's that were not.
    """
    found = read(path, stride_in_1x1, pixels)
    own = {name: value for name, value in model.state_dict().items() if name != STRIDES}
    fits = {name: value for name, value in found.state.items() if name in own and own[name].shape == value.shape}
    if not fits:
        raise checkpoints.CheckpointError(
            f"{path}: none of its {len(found.state)} tensors fits the network; name a file of torchvision, Detectron2 or Mesh R-CNN, or a checkpoint"
        )
    kept = sorted(own.keys() - fits.keys())
    body = [name for name in own if name.startswith("backbone.body.") and not name.endswith("num_batches_tracked")]
    lacks = [name for name in body if name not in fits]
    if 0 < len(lacks) < len(body):
        problem = f"has {len(body) - len(lacks)} of the {len(body)} tensors of the backbone, and not {lacks[0]}"
        raise checkpoints.CheckpointError(f"{path}: {problem}; set network.backbone to the network of the file")
    model.load_state_dict(fits, strict=False)
    halve_in_1x1(model.backbone.body, found.stride_in_1x1)
    _log.info("%s: %d of %d tensors taken", path, len(fits), len(own))
    anew = sorted({".".join(name.split(".")[:2]) for name in kept if not name.endswith("num_batches_tracked")})
    if anew:
        _log.info("%s: has nothing for %s", path, ", ".join(anew))
    left = sorted(found.names[name] for name in found.state.keys() - fits.keys() if not name.endswith("num_batches_tracked"))
    if left:
        _log.info("%s: %d tensors find no place: %s", path, len(left), ", ".join(left))
    return len(fits), kept


def read(path: Path, stride_in_1x1: bool | None = None, pixels: str | None = None) -> Weights:
    """The tensors of a file by our names."""
    document, digest = _document(path)
    state = document
    for key in ("network", "model", "state_dict", "blobs"):
        state = state[key] if isinstance(state.get(key), dict) else state
    tensors = {str(name): tensor for name, value in state.items() if (tensor := _tensor(value)) is not None}
    if any(re.match(r"res[2-5]_\d+_branch", name) for name in tensors):
        tensors = {name: value for name, value in tensors.items() if not name.endswith("_momentum")}
        return _of_detectron2(path, _named(tensors, _CAFFE2), "bgr", stride_in_1x1, pixels)
    if any(re.match(r"(backbone\.bottom_up\.|stem\.|res[2-5]\.\d)", name) for name in tensors):
        usual = "rgb" if document.get("__author__") == "torchvision" else "bgr"
        return _of_detectron2(path, {name: (name, value) for name, value in tensors.items()}, usual, stride_in_1x1, pixels)
    kept = bool(tensors.pop(STRIDES, False)) or bool(tensors.pop(STRIDES.removeprefix("backbone.body."), False))
    in_1x1 = kept if stride_in_1x1 is None else stride_in_1x1
    # The file is known by its content: its name is the user's choice, and other files with the same tensors were trained otherwise.
    if "rpn.head.conv.weight" in tensors and digest().startswith(COCO_V1):
        tensors = _with_eps(tensors)
    bare = "conv1.weight" in tensors
    placed = _named({f"backbone.body.{name}" if bare else name: value for name, value in tensors.items()}, _TORCHVISION)
    names = {name: old.removeprefix("backbone.body.") if bare else old for name, (old, _) in placed.items()}
    return Weights({name: value for name, (_, value) in placed.items()}, names, in_1x1)


def _of_detectron2(
    path: Path, tensors: dict[str, tuple[str, torch.Tensor]], usual: str, stride_in_1x1: bool | None, pixels: str | None
) -> Weights:
    """tensors: by Detectron2's names, each with the name in the file. usual: the order of colours, unless the file or the settings say it."""
    mean, deviation = (tensors.pop(name, (name, None))[1] for name in ("pixel_mean", "pixel_std"))
    tensors = {name: value for name, value in tensors.items() if ".anchor_generator.cell_anchors" not in name}
    if pixels is None:
        pixels = usual if mean is None else "rgb" if float(mean.flatten()[0]) > float(mean.flatten()[-1]) else "bgr"
    state, names = {}, {}
    for name, (old, value) in tensors.items():
        ours = _renamed(name, _DETECTRON2)
        state[ours], names[ours] = _background_first(ours, value), old
    if _CONV1 in state:
        state[_CONV1] = _for_our_pixels(path, state[_CONV1], pixels, mean, deviation)
    # Layers that only scale and shift, as Caffe2's have it.
    for name in [name for name in state if re.search(r"\.(?:bn\d|downsample\.1)\.weight$", name)]:
        for kind, fill in (("running_mean", torch.zeros_like), ("running_var", torch.ones_like)):
            other = name.removesuffix("weight") + kind
            state.setdefault(other, fill(state[name]))
            names.setdefault(other, names[name])
    # Weights for red first come from torchvision's ResNets, which halve the size in the 3x3 convolution.
    return Weights(state, names, pixels == "bgr" if stride_in_1x1 is None else stride_in_1x1)


def _background_first(name: str, value: torch.Tensor) -> torch.Tensor:
    """The tensor with a background class before the others, which has no box and no mask."""
    if ".box_predictor.cls_score." in name:
        return torch.cat([value[-1:], value[:-1]])
    rows = 4 if ".box_predictor.bbox_pred." in name else 1 if ".mask_fcn_logits." in name else 0
    return torch.cat([value.new_zeros(rows, *value.shape[1:]), value]) if rows else value


def _for_our_pixels(
    path: Path, weight: torch.Tensor, pixels: str, mean: torch.Tensor | None, deviation: torch.Tensor | None
) -> torch.Tensor:
    """The first convolution, which takes (p - mean) / deviation of colours p from 0 to 255, for our images.

    Exact, since the mean is the same: what lies beyond the border is 0 before and after.
    """
    ours_mean, ours = 255 * torch.tensor(MEAN, dtype=torch.float64), 255 * torch.tensor(DEVIATION, dtype=torch.float64)
    turn = (lambda values: values.flip(0)) if pixels == "bgr" else (lambda values: values)
    if mean is not None and (turn(mean.double().flatten()) - ours_mean).abs().max() > _MEAN_TOLERANCE:
        told = ", ".join(f"{float(value):g}" for value in mean.flatten())
        raise checkpoints.CheckpointError(f"{path}: pixel_mean is {told}, expected ImageNet's 123.675, 116.28, 103.53 of red, green and blue, in either order")
    if deviation is not None:
        theirs = turn(deviation.double().flatten())
    else:
        theirs = ours if pixels == "rgb" else torch.ones(3, dtype=torch.float64)
    turned = weight.flip(1) if pixels == "bgr" else weight
    return (turned.double() * (ours / theirs)[:, None, None]).to(weight.dtype)


def _document(path: Path) -> tuple[dict[str, Any], Callable[[], str]]:
    """What a file holds, by torch or by a pickle of arrays, and a function that gives its SHA-256."""

    def digest() -> str:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()

    try:
        with path.open("rb") as file:
            begins = file.read(16)
    except OSError as error:
        raise checkpoints.CheckpointError(f"{path}: cannot be read ({error.strerror}); name a file of weights, or a checkpoint") from error
    if begins[:1] not in (b"\x80", b"(") or begins.startswith(_TORCH):
        return checkpoints.load(path, remedy="name a file of weights, or a checkpoint, that holds tensors and plain data alone"), digest
    return pickles.load(path), digest


def _tensor(value: Any) -> torch.Tensor | None:
    """Of a tensor or an array of numbers; nothing of anything else."""
    if isinstance(value, np.ndarray) and value.dtype.kind in "fiub":
        value = torch.from_numpy(np.array(value, dtype=value.dtype.newbyteorder("=")))
    if not isinstance(value, torch.Tensor):
        return None
    return value.float() if value.is_floating_point() else value


def _renamed(name: str, rules: tuple[tuple[str, Any], ...]) -> str:
    for pattern, by in rules:
        name = re.sub(pattern, by, name)
    return name


def _named(tensors: dict[str, torch.Tensor], rules: tuple[tuple[str, Any], ...]) -> dict[str, tuple[str, torch.Tensor]]:
    """The old name and the tensor by the new name."""
    return {_renamed(name, rules): (name, value) for name, value in tensors.items()}


def _with_eps(state: dict[str, torch.Tensor]) -> dict[str, torch.Tensor]:
    """A network that was trained without `_EPS`, as torchvision's for COCO was, with scales that give the same in layers that have it.

    Torchvision sets the layers' eps to zero instead (`overwrite_eps`), which a checkpoint would not keep. Scales are in it.
    """
    scaled = dict(state)
    for name, value in state.items():
        if name.endswith(".running_var"):
            weight, variance = name.replace("running_var", "weight"), value.double()
            scaled[weight] = (state[weight].double() * ((variance + _EPS) / variance).sqrt()).to(value.dtype)
    return scaled
