"""Charts of lines as SVG, with nothing but the standard library."""

import math

COLORS = ["#c33", "#36c", "#393", "#b80", "#888", "#555"]
WIDTH, HEIGHT, MARGIN = 330, 220, 44


def chart(panels, columns=2):
    """A panel per (title, {name: [(x, y), …]}, logarithmic)."""
    rows = -(-len(panels) // columns)
    size = f"{columns * (WIDTH + MARGIN) + MARGIN} {rows * (HEIGHT + MARGIN) + MARGIN}"
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size}" font-family="sans-serif" font-size="9"><rect width="100%" height="100%" fill="white"/>'
    places = [((i % columns) * (WIDTH + MARGIN) + MARGIN, (i // columns) * (HEIGHT + MARGIN) + MARGIN) for i in range(len(panels))]
    return head + "\n".join(panel(*place, *each) for place, each in zip(places, panels)) + "</svg>\n"


def panel(x0, y0, title, lines, logarithmic):
    scale = math.log10 if logarithmic else float
    xs, ys = ([point[axis] for line in lines.values() for point in line] for axis in (0, 1))
    low = [scale(min(values)) for values in (xs, ys)] if logarithmic else [0.0, 0.0]
    high = [scale(max(values)) for values in (xs, ys)]
    x = lambda value: x0 + (scale(value) - low[0]) / ((high[0] - low[0]) or 1) * WIDTH
    y = lambda value: y0 + HEIGHT - (scale(value) - low[1]) / ((high[1] - low[1]) or 1) * HEIGHT
    parts = [f'<text x="{x0}" y="{y0 - 6}" font-weight="bold">{title}</text>', f'<rect x="{x0}" y="{y0}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="#999"/>']
    for value in ticks(low[0], high[0], logarithmic):
        parts.append(f'<path d="M{x(value):.1f} {y0}v{HEIGHT}" stroke="#ddd"/><text x="{x(value):.1f}" y="{y0 + HEIGHT + 11}" text-anchor="middle">{value:g}</text>')
    for value in ticks(low[1], high[1], logarithmic):
        parts.append(f'<path d="M{x0} {y(value):.1f}h{WIDTH}" stroke="#ddd"/><text x="{x0 - 3}" y="{y(value) + 3:.1f}" text-anchor="end">{value:g}</text>')
    for i, (name, line) in enumerate(lines.items()):
        color = COLORS[i % len(COLORS)]
        points = " ".join(f"{x(a):.1f},{y(b):.1f}" for a, b in line)
        parts.append(f'<polyline points="{points}" fill="none" stroke="{color}" stroke-width="1.5"/>')
        parts.append(f'<text x="{x0 + WIDTH - 4}" y="{y0 + 12 + 11 * i}" text-anchor="end" fill="{color}">{name}</text>')
    return "".join(parts)


def ticks(low, high, logarithmic):
    """Round values from low to high, which are logarithms where that is said."""
    if logarithmic:
        return [10.0**e * m for e in range(math.floor(low), math.ceil(high) + 1) for m in (1, 2, 5) if low - 1e-9 <= math.log10(10.0**e * m) <= high + 1e-9]
    step = 10 ** math.floor(math.log10((high - low) or 1))
    step *= next(m for m in (0.2, 0.5, 1, 2) if (high - low) / (m * step) <= 6)
    return [low + i * step for i in range(int((high - low) / step) + 1)]
