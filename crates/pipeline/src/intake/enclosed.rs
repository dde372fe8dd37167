//! Lights without a surface whose light leads nowhere: lamps within an opaque thing, and lamps and suns behind solid glass whose normals are
//! perturbed, through which the renderer cannot aim at them. No sampled direction meets such a light, so it would be black without a word.

use super::remarks::and_more;
use super::seen::Look;
use enfilade_dataset::counted;
use enfilade_math::{Ray, Vec3, warp};
use enfilade_scene::{Alpha, Bsdf, Light, Material, PartId, Scene};

/// Directions that are tried around a lamp.
const DIRECTIONS: usize = 96;
/// The share of them that must end so.
const SHARE: f64 = 0.9;
/// Faces of a part that are asked whether the sun reaches them, and the share of them that makes the part sunlit.
const FACES: usize = 32;
const SUNLIT: f64 = 0.2;
/// An enclosure of a lamp is nearer than this, metres; the walls of its room are farther away.
const NEAR_M: f32 = 0.4;
/// Below this GGX roughness glass is smooth.
const SMOOTH: f32 = 1e-3;
/// Number of names listed in place of all.
const NAMED: usize = 3;

/// The part that keeps light in, and why.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Keeper {
    Opaque(PartId),
    Bumped(PartId),
}

/// Remarks on enclosed lamps, one sentence for each kind of enclosure.
pub(super) fn lamps(scene: &Scene, look: &Look) -> Vec<String> {
    let kept: Vec<(&str, Keeper)> = scene.lights.iter().filter_map(|light| Some((light.name(), keeper(scene, look, light)?))).collect();
    let opaque = kept.iter().filter_map(|(name, by)| if let Keeper::Opaque(part) = by { Some((*name, *part)) } else { None });
    let bumped = kept.iter().filter_map(|(name, by)| if let Keeper::Bumped(part) = by { Some((*name, *part)) } else { None });
    let ways = [
        (
            opaque.collect::<Vec<_>>(),
            "inside of an opaque part, which no light leaves; if that is glass, panes = [\"its name\"] (or --panes) makes it clear, else take it \
             away",
        ),
        (
            bumped.collect(),
            "behind solid glass with a normal or bump map, through which lights without a surface are not found; make the glass thin (without a \
             volume), leave out the map, or make an emissive surface of the lamp",
        ),
    ];
    let told = |(found, text): (Vec<(&str, PartId)>, &str)| {
        let names: Vec<String> =
            found.iter().take(NAMED).map(|(lamp, part)| format!("{lamp:?} in {:?}", scene.parts[*part as usize].name)).collect();
        let verb = if found.len() == 1 { "is" } else { "are" };
        let text = format!("{} ({}{}) {verb} {text}", counted(found.len(), "lamp"), names.join(", "), and_more(found.len()));
        (!found.is_empty()).then_some(text)
    };
    ways.into_iter().filter_map(told).chain(suns(scene, look)).collect()
}

/// Says which suns shine on glass that they are not found through.
fn suns(scene: &Scene, look: &Look) -> Option<String> {
    let bumped = |part: &usize| is_bumped_body(&scene.materials[scene.parts[*part].material as usize]);
    let parts: Vec<usize> = (0..scene.parts.len()).filter(bumped).collect();
    let suns: Vec<Vec3> = (scene.lights.iter())
        .filter_map(|light| match light {
            Light::Directional { direction, angular_radius_rad, .. } if *angular_radius_rad <= 0.0 => Some(-*direction),
            _ => None,
        })
        .collect();
    if parts.is_empty() || suns.is_empty() {
        return None;
    }
    let mut faces = vec![Vec::new(); scene.parts.len()];
    for (corners, source) in look.world.corners.iter().zip(&look.world.sources) {
        faces[source.part as usize].push((corners[0] + corners[1] + corners[2]) / 3.0);
    }
    let is_sunlit = |part: usize| {
        let asked: Vec<Vec3> = faces[part].iter().step_by(faces[part].len().div_ceil(FACES).max(1)).copied().collect();
        let own = |triangle: u32| look.world.sources[triangle as usize].part as usize == part;
        let lit = |p: &&Vec3| suns.iter().any(|&to_sun| !look.bvh.occluded_filtered(&Ray::new(**p, to_sun), |hit| !own(hit.triangle)));
        asked.iter().filter(lit).count() as f64 >= SUNLIT * asked.len().max(1) as f64
    };
    let lit: Vec<usize> = parts.into_iter().filter(|&part| is_sunlit(part)).collect();
    let names: Vec<String> = lit.iter().take(NAMED).map(|&part| format!("{:?}", scene.parts[part].name)).collect();
    (!lit.is_empty()).then(|| {
        format!(
            "behind {} of solid glass with a normal or bump map ({}{}) the light of a sun without a disk is not found; make the glass thin \
             (without a volume), leave out the map, or light the scene by environment = \"sky\" (or --environment sky), whose sun has a disk",
            counted(lit.len(), "part"),
            names.join(", "),
            and_more(lit.len())
        )
    })
}

