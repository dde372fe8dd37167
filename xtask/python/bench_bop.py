"""`cargo xtask bench bop`: ten models in heaps as BOP, by `examples/compose/bop.toml` and by BlenderProc's published recipe.

Both make as many scenes with as many pictures of one size, each with its own quality, and write BOP. `recipe_bop.py` is the recipe and
`peer_blenderproc.py` starts BlenderProc; `cost.py` says what counts, `bop_reading.py` reads what was written.
"""

import io
import json
import os
import re
import shutil
import subprocess
import sys
import tokenize
from pathlib import Path

import bop_inputs
import bop_reading
import command
import figures
from cost import measured
from machine import processor
from renderers import HERE, versions

EXAMPLE = Path("examples/compose/bop.toml")
RECIPE, STARTER = HERE / "recipe_bop.py", HERE / "peer_blenderproc.py"
SCENES, FRAMES, SIZE = ["dining_0", "dining_1"], 4, "320x240"
# Pictures of each on the sheet.
SHOWN = 3
# Shares by which the time of a run on a shared machine differs from that of another.
WITHIN = 0.2
# Lines of main_ycbv_random.py as published with BlenderProc 2.8.0 (commit a80f75d8), counted as ours are.
PUBLISHED = 97
# The toolkit knows the datasets of the benchmark alone, so the models bear the name of one.
DATASET = "ycbv"


def main():
    job = command.parse("bench bop", __doc__, "cases", f"scenes, such as {SCENES[0]}", options)
    scenes = command.chosen(job.cases, SCENES)
    work = Path(job.work)
    work.mkdir(parents=True, exist_ok=True)
    load = os.getloadavg()[0]
    ours = made_by_us(job, work, scenes)
    peer = made_by_peer(job, work, len(scenes), ours["images"] // len(scenes))
    docs = work / "docs" if job.cases or job.size != SIZE or job.frames != FRAMES else Path(job.docs)
    docs.mkdir(parents=True, exist_ok=True)
    told = dict(processor=processor(), processors=os.cpu_count(), load=load, versions=versions("blenderproc", "bpy"), size=job.size, scenes=len(scenes), ours=ours, peer=peer)
    (docs / "bop.json").write_text(json.dumps(told, indent=1) + "\n")
    (docs / "bop.md").write_text("\n".join(page(told)) + "\n")
    rows = [(name, [("", picture) for picture in bop_reading.pictures(folder, SHOWN)]) for name, folder in [("enfilade", work / "ours-bop"), ("BlenderProc", work / "peer" / DATASET)]]
    figures.strips(rows).save(docs / "bop.jpg", quality=80)
    print(f"table and figure: {docs}")


def options(parser):
    parser.add_argument("--size", default=SIZE, help=f"WIDTHxHEIGHT of the pictures [{SIZE}]")
    parser.add_argument("--frames", type=int, default=FRAMES, help=f"frames of each of our cameras [{FRAMES}]; a scene has one camera for each place on its tables")


def made_by_us(job, work, scenes):
    """The dataset and its export, what they cost, and what holds."""
    dataset, bop = work / "ours", work / "ours-bop"
    for folder in [dataset, bop]:
        shutil.rmtree(folder, ignore_errors=True)
    program = [job.program, "--quiet"]
    run = measured([*program, "run", EXAMPLE, "-o", dataset, "--size", job.size, "--frames", job.frames, "--scenes", ",".join(scenes)])
    export = measured([*program, "export", dataset, "--format", "bop", "-o", bop])
    strict = subprocess.run([job.program, "verify", dataset, "--strict"], capture_output=True).returncode == 0
    card = json.loads((dataset / "verify.json").read_text())
    laws, rejected = [law["holds"] for law in card["laws"]], {gate["gate"]: gate["rejected"] for gate in card["gates"] if gate["rejected"]}
    return told(run + export, code_lines(EXAMPLE), bop, laws=len(laws), hold=sum(laws), strict=strict, rejected=rejected, dataset_mb=megabytes(dataset))


def made_by_peer(job, work, scenes, images):
    """The same by the recipe; the models and textures that it takes cost nothing."""
    models, textures, out = work / "bop", work / "cctextures", work / "peer"
    bop_inputs.models(work / "ours-bop", Path("examples/compose"), models / DATASET / "models")
    bop_inputs.textures(textures)
    shutil.rmtree(out, ignore_errors=True)
    words = [models, DATASET, 3, textures, out, scenes, images, job.size]
    cost = measured([sys.executable, STARTER, RECIPE, *words], env=os.environ | {"BLENDER_PROC_RANDOM_SEED": "1"})
    shutil.copytree(models / DATASET / "models", out / DATASET / "models")
    return told(cost, code_lines(RECIPE), out / DATASET)


def told(cost, lines, bop, **more):
    return dict(lines=lines, core_s=cost.cpu_s, wall_s=cost.wall_s, peak_mb=cost.peak_bytes / 1e6, bop_mb=megabytes(bop)) | bop_reading.read(bop) | more


def megabytes(folder):
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file()) / 1e6


def code_lines(path):
    """Lines with code in a TOML file or a Python program: neither empty, nor comments, nor the text that describes a module or function."""
    text = path.read_text()
    if path.suffix == ".toml":
        return sum(bool(line.strip()) and not line.strip().startswith("#") for line in text.splitlines())
    kept, aside = set(), {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER}
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        described = token.type == tokenize.STRING and re.match(r'\s*"""', token.line)
        if token.type not in aside and not described:
            kept.update(range(token.start[0], token.end[0] + 1))
    return len(kept)


