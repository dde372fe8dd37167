"""Pictures that were rendered, kept as soon as they are made: a benchmark that was cut off goes on where it stopped.

A picture's name tells its renderer and the digests of the scene, of the settings and of the program, in this order. What any of the
three changes is rendered again. Pictures that are measured, not references, are those of all programs that are compared: where one of
these changes, the others are measured again too, since a machine that others share is not as fast on every day. A benchmark may ask for
the references of earlier programs: the truth does not change with the program.
"""

import hashlib
import json
import os
from pathlib import Path

import numpy as np

from machine import processor
from renderers import Shot


def digest(*parts):
    """Twelve hexadecimal digits of what bytes, files, folders (with what is in them) or other values hold."""
    found = hashlib.sha256()
    for part in parts:
        if isinstance(part, Path):
            for path in sorted(Path(place) / name for place, _, names in os.walk(part, followlinks=True) for name in names) or [part]:
                found.update(path.name.encode() + path.read_bytes())
        else:
            found.update(part if isinstance(part, bytes) else json.dumps(part, sort_keys=True).encode())
    return found.hexdigest()[:12]


class Store:
    """Pictures below `folder` for a comparison of `renderers`; those of references, of any program if `any_program`."""

    def __init__(self, folder, renderers, any_program=False):
        self.folder, self.any_program = Path(folder), any_program
        self.compared = digest(*(renderer.program for renderer in renderers))
        self.folder.mkdir(parents=True, exist_ok=True)

    def shot(self, renderer, scene, size, samples, seed, reference=False, **fields):
        """The picture of `scene`, which has a `digest`, as `renderer` makes it, or has made it before."""
        settings = dict(size=size, samples=samples, seed=seed) | renderer.settings(reference) | fields
        # Processor seconds are those of one kind of machine; a reference is true on all.
        stem = f"{renderer.name}-{scene.digest}-{digest(settings, None if reference else processor())}"
        path = self.folder / f"{stem}-{digest(renderer.program) if reference else self.compared}.npz"
        earlier = sorted(self.folder.glob(f"{stem}-*.npz"), key=lambda found: found.stat().st_mtime) if reference and self.any_program else []
        if not path.exists() and not earlier:
            self.keep(renderer.shot(scene, size, samples, seed, reference, **fields), settings, path)
        return read(path if path.exists() else earlier[-1])

    def keep(self, shot, settings, path):
        unfinished = path.with_name(f"unfinished-{os.getpid()}.npz")
        np.savez(unfinished, raw=shot.raw, delivered=shot.delivered, facts=json.dumps(shot.facts), settings=json.dumps(settings))
        unfinished.replace(path)
        print(f"  rendered {path.stem}: {settings}, {shot.facts['raw_core_s']:.1f} core-s", flush=True)


def read(path):
    with np.load(path) as kept:
        return Shot(kept["raw"], kept["delivered"], json.loads(str(kept["facts"])))
