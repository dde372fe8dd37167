//! The command line: one definition per verb and flag, with its help and an example.

use clap::{Args, Parser, Subcommand, ValueEnum};
use enfilade_post::animation::AnimationFormat;
use enfilade_post::drivers::Film;
use std::path::PathBuf;

/// Turns 3D interiors into photorealistic image datasets with dense ground truth, in Hypersim's layout.
#[derive(Parser)]
#[command(name = "enfilade", version, arg_required_else_help = true)]
#[command(after_help = "Begin with:\n  enfilade run --demo out\n\nEach verb has its own help with an example: enfilade VERB --help")]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub verb: Verb,
    /// Number of threads [default: one per processor]; changes no byte of the output
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Print nothing but the result and errors
    #[arg(short, long, global = true)]
    pub quiet: bool,
}

/// The verbs.
#[derive(Subcommand)]
pub enum Verb {
    /// Make a dataset: all stages, for the demo or for the scenes of a TOML file
    Run(RunArgs),
    /// Scene file -> scene package
    Import(ImportArgs),
    /// A furnished home of a seed -> scene package
    Home(HomeArgs),
    /// Scene -> free space (octomap.bt)
    #[command(after_help = "Example:\n  enfilade carve out --scene home")]
    Carve(StageArgs),
    /// Scene, free space -> camera trajectories
    Plan(PlanArgs),
    /// Scene, trajectories -> which views are worth rendering
    #[command(
        after_help = "Example:\n  enfilade gate out\n\nViews that are blank, buried, blocked, outside or of a bare wall are not rendered. _detail/gates.html shows them; [gate] in\n\
        dataset.toml has the limits, and action = \"report\" renders them all the same."
    )]
    Gate(StageArgs),
    /// Scene, trajectories -> frames
    #[command(
        after_help = "Examples:\n  enfilade render out --scene 'bed*'\n  enfilade render out --noise 2% --samples 4096 --splits\n\nFinished frames are kept; a killed run goes on where it was."
    )]
    Render(RenderArgs),
    /// Frames -> denoised companions of the color layers, from now on (needs Open Image Denoise)
    #[command(
        after_help = "Example:\n  enfilade denoise out\n\nThe library is looked for where denoise_library in [render] says, else where \
        ENFILADE_OIDN says, else where the\nsystem has its libraries; `pip install pyoidn` brings it along. What was rendered stays as it is."
    )]
    Denoise(StageArgs),
    /// Frames, label table -> semantic layers; renders nothing again
    Label(LabelArgs),
    /// Scene, labels -> bounding boxes, and what each frame shows of each instance; renders nothing again
    #[command(
        after_help = "Example:\n  enfilade boxes out\n\nThe boxes lie in _detail/mesh, as Hypersim's do; metadata_frame_instances.csv beside each trajectory has the\n\
        2D boxes, pixel counts, visibility and truncation of every instance in every frame."
    )]
    Boxes(StageArgs),
    /// Frames -> a picture of every layer, and a contact sheet per trajectory
    #[command(after_help = "Example:\n  enfilade preview out")]
    Preview(StageArgs),
    /// Check the laws that tie the layers of a dataset together, and write its report card; the exit code says whether all hold
    Verify(VerifyArgs),
    /// Divide the dataset by scene into train, val and test, from now on in this way
    Split(SplitArgs),
    /// Everything about one pixel
    Inspect(InspectArgs),
    /// Render one frame again from its record, and compare the bytes
    Replay(ReplayArgs),
    /// The dataset in a layout that other programs load: COCO, BOP, nerfstudio, COLMAP, ScanNet, OpenEXR, ...
    Export(ExportArgs),
    /// Frames -> MP4, GIF or animated WebP of each trajectory, layer by layer
    Animate(AnimateArgs),
    /// What the images show and what they cost: numbers, charts, outliers
    Stats(StatsArgs),
    /// Label the parts of a scene, in the browser
    Annotate(AnnotateArgs),
    /// Scene file -> label table, proposed from the names of parts and materials
    Suggest(SuggestArgs),
}

