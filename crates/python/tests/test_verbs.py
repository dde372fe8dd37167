"""The verbs are those of the command line, and the types that are announced are those that are there."""

import ast
import inspect
import os
import shutil
import signal
import threading
import time
import unittest
from pathlib import Path

import enfilade
import h5py
import numpy as np

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

    def test_a_report_that_cannot_be_stored_is_given_all_the_same(self):
        root = datasets.folder() / "unwritable"
        shutil.copytree(datasets.made(), root)
        (root / "verify.json").unlink(missing_ok=True)
        (root / "verify.json").mkdir()
        with self.assertWarnsRegex(UserWarning, "the report is not stored: .*verify.json"):
            report = enfilade.verify(root)
        self.assertEqual(report["frames"], 3)

    def test_products_are_made_kept_and_made_again(self):
        root = datasets.folder() / "products"
        shutil.copytree(datasets.made(), root)
        made = enfilade.make(root, ["tracks", "words"], points=8)
        self.assertEqual([(one["product"], one["made"]) for one in made], [("tracks", 1), ("words", 1)])
        self.assertEqual([one["made"] for one in enfilade.make(root, "tracks", points=8)], [0])
        next(root.glob("scenes/home/_detail/*/tracks.npz")).unlink()
        self.assertEqual([one["product"] for one in enfilade.make(root, stale=True)], ["tracks"])
        self.assertEqual(enfilade.make(root, stale=True), [])
        with self.assertRaisesRegex(ValueError, "there is no product \"depth\"; the products are: covisibility, pairs, "):
            enfilade.make(root, "depth")
        with self.assertRaisesRegex(ValueError, "nothing is asked for"):
            enfilade.make(root)

    def test_a_configuration_is_plain_data(self):
        config = datasets.small_config()
        settings = config.to_dict()
        self.assertEqual(enfilade.Config.from_dict(settings).to_dict(), settings)
        self.assertEqual(settings["scenes"][0]["size"], list(datasets.SIZE))
        with self.assertRaisesRegex(ValueError, "nowhere.toml"):
            enfilade.Config.read("nowhere.toml")
        with self.assertRaisesRegex(ValueError, "quality"):
            enfilade.Config.demo(quality="best")

    def test_a_configuration_that_cannot_be_is_refused(self):
        changes = [
            (lambda settings: settings.update(sampels=3), "unknown field `sampels`"),
            (lambda settings: settings["scenes"][0].update(sede=3), "unknown field `sede`"),
            (lambda settings: settings["scenes"].clear(), "has no scenes"),
            (lambda settings: settings["scenes"].extend(settings["scenes"]), "two scenes have the name \"home\""),
            (lambda settings: settings["scenes"][0].update(name="../x"), "\"../x\" cannot be the name of a scene; names become folders"),
            (lambda settings: settings["scenes"][0].update(size=[0, 5]), "scene \"home\": width and height .*found 0 x 5"),
        ]
        for change, said in changes:
            settings = datasets.small_config().to_dict()
            change(settings)
            with self.assertRaisesRegex(ValueError, said):
                enfilade.Config.from_dict(settings)

    def test_a_scene_that_fails_is_an_exception_with_the_summary(self):
        settings = datasets.small_config().to_dict()
        settings["scenes"][0]["source"] = {"file": {"file": "gone.glb", "meters_per_unit": 1.0}}
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

    @unittest.skipIf(os.name == "nt", "Windows has no signal that a process can send to itself so")
    def test_a_copy_can_be_interrupted(self):
        root, out, layer = datasets.folder() / "long", datasets.folder() / "cut-short", "render_entity_id"
        shutil.copytree(datasets.as_hypersim(), root)
        first = datasets.file_of(root, enfilade.Dataset(root, layers=layer)[0], layer)
        first.unlink()
        # Images of zeros are small in the file, and take long to copy.
        with h5py.File(first, "w") as file:
            file.create_dataset("dataset", data=np.zeros((2000, 2000), dtype=np.int16), compression="gzip")
        count = 3000
        for frame in range(3, count):
            os.link(first, first.with_name(f"frame.{frame:04}.{layer}.hdf5"))

        def interrupt():
            while not out.is_dir():
                time.sleep(0.01)
            os.kill(os.getpid(), signal.SIGINT)

        threading.Thread(target=interrupt, daemon=True).start()
        with self.assertRaises(KeyboardInterrupt):
            enfilade.repack(root, out, layers=layer)
        self.assertFalse(list(out.rglob(f"frame.*.{layer}.hdf5")))

    def test_the_partition_covers_the_dataset(self):
        report = enfilade.partition(datasets.made(), seed=1, shares=(1, 0, 0))
        self.assertEqual(report["images"]["train"], 3)
        self.assertEqual(len(enfilade.Dataset(datasets.made(), layers="color", split="train")), 3)

    def test_a_scene_file_is_imported_with_a_report(self):
        folder = datasets.folder() / "imported"
        folder.mkdir()
        (folder / "slab.obj").write_text("mtllib gone.mtl\nv 0 0 0\nv 2 0 0\nv 2 0 -2\nf 1 2 3\n")
        done = enfilade.import_scene(folder / "slab.obj", folder / "slab.scene", meters_per_unit=0.5)
        self.assertEqual(Path(done["scene"]), folder / "slab.scene")
        self.assertTrue(Path(done["scene"]).is_file() and Path(done["report"]).is_file())
        self.assertIn("gone.mtl", str(done["warnings"]))
        with self.assertRaisesRegex(ValueError, "slab.txt.*end it with one of .scene"):
            enfilade.import_scene(folder / "slab.obj", folder / "slab.txt")
        with self.assertRaisesRegex(ValueError, "expected one of y, z, x"):
            enfilade.import_scene(folder / "slab.obj", up_axis="w")
        with self.assertRaisesRegex(RuntimeError, "gone.obj"):
            enfilade.import_scene(folder / "gone.obj", folder / "gone.scene")

    def test_a_home_is_made_of_rooms_and_seed(self):
        paths = [datasets.folder() / name for name in ("a.scene", "b.scene", "c.scene", "d.glb")]
        for path, seed in zip(paths, (7, 7, 8, 7), strict=True):
            done = enfilade.home(path, rooms=["bathroom", "hall"], seed=seed)
            self.assertEqual(sorted(room.split()[0] for room in done["rooms"].split(", ")), ["bathroom", "hall"])
        first, second, other, _ = (path.read_bytes() for path in paths)
        self.assertEqual(first, second)
        self.assertNotEqual(first, other)
        self.assertTrue(done["lost"] is not None and paths[3].read_bytes().startswith(b"glTF"))
        with self.assertRaisesRegex(ValueError, "expected one of living"):
            enfilade.home(paths[0], rooms="garage")
        with self.assertRaisesRegex(ValueError, "clutter must lie between"):
            enfilade.home(paths[0], clutter=9)
        with self.assertRaisesRegex(ValueError, "evening"):
            enfilade.home(paths[0], moment="noon")

    def test_a_dataset_is_exported(self):
        out = datasets.folder() / "coco"
        done = enfilade.export(datasets.made(), "coco", out, cameras="cam_*", frames=range(0, 2))
        self.assertEqual(done["frames"], 2)
        files = [path for path in out.rglob("*") if path.is_file()]
        self.assertEqual((len(files), sum(path.stat().st_size for path in files)), (done["files"], done["bytes"]))
        self.assertTrue((out / "README.md").is_file())
        self.assertEqual(enfilade.export(datasets.made(), "coco", out, frames=2)["frames"], 1)
        other = datasets.folder() / "no-export"
        other.mkdir()
        (other / "mine.txt").write_text("mine")
        with self.assertRaisesRegex(ValueError, "no-export cannot be the output folder"):
            enfilade.export(datasets.made(), "coco", other)
        enfilade.export(datasets.made(), "coco", other, layers=["color", "semantic", "semantic_instance"], force=True)
        self.assertEqual((datasets.folder() / "no-export.old/mine.txt").read_text(), "mine")
        for wrong in ({"format": "cocoa"}, {"scenes": "hom"}, {"cameras": "cam_7"}, {"frames": range(0, 4, 2)}, {"shard_mb": 0}):
            with self.assertRaises(ValueError, msg=wrong):
                enfilade.export(**({"dataset": datasets.made(), "format": "coco", "output": out} | wrong))

    def test_stages_that_do_not_exist(self):
        with self.assertRaisesRegex(ValueError, "render"):
            enfilade.stage("rendr", datasets.made())


