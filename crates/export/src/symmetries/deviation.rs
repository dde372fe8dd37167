//! How far a turned surface deviates from itself.

use crate::mesh::SurfaceMesh;
use crate::model_meshes::{clustered, spread};
use enfilade_geometry::Surfaces;
use enfilade_math::{DMat3, DVec3, Vec3};

/// Points by which the deviation is measured: so many vertices, and so many spread evenly over the area.
const VERTICES: usize = 1000;
const SPREAD: usize = 1000;

/// A first look takes one in so many points.
const COARSE_STRIDE: usize = 20;

/// Surfaces of more triangles are simplified on a grid of so many cells to the diameter.
const MAX_TRIANGLES: usize = 20_000;
const CELLS: f64 = 200.0;

/// A surface about a fixed point.
pub(super) struct Shape {
    /// Points on the surface, from the fixed point, the outermost first.
    points: Vec<DVec3>,
    /// Triangles of the surface, from the fixed point.
    corners: Vec<[Vec3; 3]>,
    /// The largest distance between two vertices.
    pub diameter_m: f64,
}

impl Shape {
    pub fn new(mesh: &SurfaceMesh, center: DVec3, diameter_m: f64) -> Self {
        let simple = (mesh.faces.len() > MAX_TRIANGLES).then(|| clustered(mesh, diameter_m / CELLS));
        let mesh = simple.as_ref().unwrap_or(mesh);
        let corners = mesh.faces.iter().map(|face| face.map(|i| (mesh.vertices[i as usize] - center).as_vec3())).collect();
        let mut vertices = mesh.vertices.clone();
        vertices.sort_by(|a, b| b.distance_squared(center).total_cmp(&a.distance_squared(center)));
        let stride = vertices.len().div_ceil(VERTICES).max(1);
        let chosen = vertices.into_iter().step_by(stride);
        let mut points: Vec<DVec3> = chosen.chain(spread(mesh, SPREAD)).map(|p| p - center).collect();
        // The outermost move most, so that most wrong rotations are found out by the first few.
        points.sort_by(|a, b| b.length_squared().total_cmp(&a.length_squared()));
        Self { points, corners, diameter_m }
    }

    /// Whether the surface and the turned surface are within a distance of each other everywhere.
    pub fn deviates_less(&self, turn: DMat3, tolerance_m: f64) -> bool {
        self.is_within(self.points.iter(), turn, tolerance_m)
    }

    /// As [`Shape::deviates_less`], by few of the points.
    pub fn may_deviate_less(&self, turn: DMat3, tolerance_m: f64) -> bool {
        self.is_within(self.points.iter().step_by(COARSE_STRIDE), turn, tolerance_m)
    }

    fn is_within<'a>(&self, mut points: impl Iterator<Item = &'a DVec3>, turn: DMat3, tolerance_m: f64) -> bool {
        let surfaces = Surfaces::new(&self.corners);
        let near = |p: DVec3| surfaces.distance_m(p).is_some_and(|distance| distance <= tolerance_m);
        points.all(|p| near(turn * *p) && near(turn.transpose() * *p))
    }

    /// Mean of the squared distances of the turned surface from the surface, by few of the points.
    pub fn mean_square(&self, turn: DMat3) -> f64 {
        let surfaces = Surfaces::new(&self.corners);
        let squares = self.points.iter().step_by(COARSE_STRIDE).map(|p| surfaces.distance_m(turn * *p).map_or(0.0, |d| d * d));
        squares.sum::<f64>() / self.points.len().div_ceil(COARSE_STRIDE) as f64
    }
}
