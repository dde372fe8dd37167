//! `check [FIRST] [COUNT] [--rooms a,b,c | --random-rooms]` makes homes of consecutive seeds and says what cannot be, how long they took
//! and how large they are. With `--random-rooms` each has one to twelve rooms of any kinds, which its seed decides.

use enfilade_home::check::faults;
use enfilade_home::{HomeConfig, RoomKind, home};
use enfilade_math::Rng;
use std::collections::BTreeMap;
use std::time::Instant;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let value = |flag: &str| args.iter().position(|a| a == flag).and_then(|i| args.get(i + 1)).cloned();
    let numbers: Vec<u64> = args.iter().map_while(|a| a.parse().ok()).collect();
    let (first, count) = (numbers.first().copied().unwrap_or(0), numbers.get(1).copied().unwrap_or(20));
    let rooms: Vec<RoomKind> = value("--rooms").iter().flat_map(|text| text.split(',')).filter_map(RoomKind::from_name).collect();
    let random_rooms = args.iter().any(|a| a == "--random-rooms");
    let mut kinds: BTreeMap<String, usize> = BTreeMap::new();
    let (mut seconds, mut longest, mut triangles, mut sound) = (0.0, 0.0f64, 0, 0);
    for seed in first..first + count {
        let rooms = if random_rooms { any_rooms(seed) } else { rooms.clone() };
        let start = Instant::now();
        let config = HomeConfig { seed, rooms, ..HomeConfig::default() };
        let Ok(made) = std::panic::catch_unwind(|| home(&config)) else {
            println!("{seed:5}  panics with the rooms {:?}", config.rooms);
            *kinds.entry("panics".into()).or_default() += 1;
            continue;
        };
        let took = start.elapsed().as_secs_f64();
        let size: usize = made.scene.parts.iter().map(|p| made.scene.meshes[p.mesh as usize].triangles.len()).sum();
        let found = faults(&made);
        (seconds, longest, triangles) = (seconds + took, longest.max(took), triangles + size);
        sound += usize::from(found.is_empty());
        println!(
            "{seed:5}  {} rooms  {} parts  {size} triangles  {took:.2} s  {} faults",
            made.plan.rooms.len(),
            made.scene.parts.len(),
            found.len()
        );
        for fault in found {
            println!("       {fault}");
            let kind: String = fault
                .to_string()
                .split(' ')
                .map(|word| word.trim_end_matches(|c: char| c.is_ascii_digit() || c == '_'))
                .collect::<Vec<_>>()
                .join(" ");
            *kinds.entry(kind).or_default() += 1;
        }
    }
    println!(
        "\n{sound} of {count} homes without a fault; {:.2} s each, the longest {longest:.2} s; {} triangles each",
        seconds / count as f64,
        triangles / count as usize
    );
    let mut kinds: Vec<(usize, String)> = kinds.into_iter().map(|(kind, n)| (n, kind)).collect();
    kinds.sort_by(|a, b| b.cmp(a));
    kinds.iter().for_each(|(n, kind)| println!("{n:6}  {kind}"));
}

/// One to [`HomeConfig::MOST_ROOMS`] rooms, each of any kind, so that many homes lack what others take for granted.
fn any_rooms(seed: u64) -> Vec<RoomKind> {
    let mut rng = Rng::new(seed).fork(0x0063_6865_636b);
    let count = 1 + rng.below(HomeConfig::MOST_ROOMS);
    (0..count).map(|_| RoomKind::ALL[rng.below(RoomKind::ALL.len())]).collect()
}
