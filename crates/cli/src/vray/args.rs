//! The command line of `vray`.

use crate::args::parse_size;
use clap::{Args, Subcommand, ValueEnum};
use std::path::PathBuf;

/// `vray`
#[derive(Args)]
#[command(after_help = "Examples:\n  enfilade vray normalize room.vrscene -o scene.vrscene --policy v1\n  \
    enfilade vray replace-paths scene.vrscene -o scene.vrscene --old 'C:\\work\\assets' --new /mnt/assets\n  \
    enfilade vray pass scene_cam_00.vrscene -o scene_cam_00_final.vrscene --pass final --light-cache /mnt/a.vrlmap --irradiance-map /mnt/a.vrmap\n\n\
    What an edit does not name stays as it is, byte for byte. The output may be the input.")]
pub struct VrayArgs {
    /// What to do
    #[command(subcommand)]
    pub edit: Edit,
}

/// A scene to be read, and where its edited copy goes.
#[derive(Args)]
pub struct Copy {
    /// A scene of V-Ray
    #[arg(value_name = "IN")]
    pub input: PathBuf,
    /// The edited scene
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
}

/// One edit.
#[derive(Subcommand)]
pub enum Edit {
    /// Read a scene and write it again: the same bytes
    Copy(Copy),
    /// What is in a scene: plugins by kind, units, files
    Info {
        /// A scene of V-Ray
        #[arg(value_name = "IN")]
        input: PathBuf,
        /// Write one line per file that the scene refers to, and nothing else
        #[arg(long)]
        files: bool,
    },
    /// Put right what old exporters wrote
    Normalize {
        #[command(flatten)]
        copy: Copy,
        /// v0: a linear frame buffer; v1: and photometric units; v2: and gamma of pictures
        #[arg(long, value_enum)]
        policy: Policy,
    },
    /// Another folder at the beginning of every path of a file
    ReplacePaths {
        #[command(flatten)]
        copy: Copy,
        /// The folder as it is written, with slashes or backslashes
        #[arg(long)]
        old: String,
        /// The folder on the machine that renders
        #[arg(long)]
        new: String,
    },
    /// Remove all plugins of some kinds, and every reference to them
    Remove {
        #[command(flatten)]
        copy: Copy,
        /// Kinds, such as RenderChannelDenoiser; IMAGE_FILTERS stands for all image filters
        #[arg(long = "kind", value_name = "KIND", required = true)]
        kinds: Vec<String>,
    },
    /// Number nodes and lights, so that every one can be told apart in the images
    Entities {
        #[command(flatten)]
        copy: Copy,
        /// metadata_objects.csv of the mesh: nodes belong to objects by name
        #[arg(long, value_name = "FILE")]
        objects: PathBuf,
        /// Write the numbers as metadata_nodes.csv
        #[arg(long, value_name = "FILE")]
        nodes: Option<PathBuf>,
        /// Write the strings that every node leads to as metadata_node_strings.csv
        #[arg(long, value_name = "FILE")]
        strings: Option<PathBuf>,
        /// Make nodes invisible that are no object of the mesh
        #[arg(long)]
        hide_nodes_not_in_mesh: bool,
        /// Make rectangle, mesh and dome lights invisible; they light all the same
        #[arg(long)]
        hide_lights: bool,
    },
    /// Render elements for every layer, linear light of 32 bits, no image filters
    Layers {
        #[command(flatten)]
        copy: Copy,
        /// Also V-Ray's denoiser
        #[arg(long)]
        denoiser: bool,
        /// Also Hypersim's settings of sampling, indirect light and surroundings
        #[arg(long)]
        hypersim_quality: bool,
    },
    /// The camera and trajectory of a dataset
    Camera {
        #[command(flatten)]
        copy: Copy,
        /// The dataset with the trajectory
        #[arg(long)]
        dataset: PathBuf,
        /// Its scene
        #[arg(long)]
        scene: String,
        /// Its camera
        #[arg(long, default_value = "cam_00")]
        camera: String,
        /// Horizontal field of view in degrees
        #[arg(long, default_value_t = 60.0)]
        fov_deg: f64,
        /// Size of the images
        #[arg(long, value_name = "WxH", value_parser = parse_size, default_value = "1024x768")]
        size: [u32; 2],
    },
    /// The scene of one of the three passes: geometry, pre, final
    Pass {
        #[command(flatten)]
        copy: Copy,
        /// Which one
        #[arg(long, value_enum)]
        pass: PassArg,
        /// Path of the light cache on the machine that renders
        #[arg(long, value_name = "PATH")]
        light_cache: Option<String>,
        /// Path of the irradiance map on the machine that renders
        #[arg(long, value_name = "PATH")]
        irradiance_map: Option<String>,
    },
    /// Keep indirect light in files
    SaveGiCaches {
        #[command(flatten)]
        copy: Copy,
        /// Path of the light cache on the machine that renders
        #[arg(long, value_name = "PATH")]
        light_cache: String,
        /// Path of the irradiance map on the machine that renders
        #[arg(long, value_name = "PATH")]
        irradiance_map: String,
    },
    /// For a quick look
    Reduce {
        #[command(flatten)]
        copy: Copy,
        /// One sample per pixel
        #[arg(long)]
        quality: bool,
        /// 256x256 pixels
        #[arg(long)]
        size: bool,
    },
    /// Radiance instead of tone-mapped colours
    Linear(Copy),
}

/// How exporters' answers are put right.
#[derive(Clone, Copy, ValueEnum)]
pub enum Policy {
    /// A linear frame buffer
    V0,
    /// And photometric units
    V1,
    /// And gamma of pictures
    V2,
}

/// One of the three passes.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum PassArg {
    /// Positions, normals, entities
    Geometry,
    /// Indirect light, kept in files
    Pre,
    /// The image and its parts
    Final,
}
