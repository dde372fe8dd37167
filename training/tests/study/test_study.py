import contextlib
import io
import json
import os
import shutil
import tempfile
import unittest
from pathlib import Path
from unittest import mock
from xml.etree import ElementTree

import torch
from PIL import Image

from enfilade_training.study import dial
from enfilade_training.study.__main__ import main
from enfilade_training.study.curves import Panel, svg
from enfilade_training.study.runs import all_runs
from tests.study import nyu

HOMES = """
frames = 2
[render]
size = [160, 120]
samples = 1
[[scene]]
name = "a"
home = { seed = 1, rooms = ["toilet"], clutter = 0 }
cameras = ["toilet_1"]
"""


class Studies(unittest.TestCase):
    def setUp(self) -> None:
        torch.set_num_threads(1)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        nyu.write(self.folder / "nyu")
        (self.folder / "homes.toml").write_text(HOMES)

    def run_study(self, *arguments: str, status: int = 0) -> str:
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            self.assertEqual(main([*nyu.options(self.folder), *arguments]), status, said.getvalue())
        return said.getvalue()

    def report(self, folder: str = "out") -> dict:
        return json.loads((self.folder / folder / "nyuv2.json").read_text(encoding="utf-8"))

    def test_the_whole_study(self) -> None:
        self.run_study("--only", "seed=0", "--only", "fraction=0,1")
        part = self.report()
        self.assertEqual([(row["arm"], row["fraction"]) for row in part["runs"] if row["task"] == "depth"], [("homes", 0.0), ("random", 1.0), ("homes", 1.0)])
        self.assertEqual(len(part["missing"]), 2 + 5)
        first = self.folder / "out" / "pretraining"
        written = {path: path.stat().st_mtime_ns for path in first.rglob("last.pt")}
        said = self.run_study()
        self.assertNotIn("homes, 100 % of the photographs, seed 0", said)
        self.assertTrue(all(path.stat().st_mtime_ns == at for path, at in written.items()))
        self.check_report()
        self.check_that_earlier_scores_count()
        self.check_dial()

    def check_report(self) -> None:
        found = self.report()
        self.assertEqual(len(found["runs"]), 2 * len(all_runs(nyu.study(self.folder))))
        self.assertEqual(found["missing"], [])
        for row in found["runs"]:
            self.assertTrue(all(value == value and value >= 0 for value in row["scores"].values()), row)
            self.assertEqual("confusion" in row, row["task"] == "semantics")
        rows = {(row["start"], row["fraction"], row["task"], row["score"]): row for row in found["differences"]}
        self.assertEqual(len(rows), 2 * (2 + 6))
        row = rows["random", 0.5, "semantics", "mean_iou"]
        mean = {
            arm: sum(run["scores"]["mean_iou"] for run in found["runs"] if (run["arm"], run["fraction"], run["task"]) == (arm, 0.5, "semantics")) / 2
            for arm in ("homes", "random")
        }
        self.assertAlmostEqual(row["mean"], mean["homes"] - mean["random"], delta=2e-5)
        self.assertTrue(row["low"] <= row["high"])
        page = (self.folder / "out" / "nyuv2.md").read_text(encoding="utf-8")
        self.assertIn("| homes | 50 % | 2 |", page)
        self.assertNotIn("Not there", page)
        for name in ("nyuv2.json", "nyuv2.md", "nyuv2.svg"):
            self.assertNotIn(str(self.folder), (self.folder / "out" / name).read_text(encoding="utf-8"))
        ElementTree.parse(self.folder / "out" / "nyuv2.svg")
        with Image.open(self.folder / "out" / "nyuv2.png") as drawn:
            # The truth and two arms, of four photographs.
            self.assertEqual(drawn.size, (4 + 3 * 154, 20 + 4 * (115 + 4) + 44))

    def check_that_earlier_scores_count(self) -> None:
        earlier = self.folder / "earlier.json"
        earlier.write_text((self.folder / "out" / "nyuv2.json").read_text(encoding="utf-8"), encoding="utf-8")
        other = ("--set", f"output={self.folder / 'other'}", "--scores", str(earlier))
        said = self.run_study(*other)
        self.assertNotIn("seed", said)
        for name in ("nyuv2.json", "nyuv2.md", "nyuv2.svg"):
            self.assertEqual((self.folder / "other" / name).read_bytes(), (self.folder / "out" / name).read_bytes(), name)
        # A bootstrap anew asks for what each photograph scored.
        anew = (*other, "--set", "resamples=60")
        self.run_study(*anew)
        self.assertEqual((len(self.report("other")["differences"]), len(self.report("other")["without_interval"])), (0, 4))
        packed = earlier.with_suffix(".npz")
        shutil.copy(self.folder / "out" / "nyuv2.npz", packed)
        self.run_study(*anew)
        found = self.report("other")
        means = {(row["fraction"], row["score"]): row["mean"] for row in self.report()["differences"]}
        self.assertEqual(len(found["differences"]), len(means))
        for row in found["differences"]:
            self.assertAlmostEqual(row["mean"], means[row["fraction"], row["score"]], delta=2e-5)
        packed.write_bytes(packed.read_bytes()[:100])
        self.assertIn("earlier.npz: is no file of photographs' scores", self.run_study(*anew, status=2))
        packed.unlink()
        # Other settings are other runs; homes change those alone that have seen them.
        (self.folder / "homes.toml").write_text(HOMES.replace("seed = 1", "seed = 2"))
        self.run_study(*other, "--only", "arm=random")
        found = self.report("other")
        self.assertEqual({row["arm"] for row in found["runs"]}, {"random"})
        self.run_study(*other, "--only", "arm=random", "--only", "fraction=0.5", "--set", "finetuning.learning_rate=0.01")
        self.assertEqual({row["fraction"] for row in self.report("other")["runs"]}, {0.5})

    def check_dial(self) -> None:
        said = io.StringIO()
        (self.folder / "homes.toml").write_text(HOMES)
        with contextlib.redirect_stdout(said):
            arguments = ["--to", str(self.folder / "dial.json"), "--pictures", str(self.folder / "seen"), "--count", "2", "--set", "composed=true"]
            self.assertEqual(dial.main([*nyu.options(self.folder), *arguments]), 0)
        self.assertIn("| wall |", said.getvalue())
        self.assertIn("of 2 frames, drawn as photographs are composed; they are worth", said.getvalue())
        found = json.loads((self.folder / "dial.json").read_text(encoding="utf-8"))
        # It is of the six photographs to learn from.
        self.assertLess(sum(map(sum, found["tasks"]["semantics"]["confusion"])), 6 * 214 * 280)
        self.assertGreater(sum(map(sum, found["tasks"]["semantics"]["confusion"])), 5 * 214 * 280)
        self.assertAlmostEqual(sum(found["tasks"]["semantics"]["share_in_homes"]), 1.0, places=3)
        self.assertEqual(len(list((self.folder / "seen").glob("*.png"))), 2)
        self.assertEqual(found["gap"]["photographs"]["depth"], found["tasks"]["depth"]["scores"])
        self.assertIn("| photographs, by both |", said.getvalue())

    def test_what_cannot_be_done_is_said(self) -> None:
        for arguments, said in [
            (["--only", "arm=imagenet"], "the study has no arm imagenet, but homes, random"),
            (["--only", "size=3"], "expected arm=, fraction= or seed="),
            (["--scores", str(self.folder / "none.json")], "none.json: cannot be read"),
            (["--scores", str(self.folder / "homes.toml")], "homes.toml: is no report of this study"),
            (["--set", "size=[100, 160]"], "expected a multiple of [120, 160]"),
            (["--set", "fractions=[2.0]"], "expected shares above 0"),
            (["--set", "finetuning.steps=0"], "steps is 0"),
        ]:
            self.assertIn(said, self.run_study(*arguments, status=2))

    def test_without_photographs_the_study_says_what_is_missing(self) -> None:
        with mock.patch.dict(os.environ):
            os.environ.pop("ENFILADE_REAL", None)
            said = self.run_study("--set", "photographs=$ENFILADE_REAL", status=2)
        self.assertIn("the variable ENFILADE_REAL is not set; set it to the folder of NYUv2's labelled photographs", said)


class Curves(unittest.TestCase):
    def test_panels_show_means_and_bands(self) -> None:
        drawn = ElementTree.fromstring(svg([Panel("a < b", "steps", {"arm": {0.0: [2.0, 1.0], 10.0: [1.0, 0.5]}})]))
        paths = [path.attrib["d"] for path in drawn.iter("{http://www.w3.org/2000/svg}path") if path.attrib.get("fill") == "none"]
        heights = [float(point.split()[1]) for point in paths[0][1:].split("L")]
        # Means of 1.5 and 0.75 below a top of 2, 180 pixels high and 44 from above.
        self.assertEqual(heights, [44 + 180 * 0.25, 44 + 180 * 0.625])


if __name__ == "__main__":
    unittest.main()
