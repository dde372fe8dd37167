"""The objects of one image as OBJ files."""

import json
from pathlib import Path
from typing import Any

import enfilade
import torch

from ..common import distributed
from .config import Config
from .data import read_image
from .evaluate import placed, restored


def predict(
    config: Config, replica: distributed.Replica, checkpoint: Path, image: Path, focal: float | None, output: Path, score: float
) -> list[dict[str, Any]]:
    """Writes `NN_category.obj` for each detection from `score` on, and `objects.json`.

    focal: focal length in pixels; unless given, the longer side of the image, an angle of 53 degrees. Camera space is x left, y up,
    z forward, and the middle of every object is 1 deep, since one image does not tell.
    """
    pixels = torch.from_numpy(read_image(image))
    height, width = pixels.shape[1:]
    focal = focal or float(max(height, width))
    network = restored(config, checkpoint).to(replica.device).eval()
    with torch.inference_mode():
        found = network([pixels.to(replica.device)])[0]
    found = {key: value.cpu() if isinstance(value, torch.Tensor) else value for key, value in found.items()}
    found["meshes"] = [(vertices.cpu(), faces.cpu()) for vertices, faces in found["meshes"]]
    output.mkdir(parents=True, exist_ok=True)
    objects = []
    for i in range(len(found["boxes"])):
        if found["scores"][i] < score:
            continue
        vertices, faces = placed(found, i, torch.tensor(1.0), focal, (height, width))
        category = enfilade.PIX3D_CATEGORIES[int(found["labels"][i]) - 1]
        name = f"{len(objects):02}_{category}.obj"
        lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in vertices.tolist()]
        lines += [f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist()]
        (output / name).write_text("\n".join(lines) + "\n", encoding="utf-8")
        box = [round(v, 2) for v in found["boxes"][i].tolist()]
        objects.append({"mesh": name, "category": category, "score": round(float(found["scores"][i]), 4), "box": box})
    (output / "objects.json").write_text(json.dumps({"image": image.name, "focal": focal, "objects": objects}, indent=1) + "\n", encoding="utf-8")
    return objects
