"""What a study found: scores, differences with their intervals, and pictures of them, as Markdown, JSON and SVG.

Scores of an arm and a seed are those of the pixels of all rooms together, each judged by a network that had not seen it. Differences are
between runs of the same seed, so what both have in common drops out; intervals are Student's, at 95 %.
"""

import json
import math
import statistics
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Sequence

import enfilade

from .curves import Curve, svg

# The arms; what they are stands in __main__.py.
SCRATCH, PRETRAINED, LONGER, ALONE = "scratch", "pre-trained", "scratch, longer", "homes alone"
# What is compared: pre-training with both ways to do without it.
PAIRS = ((PRETRAINED, SCRATCH), (PRETRAINED, LONGER))
# 97.5 % quantiles of Student's t distribution with 1, 2, ... degrees of freedom.
STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131)
SCORES = {"mean_iou": "mean IoU", "pixel_accuracy": "pixel accuracy"}


@dataclass(frozen=True)
class Row:
    """What a run's network scored in a room that it had not seen. steps: of this run alone."""

    arm: str
    seed: int
    room: str
    steps: int
    confusion: enfilade.Confusion


@dataclass(frozen=True)
class Found:
    """All that a study found."""

    settings: dict[str, Any]
    rows: list[Row]
    curves: list[Curve]

    @property
    def arms(self) -> list[str]:
        """In the order in which they were run."""
        return list(dict.fromkeys(row.arm for row in self.rows))

    @property
    def seeds(self) -> list[int]:
        return sorted({row.seed for row in self.rows})

    @property
    def rooms(self) -> list[str]:
        return sorted({row.room for row in self.rows})

    def score(self, name: str, arm: str, seeds: Sequence[int], rooms: Sequence[str]) -> float:
        """Of the pixels of these runs and rooms together, 0 to 1."""
        total = None
        for row in self.rows:
            if row.arm == arm and row.seed in seeds and row.room in rooms:
                total = total or enfilade.Confusion(row.confusion.classes)
                total.merge(row.confusion)
        value = getattr(total, name) if total else None
        if value is None:
            raise ValueError(f"{', '.join(rooms)}: no pixel has a class to judge by")
        return value


@dataclass(frozen=True)
class Difference:
    """A mean of paired differences and its 95 % interval."""

    mean: float
    low: float
    high: float

    @property
    def verdict(self) -> str:
        """`higher`, `lower`, or `no difference` where the interval holds zero."""
        return "higher" if self.low > 0 else "lower" if self.high < 0 else "no difference"


def difference(pairs: Sequence[tuple[float, float]]) -> Difference:
    """Of the first of each pair from the second."""
    values = [a - b for a, b in pairs]
    half = student(len(values) - 1) * statistics.stdev(values) / math.sqrt(len(values))
    mean = statistics.fmean(values)
    return Difference(mean, mean - half, mean + half)


def student(degrees: int) -> float:
    """The 97.5 % quantile of Student's t distribution with so many degrees of freedom.

    Beyond the table by Cornish and Fisher's expansion, which is right to 3e-5 there. Abramowitz and Stegun 1964, 26.7.5.
    """
    if degrees <= len(STUDENT):
        return STUDENT[degrees - 1]
    x = statistics.NormalDist().inv_cdf(0.975)
    first, second = (x**3 + x) / 4, (5 * x**5 + 16 * x**3 + 3 * x) / 96
    third = (3 * x**7 + 19 * x**5 + 17 * x**3 - 15 * x) / 384
    return x + first / degrees + second / degrees**2 + third / degrees**3


def over_seeds(found: Found, name: str, arm: str, other: str) -> Difference:
    """What another run of the same rooms would show: a pair for each seed."""
    return difference([(found.score(name, arm, [s], found.rooms), found.score(name, other, [s], found.rooms)) for s in found.seeds])


def over_rooms(found: Found, name: str, arm: str, other: str) -> Difference:
    """What other rooms would show, of which the study's are taken as a sample: a pair for each room, of all seeds together."""
    return difference([(found.score(name, arm, found.seeds, [r]), found.score(name, other, found.seeds, [r])) for r in found.rooms])


