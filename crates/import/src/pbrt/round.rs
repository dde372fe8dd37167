//! Round shapes as surfaces of revolution about z.

use super::params::Params;
use crate::ImportError;
use enfilade_geometry::Mesh;
use enfilade_math::{Vec2, Vec3};
use std::f64::consts::TAU;

/// Sides of a full circle; an inscribed polygon of this many sides has 0.07 % less area.
const SEGMENTS: f64 = 96.0;

/// A circle of the surface: radius and height, its normal's components along both, and its texture coordinate v.
struct Ring {
    r: f64,
    z: f64,
    normal: [f64; 2],
    v: f64,
}

/// Key of round shapes, which share a mesh if their measures are equal. `None` for other shapes.
pub(super) fn measures(class: &str, params: &Params) -> Result<Option<String>, ImportError> {
    if !matches!(class, "sphere" | "disk" | "cylinder" | "cone") {
        return Ok(None);
    }
    let names = ["radius", "zmin", "zmax", "phimax", "height", "innerradius"];
    let values = names.into_iter().map(|name| params.float(name)).collect::<Result<Vec<_>, _>>()?;
    Ok(Some(format!("{class} {values:?}")))
}

/// The mesh of a sphere, disk, cylinder or cone; `None` for other shapes.
///
/// # Errors
/// When a measure is not above zero.
pub(super) fn mesh(class: &str, params: &Params) -> Result<Option<Mesh>, ImportError> {
    let phi_max = params.float_or("phimax", 360.0)?.clamp(0.0, 360.0).to_radians();
    let radius = params.float_or("radius", 1.0)?;
    if !(radius > 0.0 && phi_max > 0.0) {
        return Err(params.place.error(format!("found the radius {radius} and phimax {phi_max}, expected numbers above zero")));
    }
    let rings = match class {
        "sphere" => sphere(params, radius)?,
        "disk" => {
            let (z, inner) = (params.float_or("height", 0.0)?, params.float_or("innerradius", 0.0)?.clamp(0.0, radius));
            [(radius, 0.0), (inner, 1.0)].map(|(r, v)| Ring { r, z, normal: [0.0, 1.0], v }).into()
        }
        "cylinder" => {
            let (a, b) = (params.float_or("zmin", -1.0)?, params.float_or("zmax", 1.0)?);
            [(a.min(b), 0.0), (a.max(b), 1.0)].map(|(z, v)| Ring { r: radius, z, normal: [1.0, 0.0], v }).into()
        }
        "cone" => {
            let height = params.float_or("height", 1.0)?;
            let normal = [height, radius].map(|n| n / height.hypot(radius));
            [(radius, 0.0, 0.0), (0.0, height, 1.0)].map(|(r, z, v)| Ring { r, z, normal, v }).into()
        }
        _ => return Ok(None),
    };
    Ok(Some(revolved(&rings, phi_max)))
}

/// Rings from `zmin` up to `zmax`.
fn sphere(params: &Params, radius: f64) -> Result<Vec<Ring>, ImportError> {
    let bound = |name: &str, default: f64| Ok::<f64, ImportError>((params.float_or(name, default)? / radius).clamp(-1.0, 1.0));
    let (a, b) = (bound("zmin", -radius)?, bound("zmax", radius)?);
    let (bottom, top) = (a.min(b).acos(), a.max(b).acos());
    let bands = ((bottom - top) * SEGMENTS / TAU).ceil().max(1.0) as u32;
    let ring = |i: u32| {
        let v = f64::from(i) / f64::from(bands);
        let theta = bottom + (top - bottom) * v;
        // The poles are points.
        let sin = if (1e-12..=0.5 * TAU - 1e-12).contains(&theta) { theta.sin() } else { 0.0 };
        Ring { r: radius * sin, z: radius * theta.cos(), normal: [sin, theta.cos()], v }
    };
    Ok((0..=bands).map(ring).collect())
}

/// Rings joined all around, or up to `phi_max`; the front is where the next ring is to the left of the azimuth's direction.
fn revolved(rings: &[Ring], phi_max: f64) -> Mesh {
    let segments = (phi_max * SEGMENTS / TAU).ceil().max(3.0) as u32;
    let mut mesh = Mesh::default();
    for ring in rings {
        for i in 0..=segments {
            let u = f64::from(i) / f64::from(segments);
            let (sin, cos) = (u * phi_max).sin_cos();
            mesh.positions.push(Vec3::new((ring.r * cos) as f32, (ring.r * sin) as f32, ring.z as f32));
            mesh.normals.push(Vec3::new((ring.normal[0] * cos) as f32, (ring.normal[0] * sin) as f32, ring.normal[1] as f32));
            mesh.uvs.push(Vec2::new(u as f32, ring.v as f32));
        }
    }
    for (j, pair) in rings.windows(2).enumerate() {
        for i in 0..segments {
            let a = j as u32 * (segments + 1) + i;
            let (b, c, d) = (a + 1, a + segments + 2, a + segments + 1);
            // At a point one of both triangles has no area.
            if pair[0].r > 0.0 {
                mesh.triangles.push([a, b, c]);
            }
            if pair[1].r > 0.0 {
                mesh.triangles.push([a, c, d]);
            }
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pbrt::params::Place;
    use crate::pbrt::tokens::Tokens;
    use std::f64::consts::PI;
    use std::path::{Path, PathBuf};
    use std::rc::Rc;

    fn params(text: &str) -> Params {
        let mut tokens = Tokens::new(text, Path::new("a.pbrt"));
        let place = Place { file: Rc::new(PathBuf::from("a.pbrt")), line: 1, column: 1, what: "Shape".into() };
        Params::read(&mut tokens, place).unwrap()
    }

    #[test]
    fn shapes_have_their_area_and_face_along_their_normals() {
        let cases = [
            ("sphere", "\"float radius\" 2", 16.0 * PI),
            ("sphere", "\"float zmin\" 0 \"float phimax\" 180", PI),
            ("disk", "\"float radius\" 2 \"float innerradius\" 1 \"float height\" 3", 3.0 * PI),
            ("cylinder", "\"float zmin\" 0 \"float zmax\" 3 \"float phimax\" 90", 1.5 * PI),
            ("cone", "\"float height\" [1]", PI * 2f64.sqrt()),
        ];
        for (class, text, area) in cases {
            let mesh = mesh(class, &params(text)).unwrap().unwrap();
            assert_eq!(mesh.validate(), Ok(()), "{class}");
            let mut sum = 0.0;
            for t in 0..mesh.triangles.len() {
                let [a, b, c] = mesh.corners(t);
                let face = 0.5 * (b - a).cross(c - a);
                let normal: Vec3 = mesh.triangles[t].iter().map(|&i| mesh.normals[i as usize]).sum();
                assert!(face.dot(normal) > 0.0, "{class} triangle {t}");
                sum += f64::from(face.length());
            }
            assert!((sum / area - 1.0).abs() < 2e-3, "{class} {text}: {sum} instead of {area}");
        }
        assert!(mesh("sphere", &params("\"float radius\" 0")).unwrap_err().to_string().contains("found the radius 0"));
    }
}
