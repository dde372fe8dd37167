"""Scores of a network on whole images, and pictures of what it sees."""

from pathlib import Path
from typing import Any, Iterator

import enfilade
import numpy as np
import torch
from torch import nn

from ..common.distributed import Replica
from .config import Config
from .data import VOID, Source, class_names, evaluation_loader


def predict(network: nn.Module, images: list[torch.Tensor], device: torch.device) -> list[torch.Tensor]:
    """The likeliest class of each pixel: int64, height x width, for images that are uint8, 3 x height x width."""
    network.eval()
    with torch.no_grad():
        if len({image.shape for image in images}) == 1:
            return list(network(torch.stack(images).to(device)).argmax(1).cpu())
        return [network(image[None].to(device)).argmax(1)[0].cpu() for image in images]


def evaluate(network: nn.Module, source: Source, config: Config, replica: Replica) -> enfilade.Confusion:
    """The confusion of all images of the source; replicas share the work, and each gets the whole result.

    The network stays in the mode, training or evaluation, in which it was.
    """
    confusion, was_training = enfilade.Confusion(config.classes), network.training
    mine = list(range(len(source)))[replica.rank :: replica.count]
    for batch in evaluation_loader(source, mine, config.evaluation.batch_size, config.train.workers):
        predictions = predict(network, [image for image, _ in batch], replica.device)
        for prediction, (_, classes) in zip(predictions, batch):
            confusion.add(prediction.numpy(), classes.numpy(), ignore=VOID)
    network.train(was_training)
    counts = replica.sum(torch.from_numpy(confusion.counts))
    return enfilade.Confusion(config.classes, counts.numpy())


def report(confusion: enfilade.Confusion, config: Config) -> dict[str, Any]:
    """The scores as plain data; those of classes that do not occur are None."""
    names = class_names(config.test_data or config.train_data, config.classes)
    return {
        "mean_iou": confusion.mean_iou,
        "pixel_accuracy": confusion.pixel_accuracy,
        "pixels": confusion.pixels,
        "iou": dict(zip(names, confusion.iou)),
    }


def pictures(network: nn.Module, source: Source, count: int, device: torch.device, classes: int) -> Iterator[tuple[str, np.ndarray]]:
    """Names and pictures of the first images: the image, the true and the predicted classes side by side; uint8, height x width x 3."""
    was_training = network.training
    for index in range(min(count, len(source))):
        image, truth = source[index]
        prediction = predict(network, [torch.from_numpy(image).permute(2, 0, 1)], device)[0].numpy()
        yield source.name(index), np.concatenate([image, colored(truth, classes), colored(prediction, classes)], axis=1)
    network.train(was_training)


def colored(values: np.ndarray, classes: int) -> np.ndarray:
    """Classes as colours, uint8, height x width x 3; black where there is none."""
    table = np.concatenate([palette(classes), np.zeros((1, 3), dtype=np.uint8)])
    return table[np.where((values >= 0) & (values < classes), values, classes)]


def palette(classes: int) -> np.ndarray:
    """A colour for each class: NYU40's, those of the NYU40 class that stands for a class of NYU13, or hues that advance by the golden ratio."""
    nyu40 = np.array(enfilade.NYU40_COLORS, dtype=np.uint8)
    if classes == 40:
        return nyu40
    if classes == 13:
        return np.array([nyu40[_of_nyu13(i + 1)] for i in range(13)], dtype=np.uint8)
    hues = np.arange(1, classes + 1) * 0.6180339887498949 % 1.0
    waves = np.abs((hues[:, None] * 6.0 + np.array([0.0, 4.0, 2.0])) % 6.0 - 3.0) - 1.0
    return np.round(255.0 * (0.25 + 0.7 * np.clip(waves, 0.0, 1.0))).astype(np.uint8)


def _of_nyu13(nyu13: int) -> int:
    """The NYU40 class, from 0, of the same name, or the first that counts as it."""
    members = [i for i, found in enumerate(enfilade.NYU13_OF_NYU40[1:]) if found == nyu13]
    same = [i for i in members if enfilade.NYU40[i] == enfilade.NYU13[nyu13 - 1]]
    return (same or members)[0]


def write_pictures(
    network: nn.Module, source: Source, folder: Path, config: Config, device: torch.device, write: Any
) -> Iterator[Path]:
    """Writes two PNG files per image into a folder: `NAME.classes.png`, whose values are classes from 1, and `NAME.color.png`.

    write: called with a path and an array.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for index in range(len(source)):
        image, _ = source[index]
        prediction = predict(network, [torch.from_numpy(image).permute(2, 0, 1)], device)[0].numpy()
        numbers = (prediction + 1).astype(np.uint16 if config.classes > 255 else np.uint8)
        for kind, values in (("classes", numbers), ("color", colored(prediction, config.classes))):
            path = folder / f"{source.name(index)}.{kind}.png"
            write(path, values)
            yield path
