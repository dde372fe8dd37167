//! Laws that tie distance, position, normals, calibration and pose together.

use super::law::Law;
use super::rounding::beyond;
use super::scan::Scan;
use enfilade_frame::vector;
use enfilade_frame::{Layer, Values};
use enfilade_math::DVec3;
use enfilade_math::quantile;

/// Least number of lines for a statement about flatness.
const FLATNESS_LINES: usize = 100;
/// Three points are on a line if the sine of the angle between their steps is less than this: more than the error of float32, and so small
/// that points of three planes hardly ever satisfy it.
const STRAIGHT: f64 = 1e-3;
/// Normals that differ by less than this are of one plane.
const SAME_NORMAL: f64 = 1e-6;
/// Guards divisions by a distance of zero.
const TINY: f64 = 1e-6;

const NORMALS: [Layer; 4] = [Layer::NormalWorld, Layer::NormalCam, Layer::NormalBumpWorld, Layer::NormalBumpCam];

pub(super) fn check(scan: &mut Scan<'_>) {
    let seen = scan.seen();
    entities(scan, &seen);
    finite_where_seen(scan);
    tex_coord(scan);
    distances(scan, &seen);
    projection(scan, &seen);
    normals(scan, &seen);
    flatness(scan, &seen);
}

fn entities(scan: &mut Scan<'_>, seen: &[usize]) {
    let Some(ids) = scan.layer(Layer::RenderEntityId) else { return };
    scan.observe_at(Law::SeesScene, if seen.is_empty() { 1.0 } else { 0.0 }, 0, "every pixel is void");
    let entities = scan.view.entities as f64;
    let strange = (0..ids.len()).filter(|&i| ids.get(i) != -1.0 && !(1.0..=entities).contains(&ids.get(i)));
    scan.broken(Law::EntityIds, &format!("the scene has parts 1 to {entities}"), strange);
}

fn finite_where_seen(scan: &mut Scan<'_>) {
    let Some(ids) = scan.layer(Layer::RenderEntityId) else { return };
    for layer in [Layer::DepthMeters, Layer::DepthZMeters, Layer::Position].into_iter().chain(NORMALS) {
        let Some(values) = scan.layer(layer) else { continue };
        let channels = layer.spec().channels;
        // Values beyond float16's largest number are infinite, which is no gap.
        let overflows = layer == Layer::Position && scan.view.rounding.position.is_some();
        let number = |v: f64| v.is_finite() || (overflows && !v.is_nan());
        let finite = |pixel: usize| (channels * pixel..channels * (pixel + 1)).all(|i| number(values.get(i)));
        let differ = (0..ids.len()).filter(|&i| finite(i) != (ids.get(i) != -1.0));
        scan.broken(Law::GeometryFinite, layer.spec().name, differ);
    }
}

fn tex_coord(scan: &mut Scan<'_>) {
    let (Some(ids), Some(values)) = (scan.layer(Layer::RenderEntityId), scan.layer(Layer::TexCoord)) else { return };
    let wrong = |&pixel: &usize| {
        let uvw = vector(values, pixel);
        !uvw.is_finite() || uvw.z != 0.0 || (ids.get(pixel) == -1.0 && uvw != DVec3::ZERO)
    };
    scan.broken(Law::TexCoord, "tex_coord", (0..ids.len()).filter(wrong));
}

fn distances(scan: &mut Scan<'_>, seen: &[usize]) {
    let Some(distance) = scan.layer(Layer::DepthMeters) else { return };
    if let Some(position) = scan.layer(Layer::Position) {
        let rounding = scan.view.rounding;
        let error = |&i: &usize| {
            let (p, stored) = (vector(position, i), distance.get(i));
            let open = rounding.of_position(p).length() + rounding.of_distance(stored);
            (i, relative((p - scan.placement(i).0).length(), stored, open))
        };
        let errors: Vec<_> = seen.iter().map(error).collect();
        scan.worst(Law::Distance, "depth_meters and position disagree", errors.into_iter());
    }
    if let Some(depth_z) = scan.layer(Layer::DepthZMeters) {
        let has_plane = scan.view.camera.camera().projection.has_image_plane();
        let error = |&i: &usize| {
            let expected = -scan.directions[i].z * distance.get(i);
            // Cameras that see to the side and behind have planar depths of 0 and less.
            let off = if has_plane { relative(depth_z.get(i), expected, 0.0) } else { (depth_z.get(i) - expected).abs() / distance.get(i) };
            (i, off)
        };
        let errors: Vec<_> = seen.iter().map(error).collect();
        scan.worst(Law::PlanarDepth, "depth_z_meters and depth_meters disagree", errors.into_iter());
    }
}

/// Error of `found` against `expected`, minus the uncertainty `open` from rounding; a distance that is not positive is infinitely wrong.
fn relative(found: f64, expected: f64, open: f64) -> f64 {
    if expected > 0.0 && found > 0.0 { beyond((found - expected).abs(), open) / expected.max(TINY) } else { f64::INFINITY }
}

