import contextlib
import io
import json
import tempfile
import unittest
from pathlib import Path
from xml.etree import ElementTree

import enfilade
import numpy as np
import torch

from enfilade_training.common import checkpoints
from enfilade_training.common import config as settings
from enfilade_training.study import report
from enfilade_training.study.__main__ import Study, main, runs
from enfilade_training.study.curves import Curve, svg
from enfilade_training.study.report import ALONE, LONGER, PRETRAINED, SCRATCH, Found, Row
from tests.ranks import ROOT

STUDY = ROOT / "studies" / "transfer.toml"
# What makes an afternoon's study one of seconds.
SMALL = [
    "seeds=2", "folds=[['a'], ['b']]", "network.width=8", "augment.size=[32, 32]", "evaluation.every_epochs=1",
    *(f"{run}.{key}" for run in ("pretraining", "finetuning") for key in ("epochs=2", "batch_size=2", "warmup_epochs=1")),
]  # fmt: skip


def homes(file: Path, seeds: dict[str, int]) -> Path:
    scenes = [f'[[scene]]\nname = "{name}"\nhome = {{ seed = {seed}, rooms = ["toilet"], clutter = 0 }}\ncameras = ["toilet_1"]\n' for name, seed in seeds.items()]
    file.write_text("frames = 3\n[render]\nsize = [32, 32]\nsamples = 1\n" + "\n".join(scenes))
    return file


def right(share: float) -> enfilade.Confusion:
    """Of 100 pixels of two classes, half of each, so many are right."""
    truth = np.repeat([0, 1], 50)
    wrong = np.arange(100) % 50 >= round(50 * share)
    confusion = enfilade.Confusion(2)
    confusion.add(np.where(wrong, 1 - truth, truth).reshape(10, 10), truth.reshape(10, 10))
    return confusion


class Statistics(unittest.TestCase):
    def test_the_interval_is_students(self) -> None:
        found = report.difference([(1.0, 0.0), (3.0, 0.0), (5.0, 0.0)])
        # Mean 3, standard deviation 2, two degrees of freedom.
        self.assertAlmostEqual(found.mean, 3.0)
        self.assertAlmostEqual(found.high - found.mean, 4.303 * 2 / 3**0.5)
        self.assertEqual(found.verdict, "no difference")
        self.assertEqual(report.difference([(1.1, 0.1), (1.3, 0.2), (1.2, 0.2)]).verdict, "higher")
        self.assertEqual(report.difference([(0.1, 1.1), (0.2, 1.3), (0.2, 1.2)]).verdict, "lower")

    def test_intervals_go_on_beyond_the_table(self) -> None:
        for degrees, quantile in ((15, 2.1314), (16, 2.1199), (20, 2.0860), (30, 2.0423), (100, 1.9840)):
            self.assertAlmostEqual(report.student(degrees), quantile, delta=6e-4 if degrees == 15 else 6e-5)
        # 20 differences of 1, as many of 3: mean 2, standard deviation sqrt(40 / 39).
        found = report.difference([(1.0, 0.0)] * 20 + [(3.0, 0.0)] * 20)
        self.assertAlmostEqual(found.high - found.mean, 2.0227 * (40 / 39) ** 0.5 / 40**0.5, places=4)

    def test_what_seeds_share_drops_out(self) -> None:
        shares = {0: 0.5, 1: 0.8}
        rows = [Row(arm, seed, room, 4, right(share + gain)) for seed, share in shares.items() for arm, gain in ((SCRATCH, 0.0), (PRETRAINED, 0.1)) for room in "ab"]
        found = Found({}, rows, [])
        value = report.over_seeds(found, "pixel_accuracy", PRETRAINED, SCRATCH)
        self.assertAlmostEqual(value.mean, 0.1)
        self.assertAlmostEqual(value.low, 0.1)

    def test_scores_are_of_all_rooms_pixels_together(self) -> None:
        rows = [Row(SCRATCH, 0, "a", 4, right(1.0)), Row(SCRATCH, 0, "b", 4, right(0.5))]
        found = Found({}, rows, [])
        self.assertAlmostEqual(found.score("pixel_accuracy", SCRATCH, [0], ["a", "b"]), 0.75)
        # 75 of 125 pixels that are, or are taken for, a class.
        self.assertAlmostEqual(found.score("mean_iou", SCRATCH, [0], ["a", "b"]), 0.6)
        with self.assertRaisesRegex(ValueError, "c: no pixel has a class"):
            found.score("mean_iou", SCRATCH, [0], ["c"])


