//! Exports, read back by what they were made for.

mod bop;
mod coco;
mod common;
mod export_folder;
mod incomplete;
mod pix3d;
mod readers;
mod round_trips;
mod scene_gltf;
