"""A picture of each kind of ground truth, from the dataset of bench_products.py."""

from pathlib import Path

import h5py
import numpy as np
from PIL import Image, ImageDraw

# Pixels per row of one picture of a strip.
WIDTH = 256


def read(path: Path) -> np.ndarray:
    return h5py.File(path)["dataset"][:]


def small(picture: Image.Image, width: int = WIDTH) -> Image.Image:
    return picture.convert("RGB").resize((width, round(width * picture.height / picture.width)), Image.Resampling.LANCZOS)


def strip(pictures: list[Image.Image], path: Path) -> None:
    """The pictures side by side."""
    pictures = [small(picture) for picture in pictures]
    joined = Image.new("RGB", (sum(p.width + 4 for p in pictures) - 4, max(p.height for p in pictures)), "white")
    x = 0
    for picture in pictures:
        joined.paste(picture, (x, 0))
        x += picture.width + 4
    joined.save(path, quality=82, optimize=True)


def depth_picture(depth: np.ndarray, near: float, far: float) -> Image.Image:
    """Near is bright; white is nothing."""
    share = np.clip((depth - near) / (far - near), 0.0, 1.0)
    grey = np.where(np.isnan(depth), 255, 225 - 200 * np.nan_to_num(share)).astype(np.uint8)
    return Image.fromarray(grey)


def colours(ids: np.ndarray) -> Image.Image:
    """A colour for each number; white below one."""
    table = np.random.default_rng(5).integers(40, 220, (int(ids.max()) + 2, 3), dtype=np.uint8)
    picture = table[np.maximum(ids, 0)]
    picture[ids < 1] = 255
    return Image.fromarray(picture)


def flow_picture(flow: np.ndarray) -> Image.Image:
    """Hue is the direction, saturation the length up to the 95th percentile."""
    x, y = flow[..., 0], flow[..., 1]
    length = np.hypot(x, y)
    most = np.nanpercentile(length, 95) or 1.0
    hue = (np.arctan2(y, x) / (2 * np.pi)) % 1.0
    channels = [np.nan_to_num(hue) * 255, np.nan_to_num(np.clip(length / most, 0, 1)) * 255, np.full(x.shape, 255)]
    return Image.fromarray(np.stack(channels, -1).astype(np.uint8), "HSV")


def tracks_picture(photograph: Image.Image, tracks: dict) -> Image.Image:
    """The ways of points over the first frame; a ring where a point is hidden in it."""
    picture = photograph.convert("RGB")
    draw = ImageDraw.Draw(picture)
    scale = np.array(picture.size)
    for point, hidden in zip(tracks["points"][::4], tracks["occluded"][::4]):
        way = [tuple(p * scale) for p in point if p[0] != -1]
        if len(way) > 1:
            draw.line(way, fill=(255, 210, 0), width=3)
        x, y = point[0] * scale
        box = (x - 6, y - 6, x + 6, y + 6)
        draw.ellipse(box, outline=(200, 30, 30), width=2) if hidden[0] else draw.ellipse(box, fill=(200, 30, 30))
    return picture


def matrix_picture(shares: np.ndarray) -> Image.Image:
    grey = (255 * np.nan_to_num(shares)).astype(np.uint8)
    return Image.fromarray(grey).resize((WIDTH, WIDTH), Image.Resampling.NEAREST)


def make(out: Path, folder: Path, scene: str, camera: str) -> None:
    folder.mkdir(exist_ok=True)
    detail, images = out / f"scenes/{scene}/_detail/{camera}", out / f"scenes/{scene}/images"
    display = lambda frame: Image.open(images / f"scene_{camera}_final_preview/frame.{frame:04}.display.jpg")
    relit = [out / f"relit/{mix}/{scene}/{camera}/frame.0000.display.jpg" for mix in ("one_window", "sun", "lamps", "evening")]
    strip([Image.open(path) for path in relit if path.exists()], folder / "fixtures.jpg")

    distance = read(detail / "surfaces/frame.0000.surface_distance_meters.hdf5")
    part = read(detail / "surfaces/frame.0000.surface_entity_id.hdf5")
    near, far = np.nanpercentile(distance[..., 0], 1), np.nanpercentile(distance[..., 2], 99)
    layers = [depth_picture(distance[..., k], near, far) for k in (0, 1, 2)]
    strip([*layers, colours(part[..., 2])], folder / "surfaces.jpg")

    strip([display(0), colours(read(detail / "planes/frame.0000.plane_id.hdf5"))], folder / "planes.jpg")

    shares = read(out / f"scenes/{scene}/_detail/covisibility.hdf5")
    strip([display(0), display(1), matrix_picture(shares)], folder / "pairs.jpg")
    flow = next(iter(sorted((detail / "pairs").glob("frame.0000.*.optical_flow.hdf5"))))
    seen = Path(str(flow).replace("optical_flow", "flow_visibility"))
    strip([flow_picture(read(flow)), Image.fromarray(255 * read(seen))], folder / "flow.jpg")
    strip([tracks_picture(display(0), np.load(detail / "tracks.npz"))], folder / "tracks.jpg")

    sensed = []
    for sensor in sorted((out / "sensors").iterdir()):
        folder_of = sensor / scene / camera
        sensed += [Image.open(path) for path in sorted(folder_of.glob("frame.0000.color.*")) if path.suffix in (".jpg", ".png")]
        for path in sorted(folder_of.glob("frame.0000.depth*.hdf5")):
            depth = read(path).astype(np.float32)
            sensed.append(depth_picture(np.where(depth > 0, depth, np.nan), near, np.nanpercentile(depth, 99)))
    strip(sensed[:4], folder / "sensors.jpg")
