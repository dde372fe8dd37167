"""The tables of nyuv2.md; what they mean is written by people, in docs/real.md."""

import statistics
from typing import Any, Sequence

import enfilade
import numpy as np

from .config import ARMS, DEPTH, SEMANTICS, SEMANTICS40
from .scores import names

TITLES = {SEMANTICS: "13 classes", SEMANTICS40: "40 classes", DEPTH: "Depth"}
# Title, factor and digits of a score, and whether more is better.
SCORES = {
    "mean_iou": ("mean IoU, %", 100.0, 1, True),
    "pixel_accuracy": ("pixel accuracy, %", 100.0, 1, True),
    "abs_rel": ("AbsRel", 1.0, 3, False),
    "delta1": ("δ1, %", 100.0, 1, True),
    "rmse_m": ("RMSE, m", 1.0, 3, False),
    "abs_rel_aligned": ("AbsRel, aligned", 1.0, 3, False),
    "delta1_aligned": ("δ1, aligned, %", 100.0, 1, True),
    "rmse_m_aligned": ("RMSE, aligned, m", 1.0, 3, False),
}

# So many of the runs that are not there are named on the page.
LISTED = 8


def markdown(found: dict[str, Any]) -> str:
    """The page of a report's JSON."""
    settings, runs = found["settings"], found["runs"]
    counts, tasks = settings["photographs"], settings["tasks"]
    lines = [
        "# Do homes help on photographs?",
        "",
        "Made by `python -m enfilade_training.study training/studies/nyuv2.toml --report docs/benchmarks`; [real.md](../real.md) explains what is",
        f"compared and what it means. NYUv2 at half size has {counts['train']} photographs for training; scores are on {counts['test']}. Values are means over seeds, with the",
        "standard deviation where there are several; 0 % of the photographs is zero-shot. [nyuv2.json](nyuv2.json) has every seed.",
        "",
        "![scores by share of the photographs, and losses](nyuv2.svg)",
    ]
    for task in tasks:
        lines += ["", f"## {TITLES[task]}", "", *_scores([row for row in runs if row["task"] == task], task)]
        lines += _differences([row for row in found["differences"] if row["task"] == task])
        if task == SEMANTICS:
            lines += _classes([row for row in runs if row["task"] == task])
    if found["missing"] or found["without_interval"]:
        lines += ["", "## Not there", ""]
        absent = [*found["missing"], *found["without_interval"]]
        lines += [f"- {line}" for line in absent[:LISTED]]
        if len(absent) > LISTED:
            lines.append(f"- and {len(absent) - LISTED} more, which [nyuv2.json](nyuv2.json) lists")
    return "\n".join([*lines, ""])


def shown(score: str, value: float) -> str:
    """A score in the unit of its title."""
    _, factor, digits, _ = SCORES[score]
    return f"{factor * value:.{digits}f}"


def _scores(runs: list[dict[str, Any]], task: str) -> list[str]:
    titles = " | ".join(SCORES[name][0] for name in names(task))
    lines = [f"| arm | photographs | seeds | {titles} |", "|---|---|---|" + "---|" * len(names(task))]
    for fraction in sorted({row["fraction"] for row in runs}):
        for arm in ARMS:
            rows = [row for row in runs if (row["arm"], row["fraction"]) == (arm, fraction)]
            if rows:
                cells = [_mean_and_spread(name, [row["scores"][name] for row in rows]) for name in names(task)]
                lines.append(f"| {arm} | {100 * fraction:g} % | {len(rows)} | {' | '.join(cells)} |")
    return lines


def _mean_and_spread(name: str, values: Sequence[float]) -> str:
    spread = f" ± {shown(name, statistics.stdev(values))}" if len(values) > 1 else ""
    return shown(name, statistics.fmean(values)) + spread


def _differences(rows: list[dict[str, Any]]) -> list[str]:
    if not rows:
        return []
    lines = ["", "With homes minus without, with 95 % bootstrap intervals over photographs and seeds; percentages in points:", ""]
    lines += ["| start | photographs | score | difference | |", "|---|---|---|---|---|"]
    for row in rows:
        title, factor, digits, more = SCORES[row["score"]]
        mean, low, high = (f"{factor * row[name]:+.{digits}f}" for name in ("mean", "low", "high"))
        verdict = "no difference" if row["low"] <= 0 <= row["high"] else "better" if (row["low"] > 0) == more else "worse"
        lines.append(f"| {row['start']} | {100 * row['fraction']:g} % | {title} | {mean} ({low} to {high}) | {verdict} |")
    return lines


def _classes(runs: list[dict[str, Any]]) -> list[str]:
    """IoU of classes, and the confusion of zero-shot networks."""
    there = {(row["arm"], row["fraction"]) for row in runs}
    shares = dict.fromkeys((0.0, max((fraction for _, fraction in there), default=0.0)))
    columns = [(arm, fraction) for fraction in shares for arm in ARMS if (arm, fraction) in there]
    titles = " | ".join(f"{arm}, {100 * fraction:g} %" for arm, fraction in columns)
    lines = ["", "IoU of classes, %, mean over seeds:", "", f"| class | {titles} |", "|---" * (len(columns) + 1) + "|"]
    for i, name in enumerate(enfilade.NYU13):
        cells = []
        for column in columns:
            values = [row["iou"][i] for row in runs if (row["arm"], row["fraction"]) == column and row["iou"][i] is not None]
            cells.append(f"{100 * statistics.fmean(values):.1f}" if values else "–")
        lines.append(f"| {name} | {' | '.join(cells)} |")
    for arm, fraction in columns[:1] + columns[-1:] if len(columns) > 1 else columns:
        counts = sum(np.array(row["confusion"]) for row in runs if (row["arm"], row["fraction"]) == (arm, fraction))
        lines += ["", f"Predicted classes of the pixels of each class, %, {arm}, {100 * fraction:g} % of the photographs:", "", *confusion(counts)]
    return lines


def confusion(counts: np.ndarray) -> list[str]:
    """A table of NYU13's true classes (rows) by predicted ones, in % of the row. counts: 13 x 13."""
    lines = ["| true | share | " + " | ".join(enfilade.NYU13) + " |", "|---" * 15 + "|"]
    for name, row in zip(enfilade.NYU13, counts):
        cells = [f"{100 * value / max(row.sum(), 1):.0f}" for value in row]
        lines.append(f"| {name} | {100 * row.sum() / max(counts.sum(), 1):.1f} | {' | '.join(cells)} |")
    return lines