/// `run`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade run --demo out\n  enfilade run --demo out --seed 2 --frames 8 --size 640x480 --quality draft\n  \
    enfilade run dataset.toml -o out --noise 2% --samples 4096\n  \
    enfilade run dataset.toml -o out --estimate --price 0.048\n\nA second run does nothing that is already done; a killed run goes on where it was."
)]
pub struct RunArgs {
    /// The scenes to use and what to make of them
    #[arg(value_name = "DATASET.TOML", required_unless_present = "demo", conflicts_with = "demo")]
    pub config: Option<PathBuf>,
    /// Make the demo dataset in the folder OUT instead: a generated home
    #[arg(long, value_name = "OUT")]
    pub demo: Option<PathBuf>,
    /// Output folder [default: the dataset's name, in the current folder]
    #[arg(short, long, value_name = "OUT", conflicts_with = "demo")]
    pub output: Option<PathBuf>,
    /// Seed of everything random
    #[arg(long)]
    pub seed: Option<u64>,
    /// Frames per trajectory
    #[arg(long, value_name = "N")]
    pub frames: Option<u32>,
    /// Width and height of the images in pixels
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<[u32; 2]>,
    /// Samples per pixel in one word
    #[arg(long, conflicts_with = "samples")]
    pub quality: Option<QualityArg>,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub render: RenderFlags,
    /// Only the scenes of these names ("bed*", "hall,bedroom")
    #[arg(long, value_name = "PATTERN", visible_alias = "scene")]
    pub scenes: Option<String>,
    /// Tell what time, money, disk and memory the run will take, from a pilot of a few pixels; nothing is rendered
    #[arg(long)]
    pub estimate: bool,
    /// With --estimate: dollars per vCPU-hour, or a CSV table of them with names [default: 0.0165, Hypersim's median]
    #[arg(long, value_name = "X|CSV", requires = "estimate")]
    pub price: Option<String>,
}

/// `--quality`.
#[derive(Clone, Copy, ValueEnum)]
pub enum QualityArg {
    /// 8 samples
    Draft,
    /// 64 samples
    Normal,
    /// 512 samples
    High,
}

/// The verbs that run one stage of a dataset.
#[derive(Args)]
pub struct StageArgs {
    /// The dataset's folder, as given to `run`
    pub dataset: PathBuf,
    /// Only the scenes of these names ("bed*", "hall,bedroom")
    #[arg(long, value_name = "PATTERN", visible_alias = "scenes")]
    pub scene: Option<String>,
    /// Do it even if nothing has changed
    #[arg(long)]
    pub force: bool,
}

/// `plan`.
#[derive(Args)]
#[command(after_help = "Examples:\n  enfilade plan out --scene home\n  enfilade plan out --preview\n\n\
    --preview draws what was planned: plan and sections with free space, frusta and scores, every view coloured by part, and statistics.")]
pub struct PlanArgs {
    #[command(flatten)]
    #[allow(missing_docs)]
    pub stage: StageArgs,
    /// Draw the trajectories, also those that were planned earlier
    #[arg(long)]
    pub preview: bool,
}

/// `render`.
#[derive(Args)]
pub struct RenderArgs {
    #[command(flatten)]
    #[allow(missing_docs)]
    pub stage: StageArgs,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub render: RenderFlags,
}

/// Choices about rendering, for `run` and `render`. None is made unless asked for.
#[derive(Args)]
#[command(next_help_heading = "Rendering (of an existing dataset: from now on)")]
pub struct RenderFlags {
    /// Samples per pixel: the mean over the image, or with --noise the most
    #[arg(long, value_name = "N")]
    pub samples: Option<u32>,
    /// Stop where the noise is this small: 2% or 0.02
    #[arg(long, value_name = "SHARE", value_parser = parse_share)]
    pub noise: Option<f32>,
    /// Longest path, in surfaces that scatter light after the first [default: no limit, which is unbiased]
    #[arg(long, value_name = "N")]
    pub max_bounces: Option<u32>,
    /// Largest radiance of one indirect sample [default: no limit, which is unbiased]
    #[arg(long, value_name = "X")]
    pub clamp: Option<f32>,
    /// Wall-clock time after which a frame ends with the samples it has: 90s, 5m; two such runs differ
    #[arg(long, value_name = "TIME", value_parser = parse_time)]
    pub time_limit: Option<f64>,
    /// Also write the light of color by its way (diffuse_direct, ...) and by its source (light_environment, ...)
    #[arg(long)]
    pub splits: bool,
    /// Also write material, flow to the next frame, what lies behind glass, occlusion boundaries and more, pixel by pixel
    #[arg(long)]
    pub extra: bool,
    /// Make denoised companions of the color layers too (needs Open Image Denoise, see `enfilade denoise --help`)
    #[arg(long)]
    pub denoise: bool,
}