class Curves(unittest.TestCase):
    def test_panels_show_means_and_bands_where_all_runs_have_a_value(self) -> None:
        def lines(losses: list[float]) -> list[dict]:
            return [{"kind": "epoch", "step": 10 * (i + 1), "epoch": i, "loss": loss} for i, loss in enumerate(losses)]

        drawn = ElementTree.fromstring(svg([Curve(SCRATCH, 0, 0, lines([2.0, 1.0])), Curve(SCRATCH, 1, 0, lines([1.0, 0.5, 0.1]))]))
        paths = [path.attrib["d"] for path in drawn.iter("{http://www.w3.org/2000/svg}path") if path.attrib.get("fill") == "none"]
        self.assertEqual(len(paths), 1)
        heights = [float(point.split()[1]) for point in paths[0][1:].split("L")]
        # Means of 1.5 and 0.75 below a top of 2, 200 pixels high and 44 from above; the third epoch has one run alone.
        self.assertEqual(heights, [44 + 200 * 0.25, 44 + 200 * 0.625])


class Studies(unittest.TestCase):
    def setUp(self) -> None:
        torch.set_num_threads(1)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def options(self, *more: str) -> list[str]:
        found = [str(STUDY)]
        for override in (*SMALL, f"output={self.folder / 'out'}", f"homes={self.folder / 'homes.toml'}", f"rooms={self.folder / 'rooms.toml'}", *more):
            found += ["--set", override]
        return found

    def test_the_study_runs_on_tiny_data_and_goes_on_where_it_was(self) -> None:
        homes(self.folder / "homes.toml", {"home": 1})
        homes(self.folder / "rooms.toml", {"a": 1, "b": 2})
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            self.assertEqual(main(self.options()), 0)
        texts = {name: (self.folder / "out" / name).read_bytes() for name in ("training.md", "training.json", "training.svg")}
        self.assertIn("seed 1, pre-trained, fold 2 of 2", said.getvalue())
        found = json.loads(texts["training.json"])
        self.assertEqual([(row["arm"], row["seed"]) for row in found["rows"]], [(arm, seed) for arm in (ALONE, SCRATCH, PRETRAINED, LONGER) for seed in (0, 1)])
        self.assertEqual([row["steps_of_folds"] for row in found["rows"]], [[2], [2], [2], [2], [2], [2], [4], [4]])
        self.assertTrue(all(0 <= row["mean_iou"] <= 1 and set(row["mean_iou_of_rooms"]) == {"a", "b"} for row in found["rows"]))
        self.assertNotIn(str(self.folder), "".join(map(str, texts.values())))
        # What is ready is taken as it is; a run that is lost is made again, and is the same.
        (self.folder / "out" / "seed_1" / "pre-trained.1" / "last.pt").unlink()
        kept = (self.folder / "out" / "seed_0" / "homes" / "last.pt").stat().st_mtime_ns
        with contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(main(self.options()), 0)
        self.assertEqual((self.folder / "out" / "seed_0" / "homes" / "last.pt").stat().st_mtime_ns, kept)
        for name, text in texts.items():
            self.assertEqual((self.folder / "out" / name).read_bytes(), text, name)
        self.assert_arms_differ_in_what_they_begin_with_alone()

    def assert_arms_differ_in_what_they_begin_with_alone(self) -> None:
        arguments = self.options()
        study = settings.read(Study, arguments[0], arguments[2::2])
        made = {(arm, fold): config for arm, fold, config in runs(study, 1)}
        self.assertEqual(len(made), 1 + 3 * 2)
        for fold, held_out in enumerate("ab"):
            scratch, tuned, longer = (made[arm, fold] for arm in (SCRATCH, PRETRAINED, LONGER))
            self.assertEqual((scratch.train_data.scenes, scratch.test_data.scenes), (("b" if held_out == "a" else "a",), (held_out,)))
            self.assertEqual(settings.differences(settings.to_dict(scratch), settings.to_dict(tuned)), ["output", "train.init_from"])
            self.assertEqual(settings.differences(settings.to_dict(scratch), settings.to_dict(longer)), ["output", "train.epochs"])
            begun = made[ALONE, None].output / "last.pt"
            self.assertEqual(tuned.train.init_from, begun)
            self.assertTrue(checkpoints.load(begun)["steps"])

    def test_settings_that_are_no_study_are_refused(self) -> None:
        for override, said in [("seeds=1", "seeds is 1"), ("folds=[['a']]", "folds is"), ("folds=[['a'], ['a']]", "each room in one"), ("finetuning.init_from=x", "init_from")]:
            err = io.StringIO()
            with contextlib.redirect_stderr(err):
                self.assertEqual(main(self.options(override)), 2)
            self.assertIn(said, err.getvalue())


if __name__ == "__main__":
    unittest.main()
