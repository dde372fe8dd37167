//! Silhouettes of single objects, by rays through the pixel centres of the image and of a margin around it.

use super::Solid;
use enfilade_dataset::PixelArea;
use enfilade_math::{DVec3, Ray};
use enfilade_scene::{Camera, CameraRay, CameraView, Projection};

/// Side of the squares of pixels whose rays are compared with whole objects before they are cast.
const TILE: i32 = 16;
/// Side of the squares of tiles that are compared with all objects, so that each tile need only be compared with some.
const BLOCK: i32 = 8 * TILE;

/// The pixels in which silhouettes are looked for: the image and as much again on every side. A panorama has nothing beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Canvas {
    /// Width of the image.
    width: i32,
    height: i32,
    /// Columns to the left and right of the image, and rows above and below.
    margin: [i32; 2],
}

/// The area of a canvas that one object covers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Silhouette {
    /// All its pixels.
    pub full: PixelArea,
    /// Pixels in the image, counted column by column.
    pub inside: Vec<u32>,
}

impl Canvas {
    /// The canvas of a camera.
    pub fn of(camera: &Camera) -> Self {
        let [width, height] = camera.size().map(|side| side as i32);
        let margin = if matches!(camera.projection, Projection::Equirectangular { .. }) { [0; 2] } else { [width, height] };
        Self { width, height, margin }
    }

    /// The areas that `solids` cover, each as if it were alone.
    pub(super) fn silhouettes(&self, solids: &[Solid], view: &CameraView<'_>) -> Vec<Silhouette> {
        let [left, above] = self.margin;
        let blocks: Vec<[i32; 4]> = squares([-left, -above, self.width + left, self.height + above], BLOCK).collect();
        let found: Vec<Vec<(usize, Silhouette)>> = enfilade_parallel::map(&blocks, |block| self.cast_block(solids, view, *block));
        let mut whole = vec![Silhouette::default(); solids.len()];
        for (solid, part) in found.into_iter().flatten() {
            whole[solid].full = whole[solid].full.union(part.full);
            whole[solid].inside.extend(part.inside);
        }
        whole
    }

    /// The areas of a block that solids cover, by their indices in `solids`; a solid may occur several times.
    fn cast_block(&self, solids: &[Solid], view: &CameraView<'_>, block: [i32; 4]) -> Vec<(usize, Silhouette)> {
        let tile = |[left, above, right, below]: [i32; 4]| {
            let pixels = (above..below).flat_map(|y| (left..right).map(move |x| (x, y)));
            let ray = |(x, y): (i32, i32)| Some((x, y, view.centre_ray(f64::from(x) + 0.5, f64::from(y) + 0.5)?));
            let rays: Rays = pixels.filter_map(ray).collect();
            Some((Cone::around(&rays)?, rays))
        };
        let tiles: Vec<(Cone, Rays)> = squares(block, TILE).filter_map(tile).collect();
        let around = Cone::around_cones(tiles.iter().map(|(cone, _)| cone));
        let near: Vec<usize> = (0..solids.len()).filter(|&i| around.as_ref().is_none_or(|cone| cone.meets(&solids[i]))).collect();
        let mut found = Vec::new();
        for (cone, rays) in &tiles {
            let met = near.iter().filter(|&&i| cone.meets(&solids[i]));
            found.extend(met.map(|&i| (i, self.cast(&solids[i], rays))).filter(|(_, part)| part.full.pixels > 0));
        }
        found
    }

    /// The pixels of `rays` that a solid covers.
    fn cast(&self, solid: &Solid, rays: &[(i32, i32, CameraRay)]) -> Silhouette {
        let mut found = Silhouette::default();
        for (x, y, ray) in rays {
            if solid.bvh.occluded(&Ray::new(ray.origin.as_vec3(), ray.direction.as_vec3())) {
                found.full = found.full.with(*x, *y);
                if (0..self.width).contains(x) && (0..self.height).contains(y) {
                    found.inside.push((x * self.height + y) as u32);
                }
            }
        }
        found
    }
}

/// The squares of this side that make up a rectangle of pixels (left, upper, right and lower border), cut off at its borders.
fn squares([left, above, right, below]: [i32; 4], side: i32) -> impl Iterator<Item = [i32; 4]> {
    let places = move |from: i32, to: i32| (from..to).step_by(side as usize).map(move |at| (at, (at + side).min(to)));
    places(above, below).flat_map(move |(y, end_y)| places(left, right).map(move |(x, end_x)| [x, y, end_x, end_y]))
}

/// Rays, and the pixels that they are of: column and row.
type Rays = Vec<(i32, i32, CameraRay)>;

/// A cone that contains some rays once they are moved by up to `spread`.
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
        let half_angle_rad = rays.iter().map(|(.., ray)| axis.dot(ray.direction)).fold(1.0, f64::min).max(-1.0).acos();
        let spread = rays.iter().map(|(.., ray)| ray.origin.distance(apex)).fold(0.0, f64::max);
        Some(Self { apex, axis, half_angle_rad, spread })
    }

    /// A cone that contains all `cones`; `None` where they point away from each other.
    fn around_cones<'a>(cones: impl Iterator<Item = &'a Self> + Clone) -> Option<Self> {
        let apex = cones.clone().next()?.apex;
        let axis = cones.clone().map(|cone| cone.axis).sum::<DVec3>().try_normalize()?;
        let half_angle_rad = cones.clone().map(|cone| axis.angle_between(cone.axis) + cone.half_angle_rad).fold(0.0, f64::max);
        let spread = cones.map(|cone| cone.apex.distance(apex) + cone.spread).fold(0.0, f64::max);
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
