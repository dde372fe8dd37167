"""The pages of comparisons with a peer: tables in Markdown, curves, pictures, and JSON.

JSON holds `rows` of `case`, `ours`, `peer` and `ratio`, above 1 where ours is better; cases of delivered pictures begin with "delivered".
"""

import json

import numpy as np

import comparison
import errors
import figures
from comparison import KINDS, SIDES, Point
from machine import processor


def write(docs, name, rows, peer, page, **more):
    """Writes `<name>.json`, with `more` in it, `.svg`, `.jpg`, and `.md`, whose lines `page` gives."""
    docs.mkdir(parents=True, exist_ok=True)
    told = dict(processor=processor(), version=rows[0]["peer"]["version"], rows=list(comparisons(rows)), cases=data(rows), **more)
    (docs / f"{name}.json").write_text(json.dumps(told, indent=1, ensure_ascii=False) + "\n")
    (docs / f"{name}.svg").write_text(curves(rows, peer))
    strips(rows, peer).save(docs / f"{name}.jpg", quality=80)
    (docs / f"{name}.md").write_text("\n".join(page) + "\n")


def sections(name, rows, peer):
    """What all comparisons tell, after the page's head: what the numbers mean, and the tables but for the curves."""
    yield from measures()
    yield from ["", "## Core-seconds to equal error", "", *equal_table(rows, peer)]
    yield from [f"![error against time]({name}.svg)", "", f"![both pictures, as rendered and as delivered]({name}.jpg)", ""]
    yield from ["## The denoisers' bias", "", *bias_words(), "", *bias_table(rows, peer), ""]
    yield from ["## Samples per core-second", "", *speed_table(rows, peer), ""]
    yield from ["## Correlated noise of pixels", "", *correlation_words(), "", *correlation_table(rows), ""]


def ending(rows, peer, seconds):
    yield from ["## The curves", "", *curve_table(rows, peer), ""]
    yield f"The run took {seconds / 60:.0f} minutes, not counting pictures that existed before."


def comparisons(rows):
    """Rows of JSON: `case`, `ours`, `peer`, and `ratio`, above 1 where ours is better."""
    blocks = f" of means of {SIDES['_blocks']}x{SIDES['_blocks']} pixels"
    for kind in KINDS:
        for of, what in {"": "", "_blocks": blocks}.items():
            for r in rows:
                start = "delivered " if kind == "delivered" else ""
                yield dict(case=f"{start}{r['case']}: core-seconds to equal error{what}", **r["equal"][kind + of])
    for key, what, better in [("rate", "M samples per core-second", 1), ("variance", "relMSE x samples, as rendered", -1), ("peak_mb", "peak MB", -1)]:
        for r in rows:
            ours, peer = r["ours"][key], r["peer"][key]
            yield dict(case=f"{r['case']}: {what}", ours=ours, peer=peer, ratio=(ours / peer) ** better)


def data(rows):
    """The rows without pictures."""
    kept = lambda who: {key: value for key, value in who.items() if key not in ("truth", "references", "shown")}
    return [r | dict(ours=kept(r["ours"]), peer=kept(r["peer"])) for r in rows]


def measures():
    seeds = len(comparison.SEEDS)
    yield "relMSE is the mean of (x − a)(x − b) / (truth² + 0.01) over pixels and channels, where a and b are two independent references by the same"
    yield "renderer, so that their own noise cancels, and the truth in the divisor is the denoised picture with the most samples, which is nearly"
    yield f"noise-free. Pictures are scaled to a mean of 0.5, and the worst 0.1 % of the pixels are left out; {f'the mean of {seeds} seeds' if seeds > 1 else 'one seed'}. *Of blocks* is the same for"
    yield f"means of {SIDES['_blocks']}×{SIDES['_blocks']} pixels, which show what one sees from farther away, in a smaller picture or after denoising."
    yield "*Ratio* is the peer's core-seconds divided by ours at the least error that both reach, interpolated linearly in log-log between measured"
    yield "points; above 1 ours is better. Nothing is extrapolated: where one curve begins with less error than the other ends with, the ratio is that"
    yield "of these two pictures and is a bound (≥ or ≤)."


def bias_words():
    yield "What remains of a delivered picture's error however many samples it gets: at the most samples measured, and for a denoised reference,"
    yield "compared with the other reference and a measured picture. *Mean moves by* is the mean of the delivered picture divided by that of the"
    yield "rendered one, minus one."


def correlation_words():
    yield f"This is the correlation of the noise of our pixels, as rendered, with that of pixels 1 to {errors.OFFSETS} across and down. Noise is the luminance minus"
    yield f"that of the references, divided by its root mean square in squares of {errors.ALIKE}×{errors.ALIKE} pixels, and at most 3. Independent pixels have 0, within ±0.005"
    yield f"at {comparison.SIZE}. The last column is the largest at any other offset of up to {errors.OFFSETS}."


def summary(values):
    return f"{np.median(values):.2f} ({min(values):.2f} to {max(values):.2f})"


