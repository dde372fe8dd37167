"""What the study found, as nyuv2.json, nyuv2.md, nyuv2.svg, and nyuv2.npz with what each photograph scored."""

import hashlib
import json
from collections import defaultdict
from pathlib import Path
from typing import Any, Sequence
from zipfile import BadZipFile

import numpy as np

from ..common import config as settings
from . import scores, tables
from .config import DEPTH, HOMES, SEMANTICS, Study
from .curves import Panel, Series, svg
from .runs import Maker, Run, all_runs

# A result of Maker.make, by run.
Results = dict[Run, dict[str, Any]]
# By task: what the scores of each photograph are made of.
Images = dict[str, np.ndarray]


class ReportError(ValueError):
    """An earlier report that cannot be read."""


class Earlier:
    """An earlier nyuv2.json, whose runs count as finished where their keys are those of the study's, and the nyuv2.npz beside it, if there."""

    def __init__(self, path: Path | None):
        self._runs: dict[str, dict[str, Any]] = {}
        self._differences: dict[tuple[str, str], list[dict[str, Any]]] = defaultdict(list)
        self._images: dict[str, Images] = defaultdict(dict)
        if path is None:
            return
        try:
            found = json.loads(path.read_text(encoding="utf-8"))
            for row in found["runs"]:
                new = {name: row[name] for name in ("key", "arm", "fraction", "seed", "steps", "pictures")} | {"losses": [], "tasks": {}}
                result = self._runs.setdefault(row["key"], new)
                result["tasks"][row["task"]] = {name: row[name] for name in ("scores", "iou", "confusion") if name in row}
                _merge(result["losses"], row["task"], row["losses"])
            for row in found["differences"]:
                self._differences[row["key"], row["task"]].append(row)
        except OSError as error:
            raise ReportError(f"{path}: cannot be read ({error.strerror}); --scores names the nyuv2.json of an earlier report") from error
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise ReportError(f"{path}: is no report of this study ({error!r}); --scores names the nyuv2.json of an earlier one") from error
        self._read_images(path.with_suffix(".npz"))

    def _read_images(self, path: Path) -> None:
        if not path.is_file():
            return
        try:
            with np.load(path, allow_pickle=False) as file:
                keys = file["keys"].tolist()
                for task in set(file.files) - {"keys"}:
                    for key, values in zip(keys, np.moveaxis(file[task], -1, 0), strict=True):
                        self._images[key][task] = values.astype(np.float64)
        except (OSError, ValueError, KeyError, BadZipFile) as error:
            advice = "fetch it again, or move it away to do without: differences that need it have no interval then"
            raise ReportError(f"{path}: is no file of photographs' scores ({error}); {advice}") from error

    def result(self, key: str, tasks: Sequence[str]) -> dict[str, Any] | None:
        """The run of that key, if it has all tasks."""
        found = self._runs.get(key)
        return found if found and set(tasks) <= set(found["tasks"]) else None

    def differences(self, key: str, task: str) -> list[dict[str, Any]]:
        """The rows of that key and task."""
        return self._differences[key, task]

    def images(self, key: str) -> Images | None:
        """What the photographs scored in the run of that key, if that is known."""
        return self._images.get(key)


def write(study: Study, maker: Maker, results: Results, earlier: Earlier, folder: Path) -> list[Path]:
    """Writes nyuv2.json, .md, .svg and .npz into a folder, and gives their paths."""
    images = _images(maker, results, earlier)
    found = plain(study, maker, results, earlier, images)
    folder.mkdir(parents=True, exist_ok=True)
    texts = {"nyuv2.json": _json(found), "nyuv2.md": tables.markdown(found), "nyuv2.svg": svg(_panels(found))}
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    np.savez_compressed(folder / "nyuv2.npz", allow_pickle=False, **_packed(study, results, images))
    return [folder / name for name in (*texts, "nyuv2.npz")]


def plain(study: Study, maker: Maker, results: Results, earlier: Earlier, images: dict[Run, Images]) -> dict[str, Any]:
    """The JSON: settings, a row for each run and task, the differences that homes make, and runs that are not there."""
    rows = []
    for run, result in results.items():
        for task in study.tasks:
            row = {name: result[name] for name in ("arm", "fraction", "seed")} | {"task": task} | result["tasks"][task]
            losses = [[step, loss[task]] for step, loss in result["losses"]]
            rows.append(row | {"steps": result["steps"], "pictures": result["pictures"], "losses": losses, "key": result["key"]})
    found: dict[str, Any] = {"settings": _described(study, maker), "runs": rows, "differences": [], "without_interval": []}
    for start, homes in HOMES.items():
        for fraction in study.fractions:
            pairs = [(Run(homes, fraction, seed), Run(start, fraction, seed)) for seed in range(study.seeds)]
            there = [pair for pair in pairs if all(run in results for run in pair)]
            if there:
                _add_differences(found, study, results, earlier, images, start, fraction, there)
    found["missing"] = [str(run) for run in all_runs(study) if run not in results]
    return found


