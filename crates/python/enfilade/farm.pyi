"""The types of the module `enfilade.farm`. What each function does is in its doc string: `help(enfilade.farm.plan)`."""

from collections.abc import Sequence
from os import PathLike
from typing import Any, Literal

from . import Config

Path = str | PathLike[str]
Price = float | Path

def plan(
    job: Path,
    config: Config | None = None,
    *,
    # options: PlanOptions
    minutes: float = 15.0,
    cpus: int = 8,
    # end of options
    price: Price | None = None,
) -> dict[str, Any]: ...
def submit(
    job: Path,
    engine: Literal["slurm", "kubernetes", "aws-batch", "openjd"],
    *,
    # options: SubmitOptions
    dry_run: bool = False,
    program: str | None = None,
    at_once: int | None = None,
    memory_mib: int | None = None,
    minutes: int | None = None,
    array_limit: int = 1000,
    collect: Path | None = None,
    image: str | None = None,
    queue: str | None = None,
    definition: str | None = None,
    # end of options
    output: Path = ".",
) -> dict[str, list[str]]: ...
def work(
    job: Path, tasks: int | str | Sequence[int] | None = None, *, shard: tuple[int, int] | None = None, scratch: Path | None = None
) -> list[dict[str, Any]]: ...
def status(job: Path) -> dict[str, Any]: ...
def collect(job: Path, output: Path) -> dict[str, Any]: ...
def statistics(job: Path, *, price: Price | None = None, table: Path | None = None) -> dict[str, Any]: ...
