//! Tone map and label images against those that the original toolkit made of the same frames.
//!
//! The frames are in `golden/post` beside the directory that ENFILADE_SCENES names.

use enfilade_dataset::hdf5::read_array;
use enfilade_frame::tonemap::ToneMap;
use enfilade_frame::{Frame, Layer, Values};
use enfilade_label::{LabelTable, join};
use enfilade_math::{DAffine3, Rgb};
use enfilade_scene::{Labels, Material, Part, PartLabel, Scene};
use enfilade_show::preview::{Subject, preview};
use std::path::{Path, PathBuf};

const FRAMES: [(u32, f64); 2] = [(0, 1.745_290_478_581_853_3), (5, 1.687_084_244_411_368_3)];

fn golden() -> Option<PathBuf> {
    let path = std::env::var_os("ENFILADE_SCENES").map(|scenes| Path::new(&scenes).join("../golden/post"));
    let there = path.filter(|path| path.is_dir());
    if there.is_none() {
        eprintln!("skipped: ENFILADE_SCENES is not set, or no golden results lie beside it");
    }
    there
}

fn values(path: &Path) -> (Vec<usize>, Values) {
    let array = read_array(path).unwrap();
    (array.shape.clone(), array.values.into_values().unwrap())
}

fn integers(path: &Path) -> Vec<i64> {
    let enfilade_dataset::Elements::I64(values) = read_array(path).unwrap().values else { panic!("{} is not int64", path.display()) };
    values
}

fn frame(root: &Path, number: u32) -> Frame {
    let images = root.join("images");
    let (shape, color) = values(&images.join(format!("scene_cam_00_final_hdf5/frame.{number:04}.color.hdf5")));
    let (_, ids) = values(&images.join(format!("scene_cam_00_geometry_hdf5/frame.{number:04}.render_entity_id.hdf5")));
    let mut frame = Frame::new(shape[1] as u32, shape[0] as u32);
    frame.insert(Layer::Color, color);
    frame.insert(Layer::RenderEntityId, ids);
    frame
}

/// Mean and largest difference of the means of 16x16 blocks, which JPEG keeps, over all channels.
fn block_difference(a: &image::RgbaImage, b: &image::RgbaImage) -> (f64, f64) {
    let mean = |picture: &image::RgbaImage, x: u32, y: u32, c: usize| {
        let pixels = (0..256).map(|i| f64::from(picture.get_pixel(16 * x + i % 16, 16 * y + i / 16).0[c]));
        pixels.sum::<f64>() / 256.0
    };
    let (columns, rows) = (a.width() / 16, a.height() / 16);
    let blocks = (0..rows).flat_map(|y| (0..columns).flat_map(move |x| (0..3).map(move |c| (x, y, c))));
    let differences: Vec<f64> = blocks.map(|(x, y, c)| (mean(a, x, y, c) - mean(b, x, y, c)).abs()).collect();
    (differences.iter().sum::<f64>() / differences.len() as f64, differences.iter().copied().fold(0.0, f64::max))
}

#[test]
fn tone_map_has_the_original_scale_and_picture() {
    let Some(root) = golden() else { return };
    for (number, scale) in FRAMES {
        let frame = frame(&root, number);
        let tone = ToneMap::of_frame(&frame).unwrap();
        assert!((tone.scale / scale - 1.0).abs() < 1e-6, "frame {number}: {} instead of {scale}", tone.scale);
        let ours = preview(Subject::ToneMapped, &frame, tone).unwrap().picture;
        let original = image::open(root.join(format!("images/scene_cam_00_final_preview/frame.{number:04}.tonemap.jpg")));
        let original = original.unwrap().into_rgba8();
        assert_eq!(ours.dimensions(), original.dimensions());
        let (mean, largest) = block_difference(&ours, &original);
        // The original truncates to bytes where we round: half a step of 255. The rest is JPEG.
        assert!(mean < 0.8 && largest < 3.0, "frame {number}: blocks differ by {mean} on average, {largest} at most (of 255)");
    }
}

#[test]
fn joined_labels_and_their_colours_are_the_original_ones() {
    let Some(root) = golden() else { return };
    let mesh = root.join("_detail/mesh");
    let column = |name: &str| integers(&mesh.join(name)).into_iter().map(|v| v as i16);
    let parts = column("mesh_objects_si.hdf5").zip(column("mesh_objects_sii.hdf5"));
    // In these scenes node i + 1 is object i.
    let labels = Labels { parts: parts.map(|(semantic, instance)| PartLabel { semantic, instance }).collect() };
    for (number, _) in FRAMES {
        let frame = frame(&root, number);
        let Some(Values::I16(ids)) = frame.get(Layer::RenderEntityId) else { panic!("ids are int16") };
        let (semantic, instance) = join(ids, &labels).unwrap();
        for (name, found) in [("semantic", semantic), ("semantic_instance", instance)] {
            let path = root.join(format!("images/scene_cam_00_geometry_hdf5/frame.{number:04}.{name}.hdf5"));
            assert_eq!(values(&path).1, Values::I16(found.clone()), "{name} of frame {number}");
            let colors = integers(&mesh.join(format!("metadata_{name}_colors.hdf5")));
            let picture = root.join(format!("images/scene_cam_00_geometry_preview/frame.{number:04}.{name}.png"));
            let picture = image::open(picture).unwrap().into_rgb8();
            for (pixel, id) in picture.pixels().zip(found) {
                let row = 3 * id.max(0) as usize;
                let expected = [0, 1, 2].map(|c| if id < 0 { 0 } else { colors[row + c] as u8 });
                assert_eq!(pixel.0, expected, "{name} {id} of frame {number}");
            }
        }
    }
}

#[test]
fn the_shared_table_of_materials_labels_the_rooms() {
    let Some(scenes) = std::env::var_os("ENFILADE_SCENES") else {
        return eprintln!("skipped: ENFILADE_SCENES is not set");
    };
    let bytes = std::fs::read(Path::new(&scenes).join("material_to_nyu40.csv")).unwrap();
    let table = LabelTable::parse(&bytes, "material_to_nyu40.csv").unwrap();
    assert_eq!(table.rows().len(), 323);
    let names = ["Sofa", "Walls", "walls.002", "Nothing"];
    let world_from_mesh = DAffine3::IDENTITY;
    let part = |(name, material): (&str, u32)| Part { name: name.into(), object: None, mesh: 0, material, world_from_mesh };
    let scene = Scene {
        parts: names.into_iter().zip(0..).map(part).collect(),
        materials: names.map(|name| Material::diffuse(name, Rgb::WHITE)).to_vec(),
        ..Scene::default()
    };
    let (labels, report) = table.assign("grey-white-room", &scene);
    assert_eq!(labels.parts.iter().map(|l| (l.semantic, l.instance)).collect::<Vec<_>>(), [(6, 1), (1, -1), (1, -1), (-1, -1)]);
    assert_eq!(report.unmatched.len(), 17, "of the room's 19 materials two are here");
}
