"""What homes teach about photographs, without the test photographs: `python -m enfilade_training.study.dial training/studies/nyuv2.toml`

A network that has seen homes alone is judged on the *training* photographs. That is the dial to watch while homes are changed one thing at a
time (`--set homes=other.toml`); the test photographs are for the one final run. Beside the scores it says where homes and photographs differ:
how frequent classes are, what is taken for what, how bright, colourful, busy and deep pictures are, and what it scores where looks or
frequencies are taken out.
"""

import argparse
import json
import sys
from pathlib import Path
from typing import Any

import enfilade
import numpy as np
import torch
from PIL import Image

from ..common import checkpoints
from ..common import config as settings
from ..segmentation.evaluate import colored
from . import gap, tables
from .config import DEPTH, HEADS, IMAGENET, RANDOM, SEMANTICS, Study
from .judge import judge, predict
from .pictures import FARTHEST_M, LUMA, VOID, Pictures, evenly
from .runs import Maker


def main(arguments: list[str] | None = None) -> int:
    """Judges, and prints what it found; gives the exit status, which is 2 for what the user can mend."""
    parser = argparse.ArgumentParser(prog="python -m enfilade_training.study.dial", description="What homes teach about photographs.")
    parser.add_argument("study", type=Path, help="settings, a TOML file such as training/studies/nyuv2.toml")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="another value of a setting, such as homes=other.toml")
    parser.add_argument("--start", choices=(RANDOM, IMAGENET), default=RANDOM, help="what the network starts from before homes")
    parser.add_argument("--seed", type=int, default=0, help="of the network")
    parser.add_argument("--to", type=Path, metavar="FILE", help="writes the numbers as JSON")
    parser.add_argument("--pictures", type=Path, metavar="FOLDER", help="writes pictures of predictions; they show NYUv2's photographs")
    parser.add_argument("--count", type=int, default=16, help="of pictures")
    options = parser.parse_args(arguments)
    try:
        study = settings.read(Study, options.study, options.set)
        torch.set_num_threads(study.threads)
        maker = Maker(study, lambda line: print(line, flush=True))
        network = maker.on_homes(options.start, options.seed).network
        found = report(network, maker.pictures("homes"), maker.pictures("train"), study)
        print("\n".join(lines(found)))
        if options.to:
            whole = {"homes": study.homes.name, "start": options.start, "seed": options.seed} | found
            options.to.write_text(json.dumps(whole) + "\n", encoding="utf-8")
        if options.pictures:
            write_pictures(network, maker.pictures("train"), study, options.pictures, options.count)
    except (ValueError, OSError, checkpoints.CheckpointError, FloatingPointError, enfilade.StageError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


def report(network: torch.nn.Module, homes: Pictures, photographs: Pictures, study: Study) -> dict[str, Any]:
    """Scores on the photographs, and how both kinds of pictures look, as plain data."""
    found: dict[str, Any] = {"looks": {"homes": looks(homes), "photographs": looks(photographs)}, "tasks": {}}
    for task, judged in judge(network, photographs, study).items():
        found["tasks"][task] = {"scores": judged.scores}
        if judged.confusion is not None:
            counts = np.array(judged.confusion.counts)
            found["tasks"][task] |= {"iou": judged.confusion.iou, "confusion": counts.tolist()}
            found["tasks"][task]["share_in_homes"] = gap.rounded_shares(homes, task)
    found["gap"] = gap.cases(network, homes, photographs, {task: of["scores"] for task, of in found["tasks"].items()}, study)
    return found


def looks(pictures: Pictures) -> dict[str, float]:
    """Means over pictures: brightness, its deviation within a picture, saturation, and the step of brightness from pixel to pixel, of 0 to 1;
    median depth, and shares of pixels without class and without depth."""
    color = pictures.color.float() / 255.0
    luma = (color * torch.tensor(LUMA)[:, None, None]).sum(1)
    saturation = (color.amax(1) - color.amin(1)) / color.amax(1).clamp(min=1e-3)
    known = pictures.depth_m[pictures.depth_m > 0].float()
    return {
        "brightness": round(float(luma.mean()), 4),
        "contrast": round(float(luma.flatten(1).std(1).mean()), 4),
        "saturation": round(float(saturation.mean()), 4),
        "step": round(float((luma[:, :, 1:] - luma[:, :, :-1]).abs().mean()), 4),
        "depth_m": round(float(known.median()), 3) if len(known) else 0.0,
        "without_class": round(float((pictures.classes40 == VOID).float().mean()), 4),
        "without_depth": round(float((pictures.depth_m == 0).float().mean()), 4),
    }


def lines(found: dict[str, Any]) -> list[str]:
    """What is printed, as Markdown."""
    made = ["| look | homes | photographs |", "|---|---|---|"]
    made += [f"| {name} | {value} | {found['looks']['photographs'][name]} |" for name, value in found["looks"]["homes"].items()]
    for task, of in found["tasks"].items():
        scores = (f"{tables.SCORES[name][0]} {tables.shown(name, value)}" for name, value in of["scores"].items())
        made += ["", f"{tables.TITLES[task]}: " + ", ".join(scores)]
        if task == SEMANTICS:
            counts = np.array(of["confusion"])
            made += ["", "| class | IoU, % | share in photographs, % | predicted, % | share in homes, % |", "|---|---|---|---|---|"]
            for i, name in enumerate(enfilade.NYU13):
                iou = "–" if of["iou"][i] is None else f"{100 * of['iou'][i]:.1f}"
                true, predicted = (100 * counts.sum(axis)[i] / max(counts.sum(), 1) for axis in (1, 0))
                made.append(f"| {name} | {iou} | {true:.1f} | {predicted:.1f} | {100 * of['share_in_homes'][i]:.1f} |")
            made += ["", *tables.confusion(counts)]
    for task in found["tasks"]:
        titles = [tables.SCORES[name][0] for name in found["tasks"][task]["scores"]]
        made += ["", f"| {tables.TITLES[task]} of | {' | '.join(titles)} |", "|---" * (len(titles) + 1) + "|"]
        for name, of in found["gap"].items():
            if task in of:
                made.append(f"| {name} | {' | '.join(tables.shown(score, value) for score, value in of[task].items())} |")
    return made


def write_pictures(network: torch.nn.Module, pictures: Pictures, study: Study, folder: Path, count: int) -> None:
    """PNG files of evenly chosen pictures: colours, then truth and prediction of each task side by side."""
    folder.mkdir(parents=True, exist_ok=True)
    for index in evenly(len(pictures), count):
        part = slice(index, index + 1)
        predicted = predict(network, pictures, part, study)
        height, width = pictures.depth_m.shape[1:]
        shown = [np.array(Image.fromarray(pictures.color[index].permute(1, 2, 0).numpy()).resize((width, height)))]
        for task in study.tasks:
            if task == DEPTH:
                both = (pictures.depth_m[index].float().numpy(), predicted[task][0])
                shown += [np.repeat((255.0 * np.clip(1.0 - values / FARTHEST_M, 0, 1)).astype(np.uint8)[..., None], 3, axis=2) for values in both]
            else:
                both = (pictures.classes(task, index).numpy(), predicted[task][0])
                shown += [colored(values.astype(np.int64), HEADS[task]) for values in both]
        Image.fromarray(np.concatenate(shown, axis=1)).save(folder / f"{pictures.names[index]}.png")


if __name__ == "__main__":
    sys.exit(main())
