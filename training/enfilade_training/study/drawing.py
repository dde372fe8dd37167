"""A drawing of the classes that networks predict for some test photographs, beside the true ones. No photograph is in it."""

from pathlib import Path

import enfilade
import numpy as np
from PIL import Image, ImageDraw, ImageFont

from ..segmentation.evaluate import colored, palette
from .config import HEADS, SEMANTICS, Study
from .judge import predict
from .network import UNet
from .pictures import VOID, Pictures, evenly
from .runs import Maker, Run

# Photographs that are drawn, evenly chosen; width of a map, what is between maps, and the height of a line of text, in pixels.
COUNT, WIDTH, MARGIN, LINE = 8, 150, 4, 20
WHITE, BLACK = (255, 255, 255), (0, 0, 0)


def write(study: Study, maker: Maker, folder: Path) -> list[Path]:
    """Draws what the networks of the largest share of photographs predict, of the first seed of which all are here, as nyuv2.png."""
    if SEMANTICS not in study.tasks:
        return []
    path, fraction = folder / "nyuv2.png", max(study.fractions)
    for seed in range(study.seeds):
        runs = [Run(arm, fraction, seed) for arm in study.arms]
        if all(maker.finished(run) and (maker.folder(run) / "last.pt").is_file() for run in runs):
            drawing(study, maker.pictures("test"), {run.arm: maker.tuned(run).network for run in runs}).save(path)
            return [path]
    maker.say(f"{path.name} is not drawn: the networks of all arms for {100 * fraction:g} % of the photographs are not all below {study.output}")
    return []


def drawing(study: Study, pictures: Pictures, networks: dict[str, UNet]) -> Image.Image:
    """A row for each photograph, with a column for the truth and each network, which are given by their titles."""
    chosen = evenly(len(pictures), COUNT)
    columns = {"truth": [_map(pictures.classes(SEMANTICS, index).numpy()) for index in chosen]}
    for title, network in networks.items():
        columns[title] = [_map(predict(network, pictures, slice(index, index + 1), study)[SEMANTICS][0]) for index in chosen]
    return _sheet(columns)


def _map(classes: np.ndarray) -> Image.Image:
    """Classes in their colours; black where there is none."""
    height, width = classes.shape
    image = Image.fromarray(colored(np.where(classes == VOID, -1, classes.astype(np.int64)), HEADS[SEMANTICS]))
    return image.resize((WIDTH, round(WIDTH * height / width)), Image.Resampling.NEAREST)


def _sheet(columns: dict[str, list[Image.Image]]) -> Image.Image:
    """The maps below the titles of their columns, and the colours of classes below all."""
    height = columns["truth"][0].height + MARGIN
    bottom = LINE + height * len(columns["truth"])
    sheet = Image.new("RGB", (MARGIN + len(columns) * (WIDTH + MARGIN), bottom + 2 * LINE + MARGIN), WHITE)
    draw, font = ImageDraw.Draw(sheet), ImageFont.load_default(13)
    for i, (title, maps) in enumerate(columns.items()):
        x = MARGIN + i * (WIDTH + MARGIN)
        draw.text((x, 3), title, BLACK, font)
        for row, image in enumerate(maps):
            sheet.paste(image, (x, LINE + row * height))
    colors, each = palette(HEADS[SEMANTICS]), -(-HEADS[SEMANTICS] // 2)
    for i, name in enumerate(enfilade.NYU13):
        x, y = MARGIN + i % each * (sheet.width // each), bottom + i // each * LINE + MARGIN
        draw.rectangle((x, y, x + 12, y + 12), tuple(int(value) for value in colors[i]))
        draw.text((x + 17, y - 2), name, BLACK, font)
    return sheet
