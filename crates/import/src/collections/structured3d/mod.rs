//! Houses of Structured3D: `annotation_3d.json`, the structure of a house as planes, lines and junctions.
//!
//! Made from Structured3D's `data_organization.md` and `visualize_3d.py`, which describe how planes become polygons: the lines of a plane
//! are chained by their junctions into loops. Millimetres, z up.
//!
//! | in the file | what becomes of it |
//! |---|---|
//! | `semantics` of a room, and `outwall` | each plane once, as `<room> <plane's type> (<number>)`: wall, floor or ceiling; it faces the way of `normal`, into the empty space |
//! | `semantics` of doors and windows | holes in the walls whose loops have their corners, and their other planes, the reveals, as parts of a door or window |
//! | furniture | Structured3D publishes boxes of it without classes (`bbox_3d.json`) and pictures, no models: left out |
//! | materials, lights | none: plain colours, and no light |

pub(crate) mod annotation;

use super::json;
use super::objects::{Object, Objects};
use crate::assembly::Assembly;
use crate::polygon::{newell_normal, triangulate};
use crate::sweethome::subtract;
use crate::{ImportError, Imported, UpAxis};
use annotation::{Annotation, Semantic};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec2, DVec3, Rgb, Vec3};
use enfilade_scene::Material;
use std::collections::{BTreeSet, HashMap, HashSet};

/// Metres per millimetre.
const MILLIMETRE: f64 = 0.001;
/// Reflectances of walls, floors and ceilings.
const PLAIN: [(&str, i16, f32); 3] = [("wall", 1, 0.75), ("floor", 2, 0.4), ("ceiling", 22, 0.8)];

/// A closed line on a plane: numbers of its junctions.
type Loop = Vec<usize>;

/// Imports a house.
pub(super) fn load(bytes: &[u8], mut a: Assembly) -> Result<Imported, ImportError> {
    let file = a.file().to_path_buf();
    let annotation: Annotation = json::parse(bytes, &file, "the structure of a house of Structured3D")?;
    a.set_units(MILLIMETRE, UpAxis::Z);
    let structure = Structure::new(&annotation);
    let mut builder = Builder { structure, objects: Objects::default(), materials: HashMap::new(), done: HashSet::new(), strange: 0 };
    let is_opening = |semantic: &&Semantic| matches!(semantic.r#type.as_str(), "door" | "window");
    for semantic in annotation.semantics.iter().filter(|s| !is_opening(s)) {
        for &plane in &semantic.planes {
            builder.room(semantic, plane, &mut a)?;
        }
    }
    for semantic in annotation.semantics.iter().filter(is_opening) {
        builder.opening(semantic, &mut a)?;
    }
    if builder.strange > 0 {
        a.warn("planes", format!("{} planes have no closed outline; they were left out", builder.strange));
    }
    a.warn(
        "whole file",
        "Structured3D has no models of furniture, no materials and no lights here: add an environment or lights of your own",
    );
    builder.objects.finish(&mut a);
    a.finish()
}

struct Structure<'s> {
    annotation: &'s Annotation,
    /// Junctions of doors and windows.
    of_openings: HashSet<usize>,
}

