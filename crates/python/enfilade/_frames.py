"""`render`, and what it gives."""

from . import _native
from ._declared import explained
from ._display import frame_html


class Frame(dict):
    """A rendered frame: a dictionary as `Dataset` gives them, which notebooks show as pictures.

    It has every layer by its name (`enfilade.LAYERS` has units, spaces and sentinels), `mask`, `K`, `world_from_camera`, `scene`, `camera`, `frame`,
    `index` and `window`; `help(enfilade.Dataset)` says what each is.
    """

    def png(self, layer="display"):
        """The bytes of a PNG file that shows a layer; "display" is the colour as people see it."""
        pictures = _native.pictures(self, [layer])
        if layer not in pictures:
            shown = [name for name in self if name in _native.LAYERS]
            raise ValueError(f"the frame cannot show {layer!r}; it has: {', '.join(shown)}")
        return pictures[layer]

    def _repr_png_(self):
        return _native.pictures(self, ["display"]).get("display")

    def _repr_html_(self):
        return frame_html(self)


@explained("RenderOptions")
def render(scene, camera, *, progress=None, **options):
    """Renders a picture of a scene in memory, with every layer; nothing is written to disk.

    scene: an `enfilade.Scene`. camera: an `enfilade.Camera`, or several, which are the frames of one trajectory: then a list of frames comes back.
    {options}
    progress: shows how far it has come; unless given, in notebooks and terminals.

    Gives a `Frame`: a dictionary of numpy arrays as `Dataset` gives them. The same arguments give the same bytes, whatever the number of threads;
    and those that a run writes for the same scene, settings and trajectory, where `seed` is the seed in the frame's record. Only the sign of zeros in
    `normal_cam` and `normal_bump_cam` may differ, which OpenCV's form of the pose does not keep.
    """
    single = isinstance(camera, _native.Camera)
    cameras = [camera] if single else list(camera)
    if not cameras:
        raise ValueError("there is no camera; give one, or several")
    rendered = _native.render(scene, cameras, progress=progress, **options)
    frames = [Frame(sample) for sample in rendered]
    return frames[0] if single else frames


Frame.__module__ = "enfilade"
