//! SpatialLM: `layout/<scene>.txt` with walls, doors, windows and boxes as its language has them, and `pcd/<scene>.ply`, the point cloud
//! that its networks read.
//!
//! Metres, z up, the dataset's world. Written after `spatiallm/layout/entity.py`: walls by the ends of their lower edge, height and
//! thickness; doors and windows by their wall, middle, width and height; boxes by class, middle, angle about z in radians and extents.

use crate::ExportError;
use crate::boxes::instance_boxes;
use crate::export_folder::ExportFolder;
use crate::mesh::instance_meshes;
use crate::points::{cloud, ply};
use crate::selected_frames::SelectedFrames;
use enfilade_math::OrientedBox;
use enfilade_scene::{NYU40, OpeningKind, Structure};
use std::fmt::Write;

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    for tracks in selected.scenes() {
        let scene = &tracks[0].scene;
        let structure = selected.structure(scene)?;
        let text = format!("{}{}", building(&structure), things(selected, scene)?);
        out.write(&format!("layout/{scene}.txt"), text.as_bytes())?;
        out.write(&format!("pcd/{scene}.ply"), &ply(&cloud(selected, tracks)?))?;
    }
    Ok(())
}

/// Walls, doors and windows; a passage is a door.
fn building(structure: &Structure) -> String {
    let mut text = String::new();
    for (i, wall) in structure.walls.iter().enumerate() {
        let ([ax, ay], [bx, by], z) = (wall.from, wall.to, wall.floor_z_m);
        let height = wall.ceiling_z_m - z;
        // A face has no thickness of its own, as in SpatialLM's data.
        let _ = writeln!(text, "wall_{i}=Wall({ax},{ay},{z},{bx},{by},{z},{height},0)");
    }
    for (word, name, is_one) in [
        ("door", "Door", (|kind| kind != OpeningKind::Window) as fn(OpeningKind) -> bool),
        ("window", "Window", |kind| kind == OpeningKind::Window),
    ] {
        for (i, opening) in structure.openings.iter().filter(|opening| is_one(opening.kind)).enumerate() {
            let ([x, y, z], [width, height]) = (opening.center().to_array(), opening.size_m());
            let _ = writeln!(text, "{word}_{i}={name}(wall_{},{x},{y},{z},{width},{height})", opening.walls[0]);
        }
    }
    text
}

/// The boxes of instances with a class, upright.
fn things(selected: &SelectedFrames<'_>, scene: &str) -> Result<String, ExportError> {
    let boxes = instance_boxes(selected.dataset, scene, &instance_meshes(selected.dataset, scene)?)?;
    let labels = selected.labels(scene)?.parts;
    let mut text = String::new();
    let of_class = |number: i16| labels.iter().find(|label| label.instance == number).map(|label| label.semantic);
    let named = boxes.iter().filter_map(|(&number, shape)| Some((NYU40.get(usize::try_from(of_class(number)? - 1).ok()?)?, shape)));
    for (i, (class, shape)) in named.enumerate() {
        let (class, [x, y, z], [sx, sy, sz]) = (class.name.replace(' ', "_"), shape.center.to_array(), shape.extents.to_array());
        let _ = writeln!(text, "bbox_{i}=Bbox({class},{x},{y},{z},{},{sx},{sy},{sz})", angle(shape));
    }
    Ok(text)
}

/// How far a box's x axis is turned about z, radians.
fn angle(shape: &OrientedBox) -> f64 {
    let x = shape.world_from_box.x_axis;
    x.y.atan2(x.x)
}