impl<'s> Structure<'s> {
    fn new(annotation: &'s Annotation) -> Self {
        let mut structure = Self { annotation, of_openings: HashSet::new() };
        let openings = annotation.semantics.iter().filter(|s| matches!(s.r#type.as_str(), "door" | "window"));
        let planes = openings.flat_map(|s| &s.planes);
        structure.of_openings = planes.flat_map(|&plane| structure.loops(plane).into_iter().flatten()).collect();
        structure
    }

    /// The loops that the lines of a plane make. Chains that do not close are left out.
    fn loops(&self, plane: usize) -> Vec<Loop> {
        let mut left: Vec<[usize; 2]> = self.annotation.lines(plane).collect();
        let mut loops = Vec::new();
        while let Some([first, mut at]) = left.pop() {
            let mut chain = vec![first];
            while at != first {
                chain.push(at);
                let Some(next) = left.iter().position(|pair| pair.contains(&at)) else { break };
                let [p, q] = left.swap_remove(next);
                at = if p == at { q } else { p };
            }
            if at == first && chain.len() > 2 {
                loops.push(chain);
            }
        }
        loops
    }

    fn point(&self, junction: usize) -> DVec3 {
        self.annotation.junctions[junction].coordinate
    }

    /// True for the outline of a door or window.
    fn is_hole(&self, corners: &Loop) -> bool {
        corners.iter().all(|junction| self.of_openings.contains(junction))
    }
}

struct Builder<'s> {
    structure: Structure<'s>,
    objects: Objects,
    materials: HashMap<&'static str, u32>,
    /// Planes that are there, and outlines of holes that were cut.
    done: HashSet<usize>,
    strange: usize,
}

impl Builder<'_> {
    /// Adds a plane of a room with its holes.
    fn room(&mut self, semantic: &Semantic, plane: usize, a: &mut Assembly) -> Result<(), ImportError> {
        let Some(stated) = self.plane(plane, a)? else { return Ok(()) };
        let (kind, class, normal) = stated;
        if !self.done.insert(plane) {
            return Ok(());
        }
        let loops = self.structure.loops(plane);
        let (holes, faces): (Vec<Loop>, Vec<Loop>) = loops.into_iter().partition(|l| self.structure.is_hole(l));
        let mesh = self.mesh(&faces, &holes, normal);
        if mesh.triangles.is_empty() {
            self.strange += 1;
            return Ok(());
        }
        let object = self.objects.of_class(class, &format!("{} {kind} ({plane})", semantic.r#type));
        self.push(object, mesh, kind, plane, a)
    }

    /// Adds the reveals of a door or window: its planes but those that are the outline of a hole.
    fn opening(&mut self, semantic: &Semantic, a: &mut Assembly) -> Result<(), ImportError> {
        let class = if semantic.r#type == "door" { 8 } else { 9 };
        let of = |structure: &Structure, plane: usize| -> BTreeSet<BTreeSet<usize>> {
            structure.loops(plane).into_iter().map(|l| l.into_iter().collect()).collect()
        };
        let walls: Vec<usize> = self.done.iter().copied().collect();
        let outlines: BTreeSet<BTreeSet<usize>> = walls.iter().flat_map(|&plane| of(&self.structure, plane)).collect();
        let mut object = None;
        for &plane in &semantic.planes {
            let Some((kind, _, normal)) = self.plane(plane, a)? else { continue };
            let is_open = of(&self.structure, plane).iter().any(|l| outlines.contains(l));
            if self.done.contains(&plane) || is_open {
                continue;
            }
            let faces = self.structure.loops(plane);
            let mesh = self.mesh(&faces, &[], normal);
            if mesh.triangles.is_empty() {
                self.strange += 1;
                continue;
            }
            let known = object.get_or_insert_with(|| self.objects.of_class(class, &semantic.r#type));
            let part = Object { name: format!("{}/{kind} ({plane})", known.name), label: known.label };
            self.push(part, mesh, kind, plane, a)?;
        }
        Ok(())
    }

    /// Type, class and normal of a plane.
    fn plane(&self, plane: usize, a: &Assembly) -> Result<Option<(&'static str, i16, DVec3)>, ImportError> {
        let planes = &self.structure.annotation.planes;
        let Some(stated) = planes.get(plane) else {
            let problem = format!("it refers to plane {plane}, but there are only {}; unpack the file again", planes.len());
            return Err(a.malformed("semantics", problem));
        };
        let known = PLAIN.iter().find(|(name, ..)| *name == stated.r#type).or(PLAIN.first());
        Ok(known.map(|(name, class, _)| (*name, *class, stated.normal)))
    }

    /// Polygons without their holes, facing along `normal`; flat ones are cut in the plane of their two largest extents.
    fn mesh(&self, faces: &[Loop], holes: &[Loop], normal: DVec3) -> Mesh {
        let mut mesh = Mesh::default();
        for face in faces {
            let corners: Vec<DVec3> = face.iter().map(|&j| self.structure.point(j)).collect();
            let single: Vec<Vec3> = corners.iter().map(|p| (*p - corners[0]).as_vec3()).collect();
            let across = newell_normal(&single).as_dvec3();
            let axis = (0..3).max_by(|&i, &j| across[i].abs().total_cmp(&across[j].abs())).unwrap_or(2);
            if across[axis] == 0.0 || !across.is_finite() {
                continue;
            }
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let flat = |p: DVec3| DVec2::new(p[u], p[v]);
            let lifted = |p: DVec2| {
                let mut at = DVec3::ZERO;
                (at[u], at[v]) = (p.x, p.y);
                at[axis] = corners[0][axis] - (across[u] * (p.x - corners[0][u]) + across[v] * (p.y - corners[0][v])) / across[axis];
                at
            };
            let mut pieces: Vec<[DVec2; 3]> = triangulate(&single).into_iter().map(|t| t.map(|i| flat(corners[i]))).collect();
            for hole in holes {
                let outline: Vec<DVec2> = hole.iter().map(|&j| flat(self.structure.point(j))).collect();
                pieces = subtract(pieces, &outline);
            }
            for piece in pieces {
                let mut corners = piece.map(lifted);
                if (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(normal) < 0.0 {
                    corners.swap(1, 2);
                }
                let first = mesh.positions.len() as u32;
                mesh.positions.extend(corners.map(|p| p.as_vec3()));
                mesh.triangles.push([first, first + 1, first + 2]);
            }
        }
        mesh
    }

    fn push(&mut self, object: Object, mesh: Mesh, kind: &'static str, plane: usize, a: &mut Assembly) -> Result<(), ImportError> {
        let file = a.file().to_path_buf();
        let material = *self.materials.entry(kind).or_insert_with(|| {
            let plain = PLAIN.iter().find(|(name, ..)| *name == kind).map_or(0.5, |(_, _, plain)| *plain);
            a.push_material(Material::diffuse(kind, Rgb::splat(plain)))
        });
        if let Some(mesh) = a.push_mesh(mesh, &file, &format!("plane {plane}"))? {
            a.push_part(&object.name, mesh, material, DAffine3::IDENTITY, object.label);
        }
        Ok(())
    }
}
