"""Losses and scores by epoch as an SVG: the mean over runs, and a band from the least to the greatest."""

import math
import statistics
from collections import defaultdict
from dataclasses import dataclass
from typing import Any, Sequence
from xml.sax.saxutils import escape

# Sizes of a panel, and what is left beside it for numbers, in pixels.
WIDTH, HEIGHT, LEFT, TOP, GAP = 260, 200, 44, 44, 62
COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00")  # Okabe and Ito's, which the colour-blind can tell apart.


@dataclass(frozen=True)
class Curve:
    """The lines of a run's `metrics.jsonl`. fold: none for runs that learn from homes."""

    arm: str
    seed: int
    fold: int | None
    lines: list[dict[str, Any]]


# Epochs finished, and a value of each run at each.
Series = dict[int, list[float]]


def svg(curves: Sequence[Curve]) -> str:
    """Three panels: losses of pre-training, losses on rooms, and the mean IoU in rooms that were held out."""
    on_homes, on_rooms = ([c for c in curves if (c.fold is None) == alone] for alone in (True, False))
    panels = [
        ("homes: training loss", _series(on_homes, "epoch", "loss")),
        ("rooms: training loss", _series(on_rooms, "epoch", "loss")),
        ("held-out rooms: mean IoU", _series(on_rooms, "test", "mean_iou")),
    ]
    arms = list(dict.fromkeys(curve.arm for curve in curves))
    colors = {arm: COLORS[i % len(COLORS)] for i, arm in enumerate(arms)}
    width, height = LEFT + len(panels) * (WIDTH + GAP), TOP + HEIGHT + 34
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="11">',
        '<rect width="100%" height="100%" fill="white"/>',
    ]
    for i, (title, series) in enumerate(panels):
        parts += _panel(LEFT + i * (WIDTH + GAP), title, series, colors)
    for i, arm in enumerate(arms):
        x = LEFT + i * 130
        parts.append(f'<path d="M{x} 12h18" stroke="{colors[arm]}" stroke-width="2"/><text x="{x + 23}" y="16">{escape(arm)}</text>')
    return "\n".join([*parts, "</svg>", ""])


def _series(curves: Sequence[Curve], kind: str, name: str) -> dict[str, Series]:
    """By arm. An arm's value at an epoch is there where all of its runs have one; epochs of folds have different numbers of steps."""
    found: dict[str, Series] = defaultdict(lambda: defaultdict(list))
    runs: dict[str, int] = defaultdict(int)
    for curve in curves:
        runs[curve.arm] += 1
        for line in curve.lines:
            if line["kind"] == kind and line.get(name) is not None:
                # A line of losses tells the epoch that it is of, one of scores how many are finished.
                finished = line["epoch"] + (kind == "epoch")
                found[curve.arm][finished].append(line[name])
    return {arm: {epoch: values for epoch, values in sorted(of.items()) if len(values) == runs[arm]} for arm, of in found.items()}


def _panel(left: float, title: str, series: dict[str, Series], colors: dict[str, str]) -> list[str]:
    values = [value for of in series.values() for at in of.values() for value in at]
    # Up to a number that four lines divide.
    most = 4 * math.ceil(max((epoch for of in series.values() for epoch in of), default=1) / 4)
    top = _round_up(max(values, default=1.0))

    def place(epoch: float, value: float) -> str:
        return f"{left + WIDTH * epoch / most:.1f} {TOP + HEIGHT * (1 - value / top):.1f}"

    parts = [f'<text x="{left}" y="{TOP - 8}" font-weight="bold">{escape(title)}</text>']
    for i in range(5):
        y, x = TOP + HEIGHT * i / 4, left + WIDTH * i / 4
        parts.append(f'<path d="M{left} {y}h{WIDTH}M{x} {TOP}v{HEIGHT}" stroke="#ddd"/>')
        parts.append(f'<text x="{left - 4}" y="{y + 4}" text-anchor="end">{top * (4 - i) / 4:.3g}</text>')
        parts.append(f'<text x="{x}" y="{TOP + HEIGHT + 15}" text-anchor="middle">{most * i / 4:g}</text>')
    parts.append(f'<text x="{left + WIDTH / 2}" y="{TOP + HEIGHT + 29}" text-anchor="middle">epochs</text>')
    for arm, of in series.items():
        upper = [place(epoch, max(at)) for epoch, at in of.items()]
        lower = [place(epoch, min(at)) for epoch, at in of.items()]
        middle = [place(epoch, statistics.fmean(at)) for epoch, at in of.items()]
        if middle:
            parts.append(f'<path d="M{"L".join(upper + lower[::-1])}Z" fill="{colors[arm]}" opacity="0.15"/>')
            parts.append(f'<path d="M{"L".join(middle)}" fill="none" stroke="{colors[arm]}" stroke-width="1.5"/>')
    return parts


def _round_up(value: float) -> float:
    """To a number that reads well."""
    scale = 10.0 ** math.floor(math.log10(max(value, 1e-9)))
    return scale * next(step for step in (1, 2, 4, 6, 8, 10) if scale * step >= value * (1 - 1e-9))
