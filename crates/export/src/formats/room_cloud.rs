//! Coloured points on the surfaces of a building, for formats whose layouts need to be covered by points: all that frames show, or all that
//! there is.

use crate::ExportError;
use crate::calibration::Calibration;
use crate::depth::DEPTH;
use crate::formats::points::{self, SurfacePoint};
use crate::formats::scannet;
use crate::mesh::{SurfaceMesh, missing_mesh_file, object_meshes};
use crate::selected_frames::{SelectedFrames, Track, View};
use enfilade_frame::Layer;
use enfilade_math::DVec3;
use enfilade_scene::{RoomOutline, Rooms};
use std::collections::BTreeMap;

/// Distance of points on a mesh, and the side of the cubes of which each has one of them, metres.
const STEP_M: f64 = 0.02;

/// Greatest distance of a room's points beyond its outline, metres: in the wall and in its openings.
const IN_WALL_M: f64 = 0.25;

/// Greatest distance of a room's points above the ceiling and below the floor, metres.
const IN_FLOOR_M: f64 = 0.05;

/// The points that the frames of a scene show.
pub(crate) fn of_frames(selected: &SelectedFrames<'_>, tracks: &[Track]) -> Result<Vec<SurfacePoint>, ExportError> {
    points::fused(selected, tracks)
}

/// Points on the mesh of a scene, in and around its rooms.
pub(crate) fn of_mesh(selected: &SelectedFrames<'_>, tracks: &[Track], rooms: &Rooms) -> Result<Vec<SurfacePoint>, ExportError> {
    let scene = &tracks[0].scene;
    if let Some(missing) = missing_mesh_file(selected.dataset, scene) {
        let problem = format!("its mesh folder has no {missing}; make it (import, label), or take the points of frames (--cloud frames)");
        return Err(selected.unsuitable(scene, problem));
    }
    let mut places: BTreeMap<[i64; 3], DVec3> = BTreeMap::new();
    for mesh in object_meshes(selected.dataset, scene)?.values() {
        for position in samples(mesh).filter(|&p| rooms.outlines.iter().any(|room| is_of_room(room, p))) {
            places.entry((position / STEP_M).round().to_array().map(|v| v as i64)).or_insert(position);
        }
    }
    let positions: Vec<DVec3> = places.into_values().collect();
    let of_pinhole = |track: &&Track| Calibration::of_pinhole(selected, track).is_ok();
    let has_colors = |view: &View<'_>| selected.has(*view, Layer::Color) && DEPTH.iter().any(|&layer| selected.has(*view, layer));
    let views: Vec<View<'_>> = tracks.iter().filter(of_pinhole).flat_map(Track::views).filter(has_colors).collect();
    let colors = scannet::colors(selected, &views, &positions)?;
    Ok(positions.into_iter().zip(colors).map(|(position, [r, g, b, _])| SurfacePoint { position, color: [r, g, b] }).collect())
}

/// Whether a point is in a room, or in the walls, floor and ceiling around it.
pub(crate) fn is_of_room(room: &RoomOutline, p: DVec3) -> bool {
    (room.floor_z_m - IN_FLOOR_M..=room.ceiling_z_m + IN_FLOOR_M).contains(&p.z) && room.reaches(p.truncate(), IN_WALL_M)
}

/// Points on every triangle of a mesh, in rows along its longest edge.
fn samples(mesh: &SurfaceMesh) -> impl Iterator<Item = DVec3> + '_ {
    mesh.faces.iter().flat_map(|face| {
        let corners = face.map(|corner| mesh.vertices[corner as usize]);
        let length = |i: usize| corners[i].distance(corners[(i + 1) % 3]);
        let longest = (0..3).max_by(|&i, &j| length(i).total_cmp(&length(j))).unwrap_or(0);
        let [a, b, c] = [0, 1, 2].map(|i| corners[(longest + i) % 3]);
        let (base, area) = (b - a, (b - a).cross(c - a).length());
        let across = area / base.length().max(f64::MIN_POSITIVE);
        let [columns, rows] = [base.length(), across].map(|size| (size / STEP_M).ceil().max(1.0) as u32);
        let place = move |i: u32| [(f64::from(i % columns) + 0.5) / f64::from(columns), (f64::from(i / columns) + 0.5) / f64::from(rows)];
        (0..columns * rows).map(place).filter(|[u, v]| u + v <= 1.0 + 1e-9).map(move |[u, v]| a + base * u + (c - a) * v)
    })
}

/// The bytes of a binary PLY file of points with their colours, lengths times `scale`.
pub(crate) fn ply(points: &[SurfacePoint], scale: f64) -> Vec<u8> {
    let mut bytes = format!("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", points.len()).into_bytes();
    bytes.extend("xyz".chars().flat_map(|axis| format!("property float {axis}\n").into_bytes()));
    bytes.extend(["red", "green", "blue"].iter().flat_map(|color| format!("property uchar {color}\n").into_bytes()));
    bytes.extend(b"end_header\n");
    for point in points {
        bytes.extend((point.position * scale).to_array().iter().flat_map(|&v| (v as f32).to_le_bytes()));
        bytes.extend(point.color);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_metre_has_its_share_of_points_however_it_is_cut() {
        let vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.5)).to_vec();
        for faces in [vec![[0, 1, 2], [0, 2, 3]], vec![[1, 2, 3], [3, 0, 1]]] {
            let mesh = SurfaceMesh { vertices: vertices.clone(), faces };
            let points: Vec<DVec3> = samples(&mesh).collect();
            let expected = 1.0 / (STEP_M * STEP_M);
            assert!((points.len() as f64 / expected - 1.0).abs() < 0.05, "{} points", points.len());
            let cell = |p: &DVec3| (p.x * 10.0) as usize + 10 * (p.y * 10.0) as usize;
            let mut cells = [0; 100];
            points.iter().for_each(|p| cells[cell(p).min(99)] += 1);
            assert!(cells.iter().all(|&count| count > 12), "{cells:?}");
        }
    }

    #[test]
    fn a_small_triangle_has_a_point() {
        let vertices = vec![DVec3::ZERO, DVec3::X * 0.001, DVec3::Y * 0.001];
        assert_eq!(samples(&SurfaceMesh { vertices, faces: vec![[0, 1, 2]] }).count(), 1);
    }
}
