//! The verbs that make scene files and what belongs to them.

use super::flags::{Flags, word};
use crate::outcome::Problem;
use clap::Args;
use enfilade_pipeline::{FileSource, HomeConfig, SceneFormat, UpAxis};
use std::path::{Path, PathBuf};

/// `home`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade home --seed 7\n  enfilade home --rooms living,kitchen,bedroom,bathroom,hall --seed 7 -o home.scene\n  enfilade home --assets furniture/ --seed 7\n\n\
    The labels are in the file. In a dataset, home = { seed = 7, rooms = [...] } does the same."
)]
pub struct HomeArgs {
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub choices: Flags<HomeConfig>,
    /// The scene package (.scene), binary glTF (.glb) or scene for simulators (.xml of MuJoCo, .urdf, .usda) to write, labels included
    #[arg(short, long, value_name = "FILE", default_value = "home.scene")]
    pub output: PathBuf,
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
    /// The scene package (.scene), binary glTF (.glb) or scene for simulators (.xml of MuJoCo, .urdf, .usda) to write [default: the input's
    /// name with .scene, in the current folder]; of Pix3D the JSON, in which paths begin at the folder of Pix3D
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Report what would be dropped, guessed or fixed and what is odd about the geometry, and write nothing
    #[arg(long, conflicts_with = "output")]
    pub check: bool,
    #[command(flatten)]
    pub choices: Flags<FileSource>,
    /// For Pix3D: only the images of this partition of Mesh R-CNN (pix3d_s1_train.json, ...), under its ids
    #[arg(long, value_name = "JSON")]
    pub partition: Option<PathBuf>,
}

/// The scene file `file`, with what the flags say about it.
pub fn file_source(file: &Path, choices: &Flags<FileSource>) -> Result<FileSource, Problem> {
    let mut source = FileSource::of(file.to_string_lossy());
    choices.apply(&mut source)?;
    Ok(source)
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
    pub choices: Flags<FileSource>,
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
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = word::<UpAxis>())]
    pub up_axis: Option<UpAxis>,
    /// Replace an existing table, even one that was corrected since
    #[arg(long)]
    pub force: bool,
}
