"""Rendered frames of the demo's home, made once for all tests."""

import atexit
import functools
import shutil
import tempfile
from pathlib import Path

import enfilade


@functools.cache
def rendered() -> Path:
    """Eight labelled frames of 128 x 128 pixels."""
    folder = Path(tempfile.mkdtemp(prefix="enfilade-training-"))
    atexit.register(lambda: shutil.rmtree(folder, ignore_errors=True))
    settings = enfilade.Config.demo(frames=8, size=(128, 128), samples=4)
    enfilade.run(folder / "home", settings, scenes=settings.scenes[0])
    return folder / "home"
