//! Laws that tie distance, position, normals, calibration and pose together.

use super::law::Law;
use super::scan::{Scan, vector};
use crate::statistics::quantile;
use enfilade_frame::{Layer, Values};
use enfilade_math::DVec3;

/// Fewer pairs of neighbours than this say nothing about flatness.
const FLATNESS_PAIRS: usize = 1000;
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
        let finite = |pixel: usize| (channels * pixel..channels * (pixel + 1)).all(|i| values.get(i).is_finite());
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
        let unit = scan.view.meters_per_unit;
        let error = |&i: &usize| (i, relative((vector(position, i) - scan.placement(i).0).length() * unit, distance.get(i)));
        let errors: Vec<_> = seen.iter().map(error).collect();
        scan.worst(Law::Distance, "depth_meters and position disagree", errors.into_iter());
    }
    if let Some(depth_z) = scan.layer(Layer::DepthZMeters) {
        let has_plane = scan.view.camera.camera().projection.has_image_plane();
        let error = |&i: &usize| {
            let expected = -scan.directions[i].z * distance.get(i);
            // Cameras that see to the side and behind have planar depths of 0 and less.
            let off = if has_plane { relative(depth_z.get(i), expected) } else { (depth_z.get(i) - expected).abs() / distance.get(i) };
            (i, off)
        };
        let errors: Vec<_> = seen.iter().map(error).collect();
        scan.worst(Law::PlanarDepth, "depth_z_meters and depth_meters disagree", errors.into_iter());
    }
}

/// Error of `found` against `expected`; a distance that is not positive is infinitely wrong.
fn relative(found: f64, expected: f64) -> f64 {
    if expected > 0.0 && found > 0.0 { (found - expected).abs() / expected.max(TINY) } else { f64::INFINITY }
}

fn projection(scan: &mut Scan<'_>, seen: &[usize]) {
    let Some(position) = scan.layer(Layer::Position) else { return };
    let (view, width) = (scan.view.camera, scan.frame.width as usize);
    let error = |&pixel: &usize| {
        let centre = ((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5);
        let (p, projection) = (view.project_in_row(vector(position, pixel), centre.1), &view.camera().projection);
        (pixel, p.map_or(f64::INFINITY, |p| projection.image_distance(p, centre)))
    };
    scan.worst(Law::Projection, "position projects elsewhere", seen.iter().map(error));
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

/// Neighbours of one part with one normal: the step between their positions lies in the plane of that normal.
fn flatness(scan: &mut Scan<'_>, seen: &[usize]) {
    let (Some(ids), Some(position), Some(normal)) =
        (scan.layer(Layer::RenderEntityId), scan.layer(Layer::Position), scan.layer(Layer::NormalWorld))
    else {
        return;
    };
    let width = scan.frame.width as usize;
    let mut pairs: Vec<(f64, usize)> = Vec::new();
    for &i in seen {
        let left = if i % width > 0 { Some(i - 1) } else { None };
        for j in [left, i.checked_sub(width)].into_iter().flatten().filter(|&j| ids.get(j) == ids.get(i)) {
            pairs.extend(out_of_plane(position, normal, i, j).map(|off| (off, i)));
        }
    }
    if pairs.len() < FLATNESS_PAIRS {
        return;
    }
    let mut values: Vec<f64> = pairs.iter().map(|&(off, _)| off).collect();
    let Some(percentile) = quantile(&mut values, 0.99) else { return };
    let first = pairs.iter().find(|&&(off, _)| off >= percentile).map_or(0, |&(_, i)| i);
    scan.observe_at(Law::Flatness, percentile, first, "position and normal_world disagree");
}

/// Sine of the angle between the step from pixel `j` to `i` and their common plane; `None` when their normals differ.
fn out_of_plane(position: &Values, normal: &Values, i: usize, j: usize) -> Option<f64> {
    let (n, step) = (vector(normal, i), vector(position, i) - vector(position, j));
    let same = (n - vector(normal, j)).abs().max_element() < SAME_NORMAL;
    same.then(|| step.dot(n).abs() / step.length().max(1e-12))
}
