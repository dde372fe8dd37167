//! Exports, read back by what they were made for.

mod bop;
mod coco;
mod common;
mod dust3r;
mod euroc;
mod export_folder;
mod huggingface;
mod incomplete;
mod layouts;
mod marigold;
mod pix3d;
mod readers;
mod round_trips;
mod scannet;
mod scene_gltf;
mod wai;
