"""The types of the module `enfilade`. What each function and class does is in its doc string: `help(enfilade.Dataset)`."""

from collections.abc import Iterable, Iterator, Sequence
from os import PathLike
from typing import Any, Literal, TypedDict, final, overload

import numpy
from numpy.typing import ArrayLike, NDArray

from . import farm as farm

__version__: str

Path = str | PathLike[str]
Names = str | Sequence[str]
Split = Literal["train", "val", "test"]
Sample = dict[str, Any]

class Layer(TypedDict):
    channels: int
    dtype: str
    unit: str
    space: str
    sentinel: str
    description: str

FORMATS: dict[str, str]
LAYERS: dict[str, Layer]
NYU13: tuple[str, ...]
NYU13_OF_NYU40: tuple[int, ...]
NYU40: tuple[str, ...]
NYU40_COLORS: tuple[tuple[int, int, int], ...]
PIX3D_CATEGORIES: list[str]
STAGES: list[str]

class DamagedFileError(OSError): ...

class StageError(RuntimeError):
    summary: dict[str, Any]

class Dataset:
    def __new__(
        cls,
        path: Path,
        *,
        # options: DatasetOptions
        layers: Names | None = None,
        scenes: Names | None = None,
        cameras: Names | None = None,
        split: Literal["train", "val", "test"] | None = None,
        crop: Sequence[int] | None = None,
        resize: Sequence[int] | None = None,
        tone_map: bool = False,
        mask: bool = True,
        poses: bool = True,
        stored: bool = False,
        seed: int = 0,
        # end of options
        crop_place: Literal["center", "random"] | tuple[int, int] = "center",
        epoch: int = 0,
        camera_table: Path | None = None,
    ) -> Dataset: ...
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[Sample]: ...
    def __getitem__(self, index: int, /) -> Sample: ...
    def __getitems__(self, indices: Sequence[int]) -> list[Sample]: ...
    def place(self, index: int) -> tuple[str, str, int]: ...
    def pairs(self, file: Path | None = None) -> list[tuple[int, int]]: ...
    @property
    def layers(self) -> list[str]: ...
    @property
    def epoch(self) -> int: ...
    def set_epoch(self, epoch: int) -> None: ...
    def _repr_html_(self) -> str: ...
    def loader(
        self,
        batch_size: int | None = None,
        *,
        shuffle: bool = False,
        threads: int | None = None,
        prefetch: int | None = None,
        drop_last: bool = False,
    ) -> Loader: ...

@final
class Loader(Iterable[Sample]):
    def __len__(self) -> int: ...
    def __iter__(self) -> LoaderIterator: ...
    @property
    def epoch(self) -> int: ...
    def set_epoch(self, epoch: int) -> None: ...

@final
class LoaderIterator:
    def __iter__(self) -> LoaderIterator: ...
    def __next__(self) -> Sample: ...

@final
class Config:
    @staticmethod
    def read(
        file: Path,
        *,
        # options: Overrides
        seed: int | None = None,
        frames: int | None = None,
        size: Sequence[int] | None = None,
        quality: Literal["draft", "normal", "high", "reference"] | None = None,
        # end of options
        # options: RenderChoices
        samples: int | None = None,
        noise: float | None = None,
        max_bounces: int | None = None,
        clamp: float | None = None,
        time_limit_s: float | None = None,
        light_parts: bool = False,
        fixtures: bool = False,
        extra: bool = False,
        lambertian: bool = False,
        color: Literal["rendered", "denoised"] | None = None,
        # end of options
    ) -> Config: ...
    @staticmethod
    def demo(
        *,
        # options: Overrides
        seed: int | None = None,
        frames: int | None = None,
        size: Sequence[int] | None = None,
        quality: Literal["draft", "normal", "high", "reference"] | None = None,
        # end of options
        # options: RenderChoices
        samples: int | None = None,
        noise: float | None = None,
        max_bounces: int | None = None,
        clamp: float | None = None,
        time_limit_s: float | None = None,
        light_parts: bool = False,
        fixtures: bool = False,
        extra: bool = False,
        lambertian: bool = False,
        color: Literal["rendered", "denoised"] | None = None,
        # end of options
    ) -> Config: ...
    @staticmethod
    def from_dict(settings: dict[str, Any], base: Path = ".") -> Config: ...
    def to_dict(self) -> dict[str, Any]: ...
    @property
    def name(self) -> str: ...
    @property
    def scenes(self) -> list[str]: ...

