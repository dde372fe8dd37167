"""`render`, and what it gives."""

from . import _native
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


def render(
    scene,
    camera,
    *,
    quality=None,
    samples=None,
    layers=None,
    denoise=None,
    seed=0,
    noise=None,
    max_bounces=None,
    clamp=None,
    lambertian=False,
    progress=None,
):
    """Renders a picture of a scene in memory, with every layer; nothing is written to disk.

    scene: an `enfilade.Scene`. camera: an `enfilade.Camera`, or several, which are the frames of one trajectory: then a list of frames comes back.
    quality: "draft", "normal" (the default), "high" or "reference", as of `Config`; samples: per pixel, instead.
    layers: names; unless given, all that a run writes. Those of `extra` (such as "material_id", "optical_flow") and of `light_parts` (such as
    "diffuse_direct") are rendered where they are named; flow leads from one camera to the next.
    denoise: whether `color`, `diffuse_illumination` and `residual` are denoised, with what was rendered beside them as `*_rendered`; yes, but for
    "reference", unless given.
    seed: of the noise. noise: ends once the picture is that clean, such as 0.02. max_bounces, clamp, lambertian: as in [render].
    progress: shows how far it has come; unless given, in notebooks and terminals.

    Gives a `Frame`: a dictionary of numpy arrays as `Dataset` gives them. The same arguments give the same bytes, whatever the number of threads;
    and those that a run writes for the same scene, settings and trajectory, where `seed` is the seed in the frame's record. Only the sign of zeros in
    `normal_cam` and `normal_bump_cam` may differ, which OpenCV's form of the pose does not keep.
    """
    single = isinstance(camera, _native.Camera)
    cameras = [camera] if single else list(camera)
    if not cameras:
        raise ValueError("there is no camera; give one, or several")
    rendered = _native.render(
        scene,
        cameras,
        quality=quality,
        samples=samples,
        layers=layers,
        denoise=denoise,
        seed=seed,
        noise=noise,
        max_bounces=max_bounces,
        clamp=clamp,
        lambertian=lambertian,
        progress=progress,
    )
    frames = [Frame(sample) for sample in rendered]
    return frames[0] if single else frames


for _public in (Frame, render):
    _public.__module__ = "enfilade"
