"""The published numbers of Mesh R-CNN, written out here, against the files of settings; nothing but their reader is needed.

They stand in `meshrcnn_R50_FPN.yaml` and `MESH-RCNN-FPN.yaml` below `configs/pix3d` of facebookresearch/meshrcnn, and, where those say
nothing, in its `meshrcnn/config/config.py` (two layers of 1024, 5000 points) and Detectron2's defaults (800 to 1333 pixels, momentum 0.9).
"""

import unittest
from pathlib import Path

from enfilade_training.common import config as settings
from enfilade_training.shapes.config import Config

CONFIGS = Path(__file__).resolve().parents[2] / "configs"
NETWORK = {
    "backbone": "resnet50",
    "anchors": (32, 64, 128, 256, 512),
    "regions": 64,
    "head_width": 1024,
    "voxel_side": 24,
    "cubify_threshold": 0.2,
    "mesh_stages": 3,
    "mesh_convolutions": 3,
    "mesh_width": 128,
    "min_size": 800,
    "max_size": 1333,
}
LOSSES = {"depth": 1.0, "voxel": 3.0, "chamfer": 1.0, "normals": 0.1, "edge": 1.0, "samples": 5000, "coordinate_limit": 5.0}
TRAIN = {
    "iterations": 11000,
    "batch": 16,
    "warmup_iterations": 1000,
    "warmup_factor": 0.1,
    "milestones": (8000, 10000),
    "momentum": 0.9,
    "weight_decay": 0.0001,
}
# Mesh R-CNN's own base rate on Pix3D, and Roberts et al.'s in pre-training.
RATES = {"shapes-pix3d-scratch.toml": 0.02, "shapes-pix3d-finetune.toml": 0.02, "shapes-pretrain-enfilade.toml": 0.005}


class Recipe(unittest.TestCase):
    def test_the_numbers_of_mesh_r_cnns_published_configuration(self) -> None:
        for name, rate in RATES.items():
            config = settings.read(Config, CONFIGS / name)
            parts = [(config.network, NETWORK), (config.losses, LOSSES), (config.train, TRAIN | {"learning_rate": rate})]
            for part, published in parts:
                for key, value in published.items():
                    self.assertEqual(getattr(part, key), value, f"{name}: {key}")


if __name__ == "__main__":
    unittest.main()
