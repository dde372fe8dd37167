//! Drawn pictures against rays through the same pixels.

use super::*;
use crate::bvh::tests::{closed_surface, kernels, random_triangles, room, solid};
use enfilade_math::{Ray, Rng, Vec3};

const WIDTH: u32 = 100;
const HEIGHT: u32 = 52;

fn looking(origin: Vec3, forward: Vec3, fov_x_rad: f32) -> PinholeRays {
    let forward = forward.normalize();
    let across = forward.any_orthonormal_vector();
    let step = 2.0 * (0.5 * fov_x_rad).tan() / WIDTH as f32;
    let (right, down) = (step * across, step * forward.cross(across));
    PinholeRays { origin, corner: forward - 0.5 * ((WIDTH - 1) as f32 * right + (HEIGHT - 1) as f32 * down), right, down }
}

/// From anywhere in the box, to anywhere.
fn random_view(rng: &mut Rng, [min, max]: [Vec3; 2]) -> PinholeRays {
    let mut point = || Vec3::new(rng.range(min.x, max.x), rng.range(min.y, max.y), rng.range(min.z, max.z));
    let (origin, other) = (point(), point());
    looking(origin, other - origin, rng.range(0.3, 2.2))
}

const AROUND: [Vec3; 2] = [Vec3::splat(-2.0), Vec3::splat(2.0)];
const INSIDE: [Vec3; 2] = [Vec3::splat(0.001), Vec3::new(5.999, 4.999, 2.999)];

fn seen(bvh: &Bvh, rays: &PinholeRays) -> VisibilityBuffer {
    let mut buffer = VisibilityBuffer::new(WIDTH, HEIGHT);
    buffer.draw(bvh, rays);
    buffer
}

/// Pixels, and the hit of the ray through each.
fn cast<'a>(bvh: &'a Bvh, rays: &'a PinholeRays) -> impl Iterator<Item = (usize, Option<crate::Hit>)> + 'a {
    (0..(WIDTH * HEIGHT) as usize).map(|pixel| {
        let direction = rays.direction((pixel % WIDTH as usize) as f32, (pixel / WIDTH as usize) as f32);
        (pixel, bvh.closest(&Ray::new(rays.origin, direction)))
    })
}

#[test]
fn drawing_sees_what_rays_meet() {
    let mut rng = Rng::new(3);
    let (mut pixels, mut other, mut void) = (0, 0, 0);
    let few = (random_triangles(&mut rng, 40, 2.0, 2.0), AROUND);
    let many = (random_triangles(&mut rng, 5000, 2.0, 0.1), AROUND);
    for (triangles, places) in [few, many, (room(&mut rng), INSIDE)] {
        let bvh = solid(&triangles);
        for _ in 0..12 {
            let rays = random_view(&mut rng, places);
            let buffer = seen(&bvh, &rays);
            for (pixel, hit) in cast(&bvh, &rays) {
                let (triangle, z) = (buffer.triangles()[pixel], buffer.inverse_z()[pixel]);
                pixels += 1;
                void += usize::from(hit.is_none());
                other += usize::from(hit.map_or(NOTHING, |h| h.triangle) != triangle);
                // The direction's part along the axis is 1, so t is the depth.
                if let Some(hit) = hit.filter(|h| h.triangle == triangle) {
                    assert!((hit.t * z - 1.0).abs() < 2e-4, "depth {} by the ray, {} drawn", hit.t, 1.0 / z);
                }
                assert_eq!(triangle == NOTHING, z == 0.0);
            }
        }
    }
    // Rounding decides where a ray runs along an edge.
    assert!(other * 5000 < pixels, "{other} of {pixels} pixels differ");
    assert!(void * 20 > pixels && void * 2 < pixels, "{void} of {pixels} pixels show nothing");
}

#[test]
fn no_pixel_falls_between_the_triangles_of_a_closed_surface() {
    let mut rng = Rng::new(5);
    let rough = closed_surface(&mut rng, 60, Vec3::splat(40.0), 1.0);
    for (triangles, places) in [(room(&mut rng), INSIDE), (rough, [Vec3::splat(39.7), Vec3::splat(40.3)])] {
        let bvh = solid(&triangles);
        for _ in 0..100 {
            let buffer = seen(&bvh, &random_view(&mut rng, places));
            assert!(buffer.triangles().iter().all(|t| *t != NOTHING));
        }
    }
}

#[test]
fn all_kernels_draw_the_same_bits() {
    let mut rng = Rng::new(7);
    for triangles in [random_triangles(&mut rng, 3000, 2.0, 0.3), room(&mut rng)] {
        let mut bvh = solid(&triangles);
        for _ in 0..8 {
            let rays = random_view(&mut rng, AROUND);
            let pictures = kernels().into_iter().map(|kernel| {
                bvh.kernel = kernel;
                let buffer = seen(&bvh, &rays);
                (buffer.triangles, buffer.inverse_z.iter().map(|z| z.to_bits()).collect::<Vec<_>>())
            });
            let pictures: Vec<_> = pictures.collect();
            assert!(pictures.windows(2).all(|p| p[0] == p[1]));
        }
    }
}

#[test]
fn of_equal_triangles_the_first_is_seen_and_both_sides_show() {
    let triangle = [Vec3::new(-9.0, -9.0, -2.0), Vec3::new(9.0, -9.0, -2.0), Vec3::new(0.0, 18.0, -2.0)];
    let [a, b, c] = triangle;
    let bvh = solid(&[[a, c, b], triangle, triangle]);
    let buffer = seen(&bvh, &looking(Vec3::ZERO, Vec3::NEG_Z, 1.0));
    assert!(buffer.triangles().iter().all(|t| *t == 0));
    assert!(buffer.inverse_z().iter().all(|z| (z - 0.5).abs() < 1e-6));
    let away = seen(&bvh, &looking(Vec3::ZERO, Vec3::Z, 1.0));
    assert!(away.triangles().iter().all(|t| *t == NOTHING));
}

#[test]
fn nothing_is_seen_where_there_is_nothing() {
    let buffer = seen(&solid(&[]), &looking(Vec3::ZERO, Vec3::X, 1.0));
    assert!(buffer.triangles().iter().all(|t| *t == NOTHING) && buffer.size() == [100, 52]);
}
