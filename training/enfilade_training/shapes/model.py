"""Mesh R-CNN on torchvision's Mask R-CNN with a feature pyramid. Gkioxari et al. 2019; He et al. 2017; Lin et al. 2017."""

from typing import Any

import torch
import torch.nn.functional as F
from torch import nn
from torchvision.models.detection import MaskRCNN
from torchvision.models.detection.backbone_utils import resnet_fpn_backbone
from torchvision.models.detection.faster_rcnn import FastRCNNPredictor, TwoMLPHead
from torchvision.models.detection.mask_rcnn import MaskRCNNPredictor
from torchvision.models.detection.roi_heads import RoIHeads, maskrcnn_inference
from torchvision.ops import MultiScaleRoIAlign
from torchvision.ops.misc import FrozenBatchNorm2d

from . import frustum
from .config import Evaluate, Losses, Network
from .cubify import cubify
from .detector import EMPTY, Anchors, IgnoringMatcher, Proposals, Resizing, halve_in_1x1, initialise, mask_loss
from .heads import DepthHead, MeshHead, VoxelHead
from .losses import depth_loss, mesh_losses, voxel_loss
from .meshes import Meshes
from .weights import DEVIATION, MEAN, load_weights

CATEGORIES = 9
_LEVELS = ["0", "1", "2", "3"]


