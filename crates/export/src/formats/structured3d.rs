//! Structured3D: `<scene>/annotation_3d.json`, the structure of a building as junctions, lines and planes.
//!
//! Millimetres, z up. A plane is the points p with normal · p + offset = 0; its normal points into the empty space. The lines of a wall are
//! its outline and those of its openings. A door or window has the planes of its outline on each side that has a face, and of
//! its reveals.

use crate::ExportError;
use crate::export_folder::ExportFolder;
use crate::selected_frames::SelectedFrames;
use enfilade_math::{DVec2, DVec3};
use enfilade_scene::{OpeningKind, Structure, WallOpening};
use serde::Serialize;
use std::collections::HashMap;

/// Millimetres in a metre.
const MILLIMETRES: f64 = 1000.0;

#[derive(Default, Serialize)]
struct Annotation {
    junctions: Vec<Junction>,
    lines: Vec<Line>,
    planes: Vec<Plane>,
    semantics: Vec<Semantic>,
    #[serde(rename = "planeLineMatrix")]
    lines_of_plane: Vec<Vec<u8>>,
    #[serde(rename = "lineJunctionMatrix")]
    junctions_of_line: Vec<Vec<u8>>,
    cuboids: Vec<()>,
    manhattan: Vec<()>,
}

#[derive(Serialize)]
struct Junction {
    #[serde(rename = "ID")]
    id: usize,
    coordinate: [f64; 3],
}

#[derive(Serialize)]
struct Line {
    #[serde(rename = "ID")]
    id: usize,
    point: [f64; 3],
    direction: [f64; 3],
}

#[derive(Serialize)]
struct Plane {
    #[serde(rename = "ID")]
    id: usize,
    r#type: &'static str,
    normal: [f64; 3],
    offset: f64,
}

#[derive(Serialize)]
struct Semantic {
    #[serde(rename = "ID")]
    id: usize,
    r#type: String,
    #[serde(rename = "planeID")]
    planes: Vec<usize>,
}

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    for tracks in selected.scenes() {
        let scene = &tracks[0].scene;
        out.write_json(&format!("{scene}/annotation_3d.json"), &annotation(&selected.structure(scene)?))?;
    }
    Ok(())
}

fn annotation(structure: &Structure) -> Annotation {
    let mut net = Net::default();
    for (number, room) in structure.rooms.iter().enumerate() {
        let at = |z: f64| room.polygon.iter().map(move |&corner| DVec2::from(corner).extend(z)).collect::<Vec<_>>();
        let (floor, ceiling) = (at(room.floor_z_m), at(room.ceiling_z_m));
        let mut planes = vec![net.plane("floor", DVec3::Z, &[floor]), net.plane("ceiling", DVec3::NEG_Z, &[ceiling])];
        for (face, wall) in structure.walls.iter().enumerate().filter(|(_, wall)| wall.room == number) {
            let [from, to] = [wall.from, wall.to].map(DVec2::from);
            let (low, high) = (wall.floor_z_m, wall.ceiling_z_m);
            let outline = vec![from.extend(low), to.extend(low), to.extend(high), from.extend(high)];
            let holes = structure.openings.iter().filter_map(|opening| hole(structure, opening, face));
            let loops: Vec<Vec<DVec3>> = std::iter::once(outline).chain(holes).collect();
            planes.push(net.plane("wall", DVec2::from(wall.inward).extend(0.0), &loops));
        }
        net.name(&words(&room.kind), planes);
    }
    for opening in &structure.openings {
        let kind = if opening.kind == OpeningKind::Window { "window" } else { "door" };
        let planes = sides(&mut net, structure, opening);
        net.name(kind, planes);
    }
    net.finish()
}

/// Structured3D's words for kinds of rooms; others keep theirs.
fn words(kind: &str) -> String {
    match kind {
        "living" => "living room",
        "dining" => "dining room",
        "childrens" => "child room",
        "toilet" => "bathroom",
        "hall" => "corridor",
        "laundry" => "laundry room",
        other => other,
    }
    .into()
}

/// The corners of an opening on one of its faces.
fn hole(structure: &Structure, opening: &WallOpening, face: usize) -> Option<Vec<DVec3>> {
    let place = opening.walls.iter().position(|&wall| wall == face)?;
    let first = &structure.walls[opening.walls[0]];
    let deep = if place == 0 { 0.0 } else { structure.walls[face].distance_m(opening.center()) };
    let behind = DVec2::from(first.inward).extend(0.0) * deep.abs();
    Some(opening.corners.iter().map(|&corner| DVec3::from(corner) - behind).collect())
}

