//! From a stroke over the image to the faces that it touches: the pixels that it covers, and the faces that are visible in them.

use super::camera::PageCamera;
use enfilade_geometry::{Bvh, Hit, NOTHING, VisibilityBuffer};
use enfilade_math::{Bounds3, Ray, Vec3};
use serde::Deserialize;
use std::cell::Cell;
use std::collections::{BTreeSet, HashSet};

/// Points per pixel along lines, as in Hypersim's tool.
const SAMPLES_PER_PIXEL: f64 = 4.0;
/// Image points farther out than this are a mistake.
const MAX_IMAGE_COORDINATE: f64 = 65_536.0;
/// Longest stroke, in points along it.
const MAX_SAMPLES: f64 = 16e6;
/// Rows of a rectangle that are drawn at once: whole tiles of the visibility buffer.
const BAND_ROWS: u32 = 64;
/// Nearer to a side of the clip box than this share of the depth, a ray decides on which side a surface is.
const CLIP_TOLERANCE: f64 = 1e-4;

/// A shape drawn over the image. Coordinates are in pixels from the upper left corner of the image, so that pixel centres are at halves.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum StrokeShape {
    /// A line through points.
    Pen(Vec<[f64; 2]>),
    /// A straight line.
    Line([[f64; 2]; 2]),
    /// Every pixel between two corners, including the pixels at the corners.
    Rectangle([f64; 4]),
    /// One pixel.
    Click([f64; 2]),
}

/// Pixels that a shape covers, within the image.
#[derive(Clone, Debug, PartialEq)]
pub enum Covered {
    /// Column and row, each once, row by row.
    Pixels(Vec<[u32; 2]>),
    /// From the first column and row to the last, these included.
    Rectangle([u32; 2], [u32; 2]),
}

impl StrokeShape {
    /// The pixels that it covers; none where it is outside of the image.
    ///
    /// # Errors
    /// When a coordinate is not finite or far away, or the stroke is longer than a person draws.
    pub fn covered(&self, camera: &PageCamera) -> Result<Covered, String> {
        let points: Vec<[f64; 2]> = match self {
            Self::Pen(points) => points.clone(),
            Self::Line(ends) => ends.to_vec(),
            Self::Rectangle([x0, y0, x1, y1]) => vec![[*x0, *y0], [*x1, *y1]],
            Self::Click(point) => vec![*point],
        };
        let bad = points.iter().flatten().find(|x| !x.is_finite() || x.abs() > MAX_IMAGE_COORDINATE);
        if let Some(bad) = bad {
            return Err(format!("shape: {bad} is no image coordinate; expected finite numbers within ±{MAX_IMAGE_COORDINATE}"));
        }
        if points.is_empty() {
            return Err("shape.pen is empty; expected at least one point".into());
        }
        if let Self::Rectangle(_) = self {
            return Ok(rectangle(points[0], points[1], camera));
        }
        let lengths = points.windows(2).map(|pair| f64::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]));
        let samples = lengths.sum::<f64>() * SAMPLES_PER_PIXEL;
        if samples > MAX_SAMPLES {
            return Err(format!("shape: the stroke is {:.0} pixels long; expected at most 4 million", samples / SAMPLES_PER_PIXEL));
        }
        let mut pixels = BTreeSet::new();
        let mut add = |[x, y]: [f64; 2]| {
            if (0.0..f64::from(camera.width)).contains(&x) && (0.0..f64::from(camera.height)).contains(&y) {
                pixels.insert([y as u32, x as u32]);
            }
        };
        add(points[0]);
        for pair in points.windows(2) {
            let ([x0, y0], [x1, y1]) = (pair[0], pair[1]);
            let steps = (f64::hypot(x1 - x0, y1 - y0) * SAMPLES_PER_PIXEL).ceil().max(1.0);
            (1..=steps as u32).for_each(|step| {
                let t = f64::from(step) / steps;
                add([x0 + t * (x1 - x0), y0 + t * (y1 - y0)]);
            });
        }
        Ok(Covered::Pixels(pixels.into_iter().map(|[row, column]| [column, row]).collect()))
    }
}

fn rectangle(a: [f64; 2], b: [f64; 2], camera: &PageCamera) -> Covered {
    let side = |a: f64, b: f64, pixels: u32| {
        let (first, last) = (a.min(b).floor().max(0.0), a.max(b).floor().min(f64::from(pixels) - 1.0));
        (first <= last).then_some((first as u32, last as u32))
    };
    match (side(a[0], b[0], camera.width), side(a[1], b[1], camera.height)) {
        (Some((left, right)), Some((top, bottom))) => Covered::Rectangle([left, top], [right, bottom]),
        _ => Covered::Pixels(Vec::new()),
    }
}

