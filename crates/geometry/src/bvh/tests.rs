//! Hits against brute force: the same on every kernel, watertight, and exact at ties, borders and degenerate triangles.

use super::hierarchy::Kernel;
use super::*;
use enfilade_math::{Ray, Rng, Vec3, warp};
use std::cell::Cell;

pub(super) type Triangle = [Vec3; 3];

/// The triangle test for one triangle, written for reading: the operations of the kernel in the kernel's order.
fn meet_one(triangle: &Triangle, ray: &Ray) -> Option<Hit> {
    let d = ray.direction.to_array();
    let size = d.map(f32::abs);
    let z = (0..3).rev().max_by(|&i, &j| size[i].total_cmp(&size[j])).unwrap();
    let (x, y, iz) = ((z + 1) % 3, (z + 2) % 3, 1.0 / d[z]);
    let [a, b, c] = triangle.map(|p| {
        let p = (p - ray.origin).to_array();
        [p[x] - d[x] * iz * p[z], p[y] - d[y] * iz * p[z], p[z]]
    });
    let mut weights = [c[0] * b[1] - c[1] * b[0], a[0] * c[1] - a[1] * c[0], b[0] * a[1] - b[1] * a[0]];
    if weights.contains(&0.0) {
        let [a, b, c] = [a, b, c].map(|p| p.map(f64::from));
        let exact = [c[0] * b[1] - c[1] * b[0], a[0] * c[1] - a[1] * c[0], b[0] * a[1] - b[1] * a[0]];
        let sum = exact[0] + exact[1] + exact[2];
        if sum == 0.0 || !same_sign(&exact) {
            return None;
        }
        weights = exact.map(|w| (w / sum) as f32);
    } else {
        let sum = weights[0] + weights[1] + weights[2];
        if !same_sign(&weights.map(f64::from)) {
            return None;
        }
        weights = weights.map(|w| w * (1.0 / sum));
    }
    let t = (weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2]) * iz;
    (t > ray.t_min && t < ray.t_max).then_some(Hit { t, triangle: 0, u: weights[1], v: weights[2] })
}

fn same_sign(weights: &[f64; 3]) -> bool {
    weights.iter().all(|&w| w >= 0.0) || weights.iter().all(|&w| w <= 0.0)
}

/// Every triangle in turn; the lowest index wins a tie.
fn brute_force(triangles: &[Triangle], ray: &Ray, accept: impl Fn(&Hit) -> bool) -> Option<Hit> {
    let hits = triangles.iter().enumerate().filter_map(|(i, t)| Some(Hit { triangle: i as u32, ..meet_one(t, ray)? }));
    hits.filter(accept).reduce(|best, hit| if hit.t < best.t { hit } else { best })
}

pub(super) fn solid(triangles: &[Triangle]) -> Bvh {
    Bvh::new(triangles, &|_| false)
}

fn point(rng: &mut Rng, size: f32) -> Vec3 {
    Vec3::new(rng.range(-size, size), rng.range(-size, size), rng.range(-size, size))
}

fn direction(rng: &mut Rng) -> Vec3 {
    warp::sphere([rng.next_f32(), rng.next_f32()])
}

pub(super) fn random_triangles(rng: &mut Rng, count: usize, room: f32, size: f32) -> Vec<Triangle> {
    (0..count)
        .map(|_| {
            let p = point(rng, room);
            [p, p + point(rng, size), p + point(rng, size)]
        })
        .collect()
}

/// Long thin triangles in all directions.
fn slivers(rng: &mut Rng, count: usize) -> Vec<Triangle> {
    (0..count)
        .map(|_| {
            let (p, along) = (point(rng, 1.0), direction(rng));
            [p, p + along, p + along * 0.5 + point(rng, 1e-4)]
        })
        .collect()
}

