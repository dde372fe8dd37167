//! Hypersim as Marigold prepares it (Ke et al. 2024, prs-eth/Marigold at b1dffaa: `preprocess_hypersim.py`, `preprocess_hypersim_normals.py`),
//! which E2E-FT and others train from too: `<side>/<scene>/{rgb,depth_plane,normal_cam}_<camera>_frIIII.*` and lists of their names.
//!
//! Depth is planar, 16-bit PNG, millimetres, 0 for none: no K is stored, and none is needed. Normals are `.npy`, float32, in the camera's axes
//! (x right, y up, z backward), unit and facing the camera. As there, a frame in which a pixel has no normal is not in the list of normals.
//! E2E-FT reads the table `filename_meta_train.csv`, and normals from pictures below `normals/` named as Hypersim's previews.

use super::huggingface::sides;
use crate::ExportError;
use crate::calibration::Calibration;
use crate::depth::{DEPTH, millimetres, planar_m};
use crate::export_folder::ExportFolder;
use crate::numpy::npy;
use crate::picture::{SHOWN, grey16_png, rgb_png, tone_mapped};
use crate::selected_frames::{SelectedFrames, View};
use enfilade_dataset::counted;
use enfilade_frame::{Frame, Layer, Values};
use enfilade_math::DVec3;
use enfilade_scene::Warning;

/// A normal that looks away from the camera by more than this cosine is turned around, as there: Hypersim's may look either way.
const AWAY: f64 = -1e-3;

/// The columns of `filename_meta_<side>.csv`: those of Hypersim's split, and what Marigold's preparation adds.
const HEADER: &str = ",scene_name,camera_name,frame_id,included_in_public_release,exclude_reason,split_partition_name,rgb_path,rgb_mean,rgb_std,rgb_min,\
                      rgb_max,depth_path,depth_mean,depth_std,depth_min,depth_max,invalid_ratio\n";

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    let (mut frames, mut without_normals) = (0, Vec::new());
    for (side, views) in sides(selected)? {
        let side = side.name();
        let written = selected.each_of(&views, |view| write_frame(selected, out, view, side))?;
        let (mut depths, mut normals, mut table) = (String::new(), String::new(), HEADER.to_string());
        for (row, (view, written)) in views.iter().zip(written).enumerate() {
            let [rgb, depth] = [name(*view, "rgb", "png"), name(*view, "depth_plane", "png")];
            depths += &format!("{rgb} {depth}\n");
            let Written { rgb_stats, depth_stats, invalid_ratio, has_normals } = written;
            let (scene, camera, frame) = (&view.track.scene, &view.track.name, view.frame());
            table += &format!("{row},{scene},{camera},{frame},True,,{side},{rgb},{rgb_stats},{depth},{depth_stats},{invalid_ratio}\n");
            match has_normals {
                true => normals += &format!("{rgb} {}\n", name(*view, "normal_cam", "npy")),
                false => without_normals.push(view.name()),
            }
        }
        frames += views.len();
        out.write(&format!("{side}/filename_list_{side}.txt"), depths.as_bytes())?;
        out.write(&format!("{side}/filename_meta_{side}.csv"), table.as_bytes())?;
        if !normals.is_empty() {
            out.write(&format!("{side}/hypersim_filtered_{side}.txt"), normals.as_bytes())?;
        }
    }
    if let Some(first) = without_normals.first() {
        let message = format!(
            "{first} and {} of {} have pixels without a normal, or no layer normal_cam, and are in the lists of depth alone, as Marigold's own \
             preparation has it",
            without_normals.len() - 1,
            counted(frames, "frame")
        );
        selected.warn(Warning { place: selected.dataset.root().display().to_string(), message });
    }
    Ok(())
}

/// The name of a file of a frame, from the side's folder on.
fn name(view: View<'_>, what: &str, ending: &str) -> String {
    format!("{}/{what}_{}_fr{:04}.{ending}", view.track.scene, view.track.name, view.frame())
}

/// A frame's row in the table, and whether its normals exist.
struct Written {
    rgb_stats: String,
    depth_stats: String,
    invalid_ratio: f64,
    has_normals: bool,
}

/// Writes the files of a frame.
fn write_frame(selected: &SelectedFrames<'_>, out: &ExportFolder, view: View<'_>, side: &str) -> Result<Written, ExportError> {
    let planar = Calibration::of(view.track).filter(|_| view.track.camera.projection.has_image_plane());
    let no_plane = || selected.unsuitable(view.track.folder(), "its camera has no image plane, so no planar depth; leave it out");
    let frame = selected.read(view, &[&SHOWN[..], &DEPTH, &[Layer::NormalCam]].concat())?;
    let depth: Vec<u16> = planar_m(selected, view, &planar.ok_or_else(no_plane)?, &frame)?.into_iter().map(millimetres).collect();
    let picture = tone_mapped(selected, view, &frame)?;
    let rgb: Vec<u8> = picture.pixels().flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    let write = |what: &str, ending: &str, bytes: &[u8]| out.write(&format!("{side}/{}", name(view, what, ending)), bytes);
    write("rgb", "png", &rgb_png(frame.width, frame.height, &rgb))?;
    write("depth_plane", "png", &grey16_png(frame.width, frame.height, &depth))?;
    let normals = facing(view, &frame);
    if let Some(normals) = &normals {
        write("normal_cam", "npy", &npy(&Values::F32(normals.clone()), &[frame.height as usize, frame.width as usize, 3]))?;
        let (scene, camera) = (&view.track.scene, &view.track.name);
        let shown = format!("normals/{scene}/images/scene_{camera}_geometry_preview/frame.{:04}.normal_cam.png", view.frame());
        let byte = |v: &f32| (127.5 * (v + 1.0)).round().clamp(0.0, 255.0) as u8;
        out.write(&shown, &rgb_png(frame.width, frame.height, &normals.iter().map(byte).collect::<Vec<u8>>()))?;
    }
    Ok(Written {
        rgb_stats: statistics(rgb.into_iter().map(f64::from)),
        depth_stats: statistics(depth.iter().map(|mm| f64::from(*mm) / 1000.0)),
        invalid_ratio: depth.iter().filter(|mm| **mm == 0).count() as f64 / depth.len().max(1) as f64,
        has_normals: normals.is_some(),
    })
}

/// Mean, standard deviation, minimum and maximum, as four cells.
fn statistics(values: impl Iterator<Item = f64> + Clone) -> String {
    let count = values.clone().count().max(1) as f64;
    let mean = values.clone().sum::<f64>() / count;
    let deviation = (values.clone().map(|v| (v - mean) * (v - mean)).sum::<f64>() / count).sqrt();
    let (least, most) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), v| (least.min(v), most.max(v)));
    format!("{mean},{deviation},{least},{most}")
}

/// The frame's normals as unit vectors that face the camera; `None` where a pixel has none.
fn facing(view: View<'_>, frame: &Frame) -> Option<Vec<f32>> {
    let normals = frame.get(Layer::NormalCam)?;
    let mut facing = Vec::with_capacity(normals.len());
    for i in 0..frame.pixels() {
        let normal = DVec3::new(normals.get(3 * i), normals.get(3 * i + 1), normals.get(3 * i + 2)).try_normalize()?;
        let (x, y) = (i % frame.width as usize, i / frame.width as usize);
        let ray = view.track.camera.projection.ray(x as f64 + 0.5, y as f64 + 0.5)?;
        let normal = if normal.dot(-ray.normalize()) < AWAY { -normal } else { normal };
        facing.extend(normal.as_vec3().to_array());
    }
    Some(facing)
}
