"""Where torchvision's detector differs from Detectron2's, on which Mesh R-CNN was trained: the parts that make it compute the same.

What each part replaces is in docs/training-shapes.md. Detectron2 is Wu et al. 2019, github.com/facebookresearch/detectron2.
"""

from typing import Any

import torch
import torch.nn.functional as F
from torch import nn
from torchvision.models.detection._utils import Matcher
from torchvision.models.detection.anchor_utils import AnchorGenerator
from torchvision.models.detection.image_list import ImageList
from torchvision.models.detection.rpn import RegionProposalNetwork
from torchvision.models.detection.transform import GeneralizedRCNNTransform, resize_boxes
from torchvision.models.resnet import Bottleneck
from torchvision.ops import clip_boxes_to_image

# Pixels between places of the pyramid's finest level; each further level has twice as many.
FINEST_STRIDE = 4
# Where the transition of the region proposals' smooth L1 lies in Mesh R-CNN's settings.
PROPOSAL_BETA = 0.111
# Boxes that are no wider or no higher than this are empty, pixels: Detectron2 keeps all that are above 0.
EMPTY = 1e-12
# The tensor of the network that says where its blocks halve the size; see `halve_in_1x1`.
STRIDES = "backbone.body.stride_in_1x1"


class IgnoringMatcher(Matcher):
    """Boxes that overlap every object by less than `ignored` are neither object nor background: detectron2's three thresholds."""

    def __init__(self, high: float, low: float, ignored: float, allow_low_quality_matches: bool):
        super().__init__(high, low, allow_low_quality_matches)
        self.ignored = ignored

    def __call__(self, match_quality_matrix: torch.Tensor) -> torch.Tensor:
        matches = super().__call__(match_quality_matrix)
        far = (match_quality_matrix.max(dim=0).values < self.ignored) & (matches == self.BELOW_LOW_THRESHOLD)
        return torch.where(far, torch.full_like(matches, self.BETWEEN_THRESHOLDS), matches)


class Anchors(AnchorGenerator):
    """Anchors whose sides are not rounded, at places that are 4, 8, 16, 32 and 64 pixels apart, whatever the image's size."""

    def generate_anchors(
        self,
        scales: list[int],
        aspect_ratios: list[float],
        dtype: torch.dtype = torch.float32,
        device: torch.device = torch.device("cpu"),
    ) -> torch.Tensor:
        sizes = torch.as_tensor(scales, dtype=torch.float64)[None, :]
        ratios = torch.as_tensor(aspect_ratios, dtype=torch.float64)[:, None].sqrt()
        widths, heights = (sizes / ratios).flatten(), (sizes * ratios).flatten()
        return (torch.stack([-widths, -heights, widths, heights], dim=1) / 2).to(device, dtype)

    def forward(self, image_list: ImageList, feature_maps: list[torch.Tensor]) -> list[torch.Tensor]:
        dtype, device = feature_maps[0].dtype, feature_maps[0].device
        self.set_cell_anchors(dtype, device)
        strides = [[torch.tensor(FINEST_STRIDE << level, device=device)] * 2 for level in range(len(feature_maps))]
        anchors = torch.cat(self.grid_anchors([list(map_.shape[-2:]) for map_ in feature_maps], strides))
        return [anchors for _ in image_list.image_sizes]