def page(told):
    ours, peer = told["ours"], told["peer"]
    yield "# Heaps of models as BOP, against BlenderProc"
    yield ""
    yield f"`cargo xtask bench bop` on {told['processors']} processors of an {told['processor']}: the ten models of `examples/compose`, three of each"
    yield f"and smaller distractors, in {told['scenes']} scenes, {told['size'].replace('x', ' × ')} pixels, written as BOP. Ours is `examples/compose/bop.toml` with `enfilade run` and"
    yield f"`enfilade export --format bop`. The peer is the recipe by which BOP's training images were made, `main_ycbv_random.py` of BlenderProc's"
    yield f"`examples/datasets/bop_challenge`, on the CPU ({told['versions']}); `xtask/python/recipe_bop.py` has its steps and numbers on our models."
    yield ""
    yield "| | enfilade | BlenderProc |"
    yield "|---|---|---|"
    for name, cell in rows():
        yield f"| {name} | {cell(ours)} | {cell(peer)} |"
    yield ""
    yield f"Lines are neither empty nor comments. The published file has {PUBLISHED}, for it loads distractors from three other datasets. Core-seconds are user and"
    yield "system time of all processes, from nothing to the finished folder: start-up, loading, placement, cameras, rendering, denoising, masks, export."
    yield "Each has the quality that it delivers: ours 32 samples and its denoiser, BlenderProc at most 50 samples, a noise threshold of 0.01, three"
    yield "bounces and Open Image Denoise. Ours renders with all bounces, and writes the whole dataset with its layers and report card before it exports."
    if told["load"] > 0.5:
        yield f"The machine did other work meanwhile (load {told['load']:.1f} before the run), which lengthens wall times most."
    yield ""
    yield comparison(ours, peer)
    yield ""
    yield "![three pictures of each](bop.jpg)"
    yield ""
    yield from ["## What differs", "", *differences(), ""]
    yield from ["## Do the files agree with the models?", "", *agreement(ours, peer)]


def comparison(ours, peer):
    """What the numbers prove, and what they do not."""
    ratio = peer["core_s"] / ours["core_s"]
    lines = f"The recipe has {peer['lines'] / ours['lines']:.1f} times as many lines"
    if abs(ratio - 1) < WITHIN:
        return f"{lines}. Its core-seconds are {ratio:.2f} times ours, which is no difference on a machine that others share."
    return f"{lines}, and takes {ratio:.2f} times the core-seconds."


def rows():
    """Rows of the table: name, and what is said of either."""
    return [
        ("lines of configuration or program", lambda side: side["lines"]),
        ("commands", lambda side: "`run`, `export`" if "strict" in side else "`blenderproc run`"),
        ("pictures", lambda side: side["images"]),
        ("core-seconds", lambda side: f"{side['core_s']:.0f}"),
        ("core-seconds per picture", lambda side: f"{side['core_s'] / side['images']:.1f}"),
        ("wall time, s", lambda side: f"{side['wall_s']:.0f}"),
        ("most memory, MB", lambda side: f"{side['peak_mb']:.0f}"),
        ("targets of which a tenth is visible, per picture", lambda side: f"{side['visible'] / side['images']:.1f}"),
        ("BOP's files, MB", lambda side: f"{side['bop_mb']:.0f}"),
        ("also written", lambda side: f"every layer as Hypersim has it, labels, previews, report card: {side['dataset_mb']:.0f} MB" if "strict" in side else "nothing"),
    ]


def differences():
    yield "- **Where.** Ours are heaps on the tables of furnished homes with their lamps and windows. The recipe's are in a room of five planes with one"
    yield "  texture, under a ceiling that shines and a lamp."
    yield "- **Textures.** The recipe draws the planes' material from some hundred of ambientCG, to be downloaded before. Here it has four made by formula,"
    yield "  in the same files of 2048² pixels; making them is not counted."
    yield "- **Models.** The recipe takes what our export wrote as `models/`, with the colours of the files as colours of vertices, which is not counted."
    yield "  The toolkit knows the published datasets alone, so the folder is called `ycbv`. Distractors are 6 of the same models, ours 4 to 8, half to"
    yield "  four fifths the size."
    yield "- **Rest.** Ours come to rest as convex pieces, and what moves more than 2 mm in two further seconds is not kept. The recipe simulates convex"
    yield "  hulls for 3 to 10 s and keeps every thing wherever it then is."
    yield "- **Cameras.** Both look at groups of objects. Ours also see to it that every object is visible in its share of the frames."
    yield "- **Blender.** BlenderProc 2.8.0 is meant for Blender 4.2.1, which it downloads; here it runs in Blender's Python module, whose version is above."


def agreement(ours, peer):
    yield "bop_toolkit reads both folders. The corners of every model, projected by its pose and the picture's K, give a box, which is compared with"
    yield "`bbox_obj`; only targets that are at least a tenth visible count, and boxes that do not go beyond what `bbox_obj` covers."
    yield ""
    yield "| | enfilade | BlenderProc |"
    yield "|---|---|---|"
    for name, key in [("boxes compared", "boxes"), ("sides that differ by more than 2 pixels", "beyond")]:
        yield f"| {name} | {ours[key]} | {peer[key]} |"
    yield f"| median difference of a side, pixels | {ours['median_px']:.2f} | {peer['median_px']:.2f} |"
    yield ""
    rejected = ", ".join(f"{count} of {ours['images']} pictures by the gate `{gate}`" for gate, count in ours["rejected"].items()) or "none"
    accepts = "accepts" if ours["strict"] else "does not accept"
    yield f"`enfilade verify --strict` {accepts} our dataset: {ours['hold']} of {ours['laws']} laws hold; rejected are {rejected}. BlenderProc has no such check."


if __name__ == "__main__":
    main()
