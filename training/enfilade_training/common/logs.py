"""What a run reports: TensorBoard's files, and the same numbers as JSON lines that every tool reads."""

import json
from pathlib import Path
from typing import Any, Mapping

import torch
from torch.utils.tensorboard import SummaryWriter


class Logs:
    """Writes `tensorboard/` and `metrics.jsonl` into a folder.

    step: batches finished so far. Entries of a former run beyond it are dropped, so that a resumed run's file equals that of an
    uninterrupted one. Lines carry no times; speed goes to TensorBoard alone.
    """

    def __init__(self, folder: Path, step: int = 0):
        folder.mkdir(parents=True, exist_ok=True)
        self._path = folder / "metrics.jsonl"
        _keep_until(self._path, step)
        self._file = self._path.open("a", encoding="utf-8")
        self._writer = SummaryWriter(str(folder / "tensorboard"), purge_step=step + 1 if step else None)

    def __enter__(self) -> "Logs":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def write(self, kind: str, step: int, values: Mapping[str, Any]) -> None:
        """A line `{"kind": ..., "step": ..., **values}`; its numbers become the scalars `kind/name`."""
        self._file.write(json.dumps({"kind": kind, "step": step, **values}) + "\n")
        self._file.flush()
        for name, value in values.items():
            if isinstance(value, int | float) and not isinstance(value, bool):
                self._writer.add_scalar(f"{kind}/{name}", value, step)

    def scalar(self, name: str, step: int, value: float) -> None:
        """A number for TensorBoard alone, such as speed."""
        self._writer.add_scalar(name, value, step)

    def picture(self, name: str, step: int, image: torch.Tensor) -> None:
        """A picture for TensorBoard: uint8, 3 x height x width."""
        self._writer.add_image(name, image, step)

    def close(self) -> None:
        """Writes what is left."""
        self._file.close()
        self._writer.close()


def read(path: Path) -> list[dict[str, Any]]:
    """The lines of a `metrics.jsonl`."""
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def _keep_until(path: Path, step: int) -> None:
    if not path.is_file():
        return
    kept = []
    for line in path.read_text(encoding="utf-8").splitlines():
        try:
            entry = json.loads(line)
        except json.JSONDecodeError:
            continue  # A line that was being written when the run was ended.
        if entry["step"] <= step:
            kept.append(line + "\n")
    path.write_text("".join(kept), encoding="utf-8")
