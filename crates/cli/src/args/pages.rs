//! The verbs that serve pages to a browser.

use super::CamerasArg;
use super::flags::word;
use clap::Args;
use enfilade_pipeline::SceneFormat;
use std::path::PathBuf;

/// `view`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade view out\n  enfilade view out --port 7000 --no-open     # on another machine: ssh -L 7000:localhost:7000 HOST\n\n\
    The page is served on this machine only, unless --host says otherwise. Nothing is written."
)]
pub struct ViewArgs {
    /// The dataset's folder: ours, the Hypersim toolkit's, or one of unpacked Hypersim archives
    pub dataset: PathBuf,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub table: CamerasArg,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
    pub listen: ListenArgs,
}

/// `annotate`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  enfilade annotate room.glb\n  enfilade annotate out --scene home\n  enfilade annotate ai_001_001/_detail/mesh --classes semantic_label_descs.csv\n\n\
    Labels are written in Hypersim's files, into the mesh folder of a dataset's scene or beside a scene file (FILE.labels). Then\n\
    `enfilade label out` brings them into the label images; nothing is rendered again."
)]
pub struct AnnotateArgs {
    /// A scene file, a dataset, a scene's folder in it, or a Hypersim mesh folder
    #[arg(value_name = "SCENE", help = format!("A scene file ({}), a dataset, a scene's folder in it, or a Hypersim mesh folder", SceneFormat::extensions()))]
    pub input: PathBuf,
    /// Which of a dataset's scenes
    #[arg(long, value_name = "NAME")]
    pub scene: Option<String>,
    /// The folder of labels [default: the dataset's mesh folder, or FILE.labels beside the scene file]
    #[arg(long, value_name = "DIR")]
    pub labels: Option<PathBuf>,
    /// Begin with the labels of an earlier version of the scene, by names and shapes; DIR is the folder of labels of that version
    #[arg(long, value_name = "DIR")]
    pub carry: Option<PathBuf>,
    /// A list of classes in the form of Hypersim's semantic_label_descs.csv [default: NYU40]
    #[arg(long, value_name = "FILE")]
    pub classes: Option<PathBuf>,
    /// Metres per unit of a scene file; multiplies what the file says itself [default: 1]
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub meters_per_unit: Option<f64>,
    /// Which way is up in a scene file [default: as its format says]
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = word::<enfilade_pipeline::UpAxis>())]
    pub up_axis: Option<enfilade_pipeline::UpAxis>,
    #[command(flatten)]
    #[allow(missing_docs, reason = "plain words")]
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
