//! Structured3D: `scene_<number>/annotation_3d.json`, the rooms of a building as junctions, lines and planes, and `bbox_3d.json`, the boxes
//! of its things; `scenes.csv` lists the numbers of the scenes. `point_cloud.ply`, which RoomFormer makes of panoramas, is taken from the
//! mesh.
//!
//! Millimetres, z up from the lowest floor, where the programs of the format look for it. A plane is the points p with
//! normal · p + offset = 0; its normal points into the empty space. The lines of a wall are its outline and those of its openings. A door or
//! window has the planes of its outline on each side that has a face, and of its reveals. [`outwall`] is what is outside.

mod numbers;
mod outwall;

use crate::ExportError;
use crate::boxes::instance_boxes;
use crate::export_folder::ExportFolder;
use crate::formats::room_cloud::{of_mesh, ply};
use crate::mesh::{instance_meshes, missing_mesh_file};
use crate::selected_frames::SelectedFrames;
use enfilade_math::{DVec2, DVec3};
use enfilade_scene::{OpeningKind, Rooms, WallOpening, Warning};
use serde::Serialize;
use std::collections::{BTreeMap, HashMap};

/// Name of the outside of the building.
const OUTWALL: &str = "outwall";

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

/// A box of an instance, as in SUN RGB-D.
#[derive(Serialize)]
struct Box3d {
    #[serde(rename = "ID")]
    id: i16,
    /// Unit vectors of its axes, one a row.
    basis: [[f64; 3]; 3],
    /// Half its extents.
    coeffs: [f64; 3],
    centroid: [f64; 3],
}

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    let numbers = numbers::numbers(selected)?;
    for tracks in selected.scenes() {
        let scene = &tracks[0].scene;
        let (folder, rooms) = (numbers::folder(numbers[scene]), selected.rooms(scene)?);
        // Its programs take planes at a height of 0 for the floor.
        let lowest_m = rooms.outlines.iter().map(|room| room.floor_z_m).fold(f64::INFINITY, f64::min);
        let raised = if lowest_m.is_finite() { DVec3::Z * -lowest_m } else { DVec3::ZERO };
        if raised.z.abs() > 1e-6 {
            let message = format!("its heights are counted from its lowest floor, which lies at {lowest_m:.3} m of the dataset's world");
            selected.warn(Warning { place: scene.clone(), message });
        }
        let annotation = annotation(&rooms, raised);
        if annotation.semantics.iter().all(|semantic| semantic.r#type != OUTWALL) {
            let message = "the outer sides of its walls do not close around it, so its annotation has no `outwall`";
            selected.warn(Warning { place: scene.clone(), message: message.into() });
        }
        out.write_json(&format!("{folder}/annotation_3d.json"), &annotation)?;
        out.write_json(&format!("{folder}/bbox_3d.json"), &boxes(selected, scene, raised)?)?;
        if missing_mesh_file(selected.dataset, scene).is_none() {
            let mut points = of_mesh(selected, tracks, &rooms)?;
            points.iter_mut().for_each(|point| point.position += raised);
            out.write(&format!("{folder}/point_cloud.ply"), &ply(&points, MILLIMETRES))?;
        }
    }
    out.write("scenes.csv", numbers::table(&numbers).as_bytes())
}

/// The boxes of all instances, upright.
fn boxes(selected: &SelectedFrames<'_>, scene: &str, raised: DVec3) -> Result<Vec<Box3d>, ExportError> {
    let boxes = instance_boxes(selected.dataset, scene, &instance_meshes(selected.dataset, scene)?)?;
    let one = |(id, of): (i16, enfilade_math::OrientedBox)| Box3d {
        id,
        basis: of.world_from_box.to_cols_array_2d(),
        coeffs: (of.extents * (0.5 * MILLIMETRES)).to_array(),
        centroid: ((of.center + raised) * MILLIMETRES).to_array(),
    };
    Ok(boxes.into_iter().map(one).collect())
}

fn annotation(rooms: &Rooms, raised: DVec3) -> Annotation {
    let mut net = Net { raised, ..Net::default() };
    for (number, room) in rooms.outlines.iter().enumerate() {
        let floor: Vec<DVec3> = room.polygon.iter().map(|&corner| DVec2::from(corner).extend(room.floor_z_m)).collect();
        let mut planes = vec![net.plane("floor", DVec3::Z, &[floor])];
        planes.extend(rooms.ceiling_pieces(number).into_iter().map(|(normal, piece)| net.plane("ceiling", normal, &[piece])));
        for (face, wall) in rooms.walls.iter().enumerate().filter(|(_, wall)| wall.room == number) {
            let outline = rooms.face_outline(face);
            let holes = rooms.openings.iter().filter_map(|opening| hole(rooms, opening, face));
            let loops: Vec<Vec<DVec3>> = std::iter::once(outline).chain(holes).collect();
            planes.push(net.plane("wall", DVec2::from(wall.inward).extend(0.0), &loops));
        }
        net.name(words(&room.kind), planes);
    }
    for opening in &rooms.openings {
        let kind = if opening.kind == OpeningKind::Window { "window" } else { "door" };
        let planes = sides(&mut net, rooms, opening);
        net.name(kind, planes);
    }
    let outer = outer_sides(&mut net, rooms);
    if !outer.is_empty() {
        net.name(OUTWALL, outer);
    }
    net.finish()
}