class Announced(unittest.TestCase):
    def test_stubs_name_everything_and_nothing_else(self):
        text = Path(enfilade.__file__).with_name("__init__.pyi").read_text()
        body = ast.parse(text).body
        stubs = {node.name: node for node in body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        values = {node.target.id for node in body if isinstance(node, ast.AnnAssign)}
        dictionaries = {"Layer", "Lens", "MeshComparison", "ShapeObject", "ShapeDetection", "JudgedShape"}
        modules = {alias.name for node in body if isinstance(node, ast.ImportFrom) and node.level for alias in node.names}
        self.assertEqual(set(enfilade.__all__), (set(stubs) - dictionaries) | values | modules)
        for name in ("Dataset", "Loader", "LoaderIterator", "Config", "Camera", "Scene"):
            announced = {node.name for node in stubs[name].body if isinstance(node, ast.FunctionDef)}
            there = {key for key in vars(getattr(enfilade, name)) if not key.startswith("__")}
            self.assertEqual({key for key in announced if not key.startswith("__")}, there, name)

    def test_stubs_of_the_farm_have_its_functions_and_their_arguments(self):
        body = ast.parse(Path(enfilade.farm.__file__).with_suffix(".pyi").read_text()).body
        stubs = {node.name: node.args for node in body if isinstance(node, ast.FunctionDef)}
        self.assertEqual(set(enfilade.farm.__all__), set(stubs))
        for name, arguments in stubs.items():
            there = inspect.signature(getattr(enfilade.farm, name)).parameters.values()
            self.assertEqual([a.arg for a in arguments.args], [p.name for p in there if p.kind is p.POSITIONAL_OR_KEYWORD], name)
            self.assertEqual([a.arg for a in arguments.kwonlyargs], [p.name for p in there if p.kind is p.KEYWORD_ONLY], name)
            self.assertTrue(getattr(enfilade.farm, name).__doc__, name)

    def test_everything_has_a_doc_string(self):
        for name in enfilade.__all__:
            value = getattr(enfilade, name)
            self.assertTrue(value.__doc__, name)

    def test_formats_are_described(self):
        self.assertIn("COLMAP", enfilade.FORMATS["colmap"])

    def test_layers_are_described(self):
        self.assertEqual(enfilade.LAYERS["depth_meters"]["unit"], "m")
        self.assertEqual(enfilade.LAYERS["color"]["dtype"], "float16")


if __name__ == "__main__":
    unittest.main()