/// `home`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade home --seed 7\n  enfilade home --rooms living,kitchen,bedroom,bathroom,hall --seed 7 -o home.scene\n  enfilade home --assets furniture/ --seed 7\n\n\
    Rooms: living, kitchen, dining, bedroom, childrens, study, bathroom, toilet, hall, laundry; each may come several times.\n\
    The labels are in the file. In a dataset, home = { seed = 7, rooms = [...] } does the same."
)]
pub struct HomeArgs {
    /// The rooms [default: four to eight, as the seed decides]
    #[arg(long, value_name = "KIND,KIND", value_delimiter = ',', value_parser = parse_room)]
    pub rooms: Vec<enfilade_pipeline::RoomKind>,
    /// Seed of everything random
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Seed of the floor plan alone
    #[arg(long, value_name = "SEED")]
    pub layout: Option<u64>,
    /// Seed of the furniture alone
    #[arg(long, value_name = "SEED")]
    pub furniture: Option<u64>,
    /// Seed of colours and materials alone
    #[arg(long, value_name = "SEED")]
    pub materials: Option<u64>,
    /// Share of the colours that go together; the others are random
    #[arg(long, default_value_t = 1.0, value_name = "SHARE")]
    pub realism: f32,
    /// Seed of the light alone
    #[arg(long, value_name = "SEED")]
    pub light: Option<u64>,
    /// Part of the day [default: as the seed decides]
    #[arg(long)]
    pub moment: Option<MomentArg>,
    /// Density of small things: 0 has none, 1 is a home that is lived in, 2 is untidy
    #[arg(long, default_value_t = 1.0, value_name = "X")]
    pub clutter: f32,
    /// Folders of glTF models, or furniture of Sweet Home 3D (.sh3f), to take in place of our own furniture where a model fits
    #[arg(long, value_name = "FOLDER|FILE", value_delimiter = ',')]
    pub assets: Vec<String>,
    /// Share of the things for which a model fits that are models
    #[arg(long, default_value_t = 1.0, value_name = "SHARE")]
    pub assets_share: f32,
    /// Go on with our own furniture where a model is broken
    #[arg(long)]
    pub allow_broken_assets: bool,
    /// The scene package (.scene) or binary glTF (.glb) to write, labels included
    #[arg(short, long, value_name = "FILE", default_value = "home.scene")]
    pub output: PathBuf,
}

/// `--moment`.
#[derive(Clone, Copy, ValueEnum)]
pub enum MomentArg {
    /// The sun is up
    Day,
    /// Blue dusk outside, lamps inside
    Evening,
    /// Lamps alone
    Night,
}

impl MomentArg {
    /// The moment it names.
    pub fn moment(self) -> enfilade_pipeline::Moment {
        use enfilade_pipeline::Moment;
        match self {
            Self::Day => Moment::Day,
            Self::Evening => Moment::Evening,
            Self::Night => Moment::Night,
        }
    }
}

/// `import`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade import room.gltf -o room.scene\n  enfilade import hall.xml -o hall.scene --meters-per-unit 0.4\n  \
    enfilade import hall.xml -o hall.glb\n  \
    enfilade import out --scene home"
)]
pub struct ImportArgs {
    /// A scene file (.gltf, .glb, .obj, .xml), or the folder of a dataset to import the scenes of
    pub input: PathBuf,
    /// The scene package (.scene) or binary glTF (.glb) to write [default: the input's name with .scene, in the current folder]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Metres per unit of the file
    #[arg(long, default_value_t = 1.0, value_name = "X")]
    pub meters_per_unit: f64,
    /// Which way is up in the file [default: as its format says]
    #[arg(long)]
    pub up_axis: Option<UpAxisArg>,
    /// Light the scene with this equirectangular picture instead of the file's own surroundings
    #[arg(long, value_name = "FILE")]
    pub environment: Option<String>,
    /// Go on with plain grey where a texture is missing
    #[arg(long)]
    pub allow_missing_textures: bool,
    /// With a dataset: only the scenes of these names
    #[arg(long, value_name = "PATTERN", visible_alias = "scenes")]
    pub scene: Option<String>,
    /// With a dataset: import even if nothing has changed
    #[arg(long)]
    pub force: bool,
}