def write(found: Found, folder: Path) -> list[Path]:
    """Writes training.md, training.json and training.svg, and gives their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    texts = {"training.md": markdown(found), "training.json": json.dumps(plain(found), indent=1) + "\n", "training.svg": svg(found.curves)}
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    return [folder / name for name in texts]


def plain(found: Found) -> dict[str, Any]:
    """The JSON: settings, a row for each arm and seed, and the differences."""
    rows = []
    for arm in found.arms:
        for seed in found.seeds:
            row: dict[str, Any] = {"arm": arm, "seed": seed, "steps_of_folds": _steps(found, arm)}
            row |= {name: round(found.score(name, arm, [seed], found.rooms), 5) for name in SCORES}
            row["mean_iou_of_rooms"] = {room: round(found.score("mean_iou", arm, [seed], [room]), 5) for room in found.rooms}
            rows.append(row)
    differences = []
    for arm, other in PAIRS:
        for over, of in _OVER.items():
            for name in SCORES:
                value = of(found, name, arm, other)
                numbers = {"mean": round(value.mean, 5), "low": round(value.low, 5), "high": round(value.high, 5)}
                differences.append({"arm": arm, "minus": other, "score": name, "over": over, **numbers, "verdict": value.verdict})
    return {"settings": found.settings, "rows": rows, "differences": differences}


def markdown(found: Found) -> str:
    """The tables of training.md; what they mean is written by people, in docs/training.md."""
    settings, seeds = found.settings, found.seeds
    pictures = settings["images"]
    lines = [
        "# Does pre-training on generated homes help?",
        "",
        "Made by `python -m enfilade_training.study training/studies/transfer.toml`; [training.md](../training.md) says what was compared and what",
        f"it means. {pictures['homes']} pictures of homes, {pictures['rooms']} of {len(found.rooms)} rooms; {len(seeds)} seeds. Scores in %, of all rooms together, each judged by",
        "networks that had not seen it: mean and standard deviation over seeds. [training.json](training.json) has each seed.",
        "",
        "| arm | steps on rooms | mean IoU | pixel accuracy |",
        "|---|---|---|---|",
    ]
    for arm in found.arms:
        scores = [_mean_and_spread([found.score(name, arm, [s], found.rooms) for s in seeds]) for name in SCORES]
        lines.append(f"| {arm} | {_steps_on_rooms(found, arm)} | {' | '.join(scores)} |")
    lines += [
        "",
        "Differences between arms, in points, with 95 % intervals: over seeds, what training again on the same rooms would show; over rooms, what",
        f"other rooms of this kind would show, of which {len(found.rooms)} are a sample.",
        "",
        "| difference | score | over seeds | over rooms |",
        "|---|---|---|---|",
    ]
    for arm, other in PAIRS:
        for name, title in SCORES.items():
            cells = [_interval(of(found, name, arm, other)) for of in _OVER.values()]
            lines.append(f"| {arm} − {other} | {title} | {' | '.join(cells)} |")
    header = [f"| room | {' | '.join(found.arms)} |", "|---" * (len(found.arms) + 1) + "|"]
    lines += ["", "Mean IoU of each room, of the pixels of all seeds together:", "", *header]
    for room in found.rooms:
        lines.append(f"| {room} | " + " | ".join(f"{100 * found.score('mean_iou', arm, seeds, [room]):.1f}" for arm in found.arms) + " |")
    lines += ["", "![losses and scores by epoch](training.svg)", ""]
    return "\n".join(lines)


_OVER: dict[str, Callable[[Found, str, str, str], Difference]] = {"seeds": over_seeds, "rooms": over_rooms}


def _steps_on_rooms(found: Found, arm: str) -> str:
    return "0" if arm == ALONE else " and ".join(map(str, _steps(found, arm)))


def _steps(found: Found, arm: str) -> list[int]:
    """Of the arm's runs of a seed; folds differ where they have different numbers of pictures."""
    return sorted({row.steps for row in found.rows if row.arm == arm})


def _mean_and_spread(values: Sequence[float]) -> str:
    return f"{100 * statistics.fmean(values):.1f} ± {100 * statistics.stdev(values):.1f}"


def _interval(value: Difference) -> str:
    return f"{100 * value.mean:+.1f} ({100 * value.low:+.1f} to {100 * value.high:+.1f}): {value.verdict}"
