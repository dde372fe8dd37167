//! The dataset on disk: Hypersim's tree, names, dtypes and CSV columns, and beside them what Hypersim lacks.
//!
//! [`Layout`] has the paths of all files, [`hdf5`] reads and writes one array per file, and [`Dataset`] puts them together:
//! scenes, cameras, frames and labels go in and come out as the types of `enfilade-scene` and `enfilade-frame`.
//!
//! Three rules apply to every file. A file is complete or absent: it is written under a temporary name and renamed into place. A
//! frame is complete or absent: its commit record `_detail/<camera>/frames/frame.IIII.json` is written last, and only a frame
//! with a record counts. Every byte is a function of the inputs; times are separate, in `manifest_times.csv`.
//!
//! World coordinates are right-handed, z up, and one asset unit is one metre.

mod after_frame_files;
mod annotation_files;
mod atomic;
mod box_files;
mod camera_files;
mod camera_model;
mod camera_record;
mod camera_rows;
mod camera_table;
mod chosen_frames;
mod class_files;
mod color;
mod covisibility_files;
mod dataset;
mod description_files;
mod error;
mod fixture_files;
mod frames;
mod gate_files;
pub mod hdf5;
mod instance_files;
mod label_files;
mod layout;
mod layout_version;
mod loader_camera;
mod machines;
mod manifest;
mod mesh_files;
pub mod mesh_names;
mod motion_files;
mod npz;
mod number_ranges;
mod object_files;
mod package_files;
mod pair_files;
mod pair_layers;
mod partition;
mod placed_files;
mod plane_files;
mod price;
mod read;
mod record;
mod release;
mod repack;
mod scene_files;
mod scene_type_files;
mod sensor_files;
mod surface_files;
mod tables;
mod times;
mod tonemap_files;
mod track_files;
mod variation_files;
mod whole_frames;
mod wording;
mod work_lock;

pub use annotation_files::{ANNOTATION_LOG, scene_hash};
pub use atomic::{remove_folder, remove_if_there, replace_file, share_file, take_file, write_bytes, write_changed, write_json};
pub use box_files::BoxKind;
pub use camera_files::{OpencvCalibration, opencv_cameras};
pub use camera_model::{StereoRecord, StereoSide, read_ray_grid};
pub use camera_record::{CameraRecord, ProjectionRecord};
pub use camera_rows::CameraTable;
pub use chosen_frames::ChosenFrames;
pub use class_files::{CLASS_LIST, Class, Classes};
pub use covisibility_files::{Covisibility, CovisibleFrame, HiddenBy};
pub use dataset::Dataset;
pub use description_files::{Caption, DescribedInstance, InstanceRelation, Question, RelationKind};
pub use error::DatasetError;
pub use fixture_files::Fixture;
pub use frames::FrameInfo;
pub use gate_files::{JudgedView, ViewFault, ViewVerdict};
pub use hdf5::{Array, Element, Elements, Number, Volume, VolumeArray, Window, image_shape};
pub use instance_files::{AmodalMask, AmodalMasks, InstanceView, PixelArea};
pub use label_files::{LabelColors, instance_colors, semantic_colors};
pub use layout::{Layout, SCENE_PACKAGE, WORKDIR, check_name};
pub use layout_version::{LAYOUT_VERSION, refuse_newer_layout};
pub use loader_camera::{LOADER_FOCAL_PX, LOADER_SIZE, loader_depth, loader_problem};
pub use machines::{memory_gib, smallest_feasible, tells_sizes};
pub use manifest::{CameraEntry, Conventions, FrameEntry, FrameStatus, LayerEntry, Manifest, ManifestInfo, SceneEntry};
pub use motion_files::{BodyPlaces, BodyRow, FilmedBodies, FrameBodies};
pub use npz::{NpyArray, npy_head, npz};
pub use number_ranges::{number_runs, parse_number_ranges, print_number_ranges};
pub use object_files::{MeshFiles, MeshGeometry};
pub use package_files::read_package;
pub use pair_files::{FramePair, PairRow, read_pairs, write_pairs};
pub use partition::{ImageAsset, MeshAsset, PartitionConfig, PartitionRow, SceneAssets, SharedAsset, Side, shared_assets};
pub use placed_files::{MissingObject, PlacedObject, PlacedObjects};
pub use price::{Machine, Per, Price, PriceError, Rate, read_prices};
pub use record::{ColorKind, Denoised, FileRecord, FrameRecord, LabelRecord, PoseRecord, Recipe, Sampling, StoppedBy};
pub use release::{RELEASED_LAYERS, planar_depth, turn_planar_depth};
pub use repack::Repacked;
pub use scene_files::{Node, read_node_table};
pub use scene_type_files::{SCENE_TYPES, SceneTypeRow, scene_type};
pub use sensor_files::{Scan, SensedFrame};
pub use surface_files::Surfaces;
pub use times::FrameTime;
pub use tonemap_files::ToneMapRow;
pub use track_files::Tracks;
pub use variation_files::{MovedThing, Variation, VariedLamp, VariedMaterial, VariedSky};
pub use wording::{counted, counted_as, quoted};
pub use work_lock::{LOCK, WorkLock};
