//! The sizes at which people take a thing for one of a family: those of our own variants, and somewhat more.

use crate::builder::Class;
use crate::pieces::{Family, Place};
use enfilade_math::{Rng, Vec3};

/// Variants that are measured.
const SAMPLES: u64 = 48;
/// Minimum and maximum widths and depths, as factors of the smallest and largest of our own.
const ACROSS: [f32; 2] = [0.65, 1.4];
/// Additional depth that is allowed for things at a wall, metres.
const DEEPER: f32 = 0.2;
/// Minimum and maximum heights of tables and desks, which the human body decides, as factors of our own.
const WORKING: [f32; 2] = [0.88, 1.12];
/// Minimum and maximum heights of other furniture, as factors of our own.
const HEIGHT: [f32; 2] = [0.6, 1.3];
/// Minimum and maximum of all measures of small things and of what hangs, as factors of our own.
const SMALL: [f32; 2] = [0.6, 1.6];

/// Minimum and maximum width, depth and height at which people take a thing for one of `family`, metres.
///
/// They are those of our own variants, and somewhat more.
pub fn believable(family: &Family) -> [Vec3; 2] {
    let sizes = (0..SAMPLES).map(|seed| (family.random)(&mut Rng::new(seed)).size());
    let (low, high) = sizes.fold((Vec3::INFINITY, Vec3::ZERO), |(low, high), size| (low.min(size), high.max(size)));
    let [narrow, wide] = match family.place {
        Place::AgainstWall | Place::Free | Place::Corner => {
            let height = if matches!(family.class, Class::Table | Class::Desk) { WORKING } else { HEIGHT };
            [0, 1].map(|k| Vec3::new(ACROSS[k], ACROSS[k], height[k]))
        }
        Place::OnWall | Place::Ceiling | Place::OnSurface | Place::Underfoot => SMALL.map(Vec3::splat),
    };
    // Things flat on a wall or on the floor may have any thickness.
    let (mut min, mut max) = (low * narrow, high * wide);
    match family.place {
        Place::OnWall => min.y = 0.0,
        Place::Underfoot => min.z = 0.0,
        Place::AgainstWall => max.y += DEEPER,
        _ => {}
    }
    [min, max]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pieces::family_named;

    #[test]
    fn sofas_are_told_from_armchairs_and_dining_tables_from_low_ones() {
        let fits = |family: &str, size: [f32; 3]| {
            let [low, high] = believable(family_named(family).expect("the catalogue has it"));
            let size = Vec3::from_array(size);
            size.cmpge(low).all() && size.cmple(high).all()
        };
        assert!(fits("sofa", [2.1, 0.9, 0.85]) && !fits("sofa", [0.8, 0.85, 0.85]));
        assert!(fits("armchair", [0.8, 0.8, 0.85]) && !fits("armchair", [2.1, 0.9, 0.85]));
        assert!(fits("dining_table", [0.9, 0.9, 0.76]) && !fits("dining_table", [0.9, 0.9, 0.4]));
        assert!(!fits("mug", [8.0, 8.0, 9.0]), "a model in centimetres");
    }
}
