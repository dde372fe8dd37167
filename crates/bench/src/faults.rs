//! `faults [FIRST] [COUNT] [--building NAME | --all-kinds] [--rooms a,b,c | --random-rooms] [--joints] [--lived-in SHARE]` makes homes of
//! consecutive seeds and reports what had to be moved, what had to be removed and why, which faults remain, how much processor time they took
//! and how large they are. With `--all-kinds` seeds take turns through all kinds of buildings, and what each kind costs is told too. With
//! `--random-rooms` each has one to twelve rooms of any kinds, which its seed decides. With `--joints` their things can be opened, and what
//! limits that is counted.

use enfilade_furniture::{family_of, object_of};
use enfilade_home::check::faults;
use enfilade_home::{Building, Home, HomeConfig, RoomKind, States, home};
use enfilade_math::Rng;
use enfilade_testkit::process_cpu_s;
use std::collections::BTreeMap;

/// Shifts by more than this are shown, metres.
const FAR: f32 = 0.03;

/// Number of occurrences by name.
type Counts = BTreeMap<String, usize>;

/// What all homes together have.
#[derive(Default)]
struct Found {
    faults: Counts,
    families: Counts,
    causes: Counts,
    moved: Counts,
    opened: Counts,
    limits: Counts,
    by_building: BTreeMap<&'static str, Cost>,
}

/// What homes of one kind of building cost.
#[derive(Default)]
struct Cost {
    homes: usize,
    sound: usize,
    seconds: f64,
    longest: f64,
    triangles: usize,
}

/// Runs the instrument.
pub fn run() -> std::io::Result<()> {
    let args: Vec<String> = crate::arguments::arguments().collect();
    let value = |flag: &str| args.iter().position(|a| a == flag).and_then(|i| args.get(i + 1)).cloned();
    let is_asked = |flag: &str| args.iter().any(|a| a == flag);
    let numbers: Vec<u64> = args.iter().map_while(|a| a.parse().ok()).collect();
    let (first, count) = (numbers.first().copied().unwrap_or(0), numbers.get(1).copied().unwrap_or(20));
    let rooms: Vec<RoomKind> = value("--rooms").iter().flat_map(|text| text.split(',')).filter_map(RoomKind::from_name).collect();
    let named = crate::arguments::building(value("--building").as_deref())?;
    let share = value("--lived-in").map(|text| text.parse().map_err(std::io::Error::other)).transpose()?;
    let mut found = Found::default();
    for seed in first..first + count {
        let building = if is_asked("--all-kinds") { Building::ALL[(seed % Building::ALL.len() as u64) as usize] } else { named };
        let rooms = if is_asked("--random-rooms") { any_rooms(building, seed) } else { rooms.clone() };
        let mut config =
            HomeConfig { seed, building, rooms, states: is_asked("--joints").then_some(States::MADE), ..HomeConfig::default() };
        config.lived_in = share.unwrap_or(config.lived_in);
        found.look_at(&config);
    }
    found.tell(count, is_asked("--joints"));
    Ok(())
}

impl Found {
    /// Makes a home and tells what is wrong with it.
    fn look_at(&mut self, config: &HomeConfig) {
        let (seed, building) = (config.seed, config.building.name());
        let start = process_cpu_s();
        let Ok(made) = std::panic::catch_unwind(|| home(config)) else {
            println!("{seed:5}  {building} panics with the rooms {:?}", config.rooms);
            *self.faults.entry("panics".into()).or_default() += 1;
            return;
        };
        let took = process_cpu_s() - start;
        let size: usize = made.scene.parts.iter().map(|p| made.scene.meshes[p.mesh as usize].triangles.len()).sum();
        let faults = faults(&made);
        let cost = self.by_building.entry(building).or_default();
        (cost.homes, cost.sound) = (cost.homes + 1, cost.sound + usize::from(faults.is_empty()));
        (cost.seconds, cost.longest, cost.triangles) = (cost.seconds + took, cost.longest.max(took), cost.triangles + size);
        println!(
            "{seed:5}  {building}  {} rooms  {} parts  {size} triangles  {took:.2} s  {} moved  {} removed  {} faults",
            made.plan.rooms.len(),
            made.scene.parts.len(),
            made.moved.len(),
            made.removed.len(),
            faults.len()
        );
        self.count(&made);
        for fault in faults {
            println!("       {fault}");
            *self.faults.entry(fault.kind()).or_default() += 1;
        }
    }

    /// Counts what was removed and moved and what can be opened.
    fn count(&mut self, made: &Home) {
        for removal in &made.removed {
            println!("       removed {}: {}", removal.object, removal.fault);
            *self.families.entry(family_of(&removal.object).to_string()).or_default() += 1;
            *self.causes.entry(removal.fault.kind()).or_default() += 1;
        }
        for shift in &made.moved {
            if shift.by.length() > FAR {
                println!("       moved {} by {:.3}", shift.object, shift.by);
            }
            *self.moved.entry(family_of(&shift.object).to_string()).or_default() += 1;
        }
        for joint in &made.joints {
            *self.opened.entry(joint.kind.name().into()).or_default() += 1;
            if let Some(thing) = &joint.limited_by {
                let limit = format!("{} of {} by {}", joint.kind.name(), family_of(object_of(&joint.body)), family_of(thing));
                *self.limits.entry(limit).or_default() += 1;
            }
        }
    }

    /// Tells of all homes together.
    fn tell(self, count: u64, joints: bool) {
        println!();
        for (building, cost) in &self.by_building {
            println!(
                "{building}: {} of {} without a fault; {:.2} s of processor time each, at most {:.2} s; {} triangles each",
                cost.sound,
                cost.homes,
                cost.seconds / cost.homes as f64,
                cost.longest,
                cost.triangles / cost.homes
            );
        }
        show("faults", self.faults, count);
        show("removed, by family", self.families, count);
        show("removed, by cause", self.causes, count);
        show("moved, by family", self.moved, count);
        if joints {
            show("joints", self.opened, count);
            show("joints that something limits", self.limits, count);
        }
    }
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
