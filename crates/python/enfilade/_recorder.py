"""Runs of MuJoCo as scenes that move: `MujocoRecorder`. MuJoCo itself is not imported; the model's arrays are read as they are."""

import math
import pathlib
import tempfile

import numpy

from . import _mjcf
from ._declared import explained, import_scene


class MujocoRecorder:
    """A recorder of a run of MuJoCo, which becomes a scene package.

        rec = enfilade.MujocoRecorder(model)
        while data.time < 3:
            mujoco.mj_step(model, data)
            rec.step(data)
        rec.save("run.scene")

    model: a `mujoco.MjModel`, or what has its arrays: bodies, joints, geoms, meshes, materials, textures, lights and cameras are taken from it.

    Joints keep their axes and limits, and cameras ride on their bodies: `mode = { kind = "cameras" }` of a dataset films with them.
    `enfilade.import_scene` says what geoms and lights become; the files that it reads are the recorder's own, so
    the scene does not depend on those that the model was made of.
    """

    def __init__(self, model):
        self._model = model
        self._times = []
        self._qpos = []
        self._mocap = []

    def step(self, data):
        """Keeps the state of a `mujoco.MjData`: the joints, the bodies that a program moves (mocap), and the time, which must not descend."""
        qpos = numpy.array(data.qpos, numpy.float64)
        if qpos.shape != (self._model.nq,):
            raise ValueError(f"data.qpos has {qpos.size} values, but the model of this recorder has {self._model.nq}: it is of another model")
        time = float(data.time)
        if not numpy.isfinite(qpos).all() or not math.isfinite(time):
            raise ValueError(f"step {len(self._times)} ({time} s) has values that are no finite numbers; the simulation has diverged")
        if self._times and time < self._times[-1]:
            raise ValueError(f"step {len(self._times)} is at {time} s, before the one ahead of it ({self._times[-1]} s); use one recorder per run")
        self._times.append(time)
        self._qpos.append(qpos)
        self._mocap.append((numpy.array(data.mocap_pos, numpy.float64), numpy.array(data.mocap_quat, numpy.float64)))

    @explained("FileSource")
    def save(self, file, **options):
        """Writes the run as a scene package (.scene); the options are those of `import_scene`, and so is what it gives.

        {options}
        """
        if options.pop("states", None) is not None:
            raise TypeError("save() takes no states: they are those that were recorded")
        self._require_steps()
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            scene = _mjcf.write(self._model, folder)
            arrays = {"time": numpy.array(self._times), "qpos": numpy.stack(self._qpos)}
            if self._mocap[0][0].size:
                arrays["mocap_pos"], arrays["mocap_quat"] = map(numpy.stack, zip(*self._mocap))
            numpy.savez(folder / "run.npz", **arrays)
            return import_scene(scene, file, states=folder / "run.npz", **options)

    def _require_steps(self):
        if not self._times:
            raise ValueError("nothing was recorded: call step(data) in the loop of the simulation")

    def __len__(self):
        return len(self._times)

    def __repr__(self):
        return f"<enfilade.MujocoRecorder: {len(self)} steps>"
