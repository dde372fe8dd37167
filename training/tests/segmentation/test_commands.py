import contextlib
import io
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
import torch
from PIL import Image

from enfilade_training.common import config as settings
from enfilade_training.segmentation.__main__ import main
from enfilade_training.segmentation.config import Config
from tests import nyu_file
from tests.ranks import ROOT
from tests.segmentation.homes import rendered
from tests.segmentation.images import write_pairs

CONFIGS = sorted((ROOT / "configs").glob("segmentation-*.toml"))
# What makes the paper's experiment one of seconds.
SMALL = [
    "train.epochs=2", "train.batch_size=4", "train.workers=0", "train.log_steps=1", "train.warmup_epochs=1", "evaluation.every_epochs=1",
    "network.width=8", "network.blocks=[1, 1, 1, 1]", "augment.size=[32, 32]", "device=cpu",
]  # fmt: skip


def call(*arguments: object) -> tuple[int, str, str]:
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = main([str(argument) for argument in arguments])
    return status, out.getvalue(), err.getvalue()


def options(*overrides: str) -> list[str]:
    return [part for override in overrides for part in ("--set", override)]


class Commands(unittest.TestCase):
    def setUp(self) -> None:
        torch.set_num_threads(1)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_all_settings_files_are_the_papers_recipe(self) -> None:
        self.assertGreaterEqual(len(CONFIGS), 5)
        for path in CONFIGS:
            found = settings.read(Config, path)
            train, augment = found.train, found.augment
            self.assertEqual((train.epochs, train.batch_size, train.learning_rate, train.warmup_epochs), (100, 64, 0.01, 3.0), path)
            self.assertEqual((augment.size, augment.scale, augment.ratio, augment.flip), ((512, 512), (0.08, 1.0), (0.75, 1.33), 0.5))
            self.assertEqual((augment.hue, augment.saturation, augment.brightness, augment.jitter), (0.375, (0.25, 1.75), (0.25, 1.75), 0.5))
            self.assertEqual((found.network.width, found.network.blocks, found.classes), (64, (3, 4, 6, 3), 13))

    def test_the_full_experiment_runs_on_tiny_data_in_the_same_layouts(self) -> None:
        random, nyu = np.random.default_rng(0), self.folder / "nyu_depth_v2_labeled.mat"
        nyu_file.write(nyu, random.integers(0, 256, (12, 40, 48, 3), dtype=np.uint8), random.integers(0, 895, (12, 40, 48)))
        before, after = self.folder / "pre-training", self.folder / "fine-tuning"
        home = options(*SMALL, f"output={before}", f"train_data.path={rendered()}", f"test_data.path={rendered()}")
        for side in ("train", "test"):
            # A home of one scene has no split; all of its frames are taken.
            home += options(f"{side}_data.scenes=['home']")
        pretraining = self.folder / "pretrain.toml"
        pretraining.write_text((ROOT / "configs" / "segmentation-pretrain-enfilade.toml").read_text().replace('split = "train"', "").replace('split = "val"', ""))
        status, out, err = call("train", pretraining, *home)
        self.assertEqual((status, err), (0, ""))
        self.assertIn("mean IoU", out)
        real = options(*SMALL, f"output={after}", f"train_data.path={nyu}", f"test_data.path={nyu}", "train_data.partial=true", "test_data.partial=true")
        tuning = [ROOT / "configs" / "segmentation-nyuv2-finetune.toml", *real, *options(f"train.init_from={before / 'last.pt'}")]
        status, out, err = call("train", *tuning)
        self.assertEqual((status, err), (0, ""))
        self.assertIn(f"weights of {before / 'last.pt'}", out)
        status, out, _ = call("evaluate", *tuning)
        scores = json.loads((after / "evaluation.json").read_text())
        self.assertEqual((status, len(scores["iou"])), (0, 13))
        self.assertIn(f"{100 * scores['mean_iou']:6.2f}  mean IoU", out)
        status, out, _ = call("predict", *tuning, "--to", self.folder / "pictures")
        written = sorted(path.name for path in (self.folder / "pictures").iterdir())
        self.assertEqual((status, written[:2], len(written)), (0, ["nyuv2.0001.classes.png", "nyuv2.0001.color.png"], 6))
        classes = np.array(Image.open(self.folder / "pictures" / written[0]))
        self.assertTrue(classes.shape == (40, 48) and classes.min() >= 1 and classes.max() <= 13)

    def test_pictures_of_ones_own_are_predicted(self) -> None:
        write_pairs(self.folder, 4)
        path = self.folder / "run.toml"
        path.write_text(f'output = "{self.folder / "out"}"\nclasses = 4\n[train_data]\nkind = "pairs"\npath = "{self.folder}"\n')
        self.assertEqual(call("train", path, *options(*SMALL))[0], 0)
        picture = self.folder / "images" / "001.png"
        status, out, _ = call("predict", path, *options(*SMALL), "--to", self.folder / "seen", "--images", picture)
        self.assertEqual((status, len(out.splitlines())), (0, 2))
        self.assertEqual(np.array(Image.open(self.folder / "seen" / "001.color.png")).shape, (40, 48, 3))
        status, _, err = call("evaluate", path, *options(*SMALL))
        self.assertEqual((status, "no [test_data]" in err), (2, True))

    def test_pictures_of_one_name_are_refused_before_any_work(self) -> None:
        path = self.folder / "run.toml"
        path.write_text(f'output = "{self.folder / "out"}"\nclasses = 4\n[train_data]\nkind = "pairs"\npath = "{self.folder}"\n')
        pictures = [self.folder / "a" / "room.jpg", self.folder / "b" / "room.png"]
        status, _, err = call("predict", path, "--set", "device=cpu", "--to", self.folder / "seen", "--images", *pictures)
        self.assertEqual(status, 2)
        for part in (*map(str, pictures), "room.classes.png"):
            self.assertIn(part, err)
        self.assertFalse((self.folder / "seen").exists())

    def test_torchrun_starts_replicas(self) -> None:
        write_pairs(self.folder, 4)
        path = self.folder / "run.toml"
        path.write_text(f'output = "{self.folder / "out"}"\nclasses = 4\n[train_data]\nkind = "pairs"\npath = "{self.folder}"\n')
        command = [sys.executable, "-m", "torch.distributed.run", "--standalone", "--nproc_per_node=2", "-m", "enfilade_training.segmentation"]
        environment = os.environ | {"OMP_NUM_THREADS": "1", "PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])}
        done = subprocess.run([*command, "train", path, *options(*SMALL)], env=environment, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.count("epoch 2 of 2"), 1, done.stdout)

    def test_mistakes_are_one_line_that_says_what_to_do(self) -> None:
        write_pairs(self.folder, 4)
        path, pairs = self.folder / "run.toml", f'[train_data]\nkind = "pairs"\npath = "{self.folder}"\n'
        cases = [
            (f'output = "x"\nepochs = 3\n{pairs}', [], "unknown key 'epochs'"),
            (f'output = "x"\n{pairs}[train]\nepoch = 3\n', [], "[train] has the unknown key 'epoch'; did you mean 'epochs'?"),
            (f'output = "x"\n{pairs}', ["augment.scale=[0.5, 2]"], "[augment]: scale is [0.5, 2.0], expected shares"),
            (f'output = "x"\n{pairs}', ["train_data.path=nowhere"], "nowhere/images: there is no such folder"),
            ('output = "x"\n[train_data]\nkind = "nyuv2"\npath = "nowhere.mat"\n', [], "nowhere.mat"),
            ('output = "x"\n[train_data]\nkind = "enfilade"\npath = "nowhere"\n', [], "nowhere"),
            (f'output = "x"\n{pairs}', ["train.init_from=nowhere.pt", "train.batch_size=4"], "nowhere.pt: there is no such checkpoint"),
            ('[train_data]\nkind = "coco"\npath = "x"\n', ["output=x"], "expected one of 'enfilade', 'nyuv2', 'pairs'"),
        ]
        for text, overrides, said in cases:
            path.write_text(text)
            status, _, err = call("train", path, *options(*overrides))
            self.assertEqual((status, err.count("\n")), (2, 1), err)
            self.assertTrue(err.startswith("error: ") and said in err, err)
        self.assertFalse(Path("x").exists())


if __name__ == "__main__":
    unittest.main()
