//! Rooms that tests furnish by hand, thing by thing.

use super::Furnisher;
use crate::light::LightConfig;
use crate::plan::FloorPlan;
use enfilade_furniture::assets::Library;
use enfilade_furniture::{Builder, Materials, Palette, RoomKind, family_of, object_of};
use enfilade_math::Rng;
use enfilade_scene::{Part, Scene};

/// Maximum number of rooms that are tried.
const SEEDS: u64 = 24;

/// The things that `furnish` puts into the one room of a home, and the next random number after that.
pub(super) fn furnished(kind: RoomKind, seed: u64, clutter: f32, library: &Library, furnish: impl FnOnce(&mut Furnisher)) -> (Scene, u64) {
    let plan = FloorPlan::new(&[kind], &Rng::new(1));
    let palette = Palette::all()[0];
    let mut b = Builder::new(Materials::new(palette, LightConfig::default().lamp_light(), Rng::new(1)));
    let mut f = Furnisher::new(&mut b, &plan, &plan.rooms[0], &palette, library, clutter, Rng::new(seed));
    furnish(&mut f);
    let next = f.rng.next_u64();
    (b.finish().0, next)
}

/// Checks that without clutter a room lacks the things of the families `small` and nothing else, and draws the same random numbers.
pub(super) fn lacks_without_clutter(kind: RoomKind, furnish: fn(&mut Furnisher), small: &[&str]) {
    let is_small = |part: &Part| small.contains(&family_of(object_of(&part.name)));
    let placed = |part: &Part| (part.name.clone(), part.world_from_mesh);
    for seed in 0..SEEDS {
        // The smallest positive clutter is too little for things that are scattered by chance.
        let [with, without] = [f32::MIN_POSITIVE, 0.0].map(|clutter| furnished(kind, seed, clutter, &Library::default(), furnish));
        let rest: Vec<_> = with.0.parts.iter().filter(|part| !is_small(part)).map(placed).collect();
        let bare: Vec<_> = without.0.parts.iter().map(placed).collect();
        let lacking = with.0.parts.len() - rest.len();
        assert_eq!((bare, without.1), (rest, with.1), "seed {seed}");
        if lacking > 0 {
            return;
        }
    }
    panic!("no room of {SEEDS} has any of {small:?}");
}
