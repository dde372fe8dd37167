"""Runs a recipe of BlenderProc in Blender's Python module: peer_blenderproc.py RECIPE ARGUMENTS...

BlenderProc otherwise downloads Blender and installs packages into it. Here both are packages of this Python, so four things are changed: it
installs nothing, it keeps the folder of packages on the path, it looks for Blender's files in the module, and it does not set the language,
which the module cannot. Its own code does everything else.
"""

import importlib.abc
import importlib.util
import os
import runpy
import sys
import tempfile
import types
from pathlib import Path


def prepare(temporary):
    """Imports BlenderProc as within Blender."""
    os.environ["INSIDE_OF_THE_INTERNAL_BLENDER_PYTHON_ENVIRONMENT"] = "1"
    [package] = importlib.util.find_spec("blenderproc").submodule_search_locations
    # It takes its own folder off the path; bpy lies there too.
    sys.path.append(str(Path(package).parent))
    # A package without contents gives access to the modules in it before the real one runs.
    empty = types.ModuleType("blenderproc")
    empty.__path__ = [package]
    sys.modules["blenderproc"] = empty
    setup = importlib.import_module("blenderproc.python.utility.SetupUtility").SetupUtility
    paths = setup.determine_python_paths
    setup.setup_pip = staticmethod(lambda *_, **__: package)
    setup.determine_python_paths = staticmethod(lambda *_: paths(*blender()))
    setup.setup_utility_paths = staticmethod(lambda _: None)
    name = "blenderproc.python.utility.Initializer"
    spec = importlib.util.find_spec(name)
    lines = Path(spec.origin).read_text().replace('bpy.context.preferences.view.language = "en_US"', "pass")
    del sys.modules["blenderproc"]
    sys.meta_path.insert(0, Changed(name, lines))
    importlib.import_module("blenderproc")
    importlib.import_module("blenderproc.python.utility.Utility").Utility.temp_dir = temporary


def blender():
    """The folder of Blender's module, and the version that its files are under."""
    import bpy

    own = Path(bpy.utils.resource_path("LOCAL"))
    return str(own.parent), own.name


class Changed(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Finds one module, whose text is given."""

    def __init__(self, name, text):
        self.name, self.text = name, text

    def find_spec(self, name, _path, _target=None):
        return importlib.util.spec_from_loader(name, self) if name == self.name else None

    def exec_module(self, module):
        exec(compile(self.text, self.name, "exec"), module.__dict__)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        prepare(folder)
        recipe, sys.argv = sys.argv[1], sys.argv[1:]
        runpy.run_path(recipe, run_name="__main__")