fn projection(scan: &mut Scan<'_>, seen: &[usize]) {
    let Some(position) = scan.layer(Layer::Position) else { return };
    let (view, width) = (scan.view.camera, scan.frame.width as usize);
    let error = |&pixel: &usize| {
        let centre = ((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5);
        let (p_world, projection) = (vector(position, pixel), &view.camera().projection);
        let p = view.project_in_row(p_world, centre.1);
        let off = p.map_or(f64::INFINITY, |p| projection.image_distance(p, centre));
        (pixel, beyond(off, rounding_px(scan, p_world, centre)))
    };
    let errors: Vec<_> = seen.iter().map(error).collect();
    scan.worst(Law::Projection, "position projects elsewhere", errors.into_iter());
}

/// Movement of a position's image, in pixels, if each of its coordinates is off by the largest rounding error.
fn rounding_px(scan: &Scan<'_>, p_world: DVec3, centre: (f64, f64)) -> f64 {
    let (view, step) = (scan.view.camera, scan.view.rounding.of_position(p_world));
    if step == DVec3::ZERO {
        return 0.0;
    }
    let moved = |offset: DVec3| {
        let at = [p_world + offset, p_world - offset].map(|p| view.project_in_row(p, centre.1));
        match at {
            [Some(a), Some(b)] => 0.5 * view.camera().projection.image_distance(a, b),
            _ => f64::INFINITY,
        }
    };
    let sum: f64 = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| moved(axis * step)).iter().sum();
    // If the steps are not numbers, the sum is not either.
    if sum.is_nan() { f64::INFINITY } else { sum }
}

fn normals(scan: &mut Scan<'_>, seen: &[usize]) {
    for layer in NORMALS {
        let Some(values) = scan.layer(layer) else { continue };
        let error = |&i: &usize| (i, (vector(values, i).length() - 1.0).abs());
        scan.worst(Law::UnitNormals, layer.spec().name, seen.iter().map(error));
    }
    for (world, camera, facing, turned) in [
        (Layer::NormalWorld, Layer::NormalCam, Law::NormalFacing, Law::NormalCamera),
        (Layer::NormalBumpWorld, Layer::NormalBumpCam, Law::BumpFacing, Law::BumpCamera),
    ] {
        let Some(n_world) = scan.layer(world) else { continue };
        let away = |&i: &usize| (i, vector(n_world, i).dot(scan.placement(i).1 * scan.directions[i]));
        let cosines: Vec<_> = seen.iter().map(away).collect();
        scan.worst(facing, world.spec().name, cosines.into_iter());
        let Some(n_camera) = scan.layer(camera) else { continue };
        let error = |&i: &usize| (i, (scan.placement(i).1.transpose() * vector(n_world, i) - vector(n_camera, i)).abs().max_element());
        let errors: Vec<_> = seen.iter().map(error).collect();
        scan.worst(turned, camera.spec().name, errors.into_iter());
    }
}

/// Checks three neighbours in a row, of one part and with one normal, whose positions are on a straight line: the line must be in the plane
/// of that normal.
///
/// A plane shows such lines at every size of a pixel. Two neighbours would be enough if pixels were small compared to everything visible.
/// But the more of the scene a pixel covers, the more neighbours are on different planes with one normal, such as two steps of a staircase,
/// or on different facets of a smoothly shaded surface.
fn flatness(scan: &mut Scan<'_>, seen: &[usize]) {
    let (Some(ids), Some(position), Some(normal)) =
        (scan.layer(Layer::RenderEntityId), scan.layer(Layer::Position), scan.layer(Layer::NormalWorld))
    else {
        return;
    };
    let (width, height) = (scan.frame.width as usize, scan.frame.height as usize);
    let mut lines: Vec<(f64, usize)> = Vec::new();
    for &i in seen {
        let row = (i % width > 0 && i % width + 1 < width).then(|| [i - 1, i, i + 1]);
        let column = (i >= width && i / width + 1 < height).then(|| [i - width, i, i + width]);
        let of_one_part = |line: &[usize; 3]| ids.get(line[0]) == ids.get(i) && ids.get(line[2]) == ids.get(i);
        lines.extend(
            [row, column].into_iter().flatten().filter(of_one_part).filter_map(|line| Some((out_of_plane(position, normal, line)?, i))),
        );
    }
    if lines.len() < FLATNESS_LINES {
        return;
    }
    let mut values: Vec<f64> = lines.iter().map(|&(off, _)| off).collect();
    let Some(percentile) = quantile(&mut values, 0.99) else { return };
    let first = lines.iter().find(|&&(off, _)| off >= percentile).map_or(0, |&(_, i)| i);
    scan.observe_at(Law::Flatness, percentile, first, "position and normal_world disagree");
}

/// Sine of the angle between the line through three pixels' positions and their common plane; `None` if their normals differ or the
/// positions are not on a line.
fn out_of_plane(position: &Values, normal: &Values, line: [usize; 3]) -> Option<f64> {
    let [a, n, c] = line.map(|i| vector(normal, i));
    let differ = |other: DVec3| (n - other).abs().max_element() >= SAME_NORMAL;
    if differ(a) || differ(c) {
        return None;
    }
    let [p, q, r] = line.map(|i| vector(position, i));
    let (step, next) = (q - p, r - q);
    let straight = step.cross(next).length() < STRAIGHT * step.length() * next.length();
    straight.then(|| (r - p).dot(n).abs() / (r - p).length())
}
