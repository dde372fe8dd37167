//! Small places on which much light falls, such as the cup around a bulb or a patch of sun: found by photons, because few of the rays that
//! gather light happen to meet them.
//!
//! A grid of small cells adds up the photons (Jensen 1996, "Global Illumination Using Photon Maps", for the estimate of density).

use super::cells::{Cells, NONE, Site};
use super::mirrored::mirrored;
use crate::bsdf::Event;
use crate::light::{LightChoice, PhotonSources};
use crate::prepared::{AlphaTest, RenderScene};
use crate::texture::Cone;
use enfilade_math::{INV_PI, Rgb, Rng, Vec3, hash_u64};

/// Surfaces that a photon reaches by way of panes, mirrors and glass.
const VERTICES: usize = 12;
/// A spot receives at least this many times the irradiance of the places that photons reach, and at least this many photons.
const BRIGHT: f32 = 4.0;
const MIN_PHOTONS: usize = 8;
/// Light from within this many spots' sizes is near.
const NEAR: f32 = 8.0;
/// Turns the seed of the field into the seed of the photons.
const SEED: u64 = 0x9407;

/// A small bright place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    /// The place where one of its photons arrived.
    pub site: Site,
    /// The middle of all of them.
    pub p: Vec3,
    /// Irradiance over π.
    pub light: Rgb,
    /// Mean radiance that the surfaces send back.
    pub radiance: Rgb,
    /// Luminance of the part of `light` that comes from no farther than [`NEAR`] spots.
    pub near: f32,
}

/// The small bright places of a scene.
pub(super) struct Spots {
    cells: Cells,
    /// Spot of each cell.
    pub spots: Vec<Spot>,
}

/// A photon on a surface: its flux, and the part that the surface sends back blurred.
#[derive(Clone, Copy)]
struct Arrival {
    site: Site,
    flux: Rgb,
    sent: Rgb,
    is_near: bool,
}

/// The photons in one small cell.
#[derive(Clone, Copy, Default)]
struct Sum {
    photons: usize,
    p: Vec3,
    flux: Rgb,
    sent: Rgb,
    near: f32,
}

impl Spots {
    /// The spots that `photons` find, in cells of `size` metres counted from `origin`.
    pub fn find(scene: &RenderScene<'_>, choice: &LightChoice, origin: Vec3, size: f32, photons: usize, seed: u64) -> Self {
        let Some(sources) = PhotonSources::new(scene, choice) else {
            return Self { cells: Cells::new(origin, size, &[]), spots: Vec::new() };
        };
        // Send photons, and add up what arrives in each cell.
        let arrivals: Vec<Arrival> = enfilade_parallel::flat_map_up_to(photons, |photon| {
            let mut arrivals = Vec::new();
            follow(scene, &sources, NEAR * size, Rng::new(hash_u64(seed ^ hash_u64(SEED << 32 | photon as u64))), &mut arrivals);
            arrivals
        });
        let sites: Vec<Site> = arrivals.iter().map(|arrival| arrival.site).collect();
        let cells = Cells::new(origin, size, &sites);
        let mut sums = vec![Sum::default(); cells.len()];
        for Arrival { site, flux, sent, is_near } in &arrivals {
            let Some(sum) = sums.get_mut(cells.find(site.p, site.n) as usize) else { continue };
            sum.photons += 1;
            sum.p += site.p;
            sum.flux += *flux;
            sum.sent += *sent;
            sum.near += if *is_near { flux.luminance() } else { 0.0 };
        }

        // Keep the bright ones. A cell counts as filled by one flat surface.
        let scale = INV_PI / (photons as f32 * size * size);
        let min = BRIGHT * sums.iter().map(|sum| sum.flux.luminance()).sum::<f32>() / sums.len() as f32;
        let spots: Vec<Spot> = sums
            .iter()
            .zip(&cells.sites)
            .filter(|(sum, _)| sum.photons >= MIN_PHOTONS && sum.flux.luminance() > min)
            .filter_map(|(sum, sites)| {
                let p = sum.p / sum.photons as f32;
                Some(Spot { site: sites[0]?, p, light: sum.flux * scale, radiance: sum.sent * scale, near: sum.near * scale })
            })
            .collect();
        // Each is in a cell of its own, so that cells are numbered as spots are.
        let cells = Cells::new(origin, size, &spots.iter().map(|spot| spot.site).collect::<Vec<_>>());
        Self { cells, spots }
    }

