"""What notebooks show of scenes, frames and datasets."""

import base64
import html
from pathlib import Path

from . import _native

# Layers that are shown small beside the picture, and how wide, pixels.
SMALL = ("diffuse_reflectance", "diffuse_illumination", "depth_meters", "normal_world", "semantic", "semantic_instance")
SMALL_WIDTH = 200
LARGE_WIDTH = 640
# Scenes that the table of a dataset lists.
MOST_SCENES = 12


def frame_html(frame):
    """The picture, other layers small, and a table of all."""
    pictures = _native.pictures(frame, ["display"], width=LARGE_WIDTH, lossy=True)
    pictures |= _native.pictures(frame, list(SMALL), width=SMALL_WIDTH)
    large = _image(pictures.pop("display"), "color") if "display" in pictures else ""
    small = "".join(_figure(bytes_, name) for name, bytes_ in pictures.items())
    arrays = [name for name in frame if name in _native.LAYERS]
    rows = [(name, frame[name].dtype, _size(frame[name].shape), _native.LAYERS[name]["unit"]) for name in arrays]
    table = f"<details><summary>{len(rows)} layers</summary>{_table(('layer', 'type', 'shape', 'unit'), rows)}</details>"
    title = html.escape(f"{frame.get('scene')}, {frame.get('camera')}, frame {frame.get('frame')}")
    return f"<div><p>{title}</p>{large}<div>{small}</div>{table}</div>"


def scene_html(scene):
    """Facts, and the plan."""
    facts = [("scene", scene.name), ("contents", scene.summary), ("cameras", len(scene.cameras)), ("warnings", len(scene.warnings))]
    return f"<div>{_table((), facts)}{scene.plan_svg()}</div>"


def dataset_html(dataset, root):
    """Scenes, layers with their sizes, and the first frame."""
    counts = {}
    for index in range(len(dataset)):
        scene, camera, _ = dataset.place(index)
        counts.setdefault(scene, {}).setdefault(camera, 0)
        counts[scene][camera] += 1
    scenes = [(scene, len(cameras), sum(cameras.values())) for scene, cameras in counts.items()]
    rest = f"<p>and {len(scenes) - MOST_SCENES} more</p>" if len(scenes) > MOST_SCENES else ""
    first = dataset[0]
    rows = [(name, first[name].dtype, _size(first[name].shape), _native.LAYERS[name]["unit"]) for name in dataset.layers]
    pictures = _pictures(first)
    title = html.escape(f"{Path(root).name}: samples: {len(dataset)}, scenes: {len(scenes)}")
    return (
        f"<div><p>{title}</p>{pictures}{_table(('scene', 'trajectories', 'samples'), scenes[:MOST_SCENES])}{rest}"
        f"{_table(('layer', 'type', 'shape', 'unit'), rows)}</div>"
    )


def _pictures(sample):
    """Those of a sample that has something to show."""
    try:
        pictures = _native.pictures(sample, ["display", *SMALL], width=SMALL_WIDTH)
    except ValueError:
        return ""
    return "".join(_figure(bytes_, "color" if name == "display" else name) for name, bytes_ in pictures.items())


def _image(content, name):
    kind = "png" if content.startswith(b"\x89PNG") else "jpeg"
    return f'<img alt="{name}" src="data:image/{kind};base64,{base64.b64encode(content).decode()}">'


def _figure(content, name):
    return f'<figure style="display:inline-block;margin:2px">{_image(content, name)}<figcaption>{name}</figcaption></figure>'


def _table(head, rows):
    lines = [_row("th", head)] if head else []
    return f"<table>{''.join(lines + [_row('td', row) for row in rows])}</table>"


def _row(tag, cells):
    return f"<tr>{''.join(f'<{tag}>{html.escape(str(cell))}</{tag}>' for cell in cells)}</tr>"


def _size(shape):
    return " x ".join(map(str, shape))
