import tempfile
import unittest
from pathlib import Path

import torch

from enfilade_training.common import logs
from enfilade_training.common.distributed import Replica
from enfilade_training.segmentation.config import Augment, Config, Data, Evaluation, Network, Train
from enfilade_training.segmentation.train import train
from tests.segmentation.homes import rendered


class Overfitting(unittest.TestCase):
    def test_eight_rendered_images_are_learnt_beyond_95_per_cent_mean_iou(self) -> None:
        torch.set_num_threads(1)
        data = Data("enfilade", rendered())
        with tempfile.TemporaryDirectory() as folder:
            settings = Config(
                output=Path(folder),
                train_data=data,
                test_data=data,
                classes=13,
                network=Network(width=24, blocks=(1, 1, 1, 1)),
                augment=Augment(size=(96, 96), scale=(1.0, 1.0), ratio=(1.0, 1.0), flip=0.0, jitter=0.0),
                train=Train(epochs=320, batch_size=2, learning_rate=0.1, weight_decay=0.0, workers=0, log_steps=20),
                evaluation=Evaluation(every_epochs=0, batch_size=8, pictures=0),
            )
            scores = train(settings, Replica(0, 1, torch.device("cpu")))
            losses = [line["loss"] for line in logs.read(Path(folder) / "metrics.jsonl") if line["kind"] == "train"]
        occurring = {name: value for name, value in scores["iou"].items() if value is not None}
        self.assertGreaterEqual(len(occurring), 7)
        self.assertGreater(scores["mean_iou"], 0.95, occurring)
        self.assertGreater(scores["pixel_accuracy"], 0.98)
        self.assertLess(losses[-1], 0.05 * losses[0])


if __name__ == "__main__":
    unittest.main()
