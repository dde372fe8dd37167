//! Silhouettes of single objects, by rays through the pixel centres of the image and of what lies around it.

use super::Solid;
use enfilade_dataset::PixelArea;
use enfilade_math::{DVec3, Ray};
use enfilade_scene::{Camera, CameraRay, CameraView, Projection};
use rayon::prelude::*;

/// Side of the squares of pixels whose rays are compared with whole objects before they are cast.
const TILE: i32 = 16;

/// The pixels in which silhouettes are looked for: the image and as much again on every side. A panorama has nothing beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Canvas {
    /// Of the image.
    width: i32,
    height: i32,
    /// Columns to the left and right of the image, and rows above and below.
    margin: [i32; 2],
}

/// What one object covers of a canvas.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Silhouette {
    /// All its pixels.
    pub full: PixelArea,
    /// Those in the image, counted column by column.
    pub inside: Vec<u32>,
}

impl Canvas {
    /// The canvas of a camera.
    pub fn of(camera: &Camera) -> Self {
        let [width, height] = camera.size().map(|side| side as i32);
        let margin = if matches!(camera.projection, Projection::Equirectangular { .. }) { [0; 2] } else { [width, height] };
        Self { width, height, margin }
    }

    /// What each of `solids` covers, each as if it were alone.
    pub(super) fn silhouettes(&self, solids: &[Solid], view: &CameraView<'_>) -> Vec<Silhouette> {
        let tiles = |from: i32, to: i32| (from..to).step_by(TILE as usize).collect::<Vec<_>>();
        let [left, above] = self.margin;
        let columns = tiles(-left, self.width + left);
        let rows: Vec<Vec<Silhouette>> = tiles(-above, self.height + above)
            .into_par_iter()
            .map(|y| {
                let mut found = vec![Silhouette::default(); solids.len()];
                columns.iter().for_each(|&x| self.cast_tile(solids, view, [x, y], &mut found));
                found
            })
            .collect();
        let mut whole = vec![Silhouette::default(); solids.len()];
        for row in rows {
            for (whole, part) in whole.iter_mut().zip(row) {
                whole.full = whole.full.union(part.full);
                whole.inside.extend(part.inside);
            }
        }
        whole
    }

    /// Casts the rays of the tile whose first pixel is (x, y) at the solids that they may meet.
    fn cast_tile(&self, solids: &[Solid], view: &CameraView<'_>, [x, y]: [i32; 2], found: &mut [Silhouette]) {
        let (end_x, end_y) = ((x + TILE).min(self.width + self.margin[0]), (y + TILE).min(self.height + self.margin[1]));
        let pixels = (y..end_y).flat_map(|y| (x..end_x).map(move |x| (x, y)));
        let rays: Vec<(i32, i32, CameraRay)> =
            pixels.filter_map(|(x, y)| Some((x, y, view.centre_ray(f64::from(x) + 0.5, f64::from(y) + 0.5)?))).collect();
        let Some(cone) = Cone::around(&rays) else { return };
        for (solid, found) in solids.iter().zip(found).filter(|(solid, _)| cone.meets(solid)) {
            for (x, y, ray) in &rays {
                if solid.bvh.occluded(&Ray::new(ray.origin.as_vec3(), ray.direction.as_vec3())) {
                    found.full = found.full.with(*x, *y);
                    if (0..self.width).contains(x) && (0..self.height).contains(y) {
                        found.inside.push((x * self.height + y) as u32);
                    }
                }
            }
        }
    }
}

/// A cone that holds some rays but for `spread`.
struct Cone {
    apex: DVec3,
    axis: DVec3,
    half_angle_rad: f64,
    /// Largest distance of a ray's origin from the apex, metres.
    spread: f64,
}

impl Cone {
    fn around(rays: &[(i32, i32, CameraRay)]) -> Option<Self> {
        let apex = rays.first()?.2.origin;
        let axis = rays.iter().map(|(.., ray)| ray.direction).sum::<DVec3>().try_normalize()?;
        let half_angle_rad = rays.iter().map(|(.., ray)| axis.angle_between(ray.direction)).fold(0.0, f64::max);
        let spread = rays.iter().map(|(.., ray)| ray.origin.distance(apex)).fold(0.0, f64::max);
        Some(Self { apex, axis, half_angle_rad, spread })
    }

    /// False only where no ray meets the ball around the solid.
    fn meets(&self, solid: &Solid) -> bool {
        let (to, radius) = (solid.center - self.apex, solid.radius + self.spread);
        let distance = to.length();
        // A thousandth of a radian is far more than rounding.
        distance <= radius || self.axis.angle_between(to) <= self.half_angle_rad + (radius / distance).asin() + 1e-3
    }
}