/// The planes of an opening: its outline on both sides of the wall, and what lies between them.
fn sides(net: &mut Net, structure: &Structure, opening: &WallOpening) -> Vec<usize> {
    let wall = &structure.walls[opening.walls[0]];
    let inward = DVec2::from(wall.inward).extend(0.0);
    let front: Vec<DVec3> = opening.corners.map(DVec3::from).to_vec();
    let beyond = opening.walls.get(1).and_then(|&face| hole(structure, opening, face));
    let mut planes = vec![net.plane("wall", inward, std::slice::from_ref(&front))];
    // To the outside an opening is open: there is no face of the wall that it would be cut from.
    planes.extend(beyond.as_ref().map(|back| net.plane("wall", -inward, std::slice::from_ref(back))));
    let back = beyond.unwrap_or_else(|| front.iter().map(|&corner| corner - inward * wall.thickness_m).collect());
    let middle = opening.center();
    for (i, j) in [(0, 1), (1, 2), (2, 3), (3, 0)] {
        let side = vec![front[i], front[j], back[j], back[i]];
        let across = (front[j] - front[i]).cross(inward).normalize_or_zero();
        let normal = if across.dot(middle - front[i]) < 0.0 { -across } else { across };
        let kind = if normal.z > 0.5 {
            "floor"
        } else if normal.z < -0.5 {
            "ceiling"
        } else {
            "wall"
        };
        planes.push(net.plane(kind, normal, &[side]));
    }
    planes
}

/// Junctions and lines, each once.
#[derive(Default)]
struct Net {
    junctions: HashMap<[i64; 3], usize>,
    lines: HashMap<[usize; 2], usize>,
    /// Lines of each plane.
    loops: Vec<Vec<usize>>,
    annotation: Annotation,
}

impl Net {
    fn junction(&mut self, p: DVec3) -> usize {
        let p = p * MILLIMETRES;
        let next = self.annotation.junctions.len();
        // Junctions within a tenth of a millimetre are one.
        let id = *self.junctions.entry((p * 10.0).round().as_i64vec3().to_array()).or_insert(next);
        if id == next {
            self.annotation.junctions.push(Junction { id, coordinate: p.to_array() });
        }
        id
    }

    fn line(&mut self, a: usize, b: usize) -> usize {
        let next = self.annotation.lines.len();
        let id = *self.lines.entry([a.min(b), a.max(b)]).or_insert(next);
        if id == next {
            let [from, to] = [a, b].map(|junction| DVec3::from(self.annotation.junctions[junction].coordinate));
            let direction = (to - from).normalize_or_zero().to_array();
            self.annotation.lines.push(Line { id, point: from.to_array(), direction });
        }
        id
    }

    /// Adds a plane with the lines of its loops.
    fn plane(&mut self, kind: &'static str, normal: DVec3, loops: &[Vec<DVec3>]) -> usize {
        let id = self.annotation.planes.len();
        let offset = -normal.dot(loops[0][0] * MILLIMETRES);
        self.annotation.planes.push(Plane { id, r#type: kind, normal: normal.to_array(), offset });
        let mut lines = Vec::new();
        for corners in loops {
            let corners: Vec<usize> = corners.iter().map(|&corner| self.junction(corner)).collect();
            lines.extend((0..corners.len()).map(|i| self.line(corners[i], corners[(i + 1) % corners.len()])));
        }
        self.loops.push(lines);
        id
    }

    fn name(&mut self, kind: &str, planes: Vec<usize>) {
        let id = self.annotation.semantics.len();
        self.annotation.semantics.push(Semantic { id, r#type: kind.into(), planes });
    }

    fn finish(self) -> Annotation {
        let Self { lines, loops, mut annotation, .. } = self;
        let row = |length: usize, ones: &[usize]| {
            let mut row = vec![0; length];
            ones.iter().for_each(|&i| row[i] = 1);
            row
        };
        annotation.lines_of_plane = loops.iter().map(|of| row(annotation.lines.len(), of)).collect();
        let mut ends = vec![[0; 2]; annotation.lines.len()];
        lines.into_iter().for_each(|(pair, line)| ends[line] = pair);
        annotation.junctions_of_line = ends.iter().map(|pair| row(annotation.junctions.len(), pair)).collect();
        annotation
    }
}
