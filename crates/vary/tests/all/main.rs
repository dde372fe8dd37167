//! Variations of a small room whose lamps, colours and things are known.

mod materials;
mod room;

use enfilade_dataset::Variation;
use enfilade_math::Rgb;
use enfilade_scene::{Bsdf, Environment, Heard, LabelledScene, Light, Quiet, to_bytes};
use enfilade_vary::{
    Classes, ClutterVary, ColorRange, First, FurnitureVary, LEAST_REFLECTANCE, LampVary, MOST_REFLECTANCE, MaterialVary, Seeds, SkyVary,
    VaryConfig, vary,
};
use std::collections::{BTreeMap, BTreeSet};

fn seeds(number: u64) -> Seeds {
    Seeds { place: 1, light: number, materials: number, arrangement: number }
}

fn everything() -> VaryConfig {
    VaryConfig {
        lamps: Some(LampVary::default()),
        sky: Some(SkyVary::default()),
        exposure: Some([-1.0, 1.0]),
        materials: Some(MaterialVary::default()),
        furniture: Some(FurnitureVary { shift_m: 0.5, ..FurnitureVary::default() }),
        clutter: Some(ClutterVary::default()),
        ..VaryConfig::default()
    }
}

fn first(scene: &LabelledScene) -> First<'_> {
    First { name: "room", scene, home: None, rooms: None, fixed: BTreeSet::new() }
}

fn varied(scene: &LabelledScene, config: &VaryConfig, number: u64) -> (LabelledScene, Variation) {
    let mut record = Variation::new("room", number as u32, [0; 3]);
    let varied = vary(&first(scene), config, &seeds(number), &mut record, &Quiet).unwrap();
    (varied.scene, record)
}

#[test]
fn a_seed_gives_the_same_bytes_and_seeds_differ() {
    let scene = room::room();
    let (a, b) = (varied(&scene, &everything(), 3), varied(&scene, &everything(), 3));
    assert_eq!(to_bytes(&a.0.scene), to_bytes(&b.0.scene));
    assert_eq!((a.0.labels, a.1), (b.0.labels, b.1));
    assert_ne!(varied(&scene, &everything(), 4).0.scene, a.0.scene);
    // A kind does not depend on which other kinds vary.
    let alone = varied(&scene, &VaryConfig { materials: Some(MaterialVary::default()), ..VaryConfig::default() }, 3);
    assert_eq!(alone.1.materials, varied(&scene, &everything(), 3).1.materials);
}

#[test]
fn no_surface_reflects_more_than_snow_or_less_than_soot() {
    let scene = room::room();
    let materials = MaterialVary { share: 1.0, textures: 0.0, ..MaterialVary::default() };
    let config = VaryConfig { materials: Some(materials), ..VaryConfig::default() };
    let mut colors = BTreeSet::new();
    for number in 1..60 {
        let (varied, record) = varied(&scene, &config, number);
        assert!(!record.materials.is_empty() && record.keeps_geometry);
        for material in &record.materials {
            assert!(material.to.iter().all(|v| (LEAST_REFLECTANCE - 1e-4..=MOST_REFLECTANCE + 1e-4).contains(v)), "{material:?}");
        }
        let paint = record.materials.iter().find(|m| m.of.as_deref() == Some("paint") && m.class == "wall").unwrap();
        assert_eq!(paint.name, "paint wall");
        colors.insert(format!("{:?}", paint.to));
        // Names and numbers stay; materials of classes that shared one come at the end.
        let names = |scene: &LabelledScene| scene.scene.materials.iter().map(|m| m.name.clone()).collect::<Vec<_>>();
        assert_eq!(names(&varied)[..6], names(&scene));
        // Metal stays as it is.
        assert_eq!(varied.scene.materials[room::STEEL], scene.scene.materials[room::STEEL]);
    }
    assert_eq!(colors.len(), 59);
}

#[test]
fn given_ranges_and_classes_count_alone() {
    let scene = room::room();
    let red = ColorRange { lightness: Some([0.6, 0.6]), chroma: Some([0.15, 0.15]), hue_deg: Some([30.0, 30.0]) };
    let classes = Classes([("sofa".to_string(), red)].into());
    let config = VaryConfig { materials: Some(MaterialVary { share: 1.0, textures: 0.0, classes }), ..VaryConfig::default() };
    let (varied, record) = varied(&scene, &config, 1);
    assert_eq!(record.materials.iter().map(|m| (m.name.as_str(), m.class.as_str())).collect::<Vec<_>>(), [("cloth sofa", "sofa")]);
    let Bsdf::Diffuse { reflectance } = &room::material(&varied, "sofa_1/body").bsdf else { panic!("a diffuse cloth") };
    assert!(reflectance.factor.r > 3.0 * reflectance.factor.b, "{reflectance:?}");
    // The book that is bound in it stays as it is.
    assert_eq!(room::material(&varied, "book_1/body"), room::material(&scene, "book_1/body"));
}

