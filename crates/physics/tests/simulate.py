"""Simulates scenes in MuJoCo: python simulate.py SCENE.xml...

For each file one line of JSON: `bodies`, `free` and `joints`, counts; `mass_kg` by body; `drift_mm` and `jump_mm`, the farthest way of a free body's
surface in five seconds and within a hundredth of a second, with the body's name; `sweeps`, joints whose bodies touch something on the way from one end of
their range to the other, with what they touch and at which state; `seconds`, the time that the simulation took.
"""

import json
import sys
import time

try:
    import mujoco
    import numpy as np
except ImportError:
    sys.exit(77)

SPAN_S, LOOK_S, STATES = 5.0, 0.01, 60
# Contacts that are less deep do not count as touching, metres.
TOUCH_M = 1e-4


def main():
    for path in sys.argv[1:]:
        model = mujoco.MjModel.from_xml_path(path)
        print(json.dumps({"file": path, **simulated(model)}), flush=True)


def simulated(model):
    data, begun = mujoco.MjData(model), time.process_time()
    free = [body for body in range(model.nbody) if model.body_dofnum[body] == 6]
    reach = np.array([radius(model, body) for body in free])
    mujoco.mj_forward(model, data)
    first, before = poses(data, free), poses(data, free)
    drift, jump = np.zeros(len(free)), np.zeros(len(free))
    for _ in range(round(SPAN_S / LOOK_S)):
        for _ in range(round(LOOK_S / model.opt.timestep)):
            mujoco.mj_step(model, data)
        now = poses(data, free)
        drift, jump = np.maximum(drift, way(first, now, reach)), np.maximum(jump, way(before, now, reach))
        before = now
    states = [name(model, "joint", joint) for joint in range(model.njnt) if model.jnt_type[joint] != mujoco.mjtJoint.mjJNT_FREE]
    return dict(
        bodies=model.nbody - 1,
        free=len(free),
        joints=len(states),
        mass_kg={name(model, "body", body): float(model.body_mass[body]) for body in range(1, model.nbody)},
        drift_mm=worst(model, free, drift),
        jump_mm=worst(model, free, jump),
        moved={name(model, "body", body): round(1e3 * far, 3) for body, far in zip(free, drift) if far > 1e-3},
        joint_drift=joint_drift(model, data),
        sweeps=sweeps(model),
        seconds=round(time.process_time() - begun, 1),
    )


def poses(data, bodies):
    return data.xipos[bodies].copy(), data.ximat[bodies].reshape(-1, 3, 3).copy()


def way(first, now, reach):
    """How far a point at `reach` from the centre can have moved, metres."""
    turn = np.einsum("bij,bij->b", first[1], now[1])
    angle = np.arccos(np.clip((turn - 1) / 2, -1, 1))
    # The cosine of small angles loses digits: the difference of the matrices does not.
    small = np.linalg.norm(now[1] - first[1], axis=(1, 2)) / np.sqrt(2)
    return np.linalg.norm(now[0] - first[0], axis=1) + reach * np.where(angle < 0.01, small, angle)


def radius(model, body):
    """The distance of the farthest geom's end from the body's centre of mass, metres."""
    geoms = range(model.body_geomadr[body], model.body_geomadr[body] + model.body_geomnum[body])
    far = [np.linalg.norm(model.geom_pos[g] - model.body_ipos[body]) + model.geom_rbound[g] for g in geoms if model.geom_contype[g]]
    return max(far, default=0.0)


def worst(model, bodies, ways):
    if not bodies:
        return [0.0, ""]
    most = int(np.argmax(ways))
    return [round(1e3 * float(ways[most]), 3), name(model, "body", bodies[most])]


def joint_drift(model, data):
    """The greatest change of a hinge's or slide's state, radians or metres, and its name."""
    found = [(abs(float(data.qpos[model.jnt_qposadr[j]])), name(model, "joint", j)) for j in range(model.njnt) if model.jnt_type[j] != mujoco.mjtJoint.mjJNT_FREE]
    return list(max(found, default=(0.0, "")))


def sweeps(model):
    """What joints' bodies touch on their ways, with everything else at rest."""
    found = {}
    for joint in range(model.njnt):
        if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_FREE:
            continue
        data = mujoco.MjData(model)
        own = descendants(model, model.jnt_bodyid[joint])
        least, most = model.jnt_range[joint] if model.jnt_limited[joint] else (-np.pi, np.pi)
        for state in np.linspace(least, most, STATES):
            data.qpos[model.jnt_qposadr[joint]] = state
            mujoco.mj_forward(model, data)
            for contact in data.contact:
                sides = [int(model.geom_bodyid[geom]) for geom in contact.geom]
                if contact.dist < -TOUCH_M and sum(side in own for side in sides) == 1:
                    other = next(side for side in sides if side not in own)
                    found.setdefault(name(model, "joint", joint), [name(model, "body", other), round(float(state), 3), round(-1e3 * float(contact.dist), 2)])
    return found


def descendants(model, body):
    found = {int(body)}
    for other in range(int(body) + 1, model.nbody):
        if int(model.body_parentid[other]) in found:
            found.add(other)
    return found


def name(model, kind, number):
    return getattr(model, kind)(number).name


if __name__ == "__main__":
    main()
