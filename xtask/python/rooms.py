"""The rooms that both renderers load, as Mitsuba XML with the parameters `width`, `height`, `depth` and `sampler`."""

import os
import re
import subprocess
import sys
from pathlib import Path

# Rooms that come as Mitsuba XML, and rooms that the exporter turns into it.
XML_ROOMS = {"grey-white-room": "mitsuba/scene.xml", "modern-hall": "mitsuba/scene.xml"}
GLTF_ROOMS = {
    "bedroom": "gltf/scene.gltf",
    "contemporary-bathroom": "gltf/scene.gltf",
    "japanese-classroom": "gltf/scene.gltf",
    "drake-furnished-living-room": "scene.gltf",
}
ROOMS = [*XML_ROOMS, *GLTF_ROOMS]

PARAMETERS = """
	<default name="width" value="256"/>
	<default name="height" value="192"/>
	<default name="depth" value="10"/>
	<default name="sampler" value="independent"/>
	<integrator type="path"><integer name="max_depth" value="$depth"/></integrator>
"""
FILM = """<film type="hdrfilm">
			<integer name="width" value="$width"/><integer name="height" value="$height"/>
			<string name="pixel_format" value="rgb"/><string name="component_format" value="float32"/>
			<rfilter type="box"/>
		</film>"""
SAMPLER = """<sampler type="$sampler"><integer name="sample_count" value="16"/></sampler>"""


def parametrised(xml):
    """A scene's text with our integrator, film and sampler in place of its own; the rest stays to the letter."""
    xml = re.sub(r"<integrator\b.*?</integrator>", "", xml, flags=re.S)
    xml = re.sub(r"<film\b.*?</film>", FILM, xml, flags=re.S)
    xml = re.sub(r"<sampler\b.*?</sampler>", SAMPLER, xml, flags=re.S)
    return re.sub(r"(<scene\b[^>]*>)", lambda m: m[1] + PARAMETERS, xml, count=1)


def exported(source, work, bench):
    """Writes a scene of another format as XML, with meshes and textures, into the folder `work`, and returns its path."""
    work.mkdir(parents=True, exist_ok=True)
    subprocess.run([bench, "to-mitsuba", source, work], check=True, stdout=subprocess.DEVNULL)
    return write(work / "exported.xml", work)


def prepare(name, scenes, work, bench):
    """Writes the room's XML below `work` and returns its path."""
    folder = Path(work) / name
    original = Path(scenes) / name / (GLTF_ROOMS | XML_ROOMS)[name]
    if not original.is_file():
        sys.exit(f"{original} is missing; ENFILADE_SCENES should name the folder of the shared rooms")
    if name in GLTF_ROOMS:
        return exported(original, folder, bench)
    folder.mkdir(parents=True, exist_ok=True)
    for entry in original.parent.iterdir():
        link = folder / entry.name
        if entry.is_dir() and not link.exists():
            os.symlink(entry.resolve(), link, target_is_directory=True)
    return write(original, folder)


def write(original, folder):
    scene = folder / "scene.xml"
    scene.write_text(parametrised(original.read_text()))
    return scene
