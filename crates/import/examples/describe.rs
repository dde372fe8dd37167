//! Prints the report of a scene file: `cargo run -p enfilade-import --example describe -- room.gltf [metres per unit]`.

use enfilade_import::{ImportOptions, load};
use enfilade_scene::Quiet;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().ok_or("name a scene file")?;
    let meters_per_unit = arguments.next().map_or(Ok(1.0), |a| a.parse())?;
    let start = std::time::Instant::now();
    let imported = load(Path::new(&file), &ImportOptions { meters_per_unit, ..ImportOptions::default() }, &Quiet)?;
    println!("{}read in {:.2} s\n", imported.report, start.elapsed().as_secs_f64());
    for camera in &imported.scene.cameras {
        println!("camera {:?} at {:.2}, {:.1}° across", camera.name, camera.position, camera.fov_x_rad.to_degrees());
    }
    for light in &imported.scene.lights {
        println!("light {light:?}");
    }
    println!("environment {:?}", imported.scene.environment);
    for part in &imported.scene.parts {
        let material = &imported.scene.materials[part.material as usize];
        println!("part {:?} of {:?}", part.name, material.name);
    }
    for material in &imported.scene.materials {
        println!("{material:?}");
    }
    Ok(())
}
