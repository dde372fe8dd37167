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

    def test_unknown_keywords_are_refused_with_the_nearest(self):
        for function, keyword, nearest in (
            (lambda **options: enfilade.import_scene("a.obj", **options), "allow_missing_mesh", "allow_missing_meshes"),
            (lambda **options: enfilade.Scene.read("a.obj", **options), "label", "labels"),
            (enfilade.Scene.home, "room", "rooms"),
            (enfilade.home, "outputs", "output"),
            (lambda **options: enfilade.Dataset(datasets.made(), **options), "layer", "layers"),
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


if __name__ == "__main__":
    unittest.main()