#[test]
fn classes_that_nobody_has_are_told_with_the_nearest_and_refused_where_no_other_is_named() {
    let scene = room::room();
    let config = |names: &[&str]| {
        let classes = Classes(names.iter().map(|name| (name.to_string(), ColorRange::default())).collect());
        VaryConfig { materials: Some(MaterialVary { share: 1.0, classes, ..MaterialVary::default() }), ..VaryConfig::default() }
    };
    let heard = Heard::default();
    let mut record = Variation::new("room", 1, [0; 3]);
    vary(&first(&scene), &config(&["table", "sofa", "towel"]), &seeds(1), &mut record, &heard).unwrap();
    let line = &heard.lines()[0];
    assert!(line.contains("the class \"towel\"") && line.contains("its classes: books, ceiling, chair"), "{line}");
    let error = vary(&first(&scene), &config(&["towel"]), &seeds(1), &mut record, &Quiet).err().unwrap().to_string();
    assert!(error.starts_with("scene \"room\" cannot vary: nothing in it has a material of the class \"towel\""), "{error}");
}

#[test]
fn lamps_are_switched_tinted_and_dimmed_each_by_itself() {
    let scene = room::room();
    let lamps = LampVary { lit: [0.5, 0.5], kelvin: [2700.0, 2700.0], power: [0.5, 2.0] };
    let config = VaryConfig { lamps: Some(lamps), ..VaryConfig::default() };
    let mut lit = BTreeMap::new();
    for number in 1..40 {
        let (varied, record) = varied(&scene, &config, number);
        assert_eq!(record.lamps.iter().map(|lamp| lamp.name.as_str()).collect::<Vec<_>>(), ["lamp_1", "lamp_2", "spot"]);
        for (lamp, part) in record.lamps.iter().zip(["lamp_1/bulb", "lamp_2/bulb"]) {
            let part = varied.scene.parts.iter().find(|known| known.name == part).unwrap();
            let emission = varied.scene.materials[part.material as usize].emission.factor;
            *lit.entry(lamp.name.clone()).or_insert(0) += usize::from(lamp.lit);
            if lamp.lit {
                assert!((emission.luminance() / (10.0 * lamp.power as f32) - 1.0).abs() < 1e-3, "{emission:?}");
                assert!(emission.r > 4.0 * emission.b && lamp.kelvin == 2700.0);
            } else {
                assert!(emission.is_black());
            }
        }
        let Light::Point { intensity, .. } = &varied.scene.lights[0] else { panic!("a point") };
        assert_eq!(intensity.is_black(), !record.lamps[2].lit);
        // Labels and geometry stay; the two bulbs shared a material and do no longer where they differ.
        assert_eq!((&varied.labels, varied.scene.parts.len()), (&scene.labels, scene.scene.parts.len()));
    }
    assert!(lit.values().all(|lit| (10..30).contains(lit)), "{lit:?}");
}

#[test]
fn a_dark_sky_leaves_a_lamp_lit_and_the_sun_comes_by_day() {
    let scene = room::room();
    let of = |moments: &[&str]| SkyVary { moments: serde_json::from_value(serde_json::json!(moments)).unwrap(), ..SkyVary::default() };
    let dark =
        VaryConfig { sky: Some(of(&["night"])), lamps: Some(LampVary { lit: [0.0, 0.0], ..LampVary::default() }), ..VaryConfig::default() };
    for number in 1..6 {
        let (varied, record) = varied(&scene, &dark, number);
        assert_eq!(record.sky.as_ref().unwrap().moment, "night");
        assert_eq!(record.lamps.iter().filter(|lamp| lamp.lit).count(), 1);
        assert!(varied.scene.lights.iter().all(|light| !matches!(light, Light::Directional { .. })));
        assert!(matches!(varied.scene.environment, Some(Environment::Map { .. })));
    }
    let clear = VaryConfig { sky: Some(SkyVary { cloud: [0.0, 0.0], ..of(&["day"]) }), ..VaryConfig::default() };
    let (bright, record) = varied(&scene, &clear, 2);
    assert!(record.sky.unwrap().sun_elevation_deg > 5.0);
    assert!(bright.scene.lights.iter().any(|light| matches!(light, Light::Directional { .. })));
    // The place on the globe is the room's.
    let latitude = |number| varied(&scene, &clear, number).1.sky.unwrap().latitude_deg;
    assert_eq!(latitude(5), latitude(9));
}