class ShapeHeads(RoIHeads):
    """Torchvision's heads for boxes and masks, and those for depth extent, voxels and meshes.

    Each object of a target needs what `data.Shapes` gives. Results have, beside torchvision's, `extent` (N: depth extent over depth, times
    focal length, per pixel of the box's height) and `meshes` (N pairs of vertices and faces in the box's frustum from -1 to 1).
    """

    def add_shapes(self, channels: int, network: Network, losses: Losses) -> None:
        """Adds the heads; `channels` are the pyramid's."""
        def pool(side: int) -> MultiScaleRoIAlign:
            return MultiScaleRoIAlign(_LEVELS, output_size=side, sampling_ratio=2)

        self.weights, self.threshold = losses, network.cubify_threshold
        self.depth_pool, self.voxel_pool, self.mesh_pool = pool(7), pool(network.voxel_side // 2), pool(14)
        self.depth_head = DepthHead(channels, 7, CATEGORIES, network.head_width)
        self.voxel_head = VoxelHead(channels, network.voxel_side)
        self.mesh_head = MeshHead(channels, network.mesh_stages, network.mesh_convolutions, network.mesh_width)

    def forward(
        self,
        features: dict[str, torch.Tensor],
        proposals: list[torch.Tensor],
        image_shapes: list[tuple[int, int]],
        targets: list[dict[str, Any]] | None = None,
    ) -> tuple[list[dict[str, Any]], dict[str, torch.Tensor]]:
        if self.training:
            assert targets is not None
            return [], self._losses(features, proposals, image_shapes, targets)
        return self._results(features, proposals, image_shapes), {}

    def _losses(
        self,
        features: dict[str, torch.Tensor],
        proposals: list[torch.Tensor],
        image_shapes: list[tuple[int, int]],
        targets: list[dict[str, Any]],
    ) -> dict[str, torch.Tensor]:
        proposals, matched, labels, regression = self.select_training_samples(proposals, targets)
        pooled = self.box_head(self.box_roi_pool(features, proposals, image_shapes))
        losses = _box_losses(*self.box_predictor(pooled), torch.cat(labels), torch.cat(regression))
        chosen = [label > 0 for label in labels]
        boxes = [p[keep] for p, keep in zip(proposals, chosen)]
        matched = [m[keep] for m, keep in zip(matched, chosen)]
        classes = torch.cat([label[keep] for label, keep in zip(labels, chosen)])
        masks = self.mask_predictor(self.mask_head(self.mask_roi_pool(features, boxes, image_shapes)))
        losses["loss_mask"] = mask_loss(masks.float(), boxes, matched, classes, [t["masks"] for t in targets])
        regions = _Regions.of(boxes, matched, image_shapes, targets)
        extent = self.depth_head(self.depth_pool(features, boxes, image_shapes)).float()
        extent = extent[torch.arange(len(extent), device=extent.device), classes - 1]
        losses["loss_depth"] = self.weights.depth * depth_loss(extent, regions.extents, regions.boxes[:, 3] - regions.boxes[:, 1])
        logits = self.voxel_head(self.voxel_pool(features, boxes, image_shapes)).float()
        losses["loss_voxel"] = self.weights.voxel * voxel_loss(logits, regions.occupancy(logits.shape[-1]))
        stages = self._refined(features, boxes, image_shapes, logits)
        found = mesh_losses(stages, regions.meshes(), self.weights.samples, self.weights.coordinate_limit)
        return losses | {f"loss_{name}": getattr(self.weights, name) * value for name, value in found.items()}

    def _refined(
        self, features: dict[str, torch.Tensor], boxes: list[torch.Tensor], image_shapes: list[tuple[int, int]], logits: torch.Tensor
    ) -> list[Meshes]:
        """The meshes of each stage. In single precision, since steps of vertices are small beside their coordinates."""
        with torch.autocast(logits.device.type, enabled=False):
            single = {level: feature.float() for level, feature in features.items()}
            return self.mesh_head(self.mesh_pool(single, boxes, image_shapes), cubify(logits.sigmoid(), self.threshold))

    def _results(
        self, features: dict[str, torch.Tensor], proposals: list[torch.Tensor], image_shapes: list[tuple[int, int]]
    ) -> list[dict[str, Any]]:
        pooled = self.box_head(self.box_roi_pool(features, proposals, image_shapes))
        scores, regression = (t.float() for t in self.box_predictor(pooled))
        boxes, found_scores, labels = self.postprocess_detections(scores, regression, proposals, image_shapes)
        masks = maskrcnn_inference(
            self.mask_predictor(self.mask_head(self.mask_roi_pool(features, boxes, image_shapes))).float(), labels
        )
        classes, counts = torch.cat(labels), [len(b) for b in boxes]
        extent = self.depth_head(self.depth_pool(features, boxes, image_shapes)).float()
        extent = DepthHead.extent(extent[torch.arange(len(extent), device=extent.device), classes - 1]).split(counts)
        logits = self.voxel_head(self.voxel_pool(features, boxes, image_shapes)).float()
        meshes = iter(self._refined(features, boxes, image_shapes, logits)[-1])
        return [
            {"boxes": b, "labels": label, "scores": s, "masks": m, "extent": e, "meshes": [next(meshes) for _ in range(len(b))]}
            for b, label, s, m, e in zip(boxes, labels, found_scores, masks, extent)
        ]


def _box_losses(logits: torch.Tensor, deltas: torch.Tensor, labels: torch.Tensor, regression: torch.Tensor) -> dict[str, torch.Tensor]:
    """Fast R-CNN's losses with smooth L1 of beta 1, as Mesh R-CNN sets it; torchvision's has 1/9."""
    logits, deltas = logits.float(), deltas.float().view(len(deltas), -1, 4)
    there = labels > 0
    found = deltas[there, labels[there]]
    boxes = F.smooth_l1_loss(found, regression[there], beta=1.0, reduction="sum") / max(labels.numel(), 1)
    return {"loss_classifier": F.cross_entropy(logits, labels), "loss_box_reg": boxes}


class _Regions:
    """The regions of a batch that hold objects, and the objects' shapes in each region's frustum. Truth has no gradients."""

    def __init__(self, boxes: torch.Tensor, focal: torch.Tensor, sizes: torch.Tensor, shapes: list[dict[str, torch.Tensor]]):
        self.boxes, self.focal, self.sizes, self.shapes = boxes, focal, sizes, shapes
        extents = [frustum.relative_depth(s["vertices"], f) for s, f in zip(shapes, focal[:, 1].tolist())]
        self.extents = torch.stack(extents) if extents else boxes.new_zeros(0)

    @classmethod
    @torch.no_grad()
    def of(cls, boxes: list[torch.Tensor], matched: list[torch.Tensor], image_shapes: list[tuple[int, int]], targets: list[dict[str, Any]]) -> "_Regions":
        """boxes and image_shapes (height, width) are of the resized images, focal lengths of the originals."""
        focal, sizes, shapes = [], [], []
        for indices, (height, width), target in zip(matched, image_shapes, targets):
            original_height, original_width = target["size"]
            scaled = [target["focal"] * width / original_width, target["focal"] * height / original_height]
            focal += [scaled] * len(indices)
            sizes += [[width, height]] * len(indices)
            shapes += [target["shapes"][i] for i in indices.tolist()]
        place = {"device": boxes[0].device, "dtype": torch.float32}
        together = torch.cat(boxes).float()
        return cls(together, torch.tensor(focal, **place).view(-1, 2), torch.tensor(sizes, **place).view(-1, 2), shapes)

    def _in_box(self, i: int, points: torch.Tensor) -> torch.Tensor:
        """Points of the i-th shape in its region; as in the original, what is placed ends at the points' own depths."""
        depths = torch.stack([points[:, 2].min(), points[:, 2].max()])[None]
        part = slice(i, i + 1)
        return frustum.to_box(points[None], depths, self.boxes[part], self.focal[part], self.sizes[part])[0]

    @torch.no_grad()
    def occupancy(self, side: int) -> torch.Tensor:
        """N x side x side x side."""
        grids = [frustum.occupancy(self._in_box(i, shape["voxels"]), side) for i, shape in enumerate(self.shapes)]
        return torch.stack(grids) if grids else self.boxes.new_zeros(0, side, side, side)

    @torch.no_grad()
    def meshes(self) -> Meshes:
        """Of each region."""
        return Meshes.of([(self._in_box(i, shape["vertices"]), shape["faces"]) for i, shape in enumerate(self.shapes)])


def build(network: Network, losses: Losses, evaluate: Evaluate) -> MaskRCNN:
    """The network for Pix3D's nine categories. In training it takes images and targets of `data.Shapes` and gives losses."""
    begins = network.weights is not None
    trainable = network.trainable_stages if network.trainable_stages is not None else (3 if begins else 5)
    backbone = resnet_fpn_backbone(
        backbone_name=network.backbone,
        weights=None,
        norm_layer=FrozenBatchNorm2d if begins else nn.BatchNorm2d,
        trainable_layers=trainable,
    )
    halve_in_1x1(backbone.body, bool(network.stride_in_1x1))
    channels = backbone.out_channels
    ratios = ((0.5, 1.0, 2.0),) * len(network.anchors)
    model = MaskRCNN(
        backbone,
        rpn_anchor_generator=Anchors(tuple((size,) for size in network.anchors), ratios),
        rpn_post_nms_top_n_train=1000,
        box_head=TwoMLPHead(channels * 7 * 7, network.head_width),
        box_predictor=FastRCNNPredictor(network.head_width, CATEGORIES + 1),
        mask_predictor=MaskRCNNPredictor(256, 256, CATEGORIES + 1),
        box_batch_size_per_image=network.regions,
        box_score_thresh=evaluate.score,
        box_detections_per_img=evaluate.detections,
    )
    model.transform = Resizing(network.min_size, network.max_size, list(MEAN), list(DEVIATION))
    model.rpn.__class__, model.rpn.min_size = Proposals, EMPTY
    model.rpn.proposal_matcher = IgnoringMatcher(0.7, 0.5, 0.2, allow_low_quality_matches=True)
    heads = model.roi_heads
    heads.proposal_matcher = IgnoringMatcher(0.5, 0.5, 0.2, allow_low_quality_matches=False)
    heads.__class__ = ShapeHeads
    heads.add_shapes(channels, network, losses)
    initialise(heads)
    if network.weights is not None:
        load_weights(model, network.weights, network.stride_in_1x1, network.weights_pixels)
    return model


def to_device(target: dict[str, Any], device: torch.device) -> dict[str, Any]:
    """The target with its tensors on the device."""
    moved = {key: value.to(device) if isinstance(value, torch.Tensor) else value for key, value in target.items()}
    return moved | {"shapes": [{key: value.to(device) for key, value in shape.items()} for shape in target["shapes"]]}
