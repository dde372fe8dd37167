"""Makes a small dataset, and loads it in batches as training does.

python load_for_training.py [folder]
"""

import sys
from pathlib import Path

import enfilade
import numpy as np


def main(folder: Path, size: tuple[int, int] = (320, 240)) -> int:
    enfilade.run(folder, enfilade.Config.demo(frames=4, size=size, quality="draft"))
    crop = (size[1] // 2, size[0] // 2)
    frames = enfilade.Dataset(folder, layers=["color", "depth_z_meters", "semantic"], crop=crop, crop_place="random", tone_map=True)
    batches = 0
    for batch in frames.loader(batch_size=2, shuffle=True):
        assert batch["color"].dtype == np.uint8 and batch["color"].shape == (2, *crop, 3)
        classes = [enfilade.NYU40[label - 1] for label in np.unique(batch["semantic"]) if label > 0]
        print(f"{batch['scene']}: {np.nanmean(batch['depth_z_meters']):.2f} m, {', '.join(classes)}")
        batches += 1
    return batches


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "out"))
