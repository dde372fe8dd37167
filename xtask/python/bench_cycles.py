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
    yield f"`cargo xtask bench cycles` on {processor()}: enfilade and Cycles of Blender {version}, the renderer of BlenderProc, Infinigen and"
    yield "Kubric, render the same glTF files of homes that `enfilade home` makes, with their cameras: two at night, lit only by lamps, each of which"
    yield f"is an emissive surface, and two by day. Both use a box filter of one pixel, {BOUNCES} bounces and float32. In Cycles everything that biases"
    yield "rendered pictures is off: clamping of direct and indirect light, filtered caustics, the threshold below which lamps are left out, and"
    yield "adaptive sampling. The light tree is on, and lamps that shine to one side are sampled from that side, which lowers its noise. Ours writes"
    yield "every layer with its default settings, Cycles only color."
    yield ""
    yield f"*Delivered* pictures are denoised: ours as the frames of a dataset are ({ours}), Cycles'"
    yield "by its own Open Image Denoise at high quality, guided by albedo and normals that it filters first (`ACCURATE`). Times are processor seconds,"
    yield "user and system, of all threads. Start-up, loading and a first picture of one sample are not counted; learning, all layers, denoising, and"
    yield "what Cycles prepares anew for every picture are."
    yield ""
    yield "What the two renderers interpret differently is changed in the files. At night, window panes, which are sheets without thickness, are black"
    yield "and keep their reflection; by day they are left out. So is the colour of thick glass and water. Each renders its own sheen: the model of Cycles differs from glTF's."
    yield ""
    yield from tables.sections("cycles", rows, "Cycles")
    yield from ["## Do they render the same?", "", *same(rows), ""]
    yield from ["![references of enfilade and Cycles, and their difference](cycles-references.jpg)", ""]
    yield from tables.ending(rows, "Cycles", seconds)


def same(rows):
    yield "The mean of our references divided by that of Cycles', minus one, for the whole image and for blocks of 16×16 pixels. To show the share of"
    yield "noise, the same is given for one of Cycles' references and the other."
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
