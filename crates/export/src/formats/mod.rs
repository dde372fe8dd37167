//! One file per format. Each `write` makes the files of its format in an export folder from the selected frames.

pub(crate) mod bop;
pub(crate) mod coco;
pub(crate) mod colmap;
pub(crate) mod colmap_text;
pub(crate) mod croissant;
pub(crate) mod cryptomatte;
pub(crate) mod depth_png;
pub(crate) mod dust3r;
pub(crate) mod euroc;
pub(crate) mod huggingface;
pub(crate) mod marigold;
pub(crate) mod moge;
pub(crate) mod nerfstudio;
pub(crate) mod opencv;
pub(crate) mod openexr;
pub(crate) mod panoptic;
mod parquet_file;
pub(crate) mod pix3d;
pub(crate) mod points;
pub(crate) mod replica;
pub(crate) mod room_cloud;
pub(crate) mod scannet;
pub(crate) mod spatiallm;
pub(crate) mod structured3d;
pub(crate) mod tum;
pub(crate) mod wai;
pub(crate) mod webdataset;