/// A grid of squares in each of the three axis planes through `at`, sharing edges and vertices.
fn grids(at: Vec3, cells: usize, step: f32) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    for (x, y) in [(Vec3::X, Vec3::Y), (Vec3::Y, Vec3::Z), (Vec3::Z, Vec3::X)] {
        for i in 0..cells {
            for j in 0..cells {
                let p = |a: usize, b: usize| at + x * (step * a as f32) + y * (step * b as f32);
                let (a, b, c, d) = (p(i, j), p(i + 1, j), p(i + 1, j + 1), p(i, j + 1));
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    triangles
}

/// The sides of an axis-aligned box.
fn cuboid(min: Vec3, max: Vec3) -> Vec<Triangle> {
    let corner = |i: usize| Vec3::new([min, max][i & 1].x, [min, max][i >> 1 & 1].y, [min, max][i >> 2].z);
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
        .into_iter()
        .flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]].map(|t| t.map(corner)))
        .collect()
}

/// A room with boxes in it: walls of two triangles beside small things.
pub(super) fn room(rng: &mut Rng) -> Vec<Triangle> {
    let mut triangles = cuboid(Vec3::ZERO, Vec3::new(6.0, 5.0, 3.0));
    for _ in 0..60 {
        let p = Vec3::new(rng.range(0.0, 5.0), rng.range(0.0, 4.0), rng.range(0.0, 2.0));
        triangles.extend(cuboid(p, p + Vec3::new(rng.range(0.01, 1.0), rng.range(0.01, 1.0), rng.range(0.01, 1.0))));
    }
    triangles
}

/// A closed surface around the origin, star-shaped and rough, of 2 · `n`² or so triangles that share their vertices.
pub(super) fn closed_surface(rng: &mut Rng, n: usize, center: Vec3, radius: f32) -> Vec<Triangle> {
    let mut vertex = vec![vec![Vec3::ZERO; n]; n + 1];
    for (i, row) in vertex.iter_mut().enumerate() {
        for (j, p) in row.iter_mut().enumerate() {
            let (theta, phi) = (i as f32 / n as f32 * std::f32::consts::PI, j as f32 / n as f32 * std::f32::consts::TAU);
            let r = radius * rng.range(0.7, 1.3);
            *p = center + r * Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
        }
    }
    let (top, bottom) = (vertex[0][0], vertex[n][0]);
    vertex[0].fill(top);
    vertex[n].fill(bottom);
    let mut triangles = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let (a, b) = (vertex[i][j], vertex[i + 1][j]);
            let (c, d) = (vertex[i + 1][(j + 1) % n], vertex[i][(j + 1) % n]);
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    triangles
}

/// A ray of every unkind sort: anywhere, along axes with zeros of both signs, from and to vertices, edges and planes.
pub(super) fn unkind_ray(rng: &mut Rng, triangles: &[Triangle], size: f32) -> Ray {
    let on_triangle = |rng: &mut Rng| {
        let [a, b, c] = triangles[rng.below(triangles.len())];
        match rng.below(4) {
            0 => a,
            1 => a.lerp(b, rng.next_f32()),
            2 => 0.5 * (b + c),
            _ => {
                let w = warp::triangle([rng.next_f32(), rng.next_f32()]);
                a + (b - a) * w.x + (c - a) * w.y
            }
        }
    };
    let origin = if rng.below(3) == 0 { on_triangle(rng) } else { point(rng, size) };
    let direction = match rng.below(5) {
        0 => direction(rng),
        1 => on_triangle(rng) - origin,
        2 => {
            let zero = if rng.below(2) == 0 { 0.0 } else { -0.0 };
            let sign = if rng.below(2) == 0 { 1.0 } else { -1.0 };
            let mut d = [zero; 3];
            d[rng.below(3)] = sign;
            Vec3::from(d)
        }
        3 => {
            let mut d = direction(rng).to_array();
            d[rng.below(3)] = if rng.below(2) == 0 { 0.0 } else { -0.0 };
            Vec3::from(d)
        }
        _ => {
            let [a, b, c] = triangles[rng.below(triangles.len())];
            (b - a) * rng.range(-1.0, 1.0) + (c - a) * rng.range(-1.0, 1.0)
        }
    };
    let t_max = if rng.below(4) == 0 { rng.range(0.0, 4.0) } else { f32::INFINITY };
    Ray { origin, direction, t_min: if rng.below(4) == 0 { rng.range(-1.0, 1.0) } else { 0.0 }, t_max }
}

