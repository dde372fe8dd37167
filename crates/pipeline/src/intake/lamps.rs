//! `lamps = "ceiling"`: plausible lamps for interiors that have none.

use super::seen::Look;
use enfilade_dataset::counted;
use enfilade_explore::LampPlace;
use enfilade_geometry::Mesh;
use enfilade_import::ImportedLabel;
use enfilade_math::{DAffine3, DVec3, Rgb, Vec3};
use enfilade_scene::{Material, Object, Part, PartLabel, Scene};
use std::f64::consts::PI;

/// Light of a lamp for every square metre of ceiling, kilo-lumens: some 120 lux on the floor of a light room.
const KLM_PER_M2: f64 = 0.25;
/// White of a warm fluorescent or LED panel, about 4000 K, with a luminance of 1.
const WHITE: Rgb = Rgb::new(1.19, 0.97, 0.75);
/// Thickness of a lamp and its distance to the ceiling, metres; the width of its frame is the thickness.
const THICK_M: f32 = 0.04;
const BELOW_M: f32 = 0.01;
/// Reflectance of the frame.
const FRAME: Rgb = Rgb::splat(0.8);
/// NYU40's number of lamps.
const LAMP: i16 = 35;

/// Hangs lamps from every ceiling and returns a remark on how many. If the file has labels, the lamps are labelled too.
pub(crate) fn hang(scene: &mut Scene, labels: Option<&mut Vec<ImportedLabel>>, look: &Look) -> String {
    let ceilings = &look.findings.ceilings;
    let lamps: Vec<LampPlace> = ceilings.iter().flat_map(|ceiling| ceiling.lamps(&look.bvh)).collect();
    if lamps.is_empty() {
        return "no ceiling was found to hang lamps from (lamps = \"ceiling\"); check unit and upward axis, or light it by \
                environment = \"overcast\""
            .into();
    }
    let first = scene.parts.len() as u32;
    let frame = push(&mut scene.materials, Material::diffuse("ceiling_lamp_frame", FRAME));
    for (i, lamp) in lamps.iter().enumerate() {
        add(scene, i + 1, lamp, frame);
    }
    if let Some(labels) = labels {
        let next = labels.iter().map(|label| label.label.instance).max().unwrap_or(0).max(0) + 1;
        let instance = |k: usize| next.saturating_add((k / 2) as i16);
        let label = |(k, part)| ImportedLabel { part, label: PartLabel { semantic: LAMP, instance: instance(k) } };
        labels.extend((first..scene.parts.len() as u32).enumerate().map(label));
    }
    format!(
        "{} of {:.2} m and less were hung from the {} (lamps = \"ceiling\"), {KLM_PER_M2} klm for every m2; they are no part of the file",
        counted(lamps.len(), "lamp"),
        lamps.iter().map(|lamp| lamp.side_m).fold(0.0, f32::max),
        if ceilings.len() == 1 { "ceiling of a room".into() } else { format!("{} ceilings of its rooms", ceilings.len()) }
    )
}

/// Adds a lamp as two parts: the panel that shines downward, and the box around and above it.
fn add(scene: &mut Scene, number: usize, lamp: &LampPlace, frame: u32) {
    let side_m = lamp.side_m - 2.0 * THICK_M.min(0.1 * lamp.side_m);
    let radiance = KLM_PER_M2 * lamp.area_m2 / (PI * f64::from(side_m).powi(2));
    let light = push(&mut scene.materials, Material::emitter(format!("ceiling_lamp_{number}"), WHITE * radiance as f32));
    let world_from_mesh = DAffine3::from_translation(lamp.top.as_dvec3() - DVec3::Z * f64::from(BELOW_M));
    let panel = push(&mut scene.meshes, panel(side_m).into());
    let rest = push(&mut scene.meshes, housing(lamp.side_m).into());
    let name = unused(scene, &format!("ceiling_lamp_{number}"));
    let object = Some(push(&mut scene.objects, Object { name: name.clone(), parent: None }));
    scene.parts.push(Part { name, object, mesh: panel, material: light, world_from_mesh });
    scene.parts.push(Part {
        name: unused(scene, &format!("ceiling_lamp_{number}_frame")),
        object,
        mesh: rest,
        material: frame,
        world_from_mesh,
    });
}

fn push<T>(list: &mut Vec<T>, item: T) -> u32 {
    list.push(item);
    list.len() as u32 - 1
}

/// The name, or one after it that no part has.
fn unused(scene: &Scene, name: &str) -> String {
    let is_free = |name: &String| scene.parts.iter().all(|part| part.name != *name);
    std::iter::once(name.to_string()).chain((2..).map(|i| format!("{name}_{i}"))).find(is_free).unwrap_or_default()
}

/// A square that faces downward, a millimetre below the housing.
fn panel(side_m: f32) -> Mesh {
    let (half, z) = (0.5 * side_m, -THICK_M - 1e-3);
    let positions = [[-half, -half], [-half, half], [half, half], [half, -half]].map(|[x, y]| Vec3::new(x, y, z)).to_vec();
    Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() }
}

/// A box whose faces look outward.
fn housing(side_m: f32) -> Mesh {
    let half = 0.5 * side_m;
    let side = |bit: bool| if bit { half } else { -half };
    let corner = |i: u8| Vec3::new(side(i & 1 > 0), side(i & 2 > 0), if i & 4 > 0 { 0.0 } else { -THICK_M });
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Mesh { positions: (0..8).map(corner).collect(), triangles, ..Mesh::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_shine_downward_and_housings_face_outward() {
        let normals = |mesh: &Mesh| {
            let normal = |t: &[u32; 3]| {
                let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
                ((b - a).cross(c - a).normalize(), (a + b + c) / 3.0)
            };
            mesh.triangles.iter().map(normal).collect::<Vec<_>>()
        };
        assert!(normals(&panel(0.5)).iter().all(|(n, _)| *n == Vec3::NEG_Z));
        let middle = Vec3::Z * (-0.5 * THICK_M);
        assert!(normals(&housing(0.5)).iter().all(|(n, at)| n.dot(*at - middle) > 0.0));
    }
}