def equal_table(rows, peer):
    """Markdown: core-seconds to equal error."""
    yield f"| case | | relMSE | ours, core-s | {peer}, core-s | **ratio** | of blocks: relMSE | ours | {peer} | **ratio** |"
    yield "|---|---|---|---|---|---|---|---|---|---|"
    numbers = lambda e: f"{e['error']:.5f} | {e['ours']:.1f} | {e['peer']:.1f} | **{e['bound']}{e['ratio']:.2f}**"
    for kind, words in KINDS.items():
        for r in rows:
            yield f"| {r['case']} | {words} | {numbers(r['equal'][kind])} | {numbers(r['equal'][kind + '_blocks'])} |"
    yield ""
    for kind, words in KINDS.items():
        pixels, blocks = (summary([r["equal"][kind + of]["ratio"] for r in rows]) for of in SIDES)
        yield f"Median (least to most), {words}: {pixels} of pixels, {blocks} of blocks."
        yield ""


def both(rows, peer):
    return [(r["case"], title, r[who]) for r in rows for who, title in (("ours", "enfilade"), ("peer", peer))]


def curve_table(rows, peer):
    """Markdown: every point that was measured."""
    yield "| case | renderer | samples | core-s | relMSE | of blocks | core-s, delivered | relMSE | of blocks |"
    yield "|---|---|---|---|---|---|---|---|---|"
    for case, title, who in both(rows, peer):
        for p in (Point(**values) for values in who["points"]):
            yield f"| {case} | {title} | {p.samples} | {p.raw_core_s:.2f} | {p.raw:.4f} | {p.raw_blocks:.5f} | {p.delivered_core_s:.2f} | {p.delivered:.5f} | {p.delivered_blocks:.5f} |"


def bias_table(rows, peer):
    """Markdown: what a denoiser leaves however many samples it gets."""
    yield "| case | renderer | delivered at samples | relMSE | of blocks | mean moves by | denoised reference with samples | relMSE | of blocks |"
    yield "|---|---|---|---|---|---|---|---|---|"
    for case, title, who in both(rows, peer):
        p = Point(**who["points"][-1])
        floor = "{} | {:.5f} | {:.5f}".format(who["reference_samples"], *who["floor"]) if who["floor"] else "| | "
        yield f"| {case} | {title} | {p.samples} | {p.delivered:.5f} | {p.delivered_blocks:.5f} | {who['shift']:+.2%} | {floor} |"


def speed_table(rows, peer):
    """Markdown: samples per core-second, what a sample is worth, and what was not counted."""
    yield f"| case | M samples per core-s: ours | {peer} | ratio | relMSE × samples: ours | {peer} | load, not counted: ours | {peer} | peak MB: ours | {peer} |"
    yield "|---|---|---|---|---|---|---|---|---|---|"
    for r in rows:
        o, p = r["ours"], r["peer"]
        yield (
            f"| {r['case']} | {o['rate']:.3f} | {p['rate']:.3f} | **{o['rate'] / p['rate']:.2f}** | {o['variance']:.2f} | {p['variance']:.2f} | {o['load_core_s']:.1f} s | "
            f"{p['load_core_s']:.1f} s | {o['peak_mb']:.0f} | {p['peak_mb']:.0f} |"
        )
    yield ""
    yield f"Median of the ratios (least to most): {summary([r['ours']['rate'] / r['peer']['rate'] for r in rows])}."


def correlation_table(rows):
    """Markdown: the noise of our pixels at offsets from 1 to 16."""
    yield f"| case | samples | | {' | '.join(str(n + 1) for n in range(errors.OFFSETS))} | largest elsewhere (down, right) |"
    yield f"|---|---|---|{'---|' * errors.OFFSETS}---|"
    for r in rows:
        found = r["ours"]["correlation"]
        down, right, value = found["largest"]
        for along, last in (("across", f"{value:+.3f} ({down}, {right})"), ("down", "")):
            yield f"| {r['case']} | {found['samples']} | {along} | {' | '.join(f'{v:+.3f}' for v in found[along])} | {last} |"


def curves(rows, peer):
    """Error against core-seconds, as SVG."""
    panels = []
    for r in rows:
        lines = {f"{title}, {words}": ([p[f"{kind}_core_s"] for p in r[who]["points"]], [p[kind] for p in r[who]["points"]])
                 for kind, words in KINDS.items() for who, title in (("ours", "enfilade"), ("peer", peer))}
        panels.append((r["case"], lines))
    return figures.curves(panels)


def strips(rows, peer):
    """The middle of both pictures at full size, of the fewest samples that both have, as rendered and as delivered, with what they cost and leave."""
    shown = []
    for r in rows:
        scale, parts, few = figures.exposure(r["ours"]["truth"]), [], min(r["ours"]["shown"].keys() & r["peer"]["shown"].keys())
        for who, title in (("ours", "enfilade"), ("peer", peer)):
            (p,) = (p for p in r[who]["points"] if p["samples"] == few)
            for kind, words in reversed(KINDS.items()):
                name = f"{title}, {few} samples, {words}: {p[kind]:.4f} in {p[f'{kind}_core_s']:.1f} s"
                parts.append((name, figures.shown(figures.middle(getattr(r[who]["shown"][few], kind)), scale)))
        shown.append((r["case"], parts))
    return figures.strips(shown)
