"""The notebooks of examples/notebooks run from top to bottom, and show something to who opens them."""

import contextlib
import importlib.util
import json
import unittest
from pathlib import Path

import datasets
import notebooks

FOLDER = Path(__file__).parents[3] / "examples/notebooks"
NAMES = [
    "1-first-dataset",
    "2-train-and-visualise",
    "3-camera-conventions",
    "4-render-your-own-scene",
    "5-from-hypersim-to-enfilade",
    "6-render-in-memory",
    "7-compose-a-scene",
]
# What they import beside enfilade and numpy; `cargo xtask python` has all of it.
MISSING = [package for package in ("PIL", "h5py", "torch", "matplotlib") if importlib.util.find_spec(package) is None]


# Paths from the root of a file system, but not the rest of a relative one, an address in the web or a closing tag.
ABSOLUTE = r"(?<![\w.})\]*</])(?<!https:)(?<!http:)/+[\w.-]+/"


def read(name):
    return json.loads((FOLDER / f"{name}.ipynb").read_text())


def words(notebook):
    """All of a notebook but its pictures, whose letters may spell anything."""
    for cell in notebook["cells"]:
        for output in cell.get("outputs", []):
            output.get("data", {}).pop("image/png", None)
    return json.dumps(notebook)


class Notebooks(unittest.TestCase):
    @unittest.skipIf(MISSING, f"not installed: {', '.join(MISSING)}")
    def test_every_notebook_runs(self):
        for name in NAMES:
            with self.subTest(name):
                folder = datasets.folder() / name
                folder.mkdir()
                with contextlib.chdir(folder):
                    notebooks.execute(read(name), name)
                    if name == NAMES[4]:  # It makes its data anew, and copies of it.
                        notebooks.execute(read(name), f"{name}, the second time")

    def test_every_notebook_shows_pictures_and_nothing_of_a_machine(self):
        self.assertEqual(sorted(path.stem for path in FOLDER.glob("*.ipynb")), NAMES)
        for name in NAMES:
            text = json.dumps(read(name))
            self.assertIn("image/png", text, name)
            self.assertLess(len(text), 600_000, name)
            for folder in ("tmp", "home", "root", "Users"):
                self.assertNotIn(f"/{folder}/", text, name)
            self.assertNotIn("Traceback", text, name)
            self.assertNotRegex(words(read(name)), ABSOLUTE, name)
            counts = [cell["execution_count"] for cell in read(name)["cells"] if cell["cell_type"] == "code"]
            self.assertEqual(counts, list(range(1, len(counts) + 1)), name)


if __name__ == "__main__":
    unittest.main()
