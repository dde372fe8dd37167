//! The shared rooms, counted against what their authors state. Skipped unless `ENFILADE_SCENES` names their folder.

use enfilade_import::{ImportOptions, Imported, load};
use enfilade_scene::{Environment, Part, Quiet, Scene};
use std::path::PathBuf;

/// The folder of the shared rooms; `None`, with a note, when it is not named.
fn rooms() -> Option<PathBuf> {
    let folder = std::env::var_os("ENFILADE_SCENES").map(PathBuf::from);
    if folder.is_none() {
        eprintln!("skipped: ENFILADE_SCENES does not name the folder of the shared rooms");
    }
    folder
}

fn import(folder: &std::path::Path, file: &str) -> Imported {
    let start = std::time::Instant::now();
    let imported = load(&folder.join(file), &ImportOptions::default(), &Quiet).unwrap_or_else(|e| panic!("{e}"));
    eprintln!("{file} in {:.2} s\n{}", start.elapsed().as_secs_f64(), imported.report);
    imported
}

#[test]
fn gltf_rooms_have_the_parts_triangles_and_lights_that_they_state() {
    let Some(folder) = rooms() else { return };
    // Name, triangles, objects, emissive materials, punctual lights, environment.
    let rooms = [
        ("bedroom", 449_390, 71, 2, 0, false),
        ("contemporary-bathroom", 380_290, 853, 1, 0, false),
        ("grey-white-room", 143_163, 65, 0, 0, true),
        ("japanese-classroom", 103_832, 79, 0, 1, true),
        ("modern-hall", 31_887, 32, 13, 0, false),
    ];
    for (name, triangles, objects, emissive, lights, environment) in rooms {
        let c = import(&folder, &format!("{name}/gltf/scene.gltf")).report.counts;
        assert_eq!((c.triangles, c.parts), (triangles, objects), "{name}");
        assert_eq!((c.emissive_materials, c.lights, c.cameras), (emissive, lights, 1), "{name}");
        assert_eq!(c.environments > 0, environment, "{name}");
    }
    let c = import(&folder, "drake-furnished-living-room/scene.gltf").report.counts;
    assert_eq!((c.triangles, c.parts, c.materials, c.cameras, c.lights), (69_603, 36, 18, 1, 1));
}

#[test]
fn poly_haven_furniture_has_the_triangles_that_it_states() {
    let Some(folder) = rooms() else { return };
    let models = [
        ("painted_wooden_cabinet", 2227),
        ("painted_wooden_cabinet_02", 966),
        ("painted_wooden_stool", 676),
        ("sofa_03", 8004),
        ("tea_set_01", 40_296),
        ("wooden_bookshelf_worn", 10_106),
        ("wooden_table_02", 196),
    ];
    for (name, triangles) in models {
        let imported = import(&folder, &format!("polyhaven-furniture-1k/{name}_1k.gltf"));
        assert_eq!(imported.report.counts.triangles, triangles, "{name}");
        assert!(imported.report.warnings.is_empty(), "{name}");
    }
}

/// Rooms from the renderer's own description and converted to glTF agree: same parts, cameras and surroundings.
#[test]
fn mitsuba_rooms_agree_with_their_gltf() {
    let Some(folder) = rooms() else { return };
    for name in ["grey-white-room", "modern-hall"] {
        let mitsuba = import(&folder, &format!("{name}/mitsuba/scene.xml")).scene;
        let gltf = import(&folder, &format!("{name}/gltf/scene.gltf")).scene;
        let names = |s: &Scene| s.parts.iter().map(|p| p.name.clone()).collect::<Vec<_>>();
        assert_eq!(names(&mitsuba), names(&gltf), "{name}");
        for (m, g) in mitsuba.parts.iter().zip(&gltf.parts).filter(|(m, _)| !m.name.starts_with("inline")) {
            let triangles = |s: &Scene, p: &Part| s.meshes[p.mesh as usize].triangles.len();
            assert_eq!(triangles(&mitsuba, m), triangles(&gltf, g), "{name} {}", m.name);
            let bounds = |s: &Scene, p: &Part| s.world_corners(p, 0);
            let difference = (0..3).map(|i| (bounds(&mitsuba, m)[i] - bounds(&gltf, g)[i]).length()).fold(0.0, f32::max);
            assert!(difference < 1e-4, "{name} {}: {difference}", m.name);
        }
        let (a, b) = (&mitsuba.cameras[0], &gltf.cameras[0]);
        assert!((a.position - b.position).length() < 1e-5 && (a.fov_x_rad - b.fov_x_rad).abs() < 1e-6, "{a:?} {b:?}");
        assert!((a.world_from_camera - b.world_from_camera).to_cols_array().iter().all(|v| v.abs() < 1e-5), "{a:?} {b:?}");
        if let (Some(Environment::Map { map_from_world: a, .. }), Some(Environment::Map { map_from_world: b, .. })) =
            (&mitsuba.environment, &gltf.environment)
        {
            assert!((*a - *b).to_cols_array().iter().all(|v| v.abs() < 1e-6), "{a} {b}");
        }
        assert_eq!(mitsuba.environment.is_some(), gltf.environment.is_some(), "{name}");
    }
}

/// Lamps of the modern hall are disks and rectangles placed by mirrored and rotated matrices: they must shine into the room.
#[test]
fn lamps_of_the_modern_hall_shine_along_their_normals() {
    let Some(folder) = rooms() else { return };
    let scene = import(&folder, "modern-hall/mitsuba/scene.xml").scene;
    let lamps: Vec<&Part> = scene.parts.iter().filter(|p| !scene.materials[p.material as usize].emission.factor.is_black()).collect();
    assert_eq!(lamps.len(), 13);
    for lamp in lamps {
        let [a, b, c] = scene.world_corners(lamp, 0);
        let face = (b - a).cross(c - a);
        let normal = scene.meshes[lamp.mesh as usize].normals[0].as_dvec3();
        let world_normal = lamp.world_from_mesh.matrix3.inverse().transpose() * normal;
        assert!(face.as_dvec3().dot(world_normal) > 0.0, "{}", lamp.name);
        if lamp.name.starts_with("inline_disk") {
            assert!(face.z < 0.0, "{} should shine down", lamp.name);
        }
    }
}

#[test]
fn the_sky_of_the_classroom_is_above_it() {
    let Some(folder) = rooms() else { return };
    let scene = import(&folder, "japanese-classroom/gltf/scene.gltf").scene;
    let Some(Environment::Map { image, map_from_world, .. }) = &scene.environment else { panic!("no environment") };
    assert!((map_from_world.determinant() - 1.0).abs() < 1e-4);
    let sky = &scene.images[*image as usize];
    let brightness = |d: enfilade_math::Vec3| {
        let uv = enfilade_scene::uv_from_direction(*map_from_world * d);
        sky.texel(
            (uv.x * sky.width as f32) as usize % sky.width as usize,
            ((uv.y * sky.height as f32) as usize).min(sky.height as usize - 1),
        )
        .0
    };
    let (above, below) = (brightness(enfilade_math::Vec3::new(0.1, 0.1, 0.99)), brightness(enfilade_math::Vec3::new(0.1, 0.1, -0.99)));
    assert!(above.luminance() > below.luminance(), "{above:?} {below:?}");
}
