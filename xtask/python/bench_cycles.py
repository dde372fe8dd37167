"""`cargo xtask bench cycles`: what a picture of a home costs, by enfilade and by Cycles, as rendered and as delivered.

Every picture is a process of its own, both renderers in turn, and is kept below the target folder: a run that was cut off goes on where it
stopped. `renderers.py` says what of a process counts, `comparison.py` what is measured, `errors.py` how.
"""

import time
from pathlib import Path

import command
import comparison
import errors
import figures
import tables
import views
from machine import processor
from renderers import BOUNCES, Cycles, Ours, Scene
from store import Store, digest

LARGE_CASE = next(iter(views.VIEWS))


def main():
    job = command.parse("bench cycles", __doc__, "cases", f"views, such as {LARGE_CASE}", command.comparing)
    cases = command.chosen(job.cases, list(views.VIEWS))
    ours, peer = Ours(job.bench, **job.config), Cycles()
    store, started, rows = Store(Path(job.work) / "pictures", [ours, peer], job.any_program), time.time(), []
    for name in cases:
        scene = prepare(name, job, peer)
        for size, counts in command.sizes(job, name == LARGE_CASE):
            rows.append(comparison.row(name, size, *comparison.measure(store, [ours, peer], scene, size, counts)))
            comparison.report(rows[-1])
    docs = command.docs(job)
    tables.write(docs, "cycles", rows, "Cycles", page(rows, time.time() - started))
    truths = [(f"{r['case']}: enfilade, Cycles, difference", r["ours"]["truth"], r["peer"]["truth"]) for r in rows if comparison.LARGE not in r["case"]]
    figures.sheet(truths, 1).save(docs / "cycles-references.jpg", quality=70)
    print(f"tables and figures: {docs}")


def prepare(name, job, peer):
    """The view as glTF, and as Blender's file."""
    view = views.prepare(job.program, name, Path(job.work) / "views")
    content = digest(view)
    blend = view.with_name(f"{name}-{content}-{digest(peer.program)}.blend")
    if not blend.exists():
        peer.convert(view, blend)
    return Scene(view, blend, content)


def page(rows, seconds):
    ours, version = rows[0]["ours"]["version"], rows[0]["peer"]["version"]
    yield "# Rendering, against Cycles"
    yield ""
    yield f"`cargo xtask bench cycles` on {processor()}: enfilade and Cycles of Blender {version}, the renderer of BlenderProc, Infinigen and Kubric, render"
    yield "the same glTF files of homes that `enfilade home` makes, with their cameras; two at night, lit by lamps alone, each a surface that emits light, and"
    yield f"two by day. Both: box filter of one pixel, {BOUNCES} bounces, float32. Of Cycles, all that makes pictures as rendered biased is off: clamping of"
    yield "direct and indirect light, filtered caustics, the threshold below which lamps are left out, adaptive sampling; the light tree is on, and lamps that"
    yield "shine to one side are sampled from that side, which lowers its noise. Ours writes every layer with its default settings, Cycles color alone."
    yield ""
    yield f"*Delivered* is denoised: ours as a dataset's frames are ({ours}), Cycles' by its own Open Image Denoise at high quality, guided by albedo and"
    yield "normals that it filters first (`ACCURATE`). Processor seconds, user and system, of all threads; start-up, load and a first picture of one sample"
    yield "are not counted, learning, all layers, denoising, and what Cycles prepares for every picture anew, are."
    yield ""
    yield "What the renderers mean different things by is changed in the files: at night window panes, sheets without thickness, are black and keep their"
    yield "reflection, by day they are left out; so is the colour of thick glass and water. Sheen is that of each: Cycles has another model than glTF's."
    yield ""
    yield from tables.sections("cycles", rows, "Cycles")
    yield from ["## Do they render the same?", "", *same(rows), ""]
    yield from ["![references of enfilade and Cycles, and their difference](cycles-references.jpg)", ""]
    yield from tables.ending(rows, "Cycles", seconds)


def same(rows):
    yield "The mean of our references over that of Cycles', less one: the whole image and blocks of 16×16 pixels; and for the share of noise in that, one of"
    yield "Cycles' references over the other."
    yield ""
    yield "| view | what | whole | median of blocks | blocks within 5 % | within 10 % |"
    yield "|---|---|---|---|---|---|"
    for r in rows:
        pairs = [("ours over Cycles'", (r["ours"]["truth"], r["peer"]["truth"])), ("Cycles' over Cycles'", r["peer"]["references"])]
        for what, pair in pairs:
            found = errors.agreement(*pair)
            yield f"| {r['case']} | {what} | {found['whole']:+.2%} | {found['median']:+.2%} | {found['within_5']:.0%} | {found['within_10']:.0%} |"


if __name__ == "__main__":
    main()
