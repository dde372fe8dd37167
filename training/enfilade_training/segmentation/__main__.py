"""The command line: `python -m enfilade_training.segmentation train configs/segmentation-nyuv2.toml`."""

import argparse
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from ..common import checkpoints, distributed
from ..common import config as settings
from . import evaluate
from .config import Config
from .data import Source, open_source
from .train import train, trained


def main(arguments: list[str] | None = None) -> int:
    """Runs a verb; gives the exit status, which is 2 for what the user can mend."""
    options = _parser().parse_args(arguments)
    try:
        config = settings.read(Config, options.config, options.set)
        with distributed.join(config.device) as replica:
            options.verb(config, options, replica)
    except (ValueError, OSError, checkpoints.CheckpointError, FloatingPointError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


def _train(config: Config, _: argparse.Namespace, replica: distributed.Replica) -> None:
    def say(line: str) -> None:
        if replica.is_first:
            print(line, flush=True)

    scores = train(config, replica, say=say)
    if replica.is_first and scores:
        _show(scores)


def _evaluate(config: Config, options: argparse.Namespace, replica: distributed.Replica) -> None:
    network = trained(config, options.checkpoint or config.output / "last.pt", replica.device)
    scores = evaluate.report(evaluate.evaluate(network, _judged(config), config, replica), config)
    if replica.is_first:
        _show(scores)
        path = config.output / "evaluation.json"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(scores, indent=2) + "\n", encoding="utf-8")


def _predict(config: Config, options: argparse.Namespace, replica: distributed.Replica) -> None:
    source: Source = _Files(options.images) if options.images else _judged(config)
    network = trained(config, options.checkpoint or config.output / "last.pt", replica.device)
    if replica.is_first:
        for path in evaluate.write_pictures(network, source, options.to, config, replica.device, _write):
            print(path)


class _Files:
    """Pictures without classes."""

    def __init__(self, paths: list[Path]):
        self._paths = paths
        named: dict[str, Path] = {}
        for path in paths:
            other = named.setdefault(path.stem, path)
            if other is not path:
                both = f"both would be written to {path.stem}.classes.png"
                raise ValueError(f"{other} and {path}: {both}; rename one, or predict it by itself, to another folder")

    def __len__(self) -> int:
        return len(self._paths)

    def __getitem__(self, index: int) -> tuple[np.ndarray, np.ndarray]:
        image = np.array(Image.open(self._paths[index]).convert("RGB"))
        return image, np.full(image.shape[:2], -1)

    def name(self, index: int) -> str:
        return self._paths[index].stem


def _judged(config: Config) -> Source:
    if config.test_data is None:
        raise ValueError("the settings have no [test_data]; say there what the network is judged by")
    return open_source(config.test_data, config.classes)


def _write(path: Path, values: np.ndarray) -> None:
    Image.fromarray(values).save(path)


def _show(scores: dict[str, Any]) -> None:
    def percent(value: float | None) -> str:
        return "     -" if value is None else f"{100 * value:6.2f}"

    for name, value in scores["iou"].items():
        print(f"{percent(value)}  {name}")
    print(f"{percent(scores['mean_iou'])}  mean IoU\n{percent(scores['pixel_accuracy'])}  pixel accuracy")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m enfilade_training.segmentation", description="Semantic segmentation by a U-Net.")
    verbs = parser.add_subparsers(required=True, metavar="VERB")
    for name, verb, help in (
        ("train", _train, "trains, or goes on with a run that was ended"),
        ("evaluate", _evaluate, "prints the scores on the test data, and writes evaluation.json"),
        ("predict", _predict, "writes the predicted classes as pictures"),
    ):
        command = verbs.add_parser(name, help=help, description=help)
        command.add_argument("config", type=Path, help="settings, a TOML file")
        command.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="another value of a setting, such as train.epochs=2")
        if verb is not _train:
            command.add_argument("--checkpoint", type=Path, help="last.pt of the output folder, unless given")
        if verb is _predict:
            command.add_argument("--to", type=Path, required=True, metavar="FOLDER", help="where pictures are written")
            about = "pictures of different names; those of the test data unless given"
            command.add_argument("--images", type=Path, nargs="+", metavar="FILE", help=about)
        command.set_defaults(verb=verb)
    return parser


if __name__ == "__main__":
    sys.exit(main())