/// The planes of the outer sides of all outer walls, storey by storey, each with the openings that go through it.
fn outer_sides(net: &mut Net, rooms: &Rooms) -> Vec<usize> {
    let mut storeys: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
    for (number, room) in rooms.outlines.iter().enumerate() {
        storeys.entry((room.floor_z_m * MILLIMETRES).round() as i64).or_default().push(number);
    }
    let backs: Vec<Vec<DVec3>> = rooms.openings.iter().filter_map(|opening| back(rooms, opening)).collect();
    let mut planes = Vec::new();
    for storey in storeys.values() {
        let Some(outlines) = outwall::outlines(rooms, storey) else { return Vec::new() };
        let low = rooms.outlines[storey[0]].floor_z_m;
        let high = storey.iter().map(|&room| rooms.outlines[room].ceiling_z_m).fold(low, f64::max);
        for outline in outlines {
            for (i, &from) in outline.iter().enumerate() {
                let to = outline[(i + 1) % outline.len()];
                let outward = -(to - from).normalize_or_zero().perp();
                let is_on = |corners: &&Vec<DVec3>| {
                    let on = |p: &DVec3| {
                        let (off, along) = ((p.truncate() - from).dot(outward), (p.truncate() - from).dot(to - from));
                        off.abs() < 1e-3 && (0.0..=(to - from).length_squared()).contains(&along) && (low..=high).contains(&p.z)
                    };
                    corners.iter().all(on)
                };
                let face = vec![from.extend(low), to.extend(low), to.extend(high), from.extend(high)];
                let loops: Vec<Vec<DVec3>> = std::iter::once(face).chain(backs.iter().filter(is_on).cloned()).collect();
                planes.push(net.plane("wall", outward.extend(0.0), &loops));
            }
        }
    }
    planes
}

/// Outline of an opening to the outside, on the outer side of its wall.
fn back(rooms: &Rooms, opening: &WallOpening) -> Option<Vec<DVec3>> {
    let wall = &rooms.walls[*opening.walls.first().filter(|_| opening.walls.len() == 1)?];
    let inward = DVec2::from(wall.inward).extend(0.0);
    Some(opening.corners.iter().map(|&corner| DVec3::from(corner) - inward * wall.thickness_m).collect())
}

/// Structured3D's word for a kind of room, of its `metadata/room_types.txt`: programs know no other.
fn words(kind: &str) -> &'static str {
    match kind {
        "living" => "living room",
        "kitchen" => "kitchen",
        "dining" => "dining room",
        "bedroom" | "childrens" | "hotel_room" => "bedroom",
        "study" => "study",
        "bathroom" | "toilet" => "bathroom",
        "hall" | "corridor" => "corridor",
        "laundry" => "laundry room",
        "office" | "open_office" => "office",
        "storeroom" => "store room",
        _ => "undefined",
    }
}

/// The corners of an opening on one of its faces.
fn hole(rooms: &Rooms, opening: &WallOpening, face: usize) -> Option<Vec<DVec3>> {
    let place = opening.walls.iter().position(|&wall| wall == face)?;
    let first = &rooms.walls[opening.walls[0]];
    let deep = if place == 0 { 0.0 } else { rooms.walls[face].distance_m(opening.center()) };
    let behind = DVec2::from(first.inward).extend(0.0) * deep.abs();
    Some(opening.corners.iter().map(|&corner| DVec3::from(corner) - behind).collect())
}

/// The planes of an opening: its outline on both sides of the wall, and the planes between them.
fn sides(net: &mut Net, rooms: &Rooms, opening: &WallOpening) -> Vec<usize> {
    let wall = &rooms.walls[opening.walls[0]];
    let inward = DVec2::from(wall.inward).extend(0.0);
    let front: Vec<DVec3> = opening.corners.map(DVec3::from).to_vec();
    let beyond = opening.walls.get(1).and_then(|&face| hole(rooms, opening, face));
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
    /// Added to all places, metres.
    raised: DVec3,
    junctions: HashMap<[i64; 3], usize>,
    lines: HashMap<[usize; 2], usize>,
    /// Lines of each plane.
    loops: Vec<Vec<usize>>,
    annotation: Annotation,
}

impl Net {
    fn junction(&mut self, p: DVec3) -> usize {
        let p = (p + self.raised) * MILLIMETRES;
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
        let offset = -normal.dot((loops[0][0] + self.raised) * MILLIMETRES);
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