/// The part at which almost all of a lamp's light ends, if it is one part.
fn keeper(scene: &Scene, look: &Look, light: &Light) -> Option<Keeper> {
    let (position, axis, cosine) = match light {
        Light::Point { position, .. } | Light::Profile { position, .. } => (*position, Vec3::Z, -1.0),
        Light::Spot { position, direction, outer_rad, .. } => (*position, *direction, outer_rad.cos()),
        Light::Directional { .. } => return None,
    };
    let directions = (0..DIRECTIONS).map(|k| warp::fibonacci_sphere(k, DIRECTIONS).as_vec3()).filter(|d| d.dot(axis) >= cosine);
    let met: Vec<Option<Keeper>> = directions.map(|direction| met(scene, look, Ray::new(position, direction))).collect();
    let first = met.iter().flatten().next()?;
    let same = met.iter().filter(|one| one.as_ref() == Some(first)).count();
    (same as f64 >= SHARE * met.len() as f64).then_some(*first)
}

/// The part nearby at which a ray from a lamp ends.
fn met(scene: &Scene, look: &Look, ray: Ray) -> Option<Keeper> {
    let hit = look.bvh.closest(&Ray { t_max: NEAR_M, ..ray })?;
    let part = look.world.sources[hit.triangle as usize].part;
    let material = &scene.materials[scene.parts[part as usize].material as usize];
    if is_bumped_body(material) {
        return Some(Keeper::Bumped(part));
    }
    is_opaque(material).then_some(Keeper::Opaque(part))
}

fn is_opaque(material: &Material) -> bool {
    material.alpha == Alpha::Opaque && !material.bsdf.transmits() && material.emission.factor.is_black()
}

fn is_bumped_body(material: &Material) -> bool {
    is_smooth_body(&material.bsdf) && material.normal_map.is_some()
}

fn is_smooth_body(bsdf: &Bsdf) -> bool {
    match bsdf {
        Bsdf::Dielectric { alpha, .. } => alpha.factor < SMOOTH,
        Bsdf::Principled(p) => p.solid && p.transmission.factor > 0.0 && p.roughness.factor * p.roughness.factor < SMOOTH,
        Bsdf::Blend { first, second, .. } => is_smooth_body(first) || is_smooth_body(second),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_geometry::Mesh;
    use enfilade_math::{DAffine3, Rgb};
    use enfilade_scene::{Image, NormalMap, Part, Pixels, TextureRef};

    /// The remarks about a lamp in the middle of a globe and a sun above it.
    fn told(bsdf: Bsdf, bumped: bool) -> Vec<String> {
        let positions = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z].map(|corner| corner * 0.2).to_vec();
        let triangles = vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
        let normal_map = bumped.then(|| NormalMap::Normal { texture: TextureRef::new(0), scale: 1.0 });
        let scene = Scene {
            meshes: vec![Mesh { positions, triangles, ..Mesh::default() }.into()],
            images: vec![Image { name: "waves".into(), width: 1, height: 1, pixels: Pixels::RgbF32(vec![[0.5, 0.5, 1.0]]) }.into()],
            materials: vec![Material { normal_map, ..Material::new("globe", bsdf) }],
            parts: vec![Part { name: "globe".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY }],
            lights: vec![
                Light::Point { name: "bulb".into(), position: Vec3::ZERO, intensity: Rgb::WHITE },
                Light::Directional { name: "sun".into(), direction: Vec3::NEG_Z, irradiance: Rgb::WHITE, angular_radius_rad: 0.0 },
            ],
            ..Scene::default()
        };
        lamps(&scene, &Look::at(&scene))
    }

    #[test]
    fn lights_that_are_not_found_are_told_and_others_are_not() {
        let glass = || Bsdf::Dielectric { eta: 1.5, alpha: 0.0.into(), transmittance: Rgb::WHITE.into(), absorption: Rgb::BLACK };
        assert_eq!(told(glass(), false), Vec::<String>::new());
        assert_eq!(told(Bsdf::ThinDielectric { eta: 1.5, transmittance: Rgb::WHITE.into() }, true), Vec::<String>::new());
        let bumped = told(glass(), true);
        assert!(bumped[0].starts_with("1 lamp (\"bulb\" in \"globe\") is behind solid glass with a normal or bump map"), "{bumped:?}");
        assert!(
            bumped[1].starts_with("behind 1 part of solid glass with a normal or bump map (\"globe\")") && bumped.len() == 2,
            "{bumped:?}"
        );
        let opaque = told(Bsdf::Diffuse { reflectance: Rgb::WHITE.into() }, false);
        assert!(opaque[0].starts_with("1 lamp (\"bulb\" in \"globe\") is inside of an opaque part") && opaque.len() == 1, "{opaque:?}");
    }
}