/// Name, triangles, size of the space around them.
fn soups() -> Vec<(&'static str, Vec<Triangle>, f32)> {
    let mut rng = Rng::new(1);
    let mut mixed = random_triangles(&mut rng, 400, 1.0, 0.02);
    mixed.extend(random_triangles(&mut rng, 20, 3.0, 5.0));
    mixed.extend(grids(Vec3::new(-0.5, 0.25, 0.0), 8, 0.125));
    let mut uneven = random_triangles(&mut rng, 300, 0.5, 1e-5);
    uneven.extend(random_triangles(&mut rng, 30, 10.0, 1e4));
    let chain = (0..600).map(|i| [Vec3::X, Vec3::Y, Vec3::Z].map(|p| p * 0.9f32.powi(i))).collect();
    vec![
        ("one", random_triangles(&mut rng, 1, 0.3, 1.0), 1.0),
        ("nine", random_triangles(&mut rng, 9, 0.5, 1.0), 1.5),
        ("random", random_triangles(&mut rng, 700, 1.0, 0.3), 1.5),
        ("slivers", slivers(&mut rng, 500), 1.5),
        ("grids", grids(Vec3::ZERO, 10, 0.1), 1.2),
        ("odd grids", grids(Vec3::new(100.1, -7.3, 0.7), 10, 0.1), 110.0),
        ("room", room(&mut rng), 7.0),
        ("closed", closed_surface(&mut rng, 16, Vec3::new(0.1, 0.2, 0.3), 1.0), 2.0),
        ("mixed", mixed, 2.0),
        ("uneven", uneven, 2.0),
        ("chain", chain, 1.0),
    ]
}

pub(super) fn bits(hit: Option<Hit>) -> Option<[u32; 4]> {
    hit.map(|h| [h.t.to_bits(), h.triangle, h.u.to_bits(), h.v.to_bits()])
}

#[test]
fn closest_and_any_hit_match_brute_force_to_the_bit() {
    for (name, triangles, size) in soups() {
        let bvh = solid(&triangles);
        let mut rng = Rng::new(2);
        let mut hits = 0;
        for i in 0..3000 {
            let ray = unkind_ray(&mut rng, &triangles, size);
            let expected = brute_force(&triangles, &ray, |_| true);
            assert_eq!(bits(bvh.closest(&ray)), bits(expected), "{name}, ray {i}: {ray:?}, expected {expected:?}");
            assert_eq!(bvh.occluded(&ray), expected.is_some(), "{name}, ray {i}: {ray:?}");
            hits += usize::from(expected.is_some());
        }
        assert!(hits > 100, "{name}: only {hits} rays hit anything");
    }
}

/// The kernels that this machine can run, the plain one first.
pub(super) fn kernels() -> Vec<Kernel> {
    let mut kernels = vec![Kernel::Portable];
    #[cfg(target_arch = "x86_64")]
    match Kernel::best_here() {
        Kernel::Portable => {}
        Kernel::Avx2 => kernels.push(Kernel::Avx2),
        Kernel::Avx512 => kernels.extend([Kernel::Avx2, Kernel::Avx512]),
    }
    kernels
}