/// `suggest`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade suggest kitchen.gltf -o labels.csv\n  enfilade suggest kitchen.gltf --min-confidence 0.6\n\n\
    Parts of less confidence have -1 and the best guess beside it. `labels = \"labels.csv\"` of a scene in dataset.toml, or\n\
    `enfilade label`, reads the table. Of names with a confidence of 0.94 or more, 95 of 100 are right in scenes that were held out."
)]
pub struct SuggestArgs {
    /// A scene file (.gltf, .glb, .obj, .xml) or scene package (.scene)
    pub input: PathBuf,
    /// The table to write [default: the input's name with .labels.csv, in the current folder]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Least confidence of a label that is written, 0 to 1 [default: where nine of ten names are right]
    #[arg(long, value_name = "SHARE")]
    pub min_confidence: Option<f32>,
    /// Which way is up in the file [default: as its format says]
    #[arg(long)]
    pub up_axis: Option<UpAxisArg>,
}

/// `--up-axis`.
#[derive(Clone, Copy, ValueEnum)]
pub enum UpAxisArg {
    /// +y
    Y,
    /// +z
    Z,
}

/// `label`.
#[derive(Args)]
#[command(after_help = "Examples:\n  enfilade label out\n  enfilade label out --scene home --table my_labels.csv\n\n\
    The table is CSV: a column `part`, `object`, `material` or `name`, a column `nyu40_id` or `semantic` (number or name of a class),\n\
    and if wanted `scene` and `instance`.")]
pub struct LabelArgs {
    #[command(flatten)]
    #[allow(missing_docs)]
    pub stage: StageArgs,
    /// Use this table from now on
    #[arg(long, value_name = "CSV")]
    pub table: Option<PathBuf>,
}

/// `verify`.
#[derive(Args)]
#[command(after_help = "Examples:\n  enfilade verify out\n  enfilade verify out --strict\n\n\
    The card is stored beside the data: verify.json has every value, verify.html is for a browser. Gates are what those who train on\n\
    such data ask of a frame (docs/verify.md). It also reads datasets of Hypersim itself.")]
pub struct VerifyArgs {
    /// The dataset's folder
    pub dataset: PathBuf,
    /// Only the scenes of these names ("bed*", "hall,bedroom")
    #[arg(long, value_name = "PATTERN", visible_alias = "scenes")]
    pub scene: Option<String>,
    /// Fail also where a gate rejects a frame
    #[arg(long)]
    pub strict: bool,
}

/// `split`.
#[derive(Args)]
#[command(
    after_help = "Example:\n  enfilade split out --seed 1 --shares 70,15,15\n\nA scene's side depends on its name and the seed alone, so no \
    scene moves when others are added. `run` divides the\nsame way. split.json tells which meshes and textures are on several sides."
)]
pub struct SplitArgs {
    /// The dataset's folder, as given to `run`
    pub dataset: PathBuf,
    /// Another seed is another division [default: the last one, at first 0]
    #[arg(long)]
    pub seed: Option<u64>,
    /// Expected shares of train, val and test [default: the last ones, at first 80,10,10]
    #[arg(long, value_name = "A,B,C", value_parser = parse_shares)]
    pub shares: Option<[f64; 3]>,
}

/// `inspect`.
#[derive(Args)]
#[command(after_help = "Example:\n  enfilade inspect out --scene home --camera cam_00 --frame 0 --pixel 160,120")]
pub struct InspectArgs {
    /// The dataset's folder
    pub dataset: PathBuf,
    /// Name of the scene [default: the only one]
    #[arg(long)]
    pub scene: Option<String>,
    /// Name of the camera
    #[arg(long, default_value = "cam_00")]
    pub camera: String,
    /// Number of the frame
    #[arg(long, default_value_t = 0)]
    pub frame: u32,
    /// Column and row of the pixel, from 0 at the upper left
    #[arg(long, value_name = "X,Y", value_parser = parse_pixel)]
    pub pixel: (u32, u32),
}

