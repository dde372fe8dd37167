//! The verbs that make scene files and what belongs to them.

use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};
use enfilade_pipeline::{EnvironmentOverride, FileSource, Lamps, SceneFormat};
use std::path::{Path, PathBuf};

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
    /// Share of the colours that match; the others are random
    #[arg(long, default_value_t = 1.0, value_name = "SHARE", allow_negative_numbers = true)]
    pub realism: f32,
    /// Seed of the light alone
    #[arg(long, value_name = "SEED")]
    pub light: Option<u64>,
    /// Part of the day [default: as the seed decides]
    #[arg(long)]
    pub moment: Option<MomentArg>,
    /// Density of small things: 0 leaves only the contents of shelves and cabinets, 1 looks lived in, 2 is untidy
    #[arg(long, default_value_t = 1.0, value_name = "X", allow_negative_numbers = true)]
    pub clutter: f32,
    /// Folders of glTF models, or furniture of Sweet Home 3D (.sh3f), to take in place of our own furniture where a model fits
    #[arg(long, value_name = "FOLDER|FILE", value_delimiter = ',')]
    pub assets: Vec<String>,
    /// Share of the things for which a model fits that are models
    #[arg(long, default_value_t = 1.0, value_name = "SHARE", allow_negative_numbers = true)]
    pub assets_share: f32,
    /// Use our own furniture where a model is broken
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
    /// Only lamps
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
    enfilade import scan.obj --check\n  \
    enfilade import pix3d -o pix3d/s1_train.json --partition pix3d_s1_train.json\n\n\
    Pix3D, as it is published, becomes the JSON that Mesh R-CNN and the shape experiment read: f in pixels is focal_length / 32 * width;\n\
    img/table/1749.jpg and img/table/0045.png are left out, as in Mesh R-CNN. Scenes of a dataset: enfilade run OUT --only import"
)]
pub struct ImportArgs {
    /// A scene file, or the folder of a collection's scene or of Pix3D
    #[arg(help = format!("A scene file ({}), the folder of one, or that of Pix3D", SceneFormat::extensions()))]
    pub input: PathBuf,
    /// The scene package (.scene) or binary glTF (.glb) to write [default: the input's name with .scene, in the current folder]; of Pix3D
    /// the JSON, in which paths begin at the folder of Pix3D
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Report what would be dropped, guessed or fixed and what is odd about the geometry, and write nothing
    #[arg(long, conflicts_with = "output")]
    pub check: bool,
    #[command(flatten)]
    pub choices: FileChoices,
    /// For Pix3D: only the images of this partition of Mesh R-CNN (pix3d_s1_train.json, ...), under its ids
    #[arg(long, value_name = "JSON")]
    pub partition: Option<PathBuf>,
}

/// What a scene file does not state.
#[derive(Args)]
pub struct FileChoices {
    /// Metres per unit of the file; multiplies what the file says itself [default: 1, which packages (.scene) always have]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub meters_per_unit: Option<f64>,
    /// Which way is up in the file [default: as its format says; in packages always z]
    #[arg(long, allow_hyphen_values = true)]
    pub up_axis: Option<UpAxisArg>,
    /// Light the scene with this equirectangular picture instead of the file's own surroundings, or with a sky that needs no file:
    /// "sky" (clear, with the sun of a summer afternoon) or "overcast"
    #[arg(long, value_name = "FILE|sky|overcast")]
    pub environment: Option<String>,
    /// Hang lamps from the ceiling of every room
    #[arg(long, value_name = "WHERE")]
    pub lamps: Option<LampsArg>,
    /// Keep only the first of faces with the same corners
    #[arg(long)]
    pub drop_doubled_faces: bool,
    /// Make clear panes of parts or materials of these names ("glass*,window pane"), where glass lost its transparency
    #[arg(long, value_name = "NAME,NAME", value_delimiter = ',')]
    pub panes: Vec<String>,
    /// Use plain grey where a texture is missing
    #[arg(long)]
    pub allow_missing_textures: bool,
    /// Leave out meshes whose file is missing or damaged, in scenes of many files (Mitsuba, pbrt, URDF, SDF)
    #[arg(long)]
    pub allow_missing_meshes: bool,
}

