"""Simulates simulation.xml for three seconds and stores the run: python simulation.py (with mujoco, which enfilade does not need)."""

import pathlib

import mujoco
import numpy

here = pathlib.Path(__file__).parent
model = mujoco.MjModel.from_xml_path(str(here / "simulation.xml"))
data = mujoco.MjData(model)
data.joint("door_hinge").qvel = 1.6
data.joint("drawer_rail").qvel = 0.5
times, states = [], []
while data.time < 3:
    if len(times) <= data.time * 60:
        times.append(data.time)
        states.append(data.qpos.copy())
    mujoco.mj_step(model, data)
numpy.savez_compressed(here / "simulation.npz", time=times, qpos=states)
