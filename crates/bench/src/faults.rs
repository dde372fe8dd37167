//! `faults [FIRST] [COUNT] [--building NAME] [--rooms a,b,c | --random-rooms] [--joints]` makes homes of consecutive seeds and reports what had to be moved, what had to
//! be removed and why, which faults remain, how much processor time they took and how large they are. With `--random-rooms` each has one to
//! twelve rooms of any kinds, which its seed decides. With `--joints` their things can be opened, and what limits that is counted.

use enfilade_furniture::{family_of, object_of};
use enfilade_home::check::faults;
use enfilade_home::{Building, HomeConfig, RoomKind, States, home};
use enfilade_math::Rng;
use enfilade_testkit::process_cpu_s;
use std::collections::BTreeMap;

/// Shifts by more than this are shown, metres.
const FAR: f32 = 0.03;

/// Number of occurrences by name.
type Counts = BTreeMap<String, usize>;

/// Runs the instrument.
pub fn run() -> std::io::Result<()> {
    let args: Vec<String> = crate::arguments::arguments().collect();
    let value = |flag: &str| args.iter().position(|a| a == flag).and_then(|i| args.get(i + 1)).cloned();
    let numbers: Vec<u64> = args.iter().map_while(|a| a.parse().ok()).collect();
    let (first, count) = (numbers.first().copied().unwrap_or(0), numbers.get(1).copied().unwrap_or(20));
    let rooms: Vec<RoomKind> = value("--rooms").iter().flat_map(|text| text.split(',')).filter_map(RoomKind::from_name).collect();
    let building = crate::arguments::building(value("--building").as_deref())?;
    let random_rooms = args.iter().any(|a| a == "--random-rooms");
    let joints = args.iter().any(|a| a == "--joints");
    let [mut kinds, mut families, mut causes, mut moved, mut limits, mut opened] = [const { Counts::new() }; 6];
    let (mut seconds, mut longest, mut triangles, mut sound) = (0.0, 0.0f64, 0, 0);
    for seed in first..first + count {
        let rooms = if random_rooms { any_rooms(building, seed) } else { rooms.clone() };
        let start = process_cpu_s();
        let config = HomeConfig { seed, building, rooms, states: joints.then_some(States::MADE), ..HomeConfig::default() };
        let Ok(made) = std::panic::catch_unwind(|| home(&config)) else {
            println!("{seed:5}  panics with the rooms {:?}", config.rooms);
            *kinds.entry("panics".into()).or_default() += 1;
            continue;
        };
        let took = process_cpu_s() - start;
        let size: usize = made.scene.parts.iter().map(|p| made.scene.meshes[p.mesh as usize].triangles.len()).sum();
        let found = faults(&made);
        (seconds, longest, triangles) = (seconds + took, longest.max(took), triangles + size);
        sound += usize::from(found.is_empty());
        println!(
            "{seed:5}  {} rooms  {} parts  {size} triangles  {took:.2} s  {} moved  {} removed  {} faults",
            made.plan.rooms.len(),
            made.scene.parts.len(),
            made.moved.len(),
            made.removed.len(),
            found.len()
        );
        for removal in &made.removed {
            println!("       removed {}: {}", removal.object, removal.fault);
            *families.entry(family_of(&removal.object).to_string()).or_default() += 1;
            *causes.entry(removal.fault.kind()).or_default() += 1;
        }
        for shift in &made.moved {
            if shift.by.length() > FAR {
                println!("       moved {} by {:.3}", shift.object, shift.by);
            }
            *moved.entry(family_of(&shift.object).to_string()).or_default() += 1;
        }
        for joint in &made.joints {
            *opened.entry(joint.kind.name().into()).or_default() += 1;
            if let Some(thing) = &joint.limited_by {
                *limits
                    .entry(format!("{} of {} by {}", joint.kind.name(), family_of(object_of(&joint.body)), family_of(thing)))
                    .or_default() += 1;
            }
        }
        for fault in found {
            println!("       {fault}");
            *kinds.entry(fault.kind()).or_default() += 1;
        }
    }
    println!(
        "\n{sound} of {count} homes without a fault; {:.2} s of processor time each, at most {longest:.2} s; {} triangles each",
        seconds / count.max(1) as f64,
        triangles / count.max(1) as usize
    );
    show("faults", kinds, count);
    show("removed, by family", families, count);
    show("removed, by cause", causes, count);
    show("moved, by family", moved, count);
    if joints {
        show("joints", opened, count);
        show("joints that something limits", limits, count);
    }
    Ok(())
}

/// The most frequent first.
fn show(title: &str, counts: Counts, homes: u64) {
    let total: usize = counts.values().sum();
    println!("{title}: {total}, {:.2} per home", total as f64 / homes.max(1) as f64);
    let mut counts: Vec<(usize, String)> = counts.into_iter().map(|(name, n)| (n, name)).collect();
    counts.sort_by(|a, b| b.cmp(a));
    counts.iter().for_each(|(n, name)| println!("{n:6}  {name}"));
}

/// One to [`HomeConfig::MOST_ROOMS`] rooms, each of any kind that the building has, so that many homes lack what others take for granted.
fn any_rooms(building: Building, seed: u64) -> Vec<RoomKind> {
    let mut rng = Rng::new(seed).fork(0x0063_6865_636b);
    let count = 1 + rng.below(HomeConfig::MOST_ROOMS);
    let kinds = building.row().kinds;
    (0..count).map(|_| kinds[rng.below(kinds.len())]).collect()
}