class Lens(TypedDict, total=False):
    aperture_radius_m: float
    f_number: float
    focal_length_mm: float
    focus_distance_m: float
    blades: int
    focus_tilt_deg: Sequence[float]

CameraModel = Literal["pinhole", "radial_tangential", "fisheye", "equirectangular"]

@final
class Camera:
    def __new__(
        cls,
        K: ArrayLike | None,
        size: Sequence[int],
        world_from_camera: ArrayLike,
        *,
        model: CameraModel = "pinhole",
        distortion: Sequence[float] | None = None,
        lens: Lens | None = None,
        name: str = "camera",
    ) -> Camera: ...
    @staticmethod
    def look_at(
        position: Sequence[float],
        target: Sequence[float],
        size: Sequence[int] = ...,
        fov_x_deg: float = 60.0,
        *,
        up: Sequence[float] = ...,
        name: str = "camera",
    ) -> Camera: ...
    @property
    def K(self) -> NDArray[numpy.float64] | None: ...
    @property
    def size(self) -> tuple[int, int]: ...
    @property
    def world_from_camera(self) -> NDArray[numpy.float64]: ...
    @property
    def position(self) -> NDArray[numpy.float64]: ...
    @property
    def model(self) -> CameraModel: ...
    @property
    def distortion(self) -> list[float]: ...
    @property
    def name(self) -> str: ...

@final
class Mesh:
    def __new__(
        cls, vertices: ArrayLike, triangles: ArrayLike, *, normals: ArrayLike | None = None, uvs: ArrayLike | None = None
    ) -> Mesh: ...
    @staticmethod
    def box(size: Sequence[float]) -> Mesh: ...
    @staticmethod
    def sphere(radius: float, steps: int = 48) -> Mesh: ...
    @property
    def vertices(self) -> NDArray[numpy.float32]: ...
    @property
    def triangles(self) -> NDArray[numpy.uint32]: ...
    @property
    def normals(self) -> NDArray[numpy.float32] | None: ...
    @property
    def uvs(self) -> NDArray[numpy.float32] | None: ...

@final
class Material:
    def __new__(
        cls,
        color: ArrayLike | None = None,
        *,
        name: str = "material",
        roughness: float | None = None,
        metallic: float = 0.0,
        emission: ArrayLike | None = None,
        texture: NDArray[numpy.uint8] | None = None,
    ) -> Material: ...
    @property
    def name(self) -> str: ...

@final
class Light:
    @staticmethod
    def point(position: ArrayLike, intensity: ArrayLike, *, name: str = "light") -> Light: ...
    @staticmethod
    def spot(
        position: ArrayLike,
        target: ArrayLike,
        intensity: ArrayLike,
        *,
        angle_deg: float = 60.0,
        soft: float = 0.2,
        name: str = "spot",
    ) -> Light: ...
    @staticmethod
    def sun(direction: ArrayLike, irradiance: ArrayLike, *, angle_deg: float = 0.533, name: str = "sun") -> Light: ...
    @property
    def kind(self) -> Literal["point", "spot", "profile", "sun"]: ...
    @property
    def name(self) -> str: ...
    @property
    def position(self) -> NDArray[numpy.float64] | None: ...
    @property
    def direction(self) -> NDArray[numpy.float64] | None: ...
    @property
    def intensity(self) -> NDArray[numpy.float64] | None: ...
    @property
    def irradiance(self) -> NDArray[numpy.float64] | None: ...

@final
class Part:
    @property
    def name(self) -> str: ...
    @property
    def object(self) -> str | None: ...
    @property
    def render_entity_id(self) -> int: ...
    @property
    def label(self) -> str | None: ...
    @property
    def semantic(self) -> int: ...
    @property
    def instance(self) -> int: ...
    @property
    def mesh(self) -> Mesh: ...
    @property
    def material(self) -> str: ...
    @property
    def pose(self) -> NDArray[numpy.float64]: ...
    @property
    def box(self) -> NDArray[numpy.float64]: ...

