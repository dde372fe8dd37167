"""`cargo xtask bench render`: what a picture of a room or a home costs, by enfilade and by Mitsuba 3, as rendered and as delivered.

Every picture is a process of its own, both renderers in turn, and is kept below the target folder: a run that was cut off goes on where it
stopped. `renderers.py` says what of a process counts, `comparison.py` what is measured, `errors.py` how.
"""

import sys
import time
from pathlib import Path

import command
import comparison
import frame_cost
import rooms
import tables
import views
from machine import processor
from renderers import BOUNCES, Mitsuba, Ours, Scene
from store import Store, digest

LARGE_CASE = "grey-white-room"


def main():
    job = command.parse("bench render", __doc__, "cases", "rooms or views of homes", command.comparing)
    if not job.scenes:
        sys.exit("ENFILADE_SCENES should name the folder of the shared rooms: this measures them and generated homes")
    cases = command.chosen(job.cases, [*rooms.ROOMS, *views.VIEWS])
    ours, peer = Ours(job.bench, **job.config), Mitsuba()
    store, started, rows, costs = Store(Path(job.work) / "pictures", [ours, peer], job.any_program), time.time(), [], []
    for name in cases:
        scene = prepare(name, job)
        for size, counts in command.sizes(job, name == LARGE_CASE):
            rows.append(comparison.row(name, size, *comparison.measure(store, [ours, peer], scene, size, counts)))
            comparison.report(rows[-1])
    docs = command.docs(job)
    write = lambda: tables.write(docs, "render", rows, "Mitsuba", page(rows, costs, peer, time.time() - started), delivered=costs)
    write()
    for name in [name for name in cases if name in rooms.ROOMS and not job.samples]:
        costs.append(frame_cost.measure(store, ours, prepare(name, job), name))
        frame_cost.report(costs[-1])
        write()
    print(f"tables and figures: {docs}")


def prepare(name, job):
    """The case as XML that both renderers load."""
    work = Path(job.work)
    if name in rooms.ROOMS:
        xml = rooms.prepare(name, job.scenes, work / "rooms", job.bench)
    else:
        xml = rooms.exported(views.prepare(job.program, name, work / "views"), work / "rooms" / name, job.bench)
    return Scene(xml, xml, digest(xml.parent))


def page(rows, costs, peer, seconds):
    ours, version = rows[0]["ours"]["version"], rows[0]["peer"]["version"]
    yield "# Rendering, against Mitsuba 3"
    yield ""
    yield f"`cargo xtask bench render` on {processor()}: enfilade and Mitsuba {version} (`llvm_ad_rgb`, LLVM {peer.llvm}, independent samples) render the"
    yield f"same XML with the same camera, box filter and path depth (Mitsuba's `max_depth` {BOUNCES + 2}, our `max_bounces` {BOUNCES}). Ours writes every layer,"
    yield "Mitsuba only color. Homes are made by `enfilade home` and exported to XML; at night their panes are black, by day their windows are open."
    yield ""
    yield f"*Delivered* pictures are denoised: ours as the frames of a dataset are ({ours}),"
    yield f"Mitsuba's by Open Image Denoise {peer.denoiser} at high quality, guided by its albedo and normals of 64 samples, taken as noise-free, whose"
    yield "time is not counted. Times are processor seconds, user and system, of all threads. Start-up, loading and compilation are not counted;"
    yield "learning, all layers and denoising are."
    yield ""
    yield from tables.sections("render", rows, "Mitsuba")
    if costs:
        yield from frame_cost.section(costs, BOUNCES)
    yield from tables.ending(rows, "Mitsuba", seconds)


if __name__ == "__main__":
    main()