def _add_differences(
    found: dict[str, Any], study: Study, results: Results, earlier: Earlier, images: dict[Run, Images],
    start: str, fraction: float, pairs: list[tuple[Run, Run]],
) -> None:  # fmt: skip
    key = hashlib.sha256(json.dumps([[results[run]["key"] for run in pair] for pair in pairs] + [study.resamples]).encode()).hexdigest()[:16]
    of_pairs = [[images.get(run) for run in pair] for pair in pairs]
    for task in study.tasks:
        if known := earlier.differences(key, task):
            found["differences"] += known
        elif all(one and task in one for pair in of_pairs for one in pair):
            arm, other = ([pair[i][task] for pair in of_pairs] for i in (0, 1))  # type: ignore[index]
            for name, value in scores.differences(task, arm, other, study.resamples).items():
                row = {"start": start, "fraction": fraction, "task": task, "score": name, "seeds": [a.seed for a, _ in pairs]}
                row |= {bound: round(getattr(value, bound), 5) for bound in ("mean", "low", "high")}
                found["differences"].append(row | {"key": key})
        else:
            reason = "not all of its runs were made here, and the earlier report has no nyuv2.npz beside it that has them"
            found["without_interval"].append(f"{task} from {start}, {100 * fraction:g} %: {reason}")


def _images(maker: Maker, results: Results, earlier: Earlier) -> dict[Run, Images]:
    """What the photographs scored in each run of which it is known."""
    found = {run: maker.images(run) or earlier.images(result["key"]) for run, result in results.items()}
    return {run: images for run, images in found.items() if images is not None}


def _packed(study: Study, results: Results, images: dict[Run, Images]) -> dict[str, np.ndarray]:
    """What nyuv2.npz holds: the keys of the runs, and for each task an array whose last axis is these runs, so that what is the same in all of
    them takes no place. Counts of pixels are whole, scores of depth in single precision."""
    known = [run for run, of in images.items() if set(study.tasks) <= set(of)]
    packed = {"keys": np.array([results[run]["key"] for run in known], dtype=str)}
    for task in study.tasks if known else ():
        values = np.stack([images[run][task] for run in known], axis=-1)
        fits = values.max() <= np.iinfo(np.uint16).max
        packed[task] = values.astype(np.float32 if task == DEPTH else np.uint16 if fits else np.uint32)
    return packed


def _described(study: Study, maker: Maker) -> dict[str, Any]:
    """The settings that a result depends on, without places on a machine."""
    described = settings.to_dict(study)
    for place in ("output", "photographs", "homes", "threads", "device"):
        del described[place]
    counts = {side: len(names) for side, names in maker.photographs.split.items()}
    return described | {"photographs": counts, "dataset_of_homes": study.homes.name}


def _merge(losses: list[list[Any]], task: str, found: list[list[Any]]) -> None:
    if not losses:
        losses += [[step, {}] for step, _ in found]
    for entry, (_, loss) in zip(losses, found):
        entry[1][task] = loss


def _json(found: dict[str, Any]) -> str:
    """A line for each row."""
    parts = [f' "settings": {json.dumps(found["settings"])}']
    for name in ("runs", "differences", "without_interval", "missing"):
        lines = ",\n".join("  " + json.dumps(row) for row in found[name])
        parts.append(f' "{name}": [\n{lines}\n ]' if lines else f' "{name}": []')
    return "{\n" + ",\n".join(parts) + "\n}\n"


def _panels(found: dict[str, Any]) -> list[Panel]:
    shown = [
        (SEMANTICS, "mean_iou", "13 classes: mean IoU, %", 100.0),
        (DEPTH, "delta1", "depth: δ1, %", 100.0),
        (DEPTH, "abs_rel", "depth: AbsRel", 1.0),
    ]
    panels = []
    for task, score, title, factor in shown:
        series: dict[str, Series] = defaultdict(lambda: defaultdict(list))
        for row in found["runs"]:
            if row["task"] == task:
                series[row["arm"]][100.0 * row["fraction"]].append(factor * row["scores"][score])
        if series:
            panels.append(Panel(title, "photographs, %", series))
    whole = max(found["settings"]["fractions"])
    for title, fraction in (("loss on homes", 0.0), (f"loss on {100 * whole:g} % of the photographs", whole)):
        for task in (SEMANTICS, DEPTH):
            losses: dict[str, Series] = defaultdict(lambda: defaultdict(list))
            for row in found["runs"]:
                if (row["task"], row["fraction"]) == (task, fraction):
                    for step, loss in row["losses"]:
                        losses[row["arm"]][step].append(loss)
            if losses:
                panels.append(Panel(f"{title}: {task}", "steps", losses))
    return panels