class Proposals(RegionProposalNetwork):
    """Region proposals, in single precision: bfloat16 places anchors on the far side of an image pixels off."""

    def forward(
        self, images: ImageList, features: dict[str, torch.Tensor], targets: list[dict[str, Any]] | None = None
    ) -> tuple[list[torch.Tensor], dict[str, torch.Tensor]]:
        with torch.autocast(images.tensors.device.type, enabled=False):
            return super().forward(images, {level: feature.float() for level, feature in features.items()}, targets)

    def compute_loss(
        self,
        objectness: torch.Tensor,
        pred_bbox_deltas: torch.Tensor,
        labels: list[torch.Tensor],
        regression_targets: list[torch.Tensor],
    ) -> tuple[torch.Tensor, torch.Tensor]:
        """Sums over the sampled anchors, divided by how many are asked for: fewer are there where most are ignored."""
        positive, negative = (torch.where(torch.cat(chosen))[0] for chosen in self.fg_bg_sampler(labels))
        sampled, asked = torch.cat([positive, negative]), self.fg_bg_sampler.batch_size_per_image * len(labels)
        found, true = pred_bbox_deltas[positive], torch.cat(regression_targets)[positive]
        boxes = F.smooth_l1_loss(found, true, beta=PROPOSAL_BETA, reduction="sum")
        there = F.binary_cross_entropy_with_logits(objectness.flatten()[sampled], torch.cat(labels)[sampled], reduction="sum")
        return there / asked, boxes / asked


class Resizing(GeneralizedRCNNTransform):
    """Images and masks resized as Pillow does it, smoothly and to 8 bits, and masks of detections pasted at fractions of pixels.

    Images are 0 to 1. Masks of targets are 0 or 1 and become 0 to 255.
    """

    def forward(
        self, images: list[torch.Tensor], targets: list[dict[str, Any]] | None = None
    ) -> tuple[ImageList, list[dict[str, Any]] | None]:
        resized, placed = [], []
        for i, image in enumerate(images):
            image, target = self.resize(image, None if targets is None else dict(targets[i]))
            resized.append(self.normalize(image))
            placed.append(target)
        sizes = [(image.shape[-2], image.shape[-1]) for image in resized]
        batch = ImageList(self.batch_images(resized, size_divisible=self.size_divisible), sizes)
        return batch, None if targets is None else placed

    def resize(self, image: torch.Tensor, target: dict[str, Any] | None = None) -> tuple[torch.Tensor, dict[str, Any] | None]:
        height, width = image.shape[-2:]
        size = output_size(height, width, self.min_size[-1], self.max_size)
        image = resampled(255 * image, size) / 255
        if target is not None:
            target["boxes"] = clip_boxes_to_image(resize_boxes(target["boxes"], [height, width], list(size)), size)
            target["masks"] = resampled(255.0 * target["masks"], size).byte()
        return image, target

    def postprocess(
        self, result: list[dict[str, Any]], image_shapes: list[tuple[int, int]], original_image_sizes: list[tuple[int, int]]
    ) -> list[dict[str, Any]]:
        if self.training:
            return result
        for found, shape, original in zip(result, image_shapes, original_image_sizes):
            found["boxes"] = resize_boxes(found["boxes"], list(shape), list(original))
            found["masks"] = pasted(found["masks"], found["boxes"], original)
        return result


def output_size(height: int, width: int, shorter: int, longest: int) -> tuple[int, int]:
    """Height and width whose shorter side is `shorter`, unless the longer would exceed `longest`; halves are rounded up."""
    scale = shorter / min(height, width)
    scale *= min(1.0, longest / (scale * max(height, width)))
    return int(scale * height + 0.5), int(scale * width + 0.5)


def resampled(planes: torch.Tensor, size: tuple[int, int]) -> torch.Tensor:
    """Planes N x H x W of values from 0 to 255, with `size` (height, width): Pillow's bilinear filter, across and then down, each time rounded, halves up."""
    made = planes[None].float()
    for step in ((made.shape[-2], size[1]), size):
        made = (F.interpolate(made, size=step, mode="bilinear", antialias=True, align_corners=False) + 0.5).floor().clamp(0, 255)
    return made[0]