@final
class Parts:
    @property
    def names(self) -> list[str]: ...
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[Part]: ...
    def __contains__(self, key: object, /) -> bool: ...
    @overload
    def __getitem__(self, key: int | str, /) -> Part: ...
    @overload
    def __getitem__(self, key: slice, /) -> list[Part]: ...

class MujocoRecorder:
    def __init__(self, model: Any) -> None: ...
    def step(self, data: Any) -> None: ...
    def save(
        self,
        file: Path,
        *,
        # options: FileSource
        meters_per_unit: float = 1.0,
        up_axis: Literal["y", "z", "x", "-x", "-y", "-z"] | None = None,
        environment: Path | None = None,
        lamps: Literal["ceiling"] | None = None,
        drop_doubled_faces: bool = False,
        still: bool = False,
        states: Path | None = None,
        geom_groups: Sequence[int] | None = None,
        panes: Names | None = None,
        allow_missing_textures: bool = False,
        allow_missing_meshes: bool = False,
        # end of options
    ) -> dict[str, Any]: ...
    def __len__(self) -> int: ...

Selected = str | Part | Iterable[str | Part]
Shape = Mesh | tuple[ArrayLike, ArrayLike] | Any

@final
class Scene:
    @staticmethod
    def empty(name: str = "scene") -> Scene: ...
    @staticmethod
    def read(
        file: Path,
        *,
        # options: FileSource
        meters_per_unit: float = 1.0,
        up_axis: Literal["y", "z", "x", "-x", "-y", "-z"] | None = None,
        environment: Path | None = None,
        lamps: Literal["ceiling"] | None = None,
        drop_doubled_faces: bool = False,
        still: bool = False,
        states: Path | None = None,
        geom_groups: Sequence[int] | None = None,
        panes: Names | None = None,
        allow_missing_textures: bool = False,
        allow_missing_meshes: bool = False,
        # end of options
        labels: Path | None = None,
        label_scene: str | None = None,
        progress: bool | None = None,
    ) -> Scene: ...
    @staticmethod
    def home(
        *,
        # options: HomeConfig
        seed: int = 0,
        building: Literal["home", "office", "school", "shop", "cafe", "library", "hotel", "gym", "workshop"] = "home",
        rooms: Names | None = None,
        plan: str | None = None,
        shape: Literal["rectangular", "varied"] = "rectangular",
        layout: int | None = None,
        furniture: int | None = None,
        materials: int | None = None,
        realism: float = 1.0,
        light: int | None = None,
        moment: Literal["day", "evening", "night"] | None = None,
        clutter: float = 1.0,
        lived_in: float = 0.5,
        states: Literal["made", "closed", "open", "random"] | None = None,
        assets: Names | None = None,
        assets_share: float = 1.0,
        allow_broken_assets: bool = False,
        # end of options
    ) -> Scene: ...
    def add(
        self,
        source: Shape | Path | Scene,
        pose: ArrayLike | None = None,
        *,
        turn_deg: float = 0.0,
        name: str | None = None,
        label: str | int | None = None,
        material: Material | str | None = None,
        meters_per_unit: float = 1.0,
        up_axis: Literal["y", "z", "x", "-x", "-y", "-z"] | None = None,
        allow_missing_textures: bool = False,
        progress: bool | None = None,
    ) -> Scene: ...
    def remove(self, parts: Selected) -> Scene: ...
    def move(
        self, parts: Selected, by: ArrayLike | None = None, *, to: Sequence[float] | None = None, turn_deg: float = 0.0
    ) -> Scene: ...
    def scale(self, parts: Selected, factor: ArrayLike, *, about: Sequence[float] | None = None) -> Scene: ...
    def set_material(self, parts: Selected, material: Material | str) -> Scene: ...
    def animate(
        self,
        *,
        # options: MotionGroup
        of: Names | None = None,
        joint: Names | None = None,
        open: Sequence[float] | None = None,
        name: str | None = None,
        on: str | None = None,
        times_s: Sequence[float] | None = None,
        angles_deg: Sequence[float] | None = None,
        distances_m: Sequence[float] | None = None,
        moved_m: Sequence[Sequence[float]] | None = None,
        turned_deg: Sequence[Sequence[float]] | None = None,
        axis: Sequence[float] | None = None,
        point_m: Sequence[float] | None = None,
        # end of options
    ) -> Scene: ...
    def at(self, time_s: float) -> Scene: ...
    def add_light(self, light: Light) -> Scene: ...
    def remove_light(self, name: str) -> Scene: ...
    def add_camera(self, camera: Camera, name: str | None = None) -> Scene: ...
    def remove_camera(self, name: str) -> Scene: ...
    def camera(self, name: str | None = None, *, size: Sequence[int] = ..., fov_x_deg: float | None = None) -> Camera: ...
    def save(self, file: Path) -> list[str]: ...
    def plan_svg(self, width: int = 400) -> str: ...
    def _repr_html_(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def summary(self) -> str: ...
    @property
    def bounds(self) -> NDArray[numpy.float64]: ...
    @property
    def triangles(self) -> int: ...
    @property
    def parts(self) -> Parts: ...
    @property
    def labels(self) -> NDArray[numpy.int16]: ...
    @property
    def materials(self) -> list[str]: ...
    @property
    def lights(self) -> list[Light]: ...
    @property
    def cameras(self) -> list[str]: ...
    @property
    def bodies(self) -> list[dict[str, Any]]: ...
    @property
    def warnings(self) -> list[dict[str, str]]: ...
    @property
    def report(self) -> dict[str, Any]: ...

class Frame(dict[str, Any]):
    def png(self, layer: str = "display") -> bytes: ...
    def _repr_png_(self) -> bytes | None: ...
    def _repr_html_(self) -> str: ...

@overload
def render(
    scene: Scene,
    camera: Camera,
    *,
    # options: RenderOptions
    quality: Literal["draft", "normal", "high", "reference"] | None = None,
    samples: int | None = None,
    layers: Names | None = None,
    denoise: bool | None = None,
    seed: int = 0,
    noise: float | None = None,
    max_bounces: int | None = None,
    clamp: float | None = None,
    lambertian: bool = False,
    # end of options
    progress: bool | None = None,
) -> Frame: ...
@overload
def render(
    scene: Scene,
    camera: Iterable[Camera],
    *,
    # options: RenderOptions
    quality: Literal["draft", "normal", "high", "reference"] | None = None,
    samples: int | None = None,
    layers: Names | None = None,
    denoise: bool | None = None,
    seed: int = 0,
    noise: float | None = None,
    max_bounces: int | None = None,
    clamp: float | None = None,
    lambertian: bool = False,
    # end of options
    progress: bool | None = None,
) -> list[Frame]: ...
def run(
    output: Path, config: Config | None = None, *, scenes: Names | None = None, progress: bool | None = None
) -> dict[str, Any]: ...
def stage(
    name: str, dataset: Path, *, scenes: Names | None = None, force: bool = False, progress: bool | None = None
) -> dict[str, Any]: ...
def verify(dataset: Path, *, scenes: Names | None = None) -> dict[str, Any]: ...
def partition(dataset: Path, *, seed: int | None = None, shares: Sequence[float] | None = None) -> dict[str, Any]: ...
def make(
    dataset: Path,
    what: Names | None = None,
    *,
    # options: ProductOptions
    pairs: Path | None = None,
    overlap: Sequence[float] | None = None,
    baseline_m: Sequence[float] | None = None,
    angle_deg: Sequence[float] | None = None,
    pixels: int = 3000,
    step: int | None = None,
    between: Sequence[tuple[str, int] | str] | None = None,
    points: int = 256,
    seed: int = 0,
    layers: int = 8,
    sensors: Path | None = None,
    mixes: Path | None = None,
    # end of options
    stale: bool = False,
    force: bool = False,
    scenes: Names | None = None,
    cameras: Names | None = None,
    frames: int | range | None = None,
    camera_table: Path | None = None,
    progress: bool | None = None,
) -> list[dict[str, Any]]: ...
def repack(dataset: Path, output: Path, *, layers: Names | None = None) -> dict[str, int]: ...
def export(
    dataset: Path,
    format: str,
    output: Path,
    *,
    # options: ExportOptions
    layers: Names | None = None,
    shard_mb: int = 1000,
    cloud: Literal["frames", "mesh"] = "frames",
    symmetries: Literal["shape", "bop", "none"] = "shape",
    # end of options
    scenes: Names | None = None,
    cameras: Names | None = None,
    frames: int | range | None = None,
    force: bool = False,
    camera_table: Path | None = None,
    progress: bool | None = None,
) -> dict[str, int]: ...
def import_scene(
    file: Path,
    output: Path | None = None,
    *,
    # options: FileSource
    meters_per_unit: float = 1.0,
    up_axis: Literal["y", "z", "x", "-x", "-y", "-z"] | None = None,
    environment: Path | None = None,
    lamps: Literal["ceiling"] | None = None,
    drop_doubled_faces: bool = False,
    still: bool = False,
    states: Path | None = None,
    geom_groups: Sequence[int] | None = None,
    panes: Names | None = None,
    allow_missing_textures: bool = False,
    allow_missing_meshes: bool = False,
    # end of options
) -> dict[str, Any]: ...
def home(
    output: Path = "home.scene",
    *,
    # options: HomeConfig
    seed: int = 0,
    building: Literal["home", "office", "school", "shop", "cafe", "library", "hotel", "gym", "workshop"] = "home",
    rooms: Names | None = None,
    plan: str | None = None,
    shape: Literal["rectangular", "varied"] = "rectangular",
    layout: int | None = None,
    furniture: int | None = None,
    materials: int | None = None,
    realism: float = 1.0,
    light: int | None = None,
    moment: Literal["day", "evening", "night"] | None = None,
    clutter: float = 1.0,
    lived_in: float = 0.5,
    states: Literal["made", "closed", "open", "random"] | None = None,
    assets: Names | None = None,
    assets_share: float = 1.0,
    allow_broken_assets: bool = False,
    # end of options
) -> dict[str, Any]: ...

class NyuV2:
    def __new__(
        cls,
        path: Path,
        *,
        split: Literal["train", "test"] | None = None,
        classes: Literal[894, 40, 13] = 40,
        layers: Names | None = None,
        partial: bool = False,
    ) -> NyuV2: ...
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[Sample]: ...
    def __getitem__(self, index: int, /) -> Sample: ...
    def __getitems__(self, indices: Sequence[int]) -> list[Sample]: ...
    def frame(self, index: int) -> int: ...
    @property
    def layers(self) -> list[str]: ...
    @property
    def class_names(self) -> list[str]: ...

@final
class Confusion:
    def __new__(cls, classes: int, counts: Any | None = None) -> Confusion: ...
    def add(self, prediction: Any, truth: Any, ignore: int = -1) -> None: ...
    def merge(self, other: Confusion) -> None: ...
    @property
    def counts(self) -> Any: ...
    @property
    def classes(self) -> int: ...
    @property
    def pixels(self) -> int: ...
    @property
    def iou(self) -> list[float | None]: ...
    @property
    def mean_iou(self) -> float | None: ...
    @property
    def pixel_accuracy(self) -> float | None: ...

Surface = tuple[NDArray[Any], NDArray[Any]]

class MeshComparison(TypedDict):
    chamfer_l2: float
    normal_consistency: float
    abs_normal_consistency: float
    precision: dict[float, float]
    recall: dict[float, float]
    f1: dict[float, float]

class ShapeObject(TypedDict):
    category: int
    box: Sequence[float]
    mask: NDArray[Any]
    mesh: Surface

class ShapeDetection(ShapeObject):
    score: float

class JudgedShape(TypedDict):
    category: int
    score: float
    truth: int
    box_iou: float
    mask_iou: float
    f1: float
    box_hit: bool
    mask_hit: bool
    mesh_hit: bool

def compare_meshes(
    found: Surface,
    truth: Surface,
    *,
    samples: int = 10_000,
    longest_edge: float | None = 10.0,
    thresholds: Sequence[float] = (0.1, 0.2, 0.3, 0.4, 0.5),
    seed: int = 0,
) -> MeshComparison: ...
def judge_shapes(
    truths: Sequence[ShapeObject],
    found: Sequence[ShapeDetection],
    *,
    filter_iou: float = 0.3,
    iou: float = 0.5,
    f1: float = 0.5,
    f1_distance: float = 0.3,
    samples: int = 10_000,
    seed: int = 0,
) -> list[JudgedShape]: ...
def shape_precision(rows: Sequence[JudgedShape], truths: dict[int, int]) -> dict[str, Any]: ...
def read_voxels(file: Path) -> NDArray[Any]: ...