#[test]
fn all_kernels_give_the_same_bits_and_ask_the_same_questions() {
    for (name, triangles, size) in soups() {
        let mut bvh = Bvh::new(&triangles, &|i| i % 3 == 0);
        let mut rng = Rng::new(3);
        for i in 0..3000 {
            let ray = unkind_ray(&mut rng, &triangles, size);
            let mut answers = kernels().into_iter().map(|kernel| {
                bvh.kernel = kernel;
                let asked = Cell::new(0);
                let accept = |hit: &Hit| hit.u > hit.v;
                let any = bvh.occluded_filtered(&ray, |hit| {
                    asked.set(enfilade_math::hash_u32(asked.get() ^ hit.triangle));
                    accept(hit)
                });
                (bits(bvh.closest(&ray)), bits(bvh.closest_filtered(&ray, accept)), any, asked.get())
            });
            let first = answers.next().unwrap();
            assert!(answers.all(|answer| answer == first), "{name}, ray {i}: {ray:?}");
        }
    }
}

#[test]
fn rejected_hits_are_as_if_they_were_not_there() {
    for (name, triangles, size) in soups() {
        let filtered = |i: u32| i % 2 == 1;
        let bvh = Bvh::new(&triangles, &filtered);
        let accept = |hit: &Hit| hit.u > 0.4;
        let mut rng = Rng::new(4);
        for i in 0..1500 {
            let ray = unkind_ray(&mut rng, &triangles, size);
            let expected = brute_force(&triangles, &ray, |hit| !filtered(hit.triangle) || accept(hit));
            let asked_solid = Cell::new(false);
            let found = bvh.closest_filtered(&ray, |hit| {
                asked_solid.set(asked_solid.get() || !filtered(hit.triangle));
                accept(hit)
            });
            assert_eq!(bits(found), bits(expected), "{name}, ray {i}: {ray:?}");
            assert_eq!(bvh.occluded_filtered(&ray, accept), expected.is_some(), "{name}, ray {i}");
            assert!(!asked_solid.get(), "{name}: the filter was asked about a solid triangle");
        }
    }
}

#[test]
fn hits_are_accurate() {
    let mut rng = Rng::new(5);
    let triangles = random_triangles(&mut rng, 300, 1.0, 1.0);
    let bvh = solid(&triangles);
    for _ in 0..3000 {
        let ray = Ray::new(point(&mut rng, 1.5), direction(&mut rng));
        let Some(hit) = bvh.closest(&ray) else { continue };
        let [a, b, c] = triangles[hit.triangle as usize].map(|p| p.as_dvec3());
        let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let normal = (b - a).cross(c - a);
        let t = (a - o).dot(normal) / d.dot(normal);
        let slope = d.dot(normal).abs() / normal.length();
        assert!((f64::from(hit.t) - t).abs() < 2e-6 / slope, "{hit:?}, exactly {t}");
        let p = a + (b - a) * f64::from(hit.u) + (c - a) * f64::from(hit.v);
        assert!((p - (o + d * t)).length() < 5e-6 / slope, "{hit:?} is at {p}");
    }
}

#[test]
fn no_ray_escapes_from_a_closed_surface() {
    let mut rng = Rng::new(6);
    let far = [(Vec3::new(1000.3, -20.7, 3.1), 5.0, 30), (Vec3::new(1e5, -3e5, 2e4), 40.0, 20)];
    let near = [(Vec3::ZERO, 1.0, 40), (Vec3::new(0.1, 0.2, 0.3), 1e-3, 30)];
    for (center, radius, n) in near.into_iter().chain(far) {
        let triangles = closed_surface(&mut rng, n, center, radius);
        let bvh = solid(&triangles);
        for i in 0..60_000 {
            let [a, b, c] = triangles[rng.below(triangles.len())];
            let target = match i % 4 {
                0 => a,
                1 => 0.5 * (a + b),
                2 => b.lerp(c, rng.next_f32()),
                _ => center + direction(&mut rng),
            };
            let origin = center + point(&mut rng, 0.3 * radius);
            let ray = Ray::new(origin, target - origin);
            assert!(bvh.closest(&ray).is_some(), "escaped: {ray:?}");
            assert!(bvh.occluded(&ray), "escaped: {ray:?}");
        }
    }
}