/// `replay`.
#[derive(Args)]
#[command(
    after_help = "Example:\n  enfilade replay out/scenes/home/_detail/cam_00/frames/frame.0000.json\n\nThe exit code is 1 when a byte differs. \
    Labels and denoised layers are made from a frame afterwards and are not compared."
)]
pub struct ReplayArgs {
    /// The commit record of the frame
    #[arg(value_name = "FRAME.JSON")]
    pub record: PathBuf,
    /// Write the layers below this folder [default: keep nothing]
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
}

/// `export`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade export out --format coco -o out-coco\n  enfilade export out --format colmap -o room --scene home --camera cam_00 --frames 0..10\n  \
    enfilade export out --format exr -o exr --layers color,depth_meters,semantic_instance\n\nNothing is rendered. docs/export.md has units, axes and contents of every format; each export has a README.md."
)]
pub struct ExportArgs {
    /// The dataset's folder
    pub dataset: PathBuf,
    /// The layout
    #[arg(long, value_parser = clap::builder::PossibleValuesParser::new(format_values()))]
    pub format: String,
    /// The folder to write; an earlier export there is replaced
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
    /// Only the scenes of these names ("bed*", "hall,bedroom")
    #[arg(long, value_name = "PATTERN", visible_alias = "scenes")]
    pub scene: Option<String>,
    /// Only the cameras of these names ("cam_00", "cam_0*")
    #[arg(long, value_name = "PATTERN", visible_alias = "cameras")]
    pub camera: Option<String>,
    /// Only frames of these numbers: 0..10 (without 10), 5.. or 7
    #[arg(long, value_name = "RANGE", value_parser = parse_range)]
    pub frames: Option<std::ops::Range<u32>>,
    /// Only these layers, of those that the format can hold
    #[arg(long, value_name = "NAME,NAME", value_delimiter = ',', value_parser = parse_layer)]
    pub layers: Option<Vec<enfilade_frame::Layer>>,
    /// With webdataset: largest size of a shard in megabytes
    #[arg(long, value_name = "MB", default_value_t = 1000, value_parser = clap::value_parser!(u64).range(1..))]
    pub shard_mb: u64,
    /// If OUT exists and is no export, rename it to OUT.old
    #[arg(long)]
    pub force: bool,
}

/// `animate`.
#[derive(Args)]
#[command(after_help = "Examples:\n  enfilade animate out\n  enfilade animate out --layers color,depth_meters,semantic --fps 10\n  \
    enfilade animate out --scene home --camera cam_00 --layers tonemap --format webp -o films\n\nExposure and ranges are the same in \
    all frames, but in tonemap, which is Hypersim's. docs/previews.md has the names.")]
pub struct AnimateArgs {
    /// The dataset's folder
    pub dataset: PathBuf,
    /// Only the scenes of these names ("bed*", "hall,bedroom")
    #[arg(long, value_name = "PATTERN", visible_alias = "scenes")]
    pub scene: Option<String>,
    /// Only the cameras of these names ("cam_00", "cam_0*")
    #[arg(long, value_name = "PATTERN", visible_alias = "cameras")]
    pub camera: Option<String>,
    /// What to show, one file each: layers, or tonemap, gamma, lambertian, non_lambertian, diff
    #[arg(long, value_name = "NAME,NAME", value_delimiter = ',', default_value = "color", value_parser = parse_film)]
    pub layers: Vec<Film>,
    /// The form of the files
    #[arg(long, value_enum, default_value_t = AnimationFormatArg::Mp4)]
    pub format: AnimationFormatArg,
    /// Pictures per second [default: as the trajectory was timed if it is a video, else 5]
    #[arg(long, value_name = "N")]
    pub fps: Option<f64>,
    /// The folder to write to [default: `animations` in the dataset]
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
}

/// `--format` of `animate`.
#[derive(Clone, Copy, ValueEnum)]
pub enum AnimationFormatArg {
    /// H.264; for every browser and player
    Mp4,
    /// 256 colours per picture; for everything that shows pictures
    Gif,
    /// Animated WebP; for browsers
    Webp,
}

impl From<AnimationFormatArg> for AnimationFormat {
    fn from(arg: AnimationFormatArg) -> Self {
        match arg {
            AnimationFormatArg::Mp4 => Self::Mp4,
            AnimationFormatArg::Gif => Self::Gif,
            AnimationFormatArg::Webp => Self::Webp,
        }
    }
}

