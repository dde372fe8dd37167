"""Pictures of comparisons, and curves."""

import numpy as np
from PIL import Image, ImageDraw

TITLE = 14
GAP = 4


def shown(picture, scale):
    """Linear radiance as 8-bit, gamma 1/2.2."""
    return (np.clip(picture * scale, 0, 1) ** (1 / 2.2) * 255 + 0.5).astype(np.uint8)


def exposure(picture):
    """What takes the 90th percentile of a picture's brightness to 0.8."""
    return 0.8**2.2 / max(np.percentile(picture.mean(-1), 90), 1e-6)


def middle(picture, width=384, height=288):
    """The middle of a picture, at most so wide and high."""
    y, x = (max(0, (have - want) // 2) for have, want in zip(picture.shape, (height, width)))
    return picture[y : y + height, x : x + width]


def strips(rows):
    """Pictures side by side under their names: for each (title, [(name, picture), …]) a row."""
    height = [max(picture.shape[0] for _, picture in parts) + 2 * TITLE + GAP for _, parts in rows]
    width = max(sum(picture.shape[1] + GAP for _, picture in parts) for _, parts in rows)
    page = Image.new("RGB", (width, sum(height)), "white")
    draw, y = ImageDraw.Draw(page), 0
    for (title, parts), high in zip(rows, height):
        draw.text((2, y + 1), title, fill="black")
        x = 0
        for name, picture in parts:
            draw.text((x + 2, y + TITLE), name, fill="black")
            page.paste(Image.fromarray(picture), (x, y + 2 * TITLE))
            x += picture.shape[1] + GAP
        y += high
    return page


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
        scale = exposure(peer)
        for j, part in enumerate([shown(ours, scale), shown(peer, scale), signed(ours, peer)]):
            page.paste(Image.fromarray(part), (x + j * (width + GAP), y + TITLE))
    return page


COLORS = ["#c33", "#36c", "#e98", "#9be"]


def curves(panels, side=190, margin=34, columns=3):
    """Error against core-seconds, both logarithmic, as SVG: a panel per (title, {name: (seconds, errors)}).

    Points without a positive time and error, as remain where next to nothing was left after start-up, are not drawn.
    """
    rows = -(-len(panels) // columns)
    parts = []
    for index, (title, lines) in enumerate(panels):
        x0, y0 = (index % columns) * (side + margin) + margin, (index // columns) * (side + margin) + margin
        measured = [np.array(line) for line in lines.values()]
        logs = [np.log10(line[:, (line > 0).all(0)]) for line in measured]
        every = np.concatenate(logs, axis=1)
        low, high = np.floor(every.min(1) * 2) / 2, np.ceil(every.max(1) * 2) / 2
        x = lambda t: x0 + (t - low[0]) / (high[0] - low[0]) * (side - 10)
        y = lambda e: y0 + (high[1] - e) / (high[1] - low[1]) * (side - 24)
        parts.append(f'<text x="{x0}" y="{y0 - 6}" font-weight="bold">{title}</text>')
        parts.append(f'<rect x="{x0}" y="{y0}" width="{side - 10}" height="{side - 24}" fill="none" stroke="#999"/>')
        for t in range(int(np.ceil(low[0])), int(high[0]) + 1):
            parts.append(f'<path d="M{x(t):.1f} {y0}v{side - 24}" stroke="#ddd"/><text x="{x(t):.1f}" y="{y0 + side - 12}" text-anchor="middle">{10.0**t:g} s</text>')
        for e in range(int(np.ceil(low[1])), int(high[1]) + 1):
            parts.append(f'<path d="M{x0} {y(e):.1f}h{side - 10}" stroke="#ddd"/><text x="{x0 - 3}" y="{y(e) + 3:.1f}" text-anchor="end">{10.0**e:g}</text>')
        for i, (name, log) in enumerate(zip(lines, logs)):
            points = [(x(t), y(e)) for t, e in log.T]
            parts.append(f'<polyline points="{" ".join(f"{a:.1f},{b:.1f}" for a, b in points)}" fill="none" stroke="{COLORS[i]}" stroke-width="1.5"/>')
            parts += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="2.5" fill="{COLORS[i]}"/>' for a, b in points]
            parts.append(f'<text x="{x0 + side - 14}" y="{y0 + 12 + 11 * i}" text-anchor="end" fill="{COLORS[i]}">{name}</text>')
    size = f"{columns * (side + margin) + margin} {rows * (side + margin) + margin}"
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size}" font-family="sans-serif" font-size="9">'
    return head + '<rect width="100%" height="100%" fill="white"/>' + "\n".join(parts) + "</svg>\n"
