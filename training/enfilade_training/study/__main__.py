"""Do homes help on photographs? `ENFILADE_REAL=nyuv2 python -m enfilade_training.study training/studies/nyuv2.toml`

Networks learn classes and depth from NYUv2's training photographs and are judged on its test photographs. They start from random weights or
ImageNet's, with and without training on rendered homes before, and learn from shares of the photographs. docs/real.md is the protocol.

What is there already is not made again: neither homes, nor runs that are finished, and others go on where they were.
"""

import argparse
import sys
from pathlib import Path
from typing import Callable

import enfilade
import torch

from ..common import checkpoints
from ..common import config as settings
from . import drawing, report
from .config import Study
from .runs import Maker, Run, all_runs


def main(arguments: list[str] | None = None) -> int:
    """Makes homes, runs and report; gives the exit status, which is 2 for what the user can mend."""
    parser = argparse.ArgumentParser(prog="python -m enfilade_training.study", description="Do homes help on photographs?")
    parser.add_argument("study", type=Path, help="settings, a TOML file such as training/studies/nyuv2.toml")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="another value of a setting, such as seeds=5")
    about = "makes these runs alone: arm=homes,random or fraction=0.25 or seed=0"
    parser.add_argument("--only", action="append", default=[], metavar="KEY=VALUES", help=about)
    about = "the nyuv2.json of an earlier report, whose runs are not made again where settings and data are the same"
    parser.add_argument("--scores", type=Path, metavar="FILE", help=about)
    parser.add_argument("--threads", type=int, metavar="N", help="threads of torch, as --set threads=N")
    about = "where nyuv2.json, .md, .svg, .npz and .png are written; the output unless given"
    parser.add_argument("--report", type=Path, metavar="FOLDER", help=about)
    options = parser.parse_args(arguments)
    overrides = options.set + ([f"threads={options.threads}"] if options.threads is not None else [])
    try:
        study = settings.read(Study, options.study, overrides)
        earlier = report.Earlier(options.scores)
        chosen = only(all_runs(study), options.only)
        for path in run(study, chosen, earlier, options.report or study.output, lambda line: print(line, flush=True)):
            print(path)
    except (ValueError, OSError, checkpoints.CheckpointError, FloatingPointError, enfilade.StageError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


def run(study: Study, chosen: list[Run], earlier: report.Earlier, folder: Path, say: Callable[[str], None] = lambda _: None) -> list[Path]:
    """Makes the runs, and writes the report of all that are finished; gives the paths of its files."""
    torch.set_num_threads(study.threads)
    maker, results = Maker(study, say), {}
    for one in all_runs(study):
        known = earlier.result(maker.key(one), study.tasks) or maker.finished(one)
        if known is None and one in chosen:
            say(str(one))
            known = maker.make(one)
            for task, of in known["tasks"].items():
                say(f"  {task}: " + ", ".join(f"{name} {value:.4f}" for name, value in of["scores"].items()))
        if known is not None:
            results[one] = known
    return report.write(study, maker, results, earlier, folder) + drawing.write(study, maker, folder)


def only(runs: list[Run], filters: list[str]) -> list[Run]:
    """The runs that all filters let through."""
    kinds = {"arm": str, "fraction": float, "seed": int}
    for text in filters:
        name, _, values = text.partition("=")
        try:
            allowed = {kinds[name](value) for value in values.split(",")}
        except (KeyError, ValueError) as error:
            expected = "arm=, fraction= or seed= and values with commas between, such as --only arm=random,homes"
            raise ValueError(f"--only {text}: expected {expected}") from error
        there = {getattr(one, name) for one in runs}
        if allowed - there:
            raise ValueError(f"--only {text}: the study has no {name} {min(allowed - there)}, but {', '.join(map(str, sorted(there)))}")
        runs = [one for one in runs if getattr(one, name) in allowed]
    return runs


if __name__ == "__main__":
    sys.exit(main())
