"""The page of `cargo xtask readers`: tables by format, the classes of differences, and every difference with its class.

`xtask/readers/explanations.json` is a list of classes. A difference belongs to the first class all of whose conditions it fulfils:

- `format` and `peer`, or lists of them; `verdict`, a list of those below;
- `files`, patterns of paths below the folder;
- `ours` and `theirs`, patterns that are found in our message or warnings, and in the peer's message;
- `facts`, a pattern that is found among the facts that any peer tells of the file;
- `counts`, one of `COUNTS`.

`cause` says why both differ, `right` who reads as the format says (`we`, `peer`, `both` where it leaves a choice), and `seen` how the cause
was verified, and on which file.
"""

import json
import os
import re
from argparse import Namespace
from collections import Counter
from collections.abc import Callable
from datetime import date
from fnmatch import fnmatch
from pathlib import Path

import numpy as np

from machine import processor

# What the comparison of a file finds, and whether that is a difference.
VERDICTS = {
    "same": False,
    "triangles": True,
    "bounds": True,
    "triangles and bounds": True,
    "ours only": True,
    "peer only": True,
    "neither": False,
}
# Conditions on the numbers of both.
COUNTS: dict[str, Callable[[dict, dict], bool]] = {
    "peer less flat": lambda own, peer: own["triangles"] == peer["triangles"] - peer["flat"],
    "we less flat": lambda own, peer: own["triangles"] - own["flat"] == peer["triangles"],
    "both less flat": lambda own, peer: own["triangles"] - own["flat"] == peer["triangles"] - peer["flat"],
    "peer all flat": lambda own, peer: peer["flat"] == peer["triangles"] > own.get("flat", 0),
    "peer has more": lambda own, peer: own["triangles"] < peer["triangles"],
    "we have more": lambda own, peer: own["triangles"] > peer["triangles"],
}
# Decimals of bounds in the JSON, relative to the diagonal of the scene.
DIGITS = 6


def write(job: Namespace, rows: list[dict], versions: dict[str, str]) -> int:
    """Writes `readers.md`, and `readers.json` to the work folder; one where a difference has no class."""
    classes = json.loads(Path(job.explanations).read_text())
    for row in rows:
        for name, peer in row["peers"].items():
            peer["class"] = next((k for k, each in enumerate(classes) if VERDICTS[peer["verdict"]] and fulfils(each, row, name)), None)
    told = [row for row in rows if any(peer["verdict"] != "neither" for peer in row["peers"].values())]
    job.docs.mkdir(parents=True, exist_ok=True)
    data = dict(date=date.today().isoformat(), processor=processor(), processors=os.cpu_count(), peers=versions, files=[compact(row, classes) for row in told])
    lines = ",\n".join(json.dumps(each, ensure_ascii=False, separators=(",", ":")) for each in data.pop("files"))
    (job.work / "readers.json").write_text(json.dumps(data, ensure_ascii=False)[:-1] + f', "files": [\n{lines}\n]}}\n')
    (job.docs / "readers.md").write_text("\n".join(page(job, rows, told, classes, versions)) + "\n")
    unexplained = [(row, name) for row in told for name, peer in row["peers"].items() if VERDICTS[peer["verdict"]] and peer["class"] is None]
    for row, name in unexplained:
        print(f"not explained: {difference(row, name)}")
    print(f"{len(told)} files, {len(unexplained)} differences without an explanation")
    return bool(unexplained)


def fulfils(each: dict, row: dict, name: str) -> bool:
    own, peer = row["ours"], row["peers"][name]
    listed = lambda key, value: key not in each or value in (each[key] if isinstance(each[key], list) else [each[key]])
    facts = " ".join(fact for other in row["peers"].values() for fact in other["facts"])
    said = {"ours": own.get("error", " ".join(own.get("warnings", []))), "theirs": peer.get("error", ""), "facts": facts}
    return (
        listed("format", row["format"])
        and listed("peer", name)
        and listed("verdict", peer["verdict"])
        and ("files" not in each or any(fnmatch(row["file"], pattern) for pattern in each["files"]))
        and all(key not in each or re.search(each[key], text) for key, text in said.items())
        and ("counts" not in each or ("triangles" in own and "triangles" in peer and COUNTS[each["counts"]](own, peer)))
    )


def compact(row: dict, classes: list[dict]) -> dict:
    """A file's results: of each reader its triangles and bounds, or its message; of peers only what differs from ours."""
    own = row["ours"]
    shown = dict(file=row["file"], ours=numbers(own))
    for name, peer in row["peers"].items():
        if peer["verdict"] == "same":
            shown[name] = "same"
        elif peer["verdict"] == "neither":
            shown[name] = "neither"
        else:
            shown[name] = dict(differs=peer["verdict"], cause=None if peer["class"] is None else classes[peer["class"]]["class"], **numbers(peer))
    return shown


def numbers(found: dict) -> dict:
    if "error" in found:
        return dict(error=found["error"])
    if "low" not in found:
        return dict(triangles=found["triangles"])
    size = max(float(np.max(np.abs([found["low"], found["high"]]))), 1e-30)
    decimals = DIGITS - int(np.floor(np.log10(size))) - 1
    return dict(triangles=found["triangles"], **{side: [round(value, decimals) + 0.0 for value in found[side]] for side in ("low", "high")})


