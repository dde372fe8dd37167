//! SpatialLM: `layout/<scene>.txt` with walls, doors, windows and boxes as its language has them, `pcd/<scene>.ply`, the point cloud that its
//! networks read, and `split.csv`, by which its `create_dataset.py` divides.
//!
//! Metres, z up, the dataset's world. Written after `spatiallm/layout/entity.py`: walls by the ends of their lower edge, height and
//! thickness; doors and windows by their wall, middle, width and height; boxes by class, middle, angle about z in radians and extents.
//! Layout and cloud are of the same rooms: those that the frames show, or all where the cloud is taken from the mesh ([`shown`]).

mod shown;

use crate::ExportError;
use crate::boxes::instance_boxes;
use crate::export_folder::ExportFolder;
use crate::formats::points::SurfacePoint;
use crate::formats::room_cloud::{is_of_room, of_frames, of_mesh, ply};
use crate::mesh::instance_meshes;
use crate::options::CloudSource;
use crate::selected_frames::{SelectedFrames, Track};
use enfilade_dataset::Side;
use enfilade_math::{DVec2, OrientedBox};
use enfilade_scene::{NYU40, OpeningKind, Rooms, Warning};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fmt::Write;

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder, cloud: CloudSource) -> Result<(), ExportError> {
    let mut written = Vec::new();
    for tracks in selected.scenes() {
        if write_scene(selected, out, tracks, cloud)? {
            written.push(tracks[0].scene.clone());
        }
    }
    if written.is_empty() {
        let problem = "the frames show no room whole, to all its walls: take the points from the mesh (--cloud mesh), or more frames";
        return Err(ExportError::Selection(problem.into()));
    }
    let sides = selected.sides_of_scenes()?;
    let side = |scene: &String| sides.get(scene).copied().unwrap_or(Side::Train).name();
    let rows: String = written.iter().map(|scene| format!("{scene},{}\n", side(scene))).collect();
    out.write("split.csv", format!("id,split\n{rows}").as_bytes())
}

/// Writes the rooms of a scene that the cloud shows; false if there are none.
fn write_scene(selected: &SelectedFrames<'_>, out: &ExportFolder, tracks: &[Track], cloud: CloudSource) -> Result<bool, ExportError> {
    let scene = &tracks[0].scene;
    let rooms = selected.rooms(scene)?;
    if !rooms.slopes.is_empty() {
        let message = "SpatialLM has no sloping ceilings: walls under a roof have the height of their highest point";
        selected.warn(Warning { place: scene.clone(), message: message.into() });
    }
    let (mut points, are_shown) = match cloud {
        CloudSource::Frames => {
            let points = of_frames(selected, tracks)?;
            let are_shown = shown::rooms(&rooms, &points);
            (points, are_shown)
        }
        CloudSource::Mesh => (of_mesh(selected, tracks, &rooms)?, vec![true; rooms.outlines.len()]),
    };
    let left_out: Vec<&str> =
        rooms.outlines.iter().zip(&are_shown).filter(|(_, shown)| !**shown).map(|(room, _)| room.name.as_str()).collect();
    if !left_out.is_empty() {
        let names = left_out[..left_out.len().min(3)].join(", ");
        let message = format!(
            "{} of {} rooms are left out, among them {names}: its frames do not show them to all their walls; --cloud mesh takes all",
            left_out.len(),
            are_shown.len()
        );
        selected.warn(Warning { place: scene.clone(), message });
    }
    if !are_shown.contains(&true) {
        return Ok(false);
    }
    let is_kept = |p| rooms.outlines.iter().zip(&are_shown).any(|(room, shown)| *shown && is_of_room(room, p));
    points.retain(|point| is_kept(point.position));
    let boxes = instance_boxes(selected.dataset, scene, &instance_meshes(selected.dataset, scene)?)?;
    let boxes: BTreeMap<i16, OrientedBox> = boxes.into_iter().filter(|(_, shape)| is_kept(shape.center)).collect();
    let text = format!("{}{}", building(&rooms, &are_shown), things(selected, scene, &boxes, &points)?);
    out.write(&format!("layout/{scene}.txt"), text.as_bytes())?;
    out.write(&format!("pcd/{scene}.ply"), &ply(&points, 1.0))?;
    Ok(true)
}

