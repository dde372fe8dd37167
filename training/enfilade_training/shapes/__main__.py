"""`python -m enfilade_training.shapes train|evaluate|predict config.toml`."""

import argparse
import json
import logging
import sys
from pathlib import Path

from ..common import checkpoints, config as settings, distributed, logs
from .config import Config
from .data import DataError
from .evaluate import evaluate
from .predict import predict
from .train import LAST, TrainingError, train


def main(arguments: list[str] | None = None) -> int:
    """Gives the exit code: 0, 1 when a file or a run is at fault, 2 when the command or its settings are."""
    parser = argparse.ArgumentParser(prog="python -m enfilade_training.shapes", description="3D shape prediction: Mesh R-CNN on Pix3D's layout.")
    verbs = parser.add_subparsers(dest="verb", required=True)
    for verb, about in (
        ("train", "train, or go on with a run, and evaluate it where data.evaluate is given"),
        ("evaluate", "AP of boxes, masks and meshes of a checkpoint"),
        ("predict", "the objects of one image as OBJ files"),
    ):
        command = verbs.add_parser(verb, help=about, description=about)
        command.add_argument("config", type=Path, help="a TOML file, such as those of training/configs")
        command.add_argument("--set", action="append", default=[], metavar="TABLE.KEY=VALUE", help="another value for a setting")
        if verb != "train":
            command.add_argument("--checkpoint", type=Path, help=f"unless given, {LAST} in the output folder")
        if verb == "predict":
            command.add_argument("--image", type=Path, required=True)
            command.add_argument("--focal", type=float, help="focal length in pixels; unless given, the image's longer side")
            command.add_argument("--score", type=float, default=0.5, help="detections below this are not written")
            command.add_argument("-o", "--output", type=Path, required=True, help="the folder to write")
    options = parser.parse_args(arguments)
    logging.basicConfig(level=logging.INFO, format="%(message)s", stream=sys.stderr)
    try:
        config = settings.read(Config, options.config, options.set)
        _check(config, options.verb)
        with distributed.join(config.train.device) as replica:
            _run(config, options, replica)
    except (settings.ConfigError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1 if isinstance(error, DataError) else 2
    except (checkpoints.CheckpointError, TrainingError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


def _check(config: Config, verb: str) -> None:
    if verb == "train" and not config.data.train:
        raise settings.ConfigError("data.train is empty; name a file of enfilade export --format pix3d or enfilade import")
    if verb == "evaluate" and config.data.evaluate is None:
        raise settings.ConfigError("data.evaluate is not given; name a file of enfilade export --format pix3d or enfilade import")


def _run(config: Config, options: argparse.Namespace, replica: distributed.Replica) -> None:
    if options.verb == "predict":
        checkpoint = options.checkpoint or config.output / LAST
        objects = predict(config, replica, checkpoint, options.image, options.focal, options.output, options.score)
        print(f"{options.output}: {len(objects)} objects")
        return
    checkpoint = train(config, replica) if options.verb == "train" else options.checkpoint or config.output / LAST
    if config.data.evaluate is None:
        return
    found = evaluate(config, replica, checkpoint)
    if replica.is_first:
        text = json.dumps(found, indent=1)
        (config.output / "evaluation.json").write_text(text + "\n", encoding="utf-8")
        if options.verb == "train":
            with logs.Logs(config.output, config.train.iterations) as writer:
                writer.write("evaluate", config.train.iterations, {name: found[name] for name in ("box_ap", "mask_ap", "mesh_ap")})
        print(text)


if __name__ == "__main__":
    sys.exit(main())
