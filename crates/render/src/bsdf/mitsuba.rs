//! Disney's model has the values of Mitsuba 3.9.1, and its samples those values.

use super::*;
use crate::texture::{Footprint, Textures};
use enfilade_math::{Rng, Vec2, warp};
use enfilade_scene::{self as scene, Disney};
use enfilade_testkit::{ChiSquare, Mean};

/// Cosines of both directions, the azimuth between them, and the side of the second.
const DIRECTIONS: [(f32, f32, f32, f32); 6] =
    [(1.0, 0.9, 2.0, 1.0), (0.6, 0.5, 2.5, 1.0), (0.3, 0.4, 3.0, 1.0), (0.8, 0.7, 0.5, 1.0), (0.6, 0.7, 3.0, -1.0), (0.9, 0.95, 2.8, -1.0)];

/// Mitsuba's defaults, except for the colour.
fn plain() -> Disney {
    Disney {
        base_color: Rgb::new(0.7, 0.4, 0.2).into(),
        roughness: 0.5.into(),
        metallic: 0.0.into(),
        eta: 1.5,
        spec_trans: 0.0.into(),
        spec_tint: 0.0.into(),
        sheen: 0.0.into(),
        sheen_tint: 0.0.into(),
        flatness: 0.0.into(),
        clearcoat: 0.0.into(),
        clearcoat_gloss: 0.0.into(),
        thin: false,
        diff_trans: 0.0.into(),
    }
}

/// Materials, whether they are seen from outside, and the value of `eval` of Mitsuba's `principled` and `principledthin` for each pair of
/// [`DIRECTIONS`].
#[rustfmt::skip]
fn cases() -> Vec<(Disney, bool, [[f32; 3]; 6])> {
    vec![
        (Disney { roughness: 0.4.into(), ..plain() }, true, [[0.215283, 0.129339, 0.072043], [0.115222, 0.067876, 0.036311], [0.340537, 0.306, 0.282976], [0.156626, 0.08973, 0.045133], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]),
        (Disney { roughness: 0.9.into(), flatness: 0.7.into(), ..plain() }, true, [[0.15696, 0.091597, 0.048022], [0.127429, 0.075492, 0.040868], [0.142669, 0.090654, 0.055977], [0.1412, 0.082088, 0.042681], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]),
        (Disney { roughness: 0.8.into(), sheen: 1.0.into(), sheen_tint: 0.5.into(), ..plain() }, true, [[0.207151, 0.121206, 0.06391], [0.126315, 0.076878, 0.043921], [0.180309, 0.13014, 0.096694], [0.159687, 0.092649, 0.047957], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]),
        (Disney { roughness: 0.3.into(), eta: 1.788_854_4, spec_tint: 1.0.into(), ..plain() }, true, [[0.224655, 0.128375, 0.064187], [0.113862, 0.065172, 0.032713], [0.308242, 0.22488, 0.169305], [0.156564, 0.089465, 0.044733], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]),
        (Disney { roughness: 0.6.into(), clearcoat: 1.0.into(), clearcoat_gloss: 0.3.into(), ..plain() }, true, [[0.223992, 0.138048, 0.080752], [0.123845, 0.076204, 0.044443], [0.243696, 0.2087, 0.18537], [0.159231, 0.092264, 0.04762], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]),
        (Disney { metallic: 0.6.into(), spec_tint: 0.4.into(), ..plain() }, true, [[0.262306, 0.151595, 0.077788], [0.1051, 0.061329, 0.032149], [0.753437, 0.50532, 0.339908], [0.075336, 0.04317, 0.021725], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]),
        (Disney { spec_trans: 0.7.into(), eta: 1.4, ..plain() }, true, [[0.071682, 0.045899, 0.02871], [0.039714, 0.025466, 0.015967], [0.223763, 0.213333, 0.20638], [0.047665, 0.027586, 0.0142], [0.673844, 0.509378, 0.360185], [1.73851, 1.31419, 0.92927]]),
        (Disney { spec_trans: 0.7.into(), eta: 1.4, ..plain() }, false, [[0.008098, 0.008098, 0.008098], [0.094959, 0.094959, 0.094959], [0.999868, 0.999868, 0.999868], [0.00057, 0.00057, 0.00057], [0.168307, 0.127228, 0.089964], [0.281466, 0.212768, 0.15045]]),
        (Disney { metallic: 0.3.into(), spec_trans: 0.6.into(), sheen: 0.4.into(), clearcoat: 0.5.into(), clearcoat_gloss: 0.1.into(), flatness: 0.2.into(), spec_tint: 0.3.into(), sheen_tint: 1.0.into(), ..plain() }, true, [[0.157942, 0.09592, 0.054572], [0.069502, 0.042178, 0.023961], [0.529582, 0.388762, 0.294882], [0.049892, 0.028982, 0.015042], [0.246602, 0.186413, 0.131814], [1.03642, 0.783459, 0.553989]]),
        (Disney { metallic: 0.3.into(), spec_trans: 0.6.into(), sheen: 0.4.into(), clearcoat: 0.5.into(), clearcoat_gloss: 0.1.into(), flatness: 0.2.into(), spec_tint: 0.3.into(), sheen_tint: 1.0.into(), ..plain() }, false, [[0.007002, 0.007002, 0.007002], [0.056975, 0.056975, 0.056975], [0.599921, 0.599921, 0.599921], [0.000493, 0.000493, 0.000493], [0.090665, 0.068536, 0.048462], [0.181068, 0.136875, 0.096785]]),
        (Disney { thin: true, spec_trans: 0.7.into(), diff_trans: 0.8.into(), spec_tint: 0.5.into(), eta: 1.4, ..plain() }, true, [[0.046403, 0.028244, 0.016138], [0.024674, 0.015253, 0.008972], [0.158734, 0.144227, 0.134555], [0.028839, 0.016602, 0.008443], [1.32437, 0.756782, 0.378391], [1.16416, 0.665237, 0.332619]]),
        (Disney { thin: true, roughness: 0.6.into(), flatness: 0.5.into(), sheen: 0.5.into(), sheen_tint: 0.3.into(), diff_trans: 1.5.into(), ..plain() }, true, [[0.041558, 0.023748, 0.011874], [0.030148, 0.017396, 0.008895], [0.03374, 0.020933, 0.012395], [0.035774, 0.020442, 0.010221], [0.116979, 0.066845, 0.033423], [0.158757, 0.090718, 0.045359]]),
    ]
}

