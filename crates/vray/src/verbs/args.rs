//! The command line of `vray`.

use crate::CameraWish;
use clap::{Args, Subcommand, ValueEnum};
use enfilade_options::text::parse_size;
use std::path::PathBuf;

/// `vray`
#[derive(Args)]
#[command(after_help = "Examples:\n  enfilade vray normalize room.vrscene -o scene.vrscene --policy v1\n  \
    enfilade vray replace-paths scene.vrscene -o scene.vrscene --old 'C:\\work\\assets' --new /mnt/assets\n  \
    enfilade vray jobs scene.vrscene -o job --dataset data --scene room --folder /mnt/job --nodes metadata_nodes.csv\n  \
    enfilade vray collect data --job job/job.json\n\n\
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
    /// Number nodes and lights, so that each can be identified in the images
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
        /// Also Hypersim's surroundings: of one colour, where no picture or sky makes them
        #[arg(long)]
        hypersim_surroundings: bool,
    },
    /// Hypersim's settings of sampling and indirect light, as `jobs` writes them
    Quality(Copy),
    /// The camera and trajectory of a dataset; a camera that is no plain pinhole by a texture of its rays
    Camera {
        #[command(flatten)]
        copy: Copy,
        /// The dataset with the trajectory
        #[arg(long)]
        dataset: PathBuf,
        /// Scene of the camera
        #[arg(long)]
        scene: String,
        /// Name of the camera
        #[arg(long, default_value = "cam_00")]
        camera: String,
        #[command(flatten)]
        wish: WishArgs,
        /// Where the picture of the lens is written, if the camera needs one
        #[arg(long, value_name = "FILE")]
        lens: Option<PathBuf>,
        /// Path of that picture on the machine that renders
        #[arg(long, value_name = "PATH", requires = "lens")]
        lens_when_rendering: Option<String>,
    },
    /// Add #include lines at the end
    Include {
        #[command(flatten)]
        copy: Copy,
        /// Path of the included scene on the machine that renders
        #[arg(long = "file", value_name = "PATH", required = true)]
        files: Vec<String>,
    },
    /// The content of included files in place of the #include lines, so that edits reach the whole scene
    Inline(Copy),
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
    /// The scenes of all passes and cameras, and the commands that render them
    Jobs(JobArgs),
    /// V-Ray's images as the frames of a dataset
    Collect(CollectArgs),
}

/// A camera in place of the dataset's own.
#[derive(Args)]
pub struct WishArgs {
    /// Horizontal field of view of a plain pinhole in degrees [default: the dataset's camera, else 60]
    #[arg(long)]
    pub fov_deg: Option<f64>,
    /// Size of the images [default: the dataset's, else 1024x768]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<[u32; 2]>,
    /// A grid of rays as Hypersim's camera_lens_distortion.hdf5
    #[arg(long, value_name = "FILE")]
    pub rays: Option<PathBuf>,
}

impl WishArgs {
    /// The camera that is asked for.
    pub fn wish(&self) -> CameraWish {
        CameraWish { fov_x_deg: self.fov_deg, size: self.size, rays: self.rays.clone() }
    }
}

/// `vray jobs`
#[derive(Args)]
pub struct JobArgs {
    /// A scene with numbered nodes and render elements
    #[arg(value_name = "IN")]
    pub input: PathBuf,
    /// The folder of the job, to be copied to the machine that renders
    #[arg(short, long, value_name = "FOLDER")]
    pub output: PathBuf,
    /// The dataset with the trajectories
    #[arg(long)]
    pub dataset: PathBuf,
    /// Scene to be rendered
    #[arg(long)]
    pub scene: String,
    /// Cameras to be rendered [default: all]
    #[arg(long = "camera", value_name = "CAMERA")]
    pub cameras: Vec<String>,
    /// Absolute path of the job's folder on the machine that renders: /mnt/job, or D:\job for Windows
    #[arg(long, value_name = "PATH")]
    pub folder: String,
    /// The table that `entities --nodes` wrote
    #[arg(long, value_name = "FILE")]
    pub nodes: PathBuf,
    #[command(flatten)]
    pub wish: WishArgs,
    /// Keep the scene's own settings of sampling and indirect light [default: Hypersim's]
    #[arg(long)]
    pub keep_quality: bool,
}

/// `vray collect`
#[derive(Args)]
pub struct CollectArgs {
    /// The dataset with the trajectories; frames are added to it
    pub dataset: PathBuf,
    /// The job.json that `jobs` wrote: scene, cameras, units and nodes
    #[arg(long, value_name = "FILE", conflicts_with_all = ["scene", "geometry", "beauty", "meters_per_unit", "fov_deg", "size", "rays"])]
    pub job: Option<PathBuf>,
    /// Where the job's folder `images` is [default: beside job.json]
    #[arg(long, value_name = "FOLDER", requires = "job")]
    pub images: Option<PathBuf>,
    /// The scene, without a job
    #[arg(long, required_unless_present = "job")]
    pub scene: Option<String>,
    /// The camera; with a job, only this one
    #[arg(long)]
    pub camera: Option<String>,
    /// Folder with the images of the geometry pass, *.0000.exr
    #[arg(long, value_name = "FOLDER", required_unless_present = "job")]
    pub geometry: Option<PathBuf>,
    /// Folder with the images of the final pass
    #[arg(long = "final", value_name = "FOLDER", required_unless_present = "job")]
    pub beauty: Option<PathBuf>,
    /// The table that `entities --nodes` wrote [default: the job's, else the dataset's own]
    #[arg(long, value_name = "FILE")]
    pub nodes: Option<PathBuf>,
    /// Metres per unit of V-Ray's scene, as `info` shows it
    #[arg(long, value_name = "M", required_unless_present = "job")]
    pub meters_per_unit: Option<f64>,
    #[command(flatten)]
    pub wish: WishArgs,
    /// Accept images whose header or positions belong to another camera than the trajectory's
    #[arg(long)]
    pub ignore_camera: bool,
    /// Read existing frames again
    #[arg(long)]
    pub force: bool,
}

/// How exporters' answers are put right.
#[derive(Clone, Copy, ValueEnum)]
pub enum Policy {
    /// A linear frame buffer
    V0,
    /// v0, and photometric units
    V1,
    /// v1, and gamma of pictures
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
