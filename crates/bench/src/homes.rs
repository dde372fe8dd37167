//! `homes [FIRST] [COUNT] -o FOLDER [--building NAME] [--rooms a,b,c] [--views N]` writes homes of consecutive seeds as scene packages, and a dataset
//! that renders N views of each, one room after the other: `enfilade run FOLDER/dataset.toml`.

use enfilade_home::{HomeConfig, RoomKind, home};
use enfilade_scene::to_bytes_with_labels;
use std::time::Instant;

const HEAD: &str = "name = \"homes\"\nframes = 1\nrender.size = [480, 360]\nrender.samples = 64\n";

/// Runs the instrument.
pub fn run() -> std::io::Result<()> {
    let args: Vec<String> = crate::arguments::arguments().collect();
    let value = |flag: &str| args.iter().position(|a| a == flag).and_then(|i| args.get(i + 1)).cloned();
    let numbers: Vec<u64> = args.iter().map_while(|a| a.parse().ok()).collect();
    let (first, count) = (numbers.first().copied().unwrap_or(0), numbers.get(1).copied().unwrap_or(1));
    let rooms: Vec<RoomKind> = value("--rooms").iter().flat_map(|text| text.split(',')).filter_map(RoomKind::from_name).collect();
    let building = crate::arguments::building(value("--building").as_deref())?;
    let views: usize = value("--views").and_then(|text| text.parse().ok()).unwrap_or(1);
    let folder = std::path::PathBuf::from(value("-o").unwrap_or_else(|| "homes".into()));
    std::fs::create_dir_all(&folder)?;
    let mut dataset = HEAD.to_string();
    for k in 0..count {
        let seed = first + k;
        let start = Instant::now();
        let made = home(&HomeConfig { seed, building, rooms: rooms.clone(), ..HomeConfig::default() });
        let seconds = start.elapsed().as_secs_f64();
        let name = format!("home_{seed:03}");
        std::fs::write(folder.join(format!("{name}.scene")), to_bytes_with_labels(&made.scene, &made.labels))?;
        // Every home begins with another of its rooms, so that a sheet shows all kinds.
        let cameras = &made.scene.cameras;
        let firsts: Vec<&str> = cameras.iter().filter(|c| c.name.ends_with("_1")).map(|c| c.name.as_str()).collect();
        let chosen: Vec<&str> =
            (0..views.min(firsts.len())).map(|i| firsts[(i + if views == 1 { k as usize } else { 0 }) % firsts.len()]).collect();
        dataset += &format!("[[scene]]\nname = \"{name}\"\nfile = \"{name}.scene\"\ncameras = {chosen:?}\n");
        let triangles: usize = made.scene.parts.iter().map(|p| made.scene.meshes[p.mesh as usize].triangles.len()).sum();
        println!(
            "{name}: {seconds:.2} s, {} parts, {triangles} triangles, {} images, {} cameras",
            made.scene.parts.len(),
            made.scene.images.len(),
            cameras.len()
        );
    }
    std::fs::write(folder.join("dataset.toml"), dataset)
}
