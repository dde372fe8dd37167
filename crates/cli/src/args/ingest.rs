//! `ingest` and what it has below it.

use clap::{Args, Subcommand};
use std::path::PathBuf;

/// `ingest`.
#[derive(Args)]
#[command(after_help = "Examples:\n  enfilade ingest pix3d pix3d -o pix3d/all.json\n  \
    enfilade ingest pix3d pix3d --split pix3d_s1_train.json -o pix3d/s1_train.json")]
pub struct IngestArgs {
    /// Which data set
    #[command(subcommand)]
    pub verb: IngestVerb,
}

/// The data sets.
#[derive(Subcommand)]
pub enum IngestVerb {
    /// Pix3D as it is published -> the JSON that Mesh R-CNN and the shape experiment read
    #[command(after_help = "Examples:\n  enfilade ingest pix3d pix3d -o pix3d/all.json\n  \
        enfilade ingest pix3d pix3d --split pix3d_s1_train.json -o pix3d/s1_train.json\n\n\
        f in pixels is focal_length / 32 * width. img/table/1749.jpg and img/table/0045.png are left out, as in Mesh R-CNN.")]
    Pix3d(Pix3dArgs),
}

/// `ingest pix3d`.
#[derive(Args)]
pub struct Pix3dArgs {
    /// The folder of pix3d.zip, with pix3d.json in it
    pub root: PathBuf,
    /// The file to write; paths in it begin at ROOT
    #[arg(short, long, value_name = "JSON")]
    pub output: PathBuf,
    /// Only the images of this split of Mesh R-CNN (pix3d_s1_train.json, ...), under its ids
    #[arg(long, value_name = "JSON")]
    pub split: Option<PathBuf>,
}