fn direction(cos: f32, phi: f32, side: f32) -> Vec3 {
    let sin = (1.0 - cos * cos).sqrt();
    Vec3::new(sin * phi.cos(), sin * phi.sin(), side * cos)
}

fn at(disney: &Disney, cos_o: f32, outside: bool, test: impl FnOnce(&Bsdf<'_>)) {
    let (textures, tables, disney) = (Textures::default(), Tables::default(), scene::Bsdf::Disney(Box::new(disney.clone())));
    let inputs = Inputs { textures: &textures, uv: Vec2::ZERO, footprint: Footprint::POINT, tables: &tables, cos_o, outside };
    test(&Bsdf::new(&disney, &inputs));
}

#[test]
fn disneys_model_has_the_values_of_mitsuba() {
    for (disney, outside, expected) in cases() {
        for ((cos_o, cos_i, phi, side), expected) in DIRECTIONS.into_iter().zip(expected) {
            at(&disney, cos_o, outside, |bsdf| {
                let value = bsdf.eval(direction(cos_o, 0.0, 1.0), direction(cos_i, phi, side)).total(bsdf.reflectance);
                for c in 0..3 {
                    let near = (value[c] - expected[c]).abs() < 2e-3 * expected[c] + 2e-6;
                    assert!(near, "{disney:?}, outside {outside}, {cos_o} {cos_i} {phi} {side}: {value:?}, expected {expected:?}");
                }
            });
        }
    }
}

#[test]
fn samples_of_disneys_model_have_its_values_and_density() {
    let tests = 2 * 2 * cases().len();
    for ((disney, outside, _), cos_o) in cases().into_iter().flat_map(|case| [0.9, 0.4].map(|cos| (case.clone(), cos))) {
        at(&disney, cos_o, outside, |bsdf| {
            let (name, wo) = (format!("{disney:?}, outside {outside}, {cos_o}"), direction(cos_o, 0.0, 1.0));
            let (mut rng, mut sampled, mut uniform) = (Rng::new(5), Mean::EMPTY, Mean::EMPTY);
            for _ in 0..60_000 {
                let u = [rng.next_f32(), rng.next_f32(), rng.next_f32()];
                sampled.add(bsdf.sample(wo, u).map_or(0.0, |s| f64::from(s.weight.total(bsdf.reflectance).g)));
                let wi = warp::sphere([rng.next_f32(), rng.next_f32()]);
                uniform.add(f64::from(bsdf.eval(wo, wi).total(bsdf.reflectance).g) * 4.0 * std::f64::consts::PI);
            }
            sampled.assert_agrees(&name, &uniform, tests);
            ChiSquare::directions(40_000, |u| bsdf.sample(wo, u).map(|s| s.wi), |w| bsdf.pdf(wo, w)).assert(&name, tests);
            // Radiance changes with the index across a border, which the estimate leaves out.
            let refracts = !disney.thin && disney.spec_trans.factor > 0.0;
            let albedo = bsdf.albedo(cos_o);
            let about = f64::from((albedo.blurred() + albedo.sharp).g);
            assert!(refracts || (about - sampled.value()).abs() < 0.25, "{name}: albedo {about}, sampled {}", sampled.value());
        });
    }
}

/// A smooth sheet is a pane: Fresnel's part is mirrored, the rest passes straight through in the base's colour, also for shadow rays.
#[test]
fn smooth_sheets_let_light_straight_through() {
    let sheet = Disney { thin: true, roughness: 0.0.into(), spec_trans: 1.0.into(), ..plain() };
    let (textures, tables, cos_o) = (Textures::default(), Tables::default(), 0.7);
    let inputs = Inputs { textures: &textures, uv: Vec2::ZERO, footprint: Footprint::POINT, tables: &tables, cos_o, outside: true };
    let reflected = fresnel::dielectric(cos_o, 1.5).0;
    let passed = straight_transmittance(&scene::Bsdf::Disney(Box::new(sheet.clone())), &inputs).expect("a pane");
    assert!((passed.g - 0.4 * (1.0 - reflected)).abs() < 1e-6, "{passed:?}");
    at(&sheet, cos_o, true, |bsdf| {
        let (mut rng, mut mirrored, mut straight) = (Rng::new(7), Mean::EMPTY, Mean::EMPTY);
        for _ in 0..40_000 {
            let s = bsdf.sample(direction(cos_o, 0.0, 1.0), [rng.next_f32(), rng.next_f32(), rng.next_f32()]).expect("smooth");
            let value = f64::from(s.weight.specular.g);
            mirrored.add(if s.event == Event::Delta { value } else { 0.0 });
            straight.add(if s.event == Event::Straight { value } else { 0.0 });
        }
        mirrored.assert_is("mirrored", f64::from(reflected), 2);
        straight.assert_is("straight", f64::from(passed.g), 2);
    });
}
