//! Things that people leave lying where they used them: plates after a meal, post, cables that run over the floor, posters, paper
//! that missed the bin. They are a table of their own, beside the catalogue: rooms do not ask for them, and they are not scattered with ornaments.

mod cables;
mod hung;
mod meal;
mod paper;

pub use cables::{LooseCable, PowerStrip};
pub use hung::{HungClothes, Poster};
pub use meal::UsedPlate;
pub use paper::{CrumpledPaper, Pizza, Post};

use super::tableware::{Bottle, Drinkware};
use super::{Furniture, family_named};
use enfilade_math::Rng;

/// A family of things that are left lying, with a function that draws one of its variants.
type Left = (&'static str, fn(&mut Rng) -> Box<dyn Furniture>);

const fn left<F: Furniture + 'static>(name: &'static str) -> Left {
    (name, |rng| Box::new(F::random(rng)))
}

/// All families that only lie about.
static LEFT: [Left; 10] = [
    left::<Poster>("poster"),
    left::<HungClothes>("hung_clothes"),
    left::<UsedPlate>("used_plate"),
    left::<Post>("post"),
    left::<Pizza>("pizza_box"),
    left::<CrumpledPaper>("crumpled_paper"),
    left::<LooseCable>("loose_cable"),
    left::<PowerStrip>("power_strip"),
    // What people drink from at work and at school.
    ("water_bottle", |rng| Box::new(Bottle { height: rng.range(0.24, 0.30), radius: rng.range(0.034, 0.04), kind: 2 })),
    ("tumbler", |_| Box::new(Drinkware::Tumbler)),
];

/// One variant of a family of the catalogue, or of those that only lie about.
pub fn left_thing(family: &str, rng: &mut Rng) -> Option<Box<dyn Furniture>> {
    let own = LEFT.iter().find(|(name, _)| *name == family).map(|(_, random)| random);
    own.or_else(|| family_named(family).map(|family| &family.random)).map(|random| random(rng))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pieces::piece_tests::scene_of;
    use enfilade_math::Bounds3;

    #[test]
    fn things_that_lie_about_are_valid_and_within_their_boxes_on_the_floor() {
        let hangs = |name: &str| ["poster", "hung_clothes"].contains(&name);
        for (name, random) in LEFT.iter().filter(|(name, _)| !hangs(name)) {
            for seed in 0..6 {
                let thing = random(&mut Rng::new(seed));
                let scene = scene_of(thing.as_ref(), seed);
                assert_eq!(scene.validate(), Ok(()), "{name}");
                let corners = scene.parts.iter().flat_map(|part| scene.world_positions(part));
                let (size, found) = (thing.size(), Bounds3::from_points(corners));
                let room = 0.5 * size.truncate() + 0.002;
                assert!((0.0..0.002).contains(&found.min.z) && found.max.z < size.z + 0.002, "{name} {seed}: {found:?}");
                let wide = found.max.truncate().abs().max(found.min.truncate().abs());
                assert!(wide.cmple(room).all(), "{name} {seed}: {found:?} in {size}");
            }
        }
        assert!(left_thing("mug", &mut Rng::new(1)).is_some() && left_thing("none", &mut Rng::new(1)).is_none());
    }
}
