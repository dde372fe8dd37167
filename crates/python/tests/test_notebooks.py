"""The notebooks of examples/notebooks run from top to bottom."""

import json
import os
import unittest
from pathlib import Path

import datasets

NOTEBOOKS = Path(__file__).parents[3] / "examples/notebooks"


def run(path):
    names = {"__name__": "__main__"}
    for number, cell in enumerate(json.loads(path.read_text())["cells"]):
        if cell["cell_type"] == "code":
            code = compile("".join(cell["source"]), f"{path.name}, cell {number}", "exec")
            exec(code, names)


class Notebooks(unittest.TestCase):
    def test_every_notebook_runs(self):
        try:
            import PIL  # noqa: F401
        except ImportError:
            self.skipTest("Pillow is not installed")
        paths = sorted(NOTEBOOKS.glob("*.ipynb"))
        self.assertGreaterEqual(len(paths), 2)
        here = os.getcwd()
        for path in paths:
            folder = datasets.folder() / path.stem
            folder.mkdir()
            os.chdir(folder)
            try:
                with self.subTest(path.name):
                    run(path)
            finally:
                os.chdir(here)


if __name__ == "__main__":
    unittest.main()
