import math
import unittest

import numpy as np
import torch

from enfilade_training.study import views
from enfilade_training.study.pictures import VOID, Pictures


def room(height_m: float, pitch_deg: float, roll_deg: float) -> tuple[np.ndarray, np.ndarray]:
    """Depths and NYU40's classes from 0 of a floor, and of a wall that faces the camera 4 m away, in the part that is taken of 240 x 320."""
    rows, columns = np.mgrid[0:214, 0:280] + 0.5
    x = (columns / 320 + views.ORIGIN[0] - views.CENTER[0]) / views.FOCAL[0]
    y = (rows / 320 + views.ORIGIN[1] - views.CENTER[1]) / views.FOCAL[1]
    pitch, roll = math.radians(pitch_deg), math.radians(roll_deg)
    # Up, in the camera's axes: x to the right, y down, z ahead.
    up = np.array([math.cos(pitch) * math.sin(roll), -math.cos(pitch) * math.cos(roll), math.sin(pitch)])
    falls = -(up[0] * x + up[1] * y + up[2])
    floor = np.where(falls > 1e-6, height_m / np.maximum(falls, 1e-6), np.inf)
    return np.minimum(floor, 4.0), np.where(floor < 4.0, views.FLOOR, 0).astype(np.uint8)


class Cameras(unittest.TestCase):
    def test_height_pitch_and_roll_are_those_of_the_floor(self) -> None:
        for height_m, pitch_deg, roll_deg in ((1.34, -13.3, 0.0), (1.6, -25.0, 4.0), (0.9, -8.0, -3.0)):
            found = views.camera_above_floor(*room(height_m, pitch_deg, roll_deg))
            assert found is not None
            for value, expected in zip(found, (height_m, pitch_deg, roll_deg)):
                self.assertAlmostEqual(value, expected, places=3)

    def test_without_a_floor_there_is_none(self) -> None:
        depth_m, classes = room(1.3, -10.0, 0.0)
        self.assertIsNone(views.camera_above_floor(depth_m, np.zeros_like(classes)))


class Compositions(unittest.TestCase):
    def test_distances_sides_and_things_are_measured(self) -> None:
        depth_m = np.full((6, 8), 2.0)
        depth_m[:2], depth_m[4:] = 4.0, 1.0
        classes = np.zeros((6, 8), dtype=np.uint8)
        classes[4:, :4], classes[5] = 3, VOID
        upper, middle, lower, sides, things = views.composition(depth_m, classes)
        self.assertEqual([round(math.exp(value), 6) for value in (upper, middle, lower)], [4.0, 2.0, 1.0])
        self.assertAlmostEqual(sides, 0.0)
        self.assertAlmostEqual(things, 4 / 40)
        depth_m[:, :2] *= math.e
        self.assertAlmostEqual(views.composition(depth_m, classes)[3], 0.5)

    def test_whitened_compositions_have_no_covariance(self) -> None:
        random = np.random.default_rng(1)
        found = random.normal(size=(500, 5)) @ random.normal(size=(5, 5))
        center, rows = views.whitening(found)
        self.assertLess(float(np.abs(np.cov(((found - center) @ rows.T).T) - np.eye(5)).max()), 1e-9)

    def test_a_page_tells_both(self) -> None:
        depth_m, classes = room(1.3, -10.0, 0.0)
        pictures = Pictures(torch.zeros(1, 3, 1, 1, dtype=torch.uint8), torch.from_numpy(classes)[None], torch.from_numpy(depth_m)[None].half(), ["a"])
        found = views.views(pictures)
        page = "\n".join(views.lines(found, found))
        self.assertIn("| pitch, degrees | -10.0 ± 0.0 | -10.0 ± 0.0 |", page)
        self.assertIn("0.0 % would need another class", page)


if __name__ == "__main__":
    unittest.main()
