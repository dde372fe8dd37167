"""The verbs are those of the command line, and the types that are announced are those that are there."""

import ast
import os
import signal
import threading
import unittest
from pathlib import Path

import enfilade

import datasets


class Verbs(unittest.TestCase):
    def test_a_finished_run_does_nothing(self):
        summary = enfilade.run(datasets.made(), datasets.small_config())
        self.assertEqual([scene["scene"] for scene in summary["scenes"]], ["home"])
        self.assertTrue(all(stage["up_to_date"] for scene in summary["scenes"] for stage in scene["stages"]))
        again = enfilade.stage("label", datasets.made(), force=True)
        self.assertFalse(again["scenes"][0]["stages"][0]["up_to_date"])

    def test_the_laws_hold(self):
        report = enfilade.verify(datasets.made())
        self.assertTrue(report["passed"], [law for law in report["laws"] if not law["holds"]])
        self.assertEqual(report["frames"], 3)

    def test_a_configuration_is_plain_data(self):
        config = datasets.small_config()
        settings = config.to_dict()
        self.assertEqual(enfilade.Config.from_dict(settings).to_dict(), settings)
        self.assertEqual(settings["scenes"][0]["size"], list(datasets.SIZE))
        with self.assertRaisesRegex(ValueError, "nowhere.toml"):
            enfilade.Config.read("nowhere.toml")
        with self.assertRaisesRegex(ValueError, "quality"):
            enfilade.Config.demo(quality="best")

    def test_a_scene_that_fails_is_an_exception_with_the_summary(self):
        settings = datasets.small_config().to_dict()
        settings["scenes"][0]["source"] = {"file": {"file": "gone.glb", "meters_per_unit": 1.0, "up_axis": None, "environment": None, "allow_missing_textures": False}}
        with self.assertRaisesRegex(enfilade.StageError, "gone.glb") as caught:
            enfilade.run(datasets.folder() / "failed", enfilade.Config.from_dict(settings))
        self.assertEqual(caught.exception.summary["scenes"][0]["stages"], [])

    @unittest.skipIf(os.name == "nt", "Windows has no signal that a process can send to itself so")
    def test_a_run_can_be_interrupted_and_goes_on(self):
        out = datasets.folder() / "interrupted"
        timer = threading.Timer(1.0, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            enfilade.run(out, enfilade.Config.demo(frames=3, size=(64, 48), samples=4096))
        summary = enfilade.run(out, enfilade.Config.demo(frames=1, size=(64, 48), samples=1))
        self.assertEqual(len(enfilade.Dataset(out, layers="color")), 1, summary)

    def test_the_split_covers_the_dataset(self):
        report = enfilade.split(datasets.made(), seed=1, shares=(1, 0, 0))
        self.assertEqual(report["images"]["train"], 3)
        self.assertEqual(len(enfilade.Dataset(datasets.made(), layers="color", split="train")), 3)

    def test_stages_that_do_not_exist(self):
        with self.assertRaisesRegex(ValueError, "render"):
            enfilade.stage("rendr", datasets.made())


class Announced(unittest.TestCase):
    def test_stubs_name_everything_and_nothing_else(self):
        text = Path(enfilade.__file__).with_name("__init__.pyi").read_text()
        body = ast.parse(text).body
        stubs = {node.name: node for node in body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        values = {node.target.id for node in body if isinstance(node, ast.AnnAssign)}
        self.assertEqual(set(enfilade.__all__), (set(stubs) - {"Layer"}) | values)
        for name in ("Dataset", "Loader", "LoaderIterator", "Config"):
            announced = {node.name for node in stubs[name].body if isinstance(node, ast.FunctionDef)}
            there = {key for key in vars(getattr(enfilade, name)) if not key.startswith("__")}
            self.assertEqual({key for key in announced if not key.startswith("__")}, there, name)

    def test_everything_has_a_doc_string(self):
        for name in enfilade.__all__:
            value = getattr(enfilade, name)
            self.assertTrue(value.__doc__, name)

    def test_layers_are_described(self):
        self.assertEqual(enfilade.LAYERS["depth_meters"]["unit"], "m")
        self.assertEqual(enfilade.LAYERS["color"]["dtype"], "float16")


if __name__ == "__main__":
    unittest.main()