#[test]
fn no_ray_escapes_from_a_room_of_large_walls() {
    let mut rng = Rng::new(7);
    let max = Vec3::new(6.1, 5.3, 2.7);
    let bvh = solid(&cuboid(Vec3::ZERO, max));
    for i in 0..100_000 {
        let mut origin = Vec3::new(rng.range(0.0, max.x), rng.range(0.0, max.y), rng.range(0.0, max.z));
        if i % 2 == 0 {
            origin = origin.max(Vec3::splat(1e-4)).min(Vec3::splat(2e-4));
        }
        let on = |rng: &mut Rng, max: f32| [0.0, max, rng.range(0.0, max)][rng.below(3)];
        let target = Vec3::new(on(&mut rng, max.x), on(&mut rng, max.y), [0.0, max.z][rng.below(2)]);
        let ray = Ray::new(origin, target - origin);
        assert!(bvh.closest(&ray).is_some(), "escaped: {ray:?}");
    }
}

#[test]
fn rays_in_the_plane_of_a_wall_pass_it_and_hit_what_stands_across() {
    let triangles = cuboid(Vec3::ZERO, Vec3::new(4.0, 3.0, 2.0));
    let bvh = solid(&triangles);
    for zero in [0.0, -0.0] {
        // In the wall y = 0, toward the wall x = 4, whose edge belongs to it.
        let ray = Ray::new(Vec3::new(1.0, 0.0, 0.5), Vec3::new(1.0, zero, zero));
        let hit = bvh.closest(&ray).expect("the wall across");
        assert_eq!(hit.t, 3.0);
        assert!(triangles[hit.triangle as usize].iter().all(|p| p.x == 4.0));
        assert!(!bvh.occluded(&Ray { t_max: 3.0, ..ray }));
        assert!(bvh.occluded(&Ray { t_max: 3.1, ..ray }));
    }
}

#[test]
fn the_ends_of_the_range_are_excluded() {
    let floor = [[Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::new(0.0, 2.0, 0.0)]];
    let bvh = solid(&floor);
    let down = |t_min: f32, t_max: f32| bvh.closest(&Ray { origin: Vec3::Z, direction: Vec3::NEG_Z, t_min, t_max }).map(|hit| hit.t);
    assert_eq!(down(0.0, f32::INFINITY), Some(1.0));
    assert_eq!(down(0.0, 1.0), None);
    assert_eq!(down(0.0, 1.0f32.next_up()), Some(1.0));
    assert_eq!(down(1.0, 2.0), None);
    assert_eq!(down(1.0f32.next_down(), 2.0), Some(1.0));
    assert_eq!(down(2.0, 1.0), None);
    let behind = Ray { origin: Vec3::NEG_Z, direction: Vec3::NEG_Z, t_min: -2.0, t_max: 0.0 };
    assert_eq!(bvh.closest(&behind).map(|hit| hit.t), Some(-1.0));
}

#[test]
fn distances_do_not_depend_on_the_order_of_the_triangles() {
    for (name, triangles, size) in soups() {
        let mut rng = Rng::new(8);
        let mut shuffled: Vec<usize> = (0..triangles.len()).collect();
        for i in (1..shuffled.len()).rev() {
            shuffled.swap(i, rng.below(i + 1));
        }
        let permuted: Vec<Triangle> = shuffled.iter().map(|&i| triangles[i]).collect();
        let (one, other) = (solid(&triangles), solid(&permuted));
        for i in 0..2000 {
            let ray = unkind_ray(&mut rng, &triangles, size);
            let (a, b) = (one.closest(&ray), other.closest(&ray));
            assert_eq!(a.map(|h| h.t), b.map(|h| h.t), "{name}, ray {i}: {ray:?}");
        }
    }
}

