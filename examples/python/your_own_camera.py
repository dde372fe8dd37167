"""Renders a walk of a calibrated camera, K and poses in OpenCV's conventions, through a scene file or a generated home.

python your_own_camera.py [scene.glb]
"""

import sys
from collections.abc import Sequence

import enfilade
import numpy as np

K = [[610.0, 0.0, 319.5], [0.0, 612.0, 238.0], [0.0, 0.0, 1.0]]
DISTORTION = [-0.12, 0.03, 0.0005, -0.0002]


def walk(scene: enfilade.Scene, size: Sequence[int], steps: int) -> list[enfilade.Camera]:
    """A tenth of a metre to the right with each step, from a good place."""
    pose = scene.camera(size=size).world_from_camera
    scale = np.diag([size[0] / 640.0, size[1] / 480.0, 1.0])
    cameras = []
    for step in range(steps):
        moved = pose.copy()
        moved[:3, 3] += 0.1 * step * pose[:3, 0]
        cameras.append(enfilade.Camera(scale @ K, size, moved, model="radial_tangential", distortion=DISTORTION, name="walk"))
    return cameras


def main(file: str | None = None, size: tuple[int, int] = (640, 480), steps: int = 3, samples: int = 8) -> list[enfilade.Frame]:
    scene = enfilade.Scene.read(file) if file else enfilade.Scene.home(rooms=["study"], seed=2)
    frames = enfilade.render(scene, walk(scene, size, steps), samples=samples, layers=["color", "depth_z_meters", "optical_flow"])
    for frame in frames[:-1]:
        flow = np.linalg.norm(frame["optical_flow"], axis=-1)
        print(f"frame {frame['frame']}: {np.nanmedian(frame['depth_z_meters']):.2f} m deep, moves by {np.nanmedian(flow):.1f} pixels")
    return frames


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else None)
