"""Keywords that are options declared once: in signatures and help, with their defaults, and refused with the nearest where they are unknown."""

import inspect
import pickle
import unittest

import enfilade

import datasets

DECLARED = {
    enfilade.import_scene: {"allow_missing_meshes": False, "meters_per_unit": 1.0, "up_axis": None},
    enfilade.Scene.read: {"lamps": None, "labels": None, "progress": None},
    enfilade.home: {"seed": 0, "clutter": 1.0, "allow_broken_assets": False},
    enfilade.Scene.home: {"seed": 0, "rooms": None},
    enfilade.render: {"seed": 0, "quality": None, "lambertian": False, "progress": None},
    enfilade.Config.demo: {"seed": None, "size": None, "time_limit_s": None, "extra": False},
    enfilade.make: {"overlap": None, "baseline_m": None, "points": 256, "layers": 8, "stale": False},
    enfilade.export: {"layers": None, "shard_mb": 1000, "cloud": "frames", "symmetries": "shape", "force": False},
    enfilade.farm.plan: {"minutes": 15.0, "cpus": 8, "price": None},
    enfilade.farm.submit: {"memory_mib": None, "array_limit": 1000, "dry_run": False},
}


class Options(unittest.TestCase):
    def test_signatures_and_help_have_every_option(self):
        for function, expected in DECLARED.items():
            parameters = inspect.signature(function).parameters
            for name, default in expected.items():
                self.assertEqual(parameters[name].default, default, name)
                self.assertIs(parameters[name].kind, inspect.Parameter.KEYWORD_ONLY)
                self.assertIn(f"{name}: ", function.__doc__)
            self.assertNotIn("{options}", function.__doc__)
        self.assertIn("tone_map: Makes `color` uint8", enfilade.Dataset.__doc__)
        self.assertIs(pickle.loads(pickle.dumps(enfilade.home)), enfilade.home)
        self.assertIs(pickle.loads(pickle.dumps(enfilade.Scene.read)), enfilade.Scene.read)
        self.assertIs(pickle.loads(pickle.dumps(enfilade.farm.plan)), enfilade.farm.plan)

    def test_unknown_keywords_are_refused_with_the_nearest(self):
        for function, keyword, nearest in (
            (lambda **options: enfilade.import_scene("a.obj", **options), "allow_missing_mesh", "allow_missing_meshes"),
            (lambda **options: enfilade.Scene.read("a.obj", **options), "label", "labels"),
            (enfilade.Scene.home, "room", "rooms"),
            (enfilade.home, "outputs", "output"),
            (lambda **options: enfilade.Dataset(datasets.made(), **options), "layer", "layers"),
            (lambda **options: enfilade.make(datasets.made(), "pairs", **options), "baseline", "baseline_m"),
            (lambda **options: enfilade.export(datasets.made(), "coco", "out", **options), "shard", "shard_mb"),
            (lambda **options: enfilade.farm.submit("job", "slurm", **options), "memory", "memory_mib"),
        ):
            with self.assertRaisesRegex(TypeError, f"'{keyword}'; did you mean `{nearest}`"):
                function(**{keyword: 1})

    def test_values_of_another_type_are_refused_by_name(self):
        for options, error, message in (
            ({"seed": "one"}, TypeError, "argument 'seed': expected a whole number"),
            ({"seed": -1}, OverflowError, ""),
            ({"clutter": None, "realism": "much"}, TypeError, "argument 'realism': expected a number"),
            ({"rooms": ["hall", "kitchn"]}, ValueError, "did you mean `kitchen`"),
            ({"allow_broken_assets": "yes"}, TypeError, "expected true or false"),
        ):
            with self.assertRaisesRegex(error, message):
                enfilade.Scene.home(**options)

    def test_values_out_of_their_bounds_are_refused_by_name(self):
        for options, error, message in (
            ({"points": 0}, ValueError, "points is 0; expected a whole number from 1 to 4294967295"),
            ({"layers": 65}, ValueError, "layers is 65; expected a whole number from 1 to 64"),
            ({"overlap": (0.7, 0.2)}, ValueError, "overlap is \\(0.7, 0.2\\); expected two numbers from 0 to 1, the smaller one first"),
            ({"baseline_m": (-1, 2)}, ValueError, "expected two numbers from 0, the smaller one first"),
            ({"baseline_m": 2}, TypeError, "argument 'baseline_m': expected two numbers from 0"),
            ({"between": ("cam_00", "cam_01")}, ValueError, "a camera and the number of a frame, as in cam_00/3"),
            ({"between": (("cam_00", 0), "cam_00/1", ("cam_00", 2))}, TypeError, "argument 'between'"),
            ({"step": "far"}, TypeError, "argument 'step': expected a whole number"),
        ):
            with self.assertRaisesRegex(error, message):
                enfilade.make(datasets.made(), ["pairs", "flow"], **options)


if __name__ == "__main__":
    unittest.main()
