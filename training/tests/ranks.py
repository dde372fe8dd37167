"""Runs a function of a test module on several processes that form a gloo group, as torchrun would start them."""

import os
import pickle
import socket
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent


def run_on_ranks(module: str, function: str, count: int, folder: Path, **arguments: Any) -> list[Any]:
    """The results of `module.function(replica, **arguments)` by rank; `folder` holds what the processes leave."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    (folder / "arguments.pickle").write_bytes(pickle.dumps(arguments))
    processes = []
    for rank in range(count):
        places = {"RANK": rank, "LOCAL_RANK": rank, "WORLD_SIZE": count, "MASTER_ADDR": "127.0.0.1", "MASTER_PORT": port, "OMP_NUM_THREADS": 1}
        environment = os.environ | {key: str(value) for key, value in places.items()}
        environment["PYTHONPATH"] = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH")]))
        command = [sys.executable, "-m", "tests.ranks", module, function, str(folder)]
        processes.append(subprocess.Popen(command, env=environment, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True))
    said = [process.communicate()[0] for process in processes]
    for rank, process in enumerate(processes):
        if process.returncode != 0:
            raise AssertionError(f"rank {rank} failed:\n{said[rank]}")
    return [pickle.loads((folder / f"result.{rank}.pickle").read_bytes()) for rank in range(count)]


def _main(module: str, function: str, folder: str) -> None:
    import importlib

    import torch

    from enfilade_training.common import distributed

    torch.set_num_threads(1)
    with distributed.join("cpu") as replica:
        arguments = pickle.loads((Path(folder) / "arguments.pickle").read_bytes())
        result = getattr(importlib.import_module(module), function)(replica, **arguments)
        (Path(folder) / f"result.{replica.rank}.pickle").write_bytes(pickle.dumps(result))


if __name__ == "__main__":
    _main(*sys.argv[1:])
