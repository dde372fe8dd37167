//! Checks on every [`Surface`] that any family offers: the room above it is free, and a part carries it.

use super::{FAMILIES, Surface};
use crate::builder::{Builder, pose};
use crate::lamplight::LampLight;
use crate::materials::Materials;
use crate::palette::Palette;
use enfilade_math::{Rng, Vec3, place};
use enfilade_scene::Scene;

/// Variants of each family that are built.
fn seeds() -> u64 {
    enfilade_testkit::seeds(2, 5)
}

/// A variant that has surfaces, built at the origin.
fn variants() -> impl Iterator<Item = (String, Vec<Surface>, Scene)> {
    FAMILIES.iter().flat_map(|family| {
        (0..seeds()).filter_map(move |seed| {
            let mut rng = Rng::new(seed);
            let thing = (family.random)(&mut rng);
            let surfaces = thing.surfaces();
            if surfaces.is_empty() {
                return None;
            }
            let mut b = Builder::new(Materials::new(Palette::all()[0], LampLight::default(), Rng::new(1)));
            thing.build(&mut b, pose(0.0, 0.0, 0.0, 0.0), &mut rng);
            Some((format!("{} of seed {seed}", family.name), surfaces, b.finish().0))
        })
    })
}

#[test]
fn nothing_stands_on_a_free_surface_and_something_carries_it() {
    let mut faults = Vec::new();
    for (name, surfaces, scene) in variants() {
        for s in surfaces {
            assert!(s.min.cmplt(s.max).all() && s.headroom > 0.1, "{name}: {s:?}");
            let mut carried = false;
            for part in &scene.parts {
                let mesh = &scene.meshes[part.mesh as usize];
                let world = |p: &Vec3| place(&part.world_from_mesh, *p);
                let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
                for p in mesh.positions.iter().map(world) {
                    (low, high) = (low.min(p), high.max(p));
                    let above = p.z > s.z + 0.004 && p.z < s.z + s.headroom.min(0.3) - 0.004;
                    if above && p.x > s.min.x && p.x < s.max.x && p.y > s.min.y && p.y < s.max.y {
                        faults.push(format!("{name}: {} reaches into {s:?}", part.name));
                        break;
                    }
                }
                let middle = 0.5 * (s.min + s.max);
                let below = low.truncate().cmplt(middle).all() && high.truncate().cmpgt(middle).all();
                carried |= below && (high.z - s.z).abs() < 0.003;
            }
            if !carried {
                faults.push(format!("{name}: nothing carries {s:?}"));
            }
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}
