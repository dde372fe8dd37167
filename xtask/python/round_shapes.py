"""Corners of the triangles that stand for shapes which USD and Mitsuba describe by numbers, three after three.

Such shapes have no triangles of their own. They are given as many here as `crates/import` makes of them (96 sides, a sphere of 48 rows; 24
sides and the area of the true one for spheres that are lights), so that their number, places and sizes can be compared. Tests there check how
close they are to the shapes.
"""

import numpy as np

SIDES, ROWS = 96, 48
LAMP_SIDES = 24

Outline = list[tuple[float, float]]
"""Distances from the axis and heights."""


def revolution(*outlines: Outline, sides: int = SIDES) -> np.ndarray:
    """Outlines turned about the z axis; where a side is on the axis there is one triangle, not two."""
    turn = np.arange(sides + 1) % sides * 2 * np.pi / sides
    rings = [[np.stack([r * np.cos(turn), r * np.sin(turn), np.full(sides + 1, z)], -1) for r, z in outline] for outline in outlines]
    triangles = []
    for rows, outline in zip(rings, outlines):
        for k in range(len(rows) - 1):
            a, b, c, d = rows[k][:-1], rows[k][1:], rows[k + 1][1:], rows[k + 1][:-1]
            triangles += [np.stack([a, b, c], 1)] if outline[k][0] > 0 else []
            triangles += [np.stack([a, c, d], 1)] if outline[k + 1][0] > 0 else []
    return np.concatenate(triangles or [np.zeros((0, 3, 3))]).reshape(-1, 3)


def arc(start: float, end: float, radius: float, height: float, rows: int) -> Outline:
    """Part of a circle, by elevations in quarters of a turn; on the axis at the poles."""
    angles = np.linspace(start, end, rows + 1) * np.pi / 2
    return [(radius * c if abs(c := np.cos(angle)) > 1e-6 else 0.0, height + radius * np.sin(angle)) for angle in angles]


def sphere(radius: float = 1.0) -> np.ndarray:
    return revolution(arc(-1, 1, radius, 0, ROWS))


def lamp(radius: float) -> np.ndarray:
    """A sphere of few triangles, with the area of the true one."""
    corners = revolution(arc(-1, 1, 1, 0, LAMP_SIDES // 2), sides=LAMP_SIDES)
    a, b, c = corners.reshape(-1, 3, 3).swapaxes(0, 1)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=-1).sum() / 2
    return corners * radius * np.sqrt(4 * np.pi / area)


def disk(radius: float = 1.0) -> np.ndarray:
    return revolution([(radius, 0), (0, 0)])


def tube(radius: float, low: float, high: float) -> np.ndarray:
    return revolution([(radius, low), (radius, high)])


def cylinder(bottom: float, top: float, height: float) -> np.ndarray:
    half = height / 2
    return revolution([(0, -half), (bottom, -half)], [(bottom, -half), (top, half)], [(top, half), (0, half)])


def capsule(bottom: float, top: float, height: float) -> np.ndarray:
    half = height / 2
    return revolution(arc(-1, 0, bottom, -half, ROWS // 2), [(bottom, -half), (top, half)], arc(0, 1, top, half, ROWS // 2))


def rectangle(width: float, length: float) -> np.ndarray:
    x, y = width / 2, length / 2
    a, b, c, d = (-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)
    return np.array([a, b, c, a, c, d], float)


def cube(size: float) -> np.ndarray:
    sides = [rectangle(size, size) + [0, 0, z] for z in (-size / 2, size / 2)]
    return np.concatenate([np.roll(side, turn, 1) for side in sides for turn in range(3)])


def along(axis: str, corners: np.ndarray) -> np.ndarray:
    """A shape along z, turned so that it lies along another axis."""
    return np.roll(corners, {"X": 1, "Y": 2}.get(axis, 0), 1)