#[test]
fn of_equal_triangles_the_first_is_hit() {
    let stack = vec![[Vec3::ZERO, Vec3::X, Vec3::Y]; 1000];
    let bvh = Bvh::new(&stack, &|i| i < 500);
    let ray = Ray::new(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z);
    assert_eq!(bvh.closest(&ray).map(|hit| hit.triangle), Some(0));
    assert_eq!(bvh.closest_filtered(&ray, |_| false).map(|hit| hit.triangle), Some(500));
    assert_eq!(bvh.closest_filtered(&ray, |hit| hit.triangle >= 77).map(|hit| hit.triangle), Some(77));
}

#[test]
fn nothing_is_hit_where_there_is_nothing() {
    let mut rng = Rng::new(9);
    let line = [Vec3::ZERO, Vec3::X, 2.0 * Vec3::X];
    let dot = [Vec3::ONE; 3];
    let broken = [Vec3::ZERO, Vec3::X, Vec3::new(0.0, f32::NAN, 1.0)];
    let endless = [Vec3::ZERO, Vec3::X, Vec3::new(0.0, f32::INFINITY, 0.0)];
    for triangles in [vec![], vec![line], vec![dot; 20], vec![line, dot, broken, endless]] {
        let bvh = solid(&triangles);
        assert!(bvh.bounds().is_empty());
        assert_eq!(bvh.triangle_count(), triangles.len());
        for _ in 0..100 {
            let ray = Ray::new(point(&mut rng, 2.0), direction(&mut rng));
            assert_eq!(bvh.closest(&ray), None);
            assert!(!bvh.occluded(&ray));
        }
    }
    let bvh = solid(&[line, [Vec3::ZERO, Vec3::X, Vec3::Y], dot]);
    let hit = bvh.closest(&Ray::new(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z)).unwrap();
    assert_eq!((hit.triangle, bvh.bounds().max), (1, Vec3::new(1.0, 1.0, 0.0)));
}

#[test]
fn rays_that_are_no_rays_hit_nothing() {
    let bvh = solid(&room(&mut Rng::new(10)));
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(bvh.closest(&Ray::new(Vec3::splat(bad), Vec3::X)), None);
        assert_eq!(bvh.closest(&Ray::new(Vec3::ONE, Vec3::splat(bad))), None);
        assert_eq!(bvh.closest(&Ray::new(Vec3::ONE, Vec3::new(1.0, bad, 0.0))), None);
    }
    assert_eq!(bvh.closest(&Ray::new(Vec3::ONE, Vec3::ZERO)), None);
    assert_eq!(bvh.closest(&Ray { t_max: f32::NAN, ..Ray::new(Vec3::ONE, Vec3::X) }), None);
}

#[test]
fn size_and_place_of_the_scene_do_not_matter() {
    let mut rng = Rng::new(11);
    let triangles = random_triangles(&mut rng, 300, 1.0, 0.5);
    for scale in [1e-12f32, 1e-6, 1e4, 1e9, 1e17] {
        let scaled: Vec<Triangle> = triangles.iter().map(|t| t.map(|p| p * scale)).collect();
        let bvh = solid(&scaled);
        let mut hits = 0;
        for i in 0..1000 {
            let ray = Ray::new(point(&mut rng, 1.5) * scale, direction(&mut rng));
            let expected = brute_force(&scaled, &ray, |_| true);
            assert_eq!(bits(bvh.closest(&ray)), bits(expected), "scale {scale}, ray {i}: {ray:?}");
            hits += usize::from(expected.is_some());
        }
        assert!(hits > 300, "scale {scale}: {hits} hits");
    }
    // Beyond the range in which areas are finite: no panic, whatever is hit.
    let huge: Vec<Triangle> = triangles.iter().map(|t| t.map(|p| p * 1e38)).collect();
    solid(&huge).closest(&Ray::new(Vec3::ZERO, Vec3::X));
}