#[test]
fn what_changes_nothing_is_said() {
    let mut scene = room::room();
    for material in &mut scene.scene.materials {
        material.emission = Rgb::BLACK.into();
    }
    scene.scene.lights.clear();
    let heard = Heard::default();
    let mut record = Variation::new("room", 1, [0; 3]);
    let furniture = FurnitureVary { classes: vec!["bathtub".into()], ..FurnitureVary::default() };
    let config =
        VaryConfig { lamps: Some(LampVary::default()), sky: Some(SkyVary::default()), furniture: Some(furniture), ..VaryConfig::default() };
    vary(&first(&scene), &config, &seeds(1), &mut record, &heard).unwrap();
    let lines = heard.lines().join("\n");
    for expected in
        ["it has no lamps, so `lamps` of [vary] changes nothing", "leaves out evenings and nights", "of the classes bathtub in it"]
    {
        assert!(lines.contains(expected), "{expected}: {lines}");
    }
}

#[test]
fn furniture_moves_with_what_it_carries_and_cuts_nothing() {
    let scene = room::room();
    let furniture = FurnitureVary { share: 1.0, shift_m: 0.6, turn_deg: 30.0, ..FurnitureVary::default() };
    let config = VaryConfig { furniture: Some(furniture), ..VaryConfig::default() };
    let mut moved = BTreeSet::new();
    for number in 1..25 {
        let (varied, record) = varied(&scene, &config, number);
        let [table, cup] = ["table_1", "cup_1"].map(|name| record.moved.iter().find(|moved| moved.name == name));
        assert_eq!(table.is_some(), cup.is_some());
        if let (Some(table), Some(cup)) = (table, cup) {
            assert_eq!((cup.turn_deg, cup.carried_by.as_deref()), (table.turn_deg, Some("table_1")));
        }
        moved.extend(record.moved.iter().map(|thing| thing.name.clone()));
        assert_eq!(record.keeps_geometry, record.moved.is_empty());
        room::check_boxes(&varied);
        // Nothing rises or sinks.
        assert!(record.moved.iter().all(|thing| thing.shift_m[2].abs() < 1e-6));
    }
    assert!(["table_1", "chair_1", "cup_1"].iter().all(|name| moved.contains(*name)), "{moved:?}");
    assert!(!moved.contains("shelf_1"), "what hangs on the wall stays");
}

#[test]
fn small_things_come_and_go_but_nothing_floats() {
    let scene = room::room();
    let clutter =
        ClutterVary { remove: [0.5, 0.5], share: 1.0, classes: vec!["otherprop".into(), "books".into()], ..ClutterVary::default() };
    let config = VaryConfig { clutter: Some(clutter), ..VaryConfig::default() };
    let mut gone = BTreeMap::new();
    for number in 1..40 {
        let (varied, record) = varied(&scene, &config, number);
        record.removed.iter().for_each(|name| *gone.entry(name.clone()).or_insert(0) += 1);
        assert_eq!(varied.scene.parts.len() + record.removed.len(), scene.scene.parts.len());
        assert_eq!(varied.labels.parts.len(), varied.scene.parts.len());
        room::check_boxes(&varied);
        // The book under the other book stays where that one does.
        assert!(!record.removed.contains(&"book_1".to_string()) || record.removed.contains(&"book_2".to_string()));
    }
    assert!(gone["cup_1"] > 8 && gone["book_2"] > 8, "{gone:?}");
}

#[test]
fn what_is_fixed_stays() {
    let scene = room::room();
    let table = room::instance(&scene, "table_1/top");
    let config = VaryConfig { furniture: Some(FurnitureVary { share: 1.0, ..FurnitureVary::default() }), ..VaryConfig::default() };
    for number in 1..10 {
        let mut record = Variation::new("room", 1, [0; 3]);
        let first = First { fixed: BTreeSet::from([table]), ..first(&scene) };
        vary(&first, &config, &seeds(number), &mut record, &Quiet).unwrap();
        assert!(record.moved.iter().all(|thing| thing.instance != table));
    }
}
