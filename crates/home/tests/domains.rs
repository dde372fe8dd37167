//! Independent variation: materials and light without layout and furniture, and the other way round.

use enfilade_home::light::Moment;
use enfilade_home::{HomeConfig, RoomKind, home};
use enfilade_math::Rgb;
use enfilade_scene::{Environment, Pixels, Scene};

fn config() -> HomeConfig {
    HomeConfig { rooms: vec![RoomKind::Living, RoomKind::Bedroom], moment: Some(Moment::Day), ..HomeConfig::of_seed(5) }
}

fn same_geometry(a: &Scene, b: &Scene) {
    assert!(a.meshes == b.meshes, "meshes differ");
    let places = |s: &Scene| s.parts.iter().map(|p| (p.name.clone(), p.mesh, p.world_from_mesh)).collect::<Vec<_>>();
    assert!(places(a) == places(b), "places differ");
    assert!(a.cameras == b.cameras, "cameras differ");
}

#[test]
fn other_materials_leave_geometry_and_light_as_they_are() {
    let usual = home(&config()).scene;
    for (materials, realism) in [(Some(77), 1.0), (Some(78), 0.0)] {
        let other = home(&HomeConfig { materials, realism, ..config() }).scene;
        same_geometry(&usual, &other);
        assert!(usual.materials != other.materials);
        assert_eq!(usual.lights, other.lights);
    }
}

#[test]
fn other_light_leaves_geometry_and_reflectances_as_they_are() {
    let usual = home(&config()).scene;
    for moment in [Moment::Day, Moment::Evening, Moment::Night] {
        let other = home(&HomeConfig { light: Some(31), moment: Some(moment), ..config() }).scene;
        same_geometry(&usual, &other);
        assert!(usual.lights != other.lights);
        let surfaces = |s: &Scene| {
            let dark = s.parts.iter().map(|p| &s.materials[p.material as usize]).filter(|m| m.emission.factor.is_black());
            dark.filter(|m| !m.name.contains("lamp")).map(|m| m.bsdf.clone()).collect::<Vec<_>>()
        };
        assert!(surfaces(&usual) == surfaces(&other));
    }
}

#[test]
fn the_world_outside_is_bright_by_day_and_dark_at_night_but_for_lit_windows() {
    let sky = |moment| {
        let scene = home(&HomeConfig { moment: Some(moment), lived_in: 0.0, ..config() }).scene;
        let Some(Environment::Map { image, .. }) = scene.environment else { panic!("a home has surroundings") };
        let Pixels::RgbF32(texels) = &scene.images[image as usize].pixels else { panic!("its sky has a high range") };
        let luminances: Vec<f32> = texels.iter().map(|t| Rgb::from(*t).luminance()).collect();
        (luminances.iter().sum::<f32>() / luminances.len() as f32, luminances.iter().fold(0.0f32, |m, v| m.max(*v)))
    };
    let [day, evening, night] = [Moment::Day, Moment::Evening, Moment::Night].map(sky);
    assert!(day.0 > evening.0 && evening.0 > night.0 && night.0 > 0.0, "{day:?} {evening:?} {night:?}");
    assert!(day.0 > 0.3 && night.0 < 0.05, "{day:?} {night:?}");
}
