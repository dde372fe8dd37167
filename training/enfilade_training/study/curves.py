"""Panels of curves as an SVG: the mean over runs, and a band from the least to the greatest."""

import math
import statistics
from dataclasses import dataclass
from typing import Sequence
from xml.sax.saxutils import escape

# Sizes of a panel, and what is left beside it for numbers, in pixels.
WIDTH, HEIGHT, LEFT, TOP, GAP = 240, 180, 44, 44, 62
COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00")  # Okabe and Ito's, which the colour-blind can tell apart.

# Values of each run at each place of the x axis.
Series = dict[float, list[float]]


@dataclass(frozen=True)
class Panel:
    """A diagram. series: by name of a curve."""

    title: str
    x: str
    series: dict[str, Series]


def svg(panels: Sequence[Panel]) -> str:
    """The panels, three beside each other; a name has the same colour in all."""
    names = list(dict.fromkeys(name for panel in panels for name in panel.series))
    colors = {name: COLORS[i % len(COLORS)] for i, name in enumerate(names)}
    columns, lines = min(3, len(panels)), -(-len(panels) // 3)
    width, height = LEFT + columns * (WIDTH + GAP), lines * (TOP + HEIGHT + 34)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="11">',
        '<rect width="100%" height="100%" fill="white"/>',
    ]
    for i, panel in enumerate(panels):
        parts += _panel(LEFT + i % 3 * (WIDTH + GAP), TOP + i // 3 * (TOP + HEIGHT + 34), panel, colors)
    for i, name in enumerate(names):
        x = LEFT + i * 150
        parts.append(f'<path d="M{x} 12h18" stroke="{colors[name]}" stroke-width="2"/><text x="{x + 23}" y="16">{escape(name)}</text>')
    return "\n".join([*parts, "</svg>", ""])


def _panel(left: float, upper: float, panel: Panel, colors: dict[str, str]) -> list[str]:
    values = [value for of in panel.series.values() for at in of.values() for value in at]
    most = _round_up(max((x for of in panel.series.values() for x in of), default=1.0))
    top = _round_up(max(values, default=1.0))

    def place(x: float, value: float) -> str:
        return f"{left + WIDTH * x / most:.1f} {upper + HEIGHT * (1 - value / top):.1f}"

    parts = [f'<text x="{left}" y="{upper - 8}" font-weight="bold">{escape(panel.title)}</text>']
    for i in range(5):
        y, x = upper + HEIGHT * i / 4, left + WIDTH * i / 4
        parts.append(f'<path d="M{left} {y}h{WIDTH}M{x} {upper}v{HEIGHT}" stroke="#ddd"/>')
        parts.append(f'<text x="{left - 4}" y="{y + 4}" text-anchor="end">{top * (4 - i) / 4:.3g}</text>')
        parts.append(f'<text x="{x}" y="{upper + HEIGHT + 15}" text-anchor="middle">{most * i / 4:g}</text>')
    parts.append(f'<text x="{left + WIDTH / 2}" y="{upper + HEIGHT + 29}" text-anchor="middle">{escape(panel.x)}</text>')
    for name, of in panel.series.items():
        ordered = sorted(of.items())
        above = [place(x, max(at)) for x, at in ordered]
        below = [place(x, min(at)) for x, at in ordered]
        middle = [place(x, statistics.fmean(at)) for x, at in ordered]
        if middle:
            parts.append(f'<path d="M{"L".join(above + below[::-1])}Z" fill="{colors[name]}" opacity="0.15"/>')
            parts.append(f'<path d="M{"L".join(middle)}" fill="none" stroke="{colors[name]}" stroke-width="1.5"/>')
            for point in middle:
                x, y = point.split()
                parts.append(f'<circle cx="{x}" cy="{y}" r="2" fill="{colors[name]}"/>')
    return parts


def _round_up(value: float) -> float:
    """To a number that reads well."""
    scale = 10.0 ** math.floor(math.log10(max(value, 1e-9)))
    return scale * next(step for step in (1, 2, 4, 6, 8, 10) if scale * step >= value * (1 - 1e-9))
