"""Pictures of comparisons, and curves."""

import numpy as np
from PIL import Image, ImageDraw

TITLE = 14
GAP = 4


def shown(picture, scale):
    """Linear radiance as 8-bit, gamma 1/2.2."""
    return (np.clip(picture * scale, 0, 1) ** (1 / 2.2) * 255 + 0.5).astype(np.uint8)


def signed(ours, peer):
    """The difference over the image's mean: white at none, red where ours is brighter, blue where darker, full at 10 %."""
    weights = np.array([0.2126, 0.7152, 0.0722])
    d = np.clip((ours - peer) @ weights / (peer @ weights).mean() / 0.1, -1, 1)
    return (255 * (1 - np.stack([np.maximum(-d, 0), np.abs(d), np.maximum(d, 0)], axis=-1))).astype(np.uint8)


def sheet(rows, columns):
    """Ours, the peer's and the signed difference of each (name, ours, peer), in `columns` columns under their names."""
    height, width = rows[0][1].shape[:2]
    cell = (3 * width + 3 * GAP, height + TITLE + GAP)
    page = Image.new("RGB", (cell[0] * columns, cell[1] * -(-len(rows) // columns)), "white")
    draw = ImageDraw.Draw(page)
    for i, (name, ours, peer) in enumerate(rows):
        x, y = cell[0] * (i % columns), cell[1] * (i // columns)
        draw.text((x + 2, y + 1), name, fill="black")
        scale = 0.8**2.2 / max(np.percentile(peer.mean(-1), 90), 1e-6)
        for j, part in enumerate([shown(ours, scale), shown(peer, scale), signed(ours, peer)]):
            page.paste(Image.fromarray(part), (x + j * (width + GAP), y + TITLE))
    return page