fn parse_film(name: &str) -> Result<Film, String> {
    let layers = || enfilade_frame::LAYERS.iter().map(|spec| spec.name).collect::<Vec<_>>().join(", ");
    let found = Film::from_name(name.trim());
    found.ok_or_else(|| format!("there are tonemap, gamma, lambertian, non_lambertian, diff, and the layers {}", layers()))
}

/// `stats`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade stats out\n  enfilade stats out --price 0.048 --compare other-dataset/statistics\n\nThe page is statistics/statistics.html. \
    Hypersim's own datasets are read as far as they have the layers; its\npublished image statistics can be compared with."
)]
pub struct StatsArgs {
    /// The dataset's folder
    pub dataset: PathBuf,
    /// Only the scenes of these names ("bed*", "hall,bedroom")
    #[arg(long, value_name = "PATTERN", visible_alias = "scenes")]
    pub scene: Option<String>,
    /// Dollars per vCPU-hour, or a CSV table of them with names [default: 0.0165, Hypersim's median]
    #[arg(long, value_name = "X|CSV", allow_hyphen_values = true)]
    pub price: Option<String>,
    /// Draw the charts over the histograms of this folder: statistics of another dataset, or Hypersim's
    #[arg(long, value_name = "FOLDER")]
    pub compare: Option<PathBuf>,
    /// The folder to write [default: statistics, in the dataset]
    #[arg(short, long, value_name = "FOLDER")]
    pub output: Option<PathBuf>,
}

/// `annotate`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade annotate room.glb\n  enfilade annotate out --scene home\n  enfilade annotate ai_001_001/_detail/mesh --classes semantic_label_descs.csv\n\n\
    Labels are written in Hypersim's files, into the mesh folder of a dataset's scene or beside a scene file (FILE.labels). Then\n\
    `enfilade label out` brings them into the label images; nothing is rendered again."
)]
pub struct AnnotateArgs {
    /// A scene file (.gltf, .glb, .obj, .xml, .scene), a dataset, a scene's folder in it, or a Hypersim mesh folder
    #[arg(value_name = "SCENE")]
    pub input: PathBuf,
    /// Which of a dataset's scenes
    #[arg(long, value_name = "NAME")]
    pub scene: Option<String>,
    /// The folder of labels [default: the dataset's mesh folder, or FILE.labels beside the scene file]
    #[arg(long, value_name = "DIR")]
    pub labels: Option<PathBuf>,
    /// A list of classes in the form of Hypersim's semantic_label_descs.csv [default: NYU40]
    #[arg(long, value_name = "FILE")]
    pub classes: Option<PathBuf>,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub listen: ListenArgs,
}

/// Where a page is served, for `annotate` and `view`.
#[derive(Args)]
#[command(next_help_heading = "Serving")]
pub struct ListenArgs {
    /// Port [default: any that is free]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub port: u16,
    /// Address to listen on; beyond this machine (0.0.0.0) a token is demanded, which the printed address carries
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1")]
    pub host: std::net::IpAddr,
    /// Demand a token on this machine too, where several people share it
    #[arg(long)]
    pub token: bool,
    /// Print the address, but do not open the browser
    #[arg(long)]
    pub no_open: bool,
}

/// The formats as `--format` shows them.
fn format_values() -> Vec<clap::builder::PossibleValue> {
    enfilade_export::FORMATS.iter().map(|spec| clap::builder::PossibleValue::new(spec.name).help(spec.about)).collect()
}

/// Frame numbers: `a..b` without b, `a..`, `..b`, or one number.
fn parse_range(text: &str) -> Result<std::ops::Range<u32>, String> {
    let number = |text: &str, default: u32| if text.trim().is_empty() { Ok(default) } else { text.trim().parse() };
    let parsed = match text.split_once("..") {
        Some((first, end)) => number(first, 0).and_then(|first| Ok(first..number(end, u32::MAX)?)),
        None => text.trim().parse().map(|only: u32| only..only.saturating_add(1)),
    };
    let expected = "expected frame numbers, as in 0..10, 5.. or 7";
    parsed.ok().filter(|range| !range.is_empty()).ok_or_else(|| expected.into())
}

