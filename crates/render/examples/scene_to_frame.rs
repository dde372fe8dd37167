//! From a scene file to a rendered frame through the library alone: import, prepare, render, write.
//!
//! `cargo run --release -p enfilade-render --example scene_to_frame -- [SCENE] [FOLDER]` renders the first camera of a scene file (glTF,
//! OBJ, Mitsuba, pbrt, USD, FBX, …; by default a Cornell box) and writes its colour and depth to the folder (by default `frame`) as HDF5.

use enfilade_dataset::hdf5::{Array, Elements, Packing, Storage, write_array};
use enfilade_frame::{Frame, Layer, Values};
use enfilade_import::{ImportOptions, load};
use enfilade_render::{Guide, RenderConfig, RenderScene, render_frame};
use enfilade_scene::{Camera, CameraView, Intrinsics, Quiet};
use std::error::Error;
use std::path::{Path, PathBuf};

/// A Cornell box in Mitsuba's format, which the repository has for comparisons with that renderer.
pub const CORNELL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../xtask/oracle/cornell.xml");

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let scene_file = arguments.next().unwrap_or_else(|| CORNELL.into());
    let folder = arguments.next().unwrap_or_else(|| "frame".into());

    let frame = frame_of(&scene_file, [320, 240], 64)?;
    std::fs::create_dir_all(&folder)?;
    for layer in [Layer::Color, Layer::DepthMeters] {
        let file = folder.join(format!("{}.hdf5", layer.spec().name));
        write_layer(&frame, layer, &file)?;
        println!("{}", file.display());
    }
    Ok(())
}

/// Renders what the first camera of a scene file sees, with this many samples per pixel.
pub fn frame_of(scene_file: &Path, [width, height]: [u32; 2], samples: u32) -> Result<Frame, Box<dyn Error>> {
    // Every importer gives the same plain data: meshes, materials, lights and parts, in metres with z up. The report lists what was
    // dropped.
    let imported = load(scene_file, &ImportOptions::default(), &Quiet)?;
    eprint!("{}", imported.report);
    let scene = imported.scene;

    // A camera has intrinsics, here from a horizontal field of view; a pose gives its position and orientation. A view is both.
    let start = scene.cameras.first().ok_or("the scene has no camera")?;
    let camera = Camera::from(Intrinsics::from_fov_x(width, height, start.fov_x_rad));
    let pose = start.pose(0);
    let view = CameraView::still(&camera, &pose);

    // Make the scene ready for rays, once for all of its frames.
    let prepared = RenderScene::new(&scene, &Quiet)?;

    // Learn where the light comes from in the places that the views show. That steers samples; it changes noise, never the mean.
    let config = RenderConfig { samples, ..RenderConfig::default() };
    let guide = Guide::learn(&prepared, &[view], &config);

    // Render every layer. The bytes depend on these arguments only, not on the number of threads.
    Ok(render_frame(&prepared, &guide, &view, &config, &Quiet)?)
}

/// Writes a layer of a frame as datasets have it: one HDF5 array of rows × columns, and × channels where there are several.
pub fn write_layer(frame: &Frame, layer: Layer, file: &Path) -> Result<(), Box<dyn Error>> {
    let values = match frame.get(layer).ok_or("the frame lacks the layer")?.clone() {
        Values::F16(values) => Elements::F16(values),
        Values::F32(values) => Elements::F32(values),
        Values::I16(values) => Elements::I16(values),
        Values::U8(values) => Elements::U8(values),
    };
    let mut shape = vec![frame.height as usize, frame.width as usize];
    if layer.spec().channels > 1 {
        shape.push(layer.spec().channels);
    }
    Ok(write_array(file, &Array::new(&shape, values), Storage::Image(Packing::of_layer(layer)), &[])?)
}