/// Whether the surface at a depth is within a box, and not so near to one of its sides that rounding decides.
fn is_well_within(clip: &Bounds3, camera: &PageCamera, x: f64, y: f64, depth_m: f64) -> bool {
    let (point, margin) = (camera.point(x, y, depth_m), CLIP_TOLERANCE * depth_m);
    (point - clip.min.as_dvec3()).min_element() > margin && (clip.max.as_dvec3() - point).min_element() > margin
}

/// The scene as rays meet it, without hidden pieces.
pub struct VisibleScene<'a> {
    /// All faces, including those of hidden pieces.
    pub bvh: &'a Bvh,
    /// The piece of every face.
    pub piece_of_face: &'a [u32],
    /// Pieces that rays pass through.
    pub hidden: &'a HashSet<u32>,
}

/// The hit of a ray of the page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picked {
    /// The face.
    pub face: u32,
    /// In the world, metres.
    pub point: Vec3,
    /// From the camera, metres.
    pub distance_m: f32,
}

impl VisibleScene<'_> {
    /// The faces seen in the covered pixels, ascending.
    pub fn visible_faces(&self, camera: &PageCamera, covered: &Covered) -> Vec<u32> {
        let mut faces: Vec<u32> = match covered {
            Covered::Pixels(pixels) => {
                let centre = |&[x, y]: &[u32; 2]| self.meet(camera, f64::from(x) + 0.5, f64::from(y) + 0.5).map(|picked| picked.face);
                enfilade_parallel::flat_map(pixels, centre)
            }
            Covered::Rectangle(first, last) => {
                let tops: Vec<u32> = (first[1]..=last[1]).step_by(BAND_ROWS as usize).collect();
                let band = |&top: &u32| {
                    let rows = (last[1] - top + 1).min(BAND_ROWS);
                    let mut buffer = VisibilityBuffer::new(last[0] - first[0] + 1, rows);
                    buffer.draw(self.bvh, &camera.rays(first[0], top));
                    // The buffer shows all faces, also those in front of the near plane, hidden and outside the clip box. Where such a
                    // one covers the pixel, a ray finds the surface behind.
                    let last = Cell::new(NOTHING);
                    let seen = |(i, (&face, &inverse_z)): (usize, (&u32, &f32))| {
                        if face == NOTHING {
                            return None;
                        }
                        let is_known = face == last.get();
                        let (x, y) = (first[0] as usize + i % buffer.size()[0], top as usize + i / buffer.size()[0]);
                        let (x, y) = (x as f64 + 0.5, y as f64 + 0.5);
                        let is_shown = f64::from(inverse_z) * camera.near_m <= 1.0
                            && (is_known || !self.hidden.contains(&self.piece_of_face[face as usize]))
                            && camera.clip.is_none_or(|clip| is_well_within(&clip, camera, x, y, 1.0 / f64::from(inverse_z)));
                        if is_shown {
                            last.set(face);
                            return Some(face).filter(|_| !is_known);
                        }
                        self.meet(camera, x, y).map(|picked| picked.face)
                    };
                    buffer.triangles().iter().zip(buffer.inverse_z()).enumerate().filter_map(seen).collect::<HashSet<u32>>()
                };
                enfilade_parallel::flat_map(&tops, band)
            }
        };
        faces.sort_unstable();
        faces.dedup();
        faces
    }

    /// The first hit of the ray through an image point.
    pub fn meet(&self, camera: &PageCamera, x: f64, y: f64) -> Option<Picked> {
        let ray = camera.ray(x, y);
        let hit = self.first(&ray, camera.clip.as_ref())?;
        Some(Picked { face: hit.triangle, point: ray.at(hit.t), distance_m: hit.t })
    }

    /// The first hit of a ray within the box, if there is one.
    pub fn first(&self, ray: &Ray, clip: Option<&Bounds3>) -> Option<Hit> {
        if self.hidden.is_empty() && clip.is_none() {
            return self.bvh.closest(ray);
        }
        let is_there = |hit: &Hit| clip.is_none_or(|clip| clip.contains(ray.at(hit.t)));
        self.bvh.closest_filtered(ray, |hit| is_there(hit) && !self.hidden.contains(&self.piece_of_face[hit.triangle as usize]))
    }
}
