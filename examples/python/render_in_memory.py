"""Renders a generated home without a dataset on disk, and makes points of its depth.

python render_in_memory.py [picture.png]
"""

import sys
from pathlib import Path

import enfilade
import numpy as np
from numpy.typing import NDArray


def points_of(frame: enfilade.Frame) -> NDArray[np.float64]:
    """The points that a pinhole sees, in the world, metres: height x width x 3."""
    depth_z = frame["depth_z_meters"]
    rows, columns = np.indices(depth_z.shape)
    rays = np.stack([columns, rows, np.ones_like(rows)], axis=-1) @ np.linalg.inv(frame["K"]).T
    pose = frame["world_from_camera"]
    points: NDArray[np.float64] = (rays * depth_z[..., None]) @ pose[:3, :3].T + pose[:3, 3]
    return points


def main(output: Path, size: tuple[int, int] = (640, 480)) -> enfilade.Frame:
    scene = enfilade.Scene.home(rooms=["living", "kitchen"], seed=7)
    print(scene)
    camera = scene.camera(size=size)
    print(camera)

    frame = enfilade.render(scene, camera, quality="draft")
    output.write_bytes(frame.png())

    seen = {scene.parts[int(part) - 1].name for part in np.unique(frame["render_entity_id"]) if part > 0}
    off = np.nanmax(np.abs(points_of(frame) - frame["position"]))
    print(f"{output.name}: {len(seen)} parts are seen; depth, K and pose agree with position to {1000 * off:.3f} mm")
    return frame


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "home.png"))
