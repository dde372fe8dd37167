"""Arrays from Python's pickles, in which others publish weights, without running what such a file may ask for.

A pickle is a program that may call any function that it names. Here it may name those that make numpy's arrays, and no other.
"""

import collections
import pickle
from pathlib import Path
from typing import Any

import numpy as np

from .checkpoints import CheckpointError


def load(path: Path) -> dict[str, Any]:
    """The dictionary in a pickle; texts of Python 2 are read as Latin-1."""
    try:
        with path.open("rb") as file:
            found = _Arrays(file, encoding="latin1").load()
    except FileNotFoundError as error:
        raise CheckpointError(f"{path}: there is no such file") from error
    except OSError as error:
        raise CheckpointError(f"{path}: cannot be read ({error.strerror})") from error
    except Exception as error:  # What a damaged pickle raises depends on where it is damaged.
        raise CheckpointError(
            f"{path}: is refused, or damaged ({error}); expected a pickle of numpy's arrays, such as Detectron2 publishes"
        ) from error
    if not isinstance(found, dict):
        raise CheckpointError(f"{path}: holds {type(found).__name__}, expected a dictionary of numpy's arrays")
    return found


class _Arrays(pickle.Unpickler):
    def find_class(self, module: str, name: str) -> Any:
        try:
            return _KNOWN[module, name]
        except KeyError:
            raise pickle.UnpicklingError(f"it asks for {module}.{name}, which could run code") from None


def _latin1(text: str, encoding: str) -> bytes:
    """How Python 3 writes bytes into old forms of pickles."""
    if encoding != "latin1":
        raise pickle.UnpicklingError(f"it has bytes in the encoding {encoding!r}, expected 'latin1'")
    return text.encode("latin1")


# What makes arrays, under the names of numpy 1 and 2.
_MAKERS = {
    ("multiarray", "_reconstruct"): np.zeros(0).__reduce__()[0],
    ("multiarray", "scalar"): np.float64(0).__reduce__()[0],
    ("numeric", "_frombuffer"): np.zeros(1).__reduce_ex__(5)[0],
}
_KNOWN = {(f"numpy.{core}.{module}", name): maker for core in ("core", "_core") for (module, name), maker in _MAKERS.items()}
_KNOWN |= {
    ("numpy", "ndarray"): np.ndarray,
    ("numpy", "dtype"): np.dtype,
    ("collections", "OrderedDict"): collections.OrderedDict,
    ("_codecs", "encode"): _latin1,
}
