import unittest

import numpy as np
import torch
from PIL import Image
from torch import nn
from torchvision.models.detection.image_list import ImageList

from enfilade_training.shapes import config as shape_config
from enfilade_training.shapes.detector import Anchors, IgnoringMatcher, mask_loss, mask_targets, output_size, pasted, resampled
from enfilade_training.shapes.model import build
from enfilade_training.shapes.train import parameters


def network(**changes: object) -> nn.Module:
    settings = shape_config.Network(backbone="resnet18", min_size=64, max_size=96, head_width=32, voxel_side=12, mesh_width=16, **changes)
    return build(settings, shape_config.Losses(), shape_config.Evaluate())


class DetectorTests(unittest.TestCase):
    def setUp(self) -> None:
        torch.set_num_threads(1)
        torch.manual_seed(0)

    def test_anchors_are_not_rounded_and_stand_apart_by_powers_of_two(self) -> None:
        generator = Anchors(((32,), (64,), (128,), (256,), (512,)), ((0.5, 1.0, 2.0),) * 5)
        # The coarsest level of 800 pixels has 13 places, which would be 61 pixels apart if they were spread.
        images = ImageList(torch.zeros(1, 3, 800, 1088), [(800, 1066)])
        maps = [torch.zeros(1, 256, -(-800 // stride), -(-1088 // stride)) for stride in (4, 8, 16, 32, 64)]
        (found,) = generator(images, maps)
        self.assertEqual(len(found), 3 * sum(map_[0, 0].numel() for map_ in maps))
        wide, high = 32 * 2**0.5, 32 / 2**0.5
        torch.testing.assert_close(found[0], torch.tensor([-wide, -high, wide, high]) / 2)
        torch.testing.assert_close(found[-2], torch.tensor([16 * 64 - 256.0, 12 * 64 - 256, 16 * 64 + 256, 12 * 64 + 256]))

    def test_sizes_are_rounded_as_by_detectron2(self) -> None:
        cases = {(480, 640): (800, 1067), (1200, 600): (1333, 667), (800, 1333): (800, 1333), (3, 1): (1333, 444)}
        for (height, width), expected in cases.items():
            self.assertEqual(output_size(height, width, 800, 1333), expected)

    def test_images_are_resized_as_by_pillow(self) -> None:
        plane = np.random.default_rng(0).integers(0, 256, (90, 120), dtype=np.uint8)
        for size in ((40, 53), (180, 240), (90, 120)):
            expected = np.asarray(Image.fromarray(plane).resize((size[1], size[0]), Image.Resampling.BILINEAR)).astype(int)
            found = resampled(torch.from_numpy(plane)[None], size)[0].numpy().astype(int)
            self.assertLessEqual(np.abs(found - expected).max(), 1)
            self.assertGreater((found == expected).mean(), 0.99)

    def test_boxes_masks_and_images_are_resized_alike_and_boxes_end_with_the_image(self) -> None:
        transform = network().transform
        target = {"boxes": torch.tensor([[4.0, -3.0, 20.0, 33.0]]), "masks": torch.ones(1, 32, 64, dtype=torch.uint8)}
        images, (found,) = transform([torch.rand(3, 32, 64)], [target])
        self.assertEqual((images.image_sizes, images.tensors.shape), ([(48, 96)], (1, 3, 64, 96)))
        self.assertEqual(found["boxes"].tolist(), [[6.0, 0.0, 30.0, 48.0]])
        self.assertEqual((found["masks"].shape, found["masks"].unique().tolist()), ((1, 48, 96), [255]))
        self.assertEqual(float(images.tensors[0, :, 48:].abs().max()), 0.0)
        self.assertEqual(target["boxes"].tolist(), [[4.0, -3.0, 20.0, 33.0]])

    def test_targets_of_masks_are_where_the_mask_touches(self) -> None:
        masks = torch.zeros(2, 20, 30, dtype=torch.uint8)
        masks[1, :, 10:] = 255
        boxes = torch.tensor([[4.9, 2.0, 16.2, 10.7], [29.5, 19.2, 30.0, 20.0]])
        found = mask_targets(masks, boxes, torch.tensor([1, 1]), 4)
        # Columns 4 to 15 in four parts of three; the middles of parts two and three are at columns 8 and 11 of the image.
        self.assertEqual(found[0].tolist(), [[0.0, 0.0, 1.0, 1.0]] * 4)
        self.assertEqual(found[1].tolist(), [[1.0] * 4] * 4)
        logits = torch.zeros(2, 3, 4, 4)
        logits[:, 2] = 10.0
        loss = mask_loss(logits, [boxes], [torch.tensor([1, 1])], torch.tensor([2, 2]), [masks])
        self.assertAlmostEqual(float(loss), 10 * 8 / 32, places=3)

    def test_masks_of_detections_cover_the_pixels_whose_middles_are_in_the_box(self) -> None:
        box = torch.tensor([[3.4, 2.6, 7.2, 5.4], [-0.1, 0.0, 30.0, 20.0]])
        found = pasted(torch.ones(2, 1, 28, 28), box, (20, 30)) >= 0.5
        self.assertEqual(found[0, 0].nonzero().amin(0).tolist() + found[0, 0].nonzero().amax(0).tolist(), [3, 3, 4, 6])
        self.assertTrue(bool(found[1].all()))

    def test_losses_of_proposals_are_divided_by_the_anchors_that_are_asked_for(self) -> None:
        rpn = network().rpn
        # Two anchors count, of 256 that are asked for; all others are ignored.
        labels = torch.full((400,), -1.0)
        labels[0], labels[1] = 1.0, 0.0
        deltas, targets = torch.zeros(400, 4), torch.zeros(400, 4)
        targets[0, 0] = 2.0
        there, boxes = rpn.compute_loss(torch.zeros(400, 1), deltas, [labels], [targets])
        self.assertAlmostEqual(float(there), 2 * 0.693147 / 256, places=6)
        self.assertAlmostEqual(float(boxes), (2.0 - 0.111 / 2) / 256, places=6)

    def test_new_heads_begin_with_detectron2s_random_weights(self) -> None:
        heads = network().roi_heads
        for layer, spread in ((heads.box_predictor.cls_score, 0.01), (heads.box_predictor.bbox_pred, 0.001), (heads.mask_predictor.mask_fcn_logits, 0.001)):
            self.assertAlmostEqual(float(layer.weight.detach().std()) / spread, 1.0, delta=0.1)
            self.assertEqual(float(layer.bias.detach().abs().max()), 0.0)
        # Uniform with the variance of 1 by the number of inputs.
        self.assertAlmostEqual(float(heads.box_head.fc6.weight.detach().std()) * 12544**0.5, 1.0, delta=0.02)
        self.assertEqual(float(heads.mask_predictor.conv5_mask.bias.detach().abs().max()), 0.0)

    def test_scales_of_batch_normalisation_do_not_decay(self) -> None:
        made = network()
        groups = parameters(made, 1e-4)
        self.assertEqual([group["weight_decay"] for group in groups], [1e-4, 0.0])
        self.assertEqual(len(groups[1]["params"]), 2 * sum(isinstance(layer, nn.BatchNorm2d) for layer in made.modules()))
        self.assertEqual(sum(len(group["params"]) for group in groups), sum(p.requires_grad for p in made.parameters()))

    def test_boxes_far_from_everything_are_neither_object_nor_background(self) -> None:
        quality = torch.tensor([[0.1, 0.3, 0.55, 0.8], [0.15, 0.2, 0.1, 0.0]])
        matcher = IgnoringMatcher(0.7, 0.5, 0.2, allow_low_quality_matches=False)
        ignored, background = matcher.BETWEEN_THRESHOLDS, matcher.BELOW_LOW_THRESHOLD
        self.assertEqual(matcher(quality).tolist(), [ignored, background, ignored, 0])
        # The best box of each object is kept, however little it overlaps: box 1 is the second object's, and more of the first's.
        matcher = IgnoringMatcher(0.7, 0.5, 0.2, allow_low_quality_matches=True)
        self.assertEqual(matcher(quality).tolist(), [ignored, 0, ignored, 0])
