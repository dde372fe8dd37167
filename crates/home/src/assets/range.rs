//! What a family's things measure.

use crate::builder::Class;
use crate::furniture::{Family, Place};
use enfilade_math::{Rng, Vec3};

/// Variants that are measured.
const SAMPLES: u64 = 48;
/// Widths and depths may differ this much from our own: least and most, as factors.
const ACROSS: [f32; 2] = [0.65, 1.4];
/// What stands at a wall may be deeper yet by this, metres.
const DEEPER: f32 = 0.2;
/// Heights of what people sit and work at, which the human body decides.
const WORKING: [f32; 2] = [0.88, 1.12];
/// Heights of other furniture.
const HEIGHT: [f32; 2] = [0.6, 1.3];
/// All measures of small things and of what hangs.
const SMALL: [f32; 2] = [0.6, 1.6];

/// Least and largest width, depth and height at which people take a thing for one of `family`, metres.
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
    // What hangs flat on a wall or lies flat on the floor may be as thin as it likes.
    let (mut least, mut most) = (low * narrow, high * wide);
    match family.place {
        Place::OnWall => least.y = 0.0,
        Place::Underfoot => least.z = 0.0,
        Place::AgainstWall => most.y += DEEPER,
        _ => {}
    }
    [least, most]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::furniture::family_named;

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