def mask_targets(masks: torch.Tensor, boxes: torch.Tensor, owners: torch.Tensor, side: int) -> torch.Tensor:
    """What the mask head should find in boxes of one image, N x side x side: 1 where the mask touches, 0 elsewhere.

    masks: M x H x W, 0 to 255. owners: of which of them each box is. As Mesh R-CNN's `crop_mask_within_box`, where boxes lose fractions
    of pixels.
    """
    height, width = masks.shape[-2:]
    made = boxes.new_zeros(len(boxes), side, side)
    for target, (left, upper, right, lower), owner in zip(made, boxes.int().tolist(), owners.tolist()):
        left, upper = min(left, width - 1), min(upper, height - 1)
        crop = masks[owner, upper : max(lower, upper + 1), left : max(right, left + 1)]
        target.copy_(F.interpolate(crop[None, None].float(), size=(side, side), mode="bilinear", align_corners=False)[0, 0] > 0)
    return made


def mask_loss(
    logits: torch.Tensor, boxes: list[torch.Tensor], matched: list[torch.Tensor], labels: torch.Tensor, masks: list[torch.Tensor]
) -> torch.Tensor:
    """Mean cross-entropy of the masks of the true classes. logits: of all boxes. matched: by image, of which object each box is."""
    if not len(logits):
        return logits.sum() * 0
    targets = torch.cat([mask_targets(*one, logits.shape[-1]) for one in zip(masks, boxes, matched)])
    return F.binary_cross_entropy_with_logits(logits[torch.arange(len(labels), device=labels.device), labels], targets)


def pasted(masks: torch.Tensor, boxes: torch.Tensor, size: tuple[int, int]) -> torch.Tensor:
    """Masks (N x 1 x side x side, 0 to 1) in an image of `size` (height, width), N x 1 x height x width: bilinear at the middles of pixels."""
    height, width = size
    whole = masks.new_zeros(len(masks), 1, height, width)
    for place, mask, box in zip(whole, masks, boxes):
        left, upper = (max(int(edge) - 1, 0) for edge in box[:2].floor())
        right, lower = (min(int(edge) + 1, last) for edge, last in zip(box[2:].ceil(), (width, height)))
        x = (torch.arange(left, right, device=box.device) + 0.5 - box[0]) / (box[2] - box[0]) * 2 - 1
        y = (torch.arange(upper, lower, device=box.device) + 0.5 - box[1]) / (box[3] - box[1]) * 2 - 1
        grid = torch.stack([x[None, :].expand(len(y), -1), y[:, None].expand(-1, len(x))], dim=-1)
        place[0, upper:lower, left:right] = F.grid_sample(mask[None], grid[None].to(mask.dtype), align_corners=False)[0, 0]
    return whole


def initialise(heads: nn.Module) -> None:
    """Gives the heads for boxes and masks the random weights with which Detectron2 begins."""
    for layer in (heads.box_head.fc6, heads.box_head.fc7):
        nn.init.kaiming_uniform_(layer.weight, a=1)
    for layer, spread in ((heads.box_predictor.cls_score, 0.01), (heads.box_predictor.bbox_pred, 0.001), (heads.mask_predictor.mask_fcn_logits, 0.001)):
        nn.init.normal_(layer.weight, std=spread)
    for part in (heads.box_head, heads.box_predictor, heads.mask_predictor):
        for name, parameter in part.named_parameters():
            if name.endswith("bias"):
                nn.init.zeros_(parameter)


def halve_in_1x1(body: nn.Module, chosen: bool) -> None:
    """Lets the blocks of three convolutions halve the size in the first, as MSRA's ResNets do, or in the second, as torchvision's.

    The choice is a tensor of the body, so that a checkpoint keeps it, and follows what is loaded.
    """
    if "stride_in_1x1" not in dict(body.named_buffers(recurse=False)):
        body.register_buffer("stride_in_1x1", torch.tensor(False))
        body.register_load_state_dict_post_hook(lambda module, _: _put_strides(module))
    body.stride_in_1x1.fill_(chosen)
    _put_strides(body)


def _put_strides(body: nn.Module) -> None:
    in_1x1 = bool(body.stride_in_1x1)
    for block in body.modules():
        if isinstance(block, Bottleneck):
            one, stride = (1, 1), max(block.conv1.stride, block.conv2.stride)
            block.conv1.stride, block.conv2.stride = (stride, one) if in_1x1 else (one, stride)
