//! Exports, read back by the programs that they are for.

mod bop;
mod bop_placed;
mod coco;
mod common;
mod dust3r;
mod euroc;
mod export_folder;
mod huggingface;
mod incomplete;
mod marigold;
mod pix3d;
mod readers;
mod rooms;
mod round_trips;
mod scannet;
mod scene_gltf;
mod wai;