    /// The number of the spot at a surface point.
    #[inline]
    pub fn at(&self, p: Vec3, n: Vec3) -> Option<usize> {
        let number = self.cells.find(p, n);
        (number != NONE).then_some(number as usize)
    }
}

/// Follows a photon through panes, mirrors and glass, and notes every blurred surface that it falls on; those within `near` metres of way are
/// near.
fn follow(scene: &RenderScene<'_>, sources: &PhotonSources<'_, '_>, near: f32, mut rng: Rng, arrivals: &mut Vec<Arrival>) {
    let Some((mut ray, mut flux)) = sources.emit(&mut rng) else { return };
    let mut way = 0.0;
    for _ in 0..VERTICES {
        // Find the next surface that is no pane.
        let Some(hit) = scene.closest(&ray, AlphaTest::Stochastic) else { return };
        let surface = scene.surface(&hit, ray.direction, &Cone::POINT);
        way += hit.t;
        if let Some(through) = surface.straight_transmittance(scene) {
            flux *= through;
            ray = surface.ray(ray.direction);
            continue;
        }
        let bsdf = surface.bsdf(scene);
        let albedo = bsdf.albedo(surface.wo.dot(surface.ns));
        let blurred = albedo.blurred();
        if !blurred.is_black() && flux.luminance().is_finite() {
            let site = Site { p: surface.p, n: surface.ns_smooth };
            arrivals.push(Arrival { site, flux, sent: flux * blurred, is_near: way < near });
        }

        // Go on by what is mirrored or refracted.
        let chance = albedo.sharp.luminance();
        let Some((sample, direction)) = mirrored(&surface, &bsdf, chance, &mut rng) else { return };
        flux *= (1.0 / chance).max(1.0);
        // Of what is sampled by a density, a part is blurred.
        flux *= sample.weight.specular * if sample.event == Event::Finite { albedo.sharp_fraction() } else { 1.0 };
        if flux.is_black() {
            return;
        }
        ray = surface.ray(direction);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_geometry::Mesh;
    use enfilade_math::DAffine3;
    use enfilade_scene::{Material, Part, Quiet, Scene};

    #[test]
    fn a_lamp_close_above_a_floor_makes_a_spot_and_nothing_else_does() {
        // A floor of 6 × 6 m, and 1 cm above its middle a lamp of 2 × 2 cm that shines down.
        let square = |half: f32, z: f32, down: bool| {
            let corners = [[-half, -half, z], [half, -half, z], [half, half, z], [-half, half, z]];
            let triangles = if down { vec![[0, 2, 1], [0, 3, 2]] } else { vec![[0, 1, 2], [0, 2, 3]] };
            Mesh { positions: corners.map(Vec3::from).to_vec(), triangles, ..Mesh::default() }
        };
        let part = |number: u32| Part {
            name: format!("part {number}"),
            object: None,
            mesh: number,
            material: number,
            world_from_mesh: DAffine3::IDENTITY,
        };
        let scene = Scene {
            meshes: vec![square(3.0, 0.0, false).into(), square(0.01, 0.01, true).into()],
            materials: vec![
                Material::diffuse("floor", Rgb::splat(0.5)),
                Material { emission: Rgb::splat(9.0).into(), ..Material::diffuse("lamp", Rgb::BLACK) },
            ],
            parts: vec![part(0), part(1)],
            ..Scene::default()
        };
        let prepared = RenderScene::new(&scene, &Quiet).expect("lit");
        let choice = LightChoice::learn(&prepared, &[], &crate::RenderConfig::default());
        let found = Spots::find(&prepared, &choice, Vec3::splat(-3.01), 0.02, 1 << 14, 1);
        assert!((1..40).contains(&found.spots.len()), "{} spots", found.spots.len());
        for spot in &found.spots {
            assert!(spot.p.length() < 0.1 && spot.site.n.z > 0.9, "{spot:?}");
            assert!((spot.radiance.g / (0.5 * spot.light.g) - 1.0).abs() < 0.01, "{spot:?}");
        }
        // A form factor of 0.55 below the middle, less around.
        let middle = found.at(Vec3::ZERO, Vec3::Z).map(|spot| found.spots[spot].light.g).expect("a spot");
        assert!((0.25 * 9.0..0.55 * 9.0).contains(&middle), "{middle}");
        assert!(found.at(Vec3::new(1.0, 0.0, 0.0), Vec3::Z).is_none());
    }
}
