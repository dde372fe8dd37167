"""Rendered frames of a living room, made once for all tests."""

import atexit
import functools
import shutil
import tempfile
from pathlib import Path

import enfilade

DATASET = """
frames = 8
[render]
size = [64, 64]
samples = 16
[[scene]]
name = "home"
home = { seed = 16, rooms = ["living"], clutter = 0 }
cameras = ["living_1"]
"""


@functools.cache
def rendered() -> Path:
    """Eight labelled frames of 64 x 64 pixels."""
    folder = Path(tempfile.mkdtemp(prefix="enfilade-training-"))
    atexit.register(lambda: shutil.rmtree(folder, ignore_errors=True))
    file = folder / "dataset.toml"
    file.write_text(DATASET, encoding="utf-8")
    enfilade.run(folder / "home", enfilade.Config.read(file))
    return folder / "home"