fn parse_room(text: &str) -> Result<enfilade_pipeline::RoomKind, String> {
    use enfilade_pipeline::RoomKind;
    let known = || RoomKind::ALL.map(RoomKind::name).join(", ");
    RoomKind::from_name(text.trim()).ok_or_else(|| format!("the kinds of rooms are: {}", known()))
}

fn parse_layer(text: &str) -> Result<enfilade_frame::Layer, String> {
    let known = || enfilade_frame::LAYERS.iter().map(|spec| spec.name).collect::<Vec<_>>().join(", ");
    enfilade_frame::Layer::from_name(text.trim()).ok_or_else(|| format!("the layers are: {}", known()))
}

fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let parsed = text.split_once(['x', 'X', '×']).and_then(|(w, h)| Some([w.trim().parse().ok()?, h.trim().parse().ok()?]));
    parsed.ok_or_else(|| "expected width and height, as in 640x480".into())
}

/// A share of one, or a percentage.
fn parse_share(text: &str) -> Result<f32, String> {
    let parsed = match text.trim().strip_suffix('%') {
        Some(percent) => percent.trim().parse().map(|v: f32| v / 100.0),
        None => text.trim().parse(),
    };
    parsed.map_err(|_| "expected a share or a percentage, as in 0.02 or 2%".into())
}

/// Seconds.
fn parse_time(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let units = [("s", 1.0), ("m", 60.0), ("h", 3600.0), ("", 1.0)];
    let parsed = units.iter().find_map(|(unit, seconds)| Some(text.strip_suffix(unit)?.trim().parse::<f64>().ok()? * seconds));
    parsed.filter(|s| s.is_finite()).ok_or_else(|| "expected a time, as in 90s, 5m or 1h".into())
}

fn parse_shares(text: &str) -> Result<[f64; 3], String> {
    let shares: Option<Vec<f64>> = text.split(',').map(|share| share.trim().parse().ok()).collect();
    shares.and_then(|shares| shares.try_into().ok()).ok_or_else(|| "expected three numbers, as in 80,10,10".into())
}

fn parse_pixel(text: &str) -> Result<(u32, u32), String> {
    let parsed = text.split_once(',').and_then(|(x, y)| Some((x.trim().parse().ok()?, y.trim().parse().ok()?)));
    parsed.ok_or_else(|| "expected column and row, as in 160,120".into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_definition_is_consistent_and_every_verb_shows_an_example() {
        Cli::command().debug_assert();
        for verb in Cli::command().get_subcommands() {
            let help = verb.get_after_help().map(ToString::to_string).unwrap_or_default();
            assert!(help.contains(&format!("enfilade {}", verb.get_name())), "{}", verb.get_name());
        }
    }

    #[test]
    fn quality_help_tells_the_numbers_that_are_used() {
        for (arg, quality) in QualityArg::value_variants().iter().zip([
            enfilade_pipeline::Quality::Draft,
            enfilade_pipeline::Quality::Normal,
            enfilade_pipeline::Quality::High,
        ]) {
            let value = arg.to_possible_value().unwrap();
            assert_eq!(value.get_help().unwrap().to_string(), format!("{} samples", quality.samples()));
        }
    }

    #[test]
    fn sizes_and_pixels_are_read() {
        assert_eq!(parse_size("640x480"), Ok([640, 480]));
        assert!(parse_size("640").is_err() && parse_size("axb").is_err());
        assert_eq!(parse_pixel("3, 4"), Ok((3, 4)));
        assert!(parse_pixel("3").is_err());
        assert_eq!(parse_shares("80,10, 10"), Ok([80.0, 10.0, 10.0]));
        assert!(parse_shares("80,20").is_err() && parse_shares("a,b,c").is_err());
        assert_eq!((parse_share("2%"), parse_share("0.02")), (Ok(0.02), Ok(0.02)));
        assert!(parse_share("two").is_err());
        assert_eq!((parse_time("90s"), parse_time("1.5m"), parse_time("1h"), parse_time("7")), (Ok(90.0), Ok(90.0), Ok(3600.0), Ok(7.0)));
        assert!(parse_time("soon").is_err() && parse_time("inf").is_err());
        assert_eq!((parse_range("0..10"), parse_range("5.."), parse_range("7")), (Ok(0..10), Ok(5..u32::MAX), Ok(7..8)));
        assert!(parse_range("3..3").is_err() && parse_range("a..b").is_err() && parse_layer("colour").is_err());
    }
}
