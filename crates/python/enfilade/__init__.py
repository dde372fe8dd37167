"""3D interiors as photorealistic datasets with dense ground truth.

    import enfilade

    enfilade.run("out", enfilade.Config.demo(quality="draft"))
    frames = enfilade.Dataset("out", layers=["color", "depth_meters", "semantic"], crop=(192, 256), tone_map=True)
    sample = frames[0]
    for batch in frames.loader(batch_size=4, shuffle=True):
        ...

`Dataset` opens enfilade's datasets and Hypersim's release alike. The other functions are the verbs of the command line.
"""

from ._native import (
    LAYERS,
    PIX3D_CATEGORIES,
    STAGES,
    Config,
    DamagedFileError,
    Dataset,
    Loader,
    LoaderIterator,
    StageError,
    __version__,
    compare_meshes,
    judge_shapes,
    read_voxels,
    repack,
    run,
    shape_precision,
    split,
    stage,
    verify,
)

__all__ = [
    "LAYERS",
    "PIX3D_CATEGORIES",
    "STAGES",
    "Config",
    "DamagedFileError",
    "Dataset",
    "Loader",
    "LoaderIterator",
    "StageError",
    "__version__",
    "compare_meshes",
    "judge_shapes",
    "read_voxels",
    "repack",
    "run",
    "shape_precision",
    "split",
    "stage",
    "verify",
]
