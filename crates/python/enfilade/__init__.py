"""3D interiors as photorealistic datasets with dense ground truth.

    import enfilade

    enfilade.run("out", enfilade.Config.demo(quality="draft"))
    frames = enfilade.Dataset("out", layers=["color", "depth_meters", "semantic"], crop=(192, 256), tone_map=True)
    sample = frames[0]
    for batch in frames.loader(batch_size=4, shuffle=True):
        ...

Without a dataset on disk: `render` makes pictures of a `Scene` through a `Camera`, with every layer.

    scene = enfilade.Scene.home(seed=7)
    frame = enfilade.render(scene, scene.camera(), quality="draft")

A scene is a value: its edits, such as `scene.add(mesh)` and `scene.set_material("wall", material)`, each give a new one.

`Dataset` opens enfilade's datasets and Hypersim's release alike, `NyuV2` that dataset's published file. The other functions are the verbs of the command line;
those of `enfilade farm`, which makes a dataset on many machines, are in `enfilade.farm`.
"""

from . import farm
from ._declared import export, home, import_scene, make
from ._frames import Frame, render
from ._native import (
    FORMATS,
    LAYERS,
    NYU13,
    NYU13_OF_NYU40,
    NYU40,
    NYU40_COLORS,
    PIX3D_CATEGORIES,
    STAGES,
    Camera,
    Config,
    Confusion,
    DamagedFileError,
    Dataset,
    Light,
    Loader,
    LoaderIterator,
    Material,
    Mesh,
    NyuV2,
    Part,
    Parts,
    Scene,
    StageError,
    __version__,
    compare_meshes,
    judge_shapes,
    partition,
    read_voxels,
    repack,
    run,
    shape_precision,
    stage,
    verify,
)
from ._recorder import MujocoRecorder

__all__ = [
    "FORMATS",
    "LAYERS",
    "NYU13",
    "NYU13_OF_NYU40",
    "NYU40",
    "NYU40_COLORS",
    "PIX3D_CATEGORIES",
    "STAGES",
    "Camera",
    "Config",
    "Confusion",
    "DamagedFileError",
    "Dataset",
    "Frame",
    "Light",
    "Loader",
    "LoaderIterator",
    "Material",
    "Mesh",
    "MujocoRecorder",
    "NyuV2",
    "Part",
    "Parts",
    "Scene",
    "StageError",
    "__version__",
    "compare_meshes",
    "export",
    "farm",
    "home",
    "import_scene",
    "judge_shapes",
    "make",
    "partition",
    "read_voxels",
    "render",
    "repack",
    "run",
    "shape_precision",
    "stage",
    "verify",
]