/// Walls, doors and windows of the rooms that are shown; a passage is a door.
fn building(rooms: &Rooms, are_shown: &[bool]) -> String {
    let mut text = String::new();
    let mut numbers: BTreeMap<usize, usize> = BTreeMap::new();
    for (face, wall) in rooms.walls.iter().enumerate().filter(|(_, wall)| are_shown[wall.room]) {
        let ([ax, ay], [bx, by], z) = (wall.from, wall.to, wall.floor_z_m);
        let (height, number) = (wall.ceiling_z_m - z, numbers.len());
        // A face has no thickness of its own, as in SpatialLM's data.
        let _ = writeln!(text, "wall_{number}=Wall({ax},{ay},{z},{bx},{by},{z},{height},0)");
        numbers.insert(face, number);
    }
    for (word, name, is_one) in [
        ("door", "Door", (|kind| kind != OpeningKind::Window) as fn(OpeningKind) -> bool),
        ("window", "Window", |kind| kind == OpeningKind::Window),
    ] {
        let of_kind = rooms.openings.iter().filter(|opening| is_one(opening.kind));
        let on_face = of_kind.filter_map(|opening| Some((opening, *opening.walls.iter().find(|face| numbers.contains_key(face))?)));
        for (i, (opening, face)) in on_face.enumerate() {
            // Its corners are on the first of its faces, which may belong to a room that is left out.
            let wall = &rooms.walls[face];
            let off = DVec2::from(wall.inward).extend(0.0) * wall.distance_m(opening.center());
            let center = if face == opening.walls[0] { opening.center() } else { opening.center() - off };
            let ([x, y, z], [width, height]) = (center.to_array(), opening.size_m());
            let _ = writeln!(text, "{word}_{i}={name}(wall_{},{x},{y},{z},{width},{height})", numbers[&face]);
        }
    }
    text
}

/// The boxes of instances with a class and with points, upright.
fn things(
    selected: &SelectedFrames<'_>,
    scene: &str,
    boxes: &BTreeMap<i16, OrientedBox>,
    points: &[SurfacePoint],
) -> Result<String, ExportError> {
    let labels = selected.labels(scene)?.parts;
    let of_class = |number: i16| labels.iter().find(|label| label.instance == number).map(|label| label.semantic);
    let named = boxes.iter().filter_map(|(&number, shape)| Some((NYU40.get(usize::try_from(of_class(number)? - 1).ok()?)?, shape)));
    let named: Vec<_> = named.collect();
    let shown: Vec<bool> = named.par_iter().map(|(_, shape)| shown::has_points(shape, points)).collect();
    let without = shown.iter().filter(|shown| !**shown).count();
    if without > 0 {
        let message =
            format!("{without} of {} boxes are left out: they have 100 points or fewer, with which SpatialLM drops them too", shown.len());
        selected.warn(Warning { place: scene.into(), message });
    }
    let mut text = String::new();
    for (i, ((class, shape), _)) in named.into_iter().zip(shown).filter(|(_, shown)| *shown).enumerate() {
        let (class, [x, y, z], [sx, sy, sz]) = (class.name.replace(' ', "_"), shape.center.to_array(), shape.extents.to_array());
        let _ = writeln!(text, "bbox_{i}=Bbox({class},{x},{y},{z},{},{sx},{sy},{sz})", angle(shape));
    }
    Ok(text)
}

/// Angle of a box's x axis about z, radians.
fn angle(shape: &OrientedBox) -> f64 {
    let x = shape.world_from_box.x_axis;
    x.y.atan2(x.x)
}
