"""Does the data help? `python -m enfilade_training.study training/studies/transfer.toml`

A small network is trained on rooms of artists and judged by rooms that it has not seen, in folds, so that every room is judged once for
each seed. Four arms are compared:

- scratch: fine-tuning's steps, from random weights;
- pre-trained: the same steps, on the same images in the same order, from weights that were trained on generated homes;
- scratch, longer: from random weights, as many steps as pre-training and fine-tuning together;
- homes alone: the pre-trained network as it is, which has seen no room.

What is there already is not made again: neither pictures, nor runs that are finished, and others go on where they were.
"""

import argparse
import sys
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Iterator

import enfilade
import torch

from ..common import checkpoints, logs
from ..common import config as settings
from ..common.distributed import Replica
from ..segmentation import evaluate
from ..segmentation.config import Augment, Config, Data, Evaluation, Network, Train
from ..segmentation.data import batches, open_source
from ..segmentation.train import train, trained
from . import report
from .curves import Curve
from .report import ALONE, LONGER, PRETRAINED, SCRATCH, Found, Row


@dataclass(frozen=True)
class Study:
    """What is compared."""

    # Folder of pictures and runs.
    output: Path
    # What `enfilade run` renders: the homes of pre-training, and the rooms.
    homes: Path
    rooms: Path
    # Rooms that are held out together; networks that are judged by them learn from all others.
    folds: tuple[tuple[str, ...], ...]
    # Runs of each arm, with the seeds 0, 1, ...
    seeds: int = 5
    classes: int = 13
    # Threads of torch; results are the same for the same number.
    threads: int = 1
    network: Network = field(default_factory=Network)
    augment: Augment = field(default_factory=Augment)
    pretraining: Train = field(default_factory=Train)
    finetuning: Train = field(default_factory=Train)
    evaluation: Evaluation = field(default_factory=Evaluation)

    def __post_init__(self) -> None:
        if self.seeds < 2:
            raise ValueError(f"seeds is {self.seeds}, expected at least 2")
        rooms = [room for fold in self.folds for room in fold]
        if len(self.folds) < 2 or not all(self.folds) or len(set(rooms)) != len(rooms):
            raise ValueError(f"folds is {[list(fold) for fold in self.folds]}, expected two or more lists of rooms, each room in one")
        if self.pretraining.init_from or self.finetuning.init_from:
            raise ValueError("init_from is given, but what a run begins with is what is studied; leave it out")

    @property
    def all_rooms(self) -> list[str]:
        """Every room, fold by fold."""
        return [room for fold in self.folds for room in fold]


def main(arguments: list[str] | None = None) -> int:
    """Makes pictures, runs and report; gives the exit status, which is 2 for what the user can mend."""
    parser = argparse.ArgumentParser(prog="python -m enfilade_training.study", description="Does pre-training on generated homes help?")
    parser.add_argument("study", type=Path, help="settings, a TOML file such as training/studies/transfer.toml")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="another value of a setting, such as seeds=3")
    parser.add_argument("--report", type=Path, metavar="FOLDER", help="where training.md, .json and .svg are written; the output unless given")
    options = parser.parse_args(arguments)
    try:
        study = settings.read(Study, options.study, options.set)
        found = run(study, lambda line: print(line, flush=True))
        for path in report.write(found, options.report or study.output):
            print(path)
    except (ValueError, OSError, checkpoints.CheckpointError, FloatingPointError, enfilade.StageError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


def run(study: Study, say: Any = lambda _: None) -> Found:
    """Renders, trains and judges."""
    torch.set_num_threads(study.threads)
    for name, file in (("homes", study.homes), ("rooms", study.rooms)):
        say(f"pictures of {name}")
        enfilade.run(study.output / name, enfilade.Config.read(file))
    replica = Replica(0, 1, torch.device("cpu"))
    rows, curves = [], []
    for seed in range(study.seeds):
        for arm, fold, config in runs(study, seed):
            say(f"seed {seed}, {arm}" + ("" if fold is None else f", fold {fold + 1} of {len(study.folds)}"))
            train(config, replica)
            curves.append(Curve(arm, seed, fold, logs.read(config.output / "metrics.jsonl")))
            judged, name = (study.all_rooms, ALONE) if fold is None else (study.folds[fold], arm)
            rows += [_judge(study, config, replica, seed, name, room) for room in judged]
    return Found(_described(study), rows, curves)


def runs(study: Study, seed: int) -> Iterator[tuple[str, int | None, Config]]:
    """The runs of a seed: their arm, their fold, which pre-training has none of, and their settings."""
    folder = study.output / f"seed_{seed}"
    homes = Data("enfilade", study.output / "homes")
    before = _config(study, folder / "homes", seed, homes, None, study.pretraining)
    yield ALONE, None, before
    for i, fold in enumerate(study.folds):
        learnt = Data("enfilade", study.output / "rooms", scenes=tuple(room for room in study.all_rooms if room not in fold))
        judged = replace(learnt, scenes=fold)
        tuning = study.finetuning
        more = -(-_steps(before) // _per_epoch(learnt, tuning, study.classes))
        for arm, recipe in (
            (SCRATCH, tuning),
            (PRETRAINED, replace(tuning, init_from=before.output / "last.pt")),
            (LONGER, replace(tuning, epochs=tuning.epochs + more)),
        ):
            yield arm, i, _config(study, folder / f"{arm.replace(', ', '-')}.{i}", seed, learnt, judged, recipe)


def _config(study: Study, output: Path, seed: int, learnt: Data, judged: Data | None, recipe: Train) -> Config:
    return Config(
        output=output,
        train_data=learnt,
        test_data=judged,
        classes=study.classes,
        seed=seed,
        device="cpu",
        network=study.network,
        augment=study.augment,
        train=recipe,
        evaluation=study.evaluation,
    )


def _per_epoch(data: Data, recipe: Train, classes: int) -> int:
    return len(batches(0, 0, len(open_source(data, classes)), recipe.batch_size, recipe.drop_last))


def _steps(config: Config) -> int:
    return config.train.epochs * _per_epoch(config.train_data, config.train, config.classes)


def _judge(study: Study, config: Config, replica: Replica, seed: int, arm: str, room: str) -> Row:
    data = Data("enfilade", study.output / "rooms", scenes=(room,))
    network = trained(config, config.output / "last.pt", replica.device)
    confusion = evaluate.evaluate(network, open_source(data, study.classes), config, replica)
    return Row(arm, seed, room, _steps(config), confusion)


def _described(study: Study) -> dict[str, Any]:
    """The settings that a result depends on, without places on a machine."""
    plain = settings.to_dict(study)
    for place in ("output", "homes", "rooms", "evaluation"):
        del plain[place]
    rooms = Data("enfilade", study.output / "rooms", scenes=tuple(study.all_rooms))
    counts = {"homes": len(open_source(replace(rooms, path=study.output / "homes", scenes=()), study.classes)), "rooms": len(open_source(rooms, study.classes))}
    return {"images": counts, **plain}


if __name__ == "__main__":
    sys.exit(main())