def page(job: Namespace, rows: list[dict], told: list[dict], classes: list[dict], versions: dict[str, str]):
    yield "# Readers of scene files, beside other programs'"
    yield ""
    yield f"Made by `cargo xtask readers` on {date.today():%d %B %Y}, {processor()}, {os.cpu_count()} cores. Peers: " + ", ".join(f"{name} {number}" for name, number in versions.items()) + "."
    yield from INTRODUCTION.splitlines()
    yield from ["", "## By format", "", *format_table(rows), ""]
    yield from ["## Why they differ", "", *class_table(told, classes), ""]
    yield from ["## Where the files are from", "", *source_table(job, told), ""]
    yield from ["## Every difference", "", "Numbers are triangles, ours and the peer's.", ""]
    yield from every_difference(told, classes)


def format_table(rows: list[dict]):
    yield "| format | peer | files | read by neither | ours | peer | by both | same triangles | same bounds | same in both | differences |"
    yield "|---|---|---|---|---|---|---|---|---|---|---|"
    for kind in dict.fromkeys(row["format"] for row in rows):
        names = dict.fromkeys(name for row in rows if row["format"] == kind for name in row["peers"])
        for name in names:
            found = Counter(row["peers"][name]["verdict"] for row in rows if row["format"] == kind)
            both = found["same"] + found["triangles"] + found["bounds"] + found["triangles and bounds"]
            cells = [
                found.total(), found["neither"], both + found["ours only"], both + found["peer only"], both,
                found["same"] + found["bounds"], found["same"] + found["triangles"], found["same"], sum(found[each] for each, counts in VERDICTS.items() if counts)]
            yield f"| {kind} | {name} | {' | '.join(f'{cell:,}' for cell in cells)} |"


def class_table(told: list[dict], classes: list[dict]):
    yield "| | format, peer: differences | what differs | cause | reads as the format says | verified |"
    yield "|---|---|---|---|---|---|"
    for k, each in enumerate(classes):
        places = [(row["format"], name, peer["verdict"]) for row in told for name, peer in row["peers"].items() if peer["class"] == k]
        if places:
            counts = ", ".join(f"{kind}, {name}: {count}" for (kind, name), count in Counter(place[:2] for place in places).items())
            what = ", ".join(dict.fromkeys(place[2] for place in places))
            yield f"| {each['class']} | {counts} | {what} | {each['cause']} | {each['right']} | {each['seen']} |"


def source_table(job: Namespace, told: list[dict]):
    """Files by repository; FOLDER/commits.json has `[commit, its date]` of each."""
    path = job.folder / "commits.json"
    commits = json.loads(path.read_text()) if path.exists() else {}
    yield "| repository | commit | of | " + " | ".join(kinds := list(dict.fromkeys(row["format"] for row in told))) + " |"
    yield "|---|---|---|" + "---|" * len(kinds)
    of = lambda row: "/".join(row["file"].split("/")[:2])
    for name in dict.fromkeys(map(of, told)):
        counts = Counter(row["format"] for row in told if of(row) == name)
        commit, day = commits.get(name, ("", ""))
        yield f"| {name} | {commit[:12]} | {day} | {' | '.join(f'{counts[kind]:,}' if counts[kind] else '' for kind in kinds)} |"


def every_difference(told: list[dict], classes: list[dict]):
    for k, each in [*enumerate(classes), (None, {"class": "Not explained"})]:
        lines = [difference(row, name) for row in told for name, peer in row["peers"].items() if VERDICTS[peer["verdict"]] and peer["class"] == k]
        if lines:
            yield from [f"### {each['class']}", "", *(f"- {line}" for line in lines), ""]


def difference(row: dict, name: str) -> str:
    own, peer = row["ours"], row["peers"][name]
    count = lambda found: "refused" if "error" in found else f"{found['triangles']:,}"
    return f"`{row['file']}`, {name}: {peer['verdict']}; {count(own)}, {count(peer)}"


INTRODUCTION = """
Every file is imported by `enfilade import` in its own process, and read by each peer that knows its format; each has ten minutes per
file. Triangles are counted. Bounds of the corners of triangles are compared in metres with z up; they count as the same if they agree to
within 0.0001 of the diagonal (and a millionth of the distance from the origin, the limit of single precision). Every difference has a
cause, which was verified on at least one file, as the table says; the program fails if a difference has none. `target/readers/readers.json`
has the numbers of every file.

- *Read* means that at least one triangle was found. *Read by neither* counts files without triangles (layers of materials or cameras,
  clouds of points), and broken ones that both refuse: tests of validators and findings of fuzzers.
- Polygons of n corners count as n − 2 triangles, so counts do not depend on how polygons are triangulated.
- **Our FBX reader is ufbx**, with our own code for units, axes, instances, materials and visibility. assimp has its own reader.
- USD: usd-core has stages but no triangles. The comparison walks the stage at the first moment and counts the meshes, shapes, instances and
  lights with a surface that are visible and have the purpose default or render. Shapes without triangles, such as spheres, get as many as
  our importer gives them, so that their number and bounds can be compared; the same applies to Mitsuba's shapes.
- The files are those of the commits below, without files of 4 MiB or more and files in Git LFS. Pictures of more than 6 kB were replaced
  by pictures of 4x4 pixels of the same format, except in Mitsuba's repositories, since triangles do not depend on them."""