impl FileChoices {
    /// The first of these flags that is given.
    pub fn given(&self) -> Option<&'static str> {
        let given = [
            ("--meters-per-unit", self.meters_per_unit.is_some()),
            ("--up-axis", self.up_axis.is_some()),
            ("--environment", self.environment.is_some()),
            ("--lamps", self.lamps.is_some()),
            ("--drop-doubled-faces", self.drop_doubled_faces),
            ("--panes", !self.panes.is_empty()),
            ("--allow-missing-textures", self.allow_missing_textures),
            ("--allow-missing-meshes", self.allow_missing_meshes),
        ];
        given.into_iter().find(|(_, is_given)| *is_given).map(|(flag, _)| flag)
    }

    /// With the file that they are about.
    pub fn source(&self, file: &Path) -> FileSource {
        FileSource {
            meters_per_unit: self.meters_per_unit.unwrap_or(1.0),
            up_axis: self.up_axis.map(Into::into),
            environment: self.environment.as_deref().map(EnvironmentOverride::named),
            lamps: self.lamps.map(|LampsArg::Ceiling| Lamps::Ceiling),
            drop_doubled_faces: self.drop_doubled_faces,
            panes: self.panes.clone(),
            allow_missing_textures: self.allow_missing_textures,
            allow_missing_meshes: self.allow_missing_meshes,
            ..FileSource::of(file.to_string_lossy())
        }
    }
}

/// Where lamps hang.
#[derive(Clone, Copy, ValueEnum)]
pub enum LampsArg {
    /// Below every ceiling
    Ceiling,
}

/// `look`.
#[derive(Args)]
#[command(after_help = "Examples:\n  enfilade look room.glb\n  enfilade look room.obj --meters-per-unit 0.01 --up-axis z -o room.png\n\n\
    The view is the file's first camera that stands in a room, or else the first that sees something, or a place that is found. A file without light is lit by lamps below\n\
    its ceilings and an overcast sky. Samples are taken for --seconds, 16 per pixel at most; the picture is denoised. For a dataset: enfilade run.")]
pub struct LookArgs {
    /// A scene file
    #[arg(help = format!("A scene file ({})", SceneFormat::extensions()))]
    pub input: PathBuf,
    /// The picture to write (.png or .jpg) [default: the input's name with .jpg, in the current folder]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// The camera to look through, by its name in the file
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// For how long samples are taken, seconds
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..))]
    pub seconds: u32,
    #[command(flatten)]
    pub choices: FileChoices,
}

/// `suggest`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade suggest kitchen.gltf -o labels.csv\n  enfilade suggest kitchen.gltf --min-confidence 0.6\n\n\
    Parts of less confidence have -1 and the best guess beside it. `labels = \"labels.csv\"` of a scene in dataset.toml, or\n\
    `enfilade label`, reads the table. Of names with a confidence of 0.94 or more, 95 of 100 are right in scenes that were held out."
)]
pub struct SuggestArgs {
    /// A scene file or scene package
    #[arg(help = format!("A scene file or scene package ({})", SceneFormat::extensions()))]
    pub input: PathBuf,
    /// The table to write [default: the input's name with .labels.csv, in the current folder]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Least confidence of a label that is written, 0 to 1 [default: where nine of ten names are right]
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true)]
    pub min_confidence: Option<f32>,
    /// Which way is up in the file [default: as its format says; in packages always z]
    #[arg(long, allow_hyphen_values = true)]
    pub up_axis: Option<UpAxisArg>,
    /// Replace an existing table, even one that was corrected since
    #[arg(long)]
    pub force: bool,
}

/// `--up-axis`.
#[derive(Clone, Copy)]
pub struct UpAxisArg(enfilade_pipeline::UpAxis);

impl ValueEnum for UpAxisArg {
    fn value_variants<'a>() -> &'a [Self] {
        use enfilade_pipeline::UpAxis;
        const ALL: [UpAxisArg; UpAxis::ALL.len()] = [
            UpAxisArg(UpAxis::Y),
            UpAxisArg(UpAxis::Z),
            UpAxisArg(UpAxis::X),
            UpAxisArg(UpAxis::MinusX),
            UpAxisArg(UpAxis::MinusY),
            UpAxisArg(UpAxis::MinusZ),
        ];
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.0.name()))
    }
}

impl From<UpAxisArg> for enfilade_pipeline::UpAxis {
    fn from(axis: UpAxisArg) -> Self {
        axis.0
    }
}

fn parse_room(text: &str) -> Result<enfilade_pipeline::RoomKind, String> {
    use enfilade_pipeline::RoomKind;
    let known = || RoomKind::ALL.map(RoomKind::name).join(", ");
    RoomKind::from_name(text.trim()).ok_or_else(|| format!("the kinds of rooms are: {}", known()))
}
