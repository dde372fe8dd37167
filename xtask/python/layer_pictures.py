"""Small JPEGs of a frame's previews for docs/layers: python layer_pictures.py IMAGES OUT LAYER..."""

import sys
from pathlib import Path

from PIL import Image

# Previews of Hypersim's names that show a layer under another.
OTHER_NAMES = {"color": "tonemap"}


def preview(images: Path, layer: str) -> Path:
    name = OTHER_NAMES.get(layer, layer)
    found = [path for path in images.glob(f"scene_cam_00_*_preview/frame.0000.{name}.*") if path.suffix in {".jpg", ".png"}]
    if not found:
        sys.exit(f"{images} has no preview of {layer}; was the demo made with --extra and --light-parts?")
    return found[0]


def main() -> None:
    images, out = Path(sys.argv[1]), Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    for old in out.glob("*.jpg"):
        old.unlink()
    for layer in sys.argv[3:]:
        picture = Image.open(preview(images, layer)).convert("RGBA")
        # Where there is no value, previews are transparent.
        white = Image.new("RGBA", picture.size, "white")
        Image.alpha_composite(white, picture).convert("RGB").save(out / f"{layer}.jpg", quality=80, optimize=True)


main()
