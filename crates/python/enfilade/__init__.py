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
    FORMATS,
    LAYERS,
    STAGES,
    Config,
    DamagedFileError,
    Dataset,
    Loader,
    LoaderIterator,
    StageError,
    __version__,
    export,
    home,
    import_scene,
    repack,
    run,
    split,
    stage,
    verify,
)

__all__ = [
    "FORMATS",
    "LAYERS",
    "STAGES",
    "Config",
    "DamagedFileError",
    "Dataset",
    "Loader",
    "LoaderIterator",
    "StageError",
    "__version__",
    "export",
    "home",
    "import_scene",
    "repack",
    "run",
    "split",
    "stage",
    "verify",
]
