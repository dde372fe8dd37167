//! Materials that are divided by class, and their textures.

use crate::{first, room, seeds, varied};
use enfilade_dataset::{Variation, VariedMaterial};
use enfilade_math::Rgb;
use enfilade_scene::{Bsdf, ColorParam, Heard, LabelledScene};
use enfilade_vary::{MaterialVary, VaryConfig, vary};
use std::collections::{BTreeMap, BTreeSet};

fn config(textures: f64) -> VaryConfig {
    VaryConfig { materials: Some(MaterialVary { share: 1.0, textures, ..MaterialVary::default() }), ..VaryConfig::default() }
}

fn color(bsdf: &Bsdf) -> &ColorParam {
    match bsdf {
        Bsdf::Diffuse { reflectance } | Bsdf::RoughDiffuse { reflectance, .. } => reflectance,
        Bsdf::Plastic { diffuse, .. } => diffuse,
        Bsdf::Principled(principled) => &principled.base_color,
        other => panic!("no body: {other:?}"),
    }
}

/// Mean reflectance, and the share of texels that reflect more than 0.91 in a channel.
fn reflectance(scene: &LabelledScene, param: &ColorParam) -> (Rgb, f64) {
    let Some(texture) = param.texture else { return (param.factor, 0.0) };
    let image = &scene.scene.images[texture.image as usize];
    let (width, height) = (image.width as usize, image.height as usize);
    let texels: Vec<Rgb> = (0..width * height).map(|i| image.texel(i % width, i / width).0 * param.factor).collect();
    let bright = texels.iter().filter(|texel| texel.max_component() > 0.91).count();
    (texels.iter().copied().sum::<Rgb>() / texels.len() as f32, bright as f64 / texels.len() as f64)
}

#[test]
fn a_ceiling_that_shares_the_paint_of_the_walls_stays_white_whatever_colour_they_get() {
    let scene = room::room();
    let mut coloured = 0;
    for number in 1..60 {
        let (varied, record) = varied(&scene, &config(0.0), number);
        let [wall, ceiling] = ["wall_west", "ceiling"].map(|part| color(&room::material(&varied, part).bsdf).factor);
        assert!(ceiling.r.min(ceiling.g).min(ceiling.b) > 0.66 && ceiling.max_component() < 0.9, "{ceiling:?}");
        assert_eq!(room::material(&varied, "wall_west"), room::material(&varied, "wall_south_right"));
        coloured += usize::from(wall.max_component() < 0.6);
        // The cup keeps the paint.
        assert_eq!(room::material(&varied, "cup_1/body"), &scene.scene.materials[0]);
        let of_paint: Vec<_> = record.materials.iter().filter(|m| m.of.as_deref() == Some("paint")).map(|m| m.name.as_str()).collect();
        assert_eq!(of_paint, ["paint wall", "paint ceiling"]);
    }
    assert!(coloured > 5, "{coloured}");
}

#[test]
fn furniture_of_one_wood_stays_of_one_wood() {
    let scene = room::room();
    for number in 1..6 {
        let (varied, _) = varied(&scene, &config(0.5), number);
        let parts = ["table_1/top", "chair_1/seat", "shelf_1/board"].map(|part| room::material(&varied, part));
        assert!(parts.iter().all(|material| *material == parts[0]) && parts[0].name == "oak table", "{:?}", parts[0].name);
        assert_eq!(room::material(&varied, "book_2/body"), room::material(&scene, "book_2/body"));
    }
}

#[test]
fn textures_are_those_of_the_class_lie_in_metres_and_reflect_what_the_record_says() {
    let scene = room::room();
    let mut found: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for number in 1..12 {
        let (varied, record) = varied(&scene, &config(1.0), number);
        assert!(record.keeps_geometry);
        for VariedMaterial { name, class, to, texture, .. } in &record.materials {
            let texture = texture.clone().unwrap_or_else(|| panic!("{name} has none"));
            found.entry(class.clone()).or_default().insert(texture.clone());
            let material = varied.scene.materials.iter().find(|material| material.name == *name).unwrap();
            let (mean, bright) = reflectance(&varied, color(&material.bsdf));
            assert!((0..3).all(|c| (mean[c] - to[c]).abs() < 0.02), "{name}, {texture}: {mean:?} {to:?}");
            assert!(bright < 0.02 && mean.max_component() <= 0.9, "{name}, {texture}: {mean:?}, {bright}");
            assert!(material.emission.factor.is_black());
        }
        // The triangles are where they were, in their order.
        for (part, before) in varied.scene.parts.iter().zip(&scene.scene.parts) {
            let count = scene.scene.meshes[before.mesh as usize].triangles.len();
            assert_eq!(varied.scene.meshes[part.mesh as usize].triangles.len(), count);
            assert!((0..count).all(|t| varied.scene.world_corners(part, t) == scene.scene.world_corners(before, t)), "{}", part.name);
        }
        assert_eq!(varied.scene.materials[room::STEEL], scene.scene.materials[room::STEEL]);
        assert!(varied.scene.parts.iter().all(|part| (part.mesh as usize) < varied.scene.meshes.len()));
    }
    let of = |class: &str| found[class].iter().map(String::as_str).collect::<Vec<_>>();
    let floors = ["carpet", "concrete", "herringbone parquet", "planks", "terrazzo", "tiles"];
    assert!(found["floor"].len() > 2 && of("floor").iter().all(|texture| floors.contains(texture)), "{found:?}");
    assert!(of("sofa").iter().all(|texture| ["boucle", "leather", "upholstery", "velvet"].contains(texture)), "{found:?}");
    assert_eq!(of("table"), ["veneer"]);
    assert!(!found.contains_key("books") && !found.contains_key("otherprop"));
}

#[test]
fn a_share_of_zero_changes_colours_alone() {
    let scene = room::room();
    for number in 1..20 {
        let (varied, record) = varied(&scene, &config(0.0), number);
        assert!(record.materials.iter().all(|material| material.texture.is_none()));
        assert_eq!((varied.scene.meshes, varied.scene.images.len()), (scene.scene.meshes.clone(), 0));
    }
}

#[test]
fn walls_and_ceiling_in_one_part_stay_white_and_that_is_said() {
    let mut scene = room::room();
    // The class of the ceiling is that of the walls, as where both are one mesh.
    let ceiling = scene.scene.parts.iter().position(|part| part.name == "ceiling").unwrap();
    scene.labels.parts[ceiling].semantic = 1;
    for number in 1..30 {
        let (varied, _) = varied(&scene, &config(0.0), number);
        let wall = color(&room::material(&varied, "wall_west").bsdf).factor;
        assert!(wall.r.min(wall.g).min(wall.b) > 0.66, "{wall:?}");
    }
    let heard = Heard::default();
    let mut record = Variation::new("room", 1, [0; 3]);
    vary(&first(&scene), &config(0.0), &seeds(1), &mut record, &heard).unwrap();
    assert!(heard.lines().iter().any(|line| line.contains("walls and ceiling are one part of it")), "{:?}", heard.lines());
}
