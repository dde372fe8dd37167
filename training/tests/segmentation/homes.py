"""Rendered frames of a bedroom, made once for all tests."""

import atexit
import functools
import shutil
import tempfile
from pathlib import Path

import enfilade

DATASET = """
frames = 8
[render]
size = [96, 96]
samples = 8
[plan]
mode = { kind = "walk" }
[[scene]]
name = "home"
seed = 5
home = { seed = 6, rooms = ["bedroom"], clutter = 0, lived_in = 0 }
cameras = ["bedroom_1"]
"""


@functools.cache
def rendered() -> Path:
    """Eight labelled frames of 96 x 96 pixels."""
    folder = Path(tempfile.mkdtemp(prefix="enfilade-training-"))
    atexit.register(lambda: shutil.rmtree(folder, ignore_errors=True))
    file = folder / "dataset.toml"
    file.write_text(DATASET, encoding="utf-8")
    enfilade.run(folder / "home", enfilade.Config.read(file))
    return folder / "home"
