"""The runs of a study: which there are, what tells them apart, and how each is made."""

import hashlib
import json
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Callable

import numpy as np

from ..common import checkpoints
from ..common import config as settings
from . import composition, homes
from .config import HOMES, IMAGENET, RANDOM, SEMANTICS40, Study, meaning
from .judge import judge
from .network import UNet
from .photographs import Photographs
from .pictures import Pictures
from .train import Trained, new_network, train

# Raised when runs with the same settings give other scores: no earlier ones count any more.
FORMAT = 1


@dataclass(frozen=True)
class Run:
    """A network that is judged. fraction: share of the training photographs that it has seen, 0 for zero-shot."""

    arm: str
    fraction: float
    seed: int

    @property
    def start(self) -> str:
        """What it starts from, before homes."""
        return IMAGENET if IMAGENET in self.arm else RANDOM

    @property
    def has_homes(self) -> bool:
        """Whether it is trained on homes before photographs."""
        return self.arm in HOMES.values()

    def __str__(self) -> str:
        return f"{self.arm}, {100 * self.fraction:g} % of the photographs, seed {self.seed}"


def all_runs(study: Study) -> list[Run]:
    """Seed by seed, so that a study that is ended early has whole seeds; zero-shot runs, which cost nothing but homes, before others."""
    found = []
    for seed in range(study.seeds):
        found += [Run(arm, 0.0, seed) for arm in study.arms if arm in HOMES.values()]
        found += [Run(arm, fraction, seed) for fraction in study.fractions for arm in study.arms]
    return found


class Maker:
    """Makes runs, and what they need when they need it: photographs, homes, networks trained on homes."""

    def __init__(self, study: Study, say: Callable[[str], None]):
        self.study, self.say = study, say
        self.photographs = Photographs(study.photographs_folder(), study.size, study.output / "packed")
        self._pictures: dict[str, Pictures] = {}

    def key(self, run: Run) -> str:
        """Differs where settings or data of the run do."""
        said: dict[str, Any] = {"format": FORMAT, "start": run.start, "seed": run.seed, "photographs": self.photographs.digest}
        said["homes"] = self._homes_key(run.start, run.seed) if run.has_homes else None
        said["fraction"], said["tuning"] = run.fraction, meaning(self.study, self.study.finetuning) if run.fraction else None
        return _digest(said)

    def finished(self, run: Run) -> dict[str, Any] | None:
        """The run's results, if they are there."""
        path = self.folder(run) / "result.json"
        if not path.is_file():
            return None
        result = json.loads(path.read_text(encoding="utf-8"))
        return result if result["key"] == self.key(run) else None

    def make(self, run: Run) -> dict[str, Any]:
        """The run's results as plain data, by training and judging its network; `images` has what they are made of."""
        study, folder, key = self.study, self.folder(run), self.key(run)
        trained = self.tuned(run) if run.fraction else self.on_homes(run.start, run.seed)
        judged = judge(trained.network, self.pictures("test"), study)
        result = {"key": key, "arm": run.arm, "fraction": run.fraction, "seed": run.seed, "losses": trained.losses, "tasks": {}}
        result |= {"steps": study.finetuning.steps if run.fraction else 0, "pictures": trained.pictures}
        for task, found in judged.items():
            result["tasks"][task] = {"scores": {name: round(value, 5) for name, value in found.scores.items()}}
            if found.confusion is not None:
                result["tasks"][task] |= {"iou": [_rounded(value) for value in found.confusion.iou]}
                # A matrix of 40 classes would make the report ten times as long.
                if task != SEMANTICS40:
                    result["tasks"][task] |= {"confusion": np.array(found.confusion.counts).tolist()}
        folder.mkdir(parents=True, exist_ok=True)
        np.savez_compressed(folder / "images.npz", **{task: found.images for task, found in judged.items()})
        # Whole or not at all, and after all else: it says that the run is finished.
        aside = folder / ".result.json.part"
        aside.write_text(json.dumps(result) + "\n", encoding="utf-8")
        aside.replace(folder / "result.json")
        return result

    def images(self, run: Run) -> dict[str, np.ndarray] | None:
        """By task: what the scores of each image are made of; None of a run that was not made here."""
        path = self.folder(run) / "images.npz"
        if self.finished(run) is None or not path.is_file():
            return None
        with np.load(path, allow_pickle=False) as file:
            return {task: file[task] for task in file.files}

    def folder(self, run: Run) -> Path:
        """Where the run's files are; other settings or data have another folder."""
        return self.study.output / "runs" / f"{run.arm}-{run.fraction:g}-{run.seed}-{self.key(run)}"

    def tuned(self, run: Run) -> Trained:
        """The run's network, trained on its share of the photographs."""
        whole = self.pictures("train")
        chosen = subset(len(whole), run.fraction, run.seed)
        pictures = Pictures(whole.color[chosen], whole.classes40[chosen], whole.depth_m[chosen], [whole.names[i] for i in chosen])

        def begin() -> UNet:
            return self.on_homes(run.start, run.seed).network if run.has_homes else new_network(self.study, run.seed, run.start)

        return train(self.study, self.study.finetuning, run.seed, self.key(run), self.folder(run), pictures, begin, say=self.say)

    def on_homes(self, start: str, seed: int) -> Trained:
        """The network that was trained on homes."""
        study, key = self.study, self._homes_key(start, seed)
        folder = study.output / "pretraining" / f"{study.homes.stem}-{start}-{seed}-{key}"
        last = folder / "last.pt"
        if last.exists():
            state = checkpoints.load(last)
            if (state.get("key"), state.get("step")) == (key, study.pretraining.steps):
                network = UNet(study.heads)
                network.load_state_dict(state["network"])
                return Trained(network, state["losses"], state["pictures"])
        self.say(f"homes, from {start}, seed {seed}")
        begin = lambda: new_network(study, seed, start)  # noqa: E731
        return train(study, study.pretraining, seed, key, folder, self.pictures("homes"), begin, camera=study.camera, say=self.say)

    def pictures(self, name: str) -> Pictures:
        """Of "train", "test" or "homes"."""
        if name not in self._pictures:
            packed = self.study.output / "packed"
            if name == "homes":
                self.say("pictures of homes")
                there = homes.rendered(self.study.homes, self.study.output, self.study.scenes, self.say)
                made = homes.read(there, self.study.size, packed)
                if self.study.composed:
                    made = composition.drawn(made, self.pictures("train"), self.say)
            else:
                made = self.photographs.side(name)
            self._pictures[name] = made
        return self._pictures[name]

    @cached_property
    def _homes_digest(self) -> str:
        return homes.digest(self.study.homes)

    def _homes_key(self, start: str, seed: int) -> str:
        said = {"format": FORMAT, "start": start, "seed": seed, "homes": self._homes_digest, "scenes": self.study.scenes}
        said |= {"camera": settings.to_dict(self.study.camera), "training": meaning(self.study, self.study.pretraining)}
        return _digest(said | ({"composed": [self.photographs.digest, *composition.SETTINGS]} if self.study.composed else {}))


def subset(count: int, fraction: float, seed: int) -> list[int]:
    """The photographs of a share, in ascending order; those of smaller shares are among them."""
    order = np.random.Generator(np.random.PCG64(np.random.SeedSequence([seed, count]))).permutation(count)
    return sorted(int(i) for i in order[: max(1, round(fraction * count))])


def _rounded(value: float | None) -> float | None:
    return None if value is None else round(value, 5)


def _digest(said: dict[str, Any]) -> str:
    return hashlib.sha256(json.dumps(said, sort_keys=True).encode()).hexdigest()[:16]
