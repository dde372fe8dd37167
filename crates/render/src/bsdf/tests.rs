//! Known answers for every model: the white furnace, sampling against evaluation, reciprocity.

use super::*;
use crate::texture::{Footprint, Textures};
use enfilade_math::{Rng, Vec2, warp};
use enfilade_scene::{self as scene, Material, Principled};
use enfilade_testkit::Mean;

/// Every model and its interesting corners, with whether a white furnace must see all light again.
fn models() -> Vec<(&'static str, Material, bool)> {
    let white = || Rgb::WHITE.into();
    let material = |name: &'static str, bsdf| (name, Material::new(name, bsdf));
    let conductor = |alpha: f32| scene::Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, reflectance: white(), alpha: alpha.into() };
    let dielectric = |alpha: f32| scene::Bsdf::Dielectric { eta: 1.5, alpha: alpha.into(), transmittance: white(), absorption: Rgb::BLACK };
    let plastic =
        |alpha: f32, nonlinear| scene::Bsdf::Plastic { diffuse: white(), eta: 1.5, alpha: alpha.into(), specular: white(), nonlinear };
    let principled = |p: Principled| scene::Bsdf::Principled(Box::new(p));
    let rough_diffuse = |roughness: f32| scene::Bsdf::RoughDiffuse { reflectance: white(), roughness: roughness.into() };
    let blend = scene::Bsdf::Blend {
        first: Box::new(plastic(0.3, false)),
        second: Box::new(scene::Bsdf::Blend { first: Box::new(rough_diffuse(0.7)), second: Box::new(conductor(0.4)), weight: 0.5.into() }),
        weight: 0.4.into(),
    };
    let beckmann = |alpha: f32| scene::Roughness { distribution: scene::Distribution::Beckmann, ..alpha.into() };
    let mirror = |alpha| scene::Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, reflectance: white(), alpha: beckmann(alpha) };
    let solid = |alpha| scene::Bsdf::Dielectric { eta: 1.5, alpha: beckmann(alpha), transmittance: white(), absorption: Rgb::BLACK };
    let varnish = |alpha| scene::Bsdf::Plastic { diffuse: white(), eta: 1.5, alpha: beckmann(alpha), specular: white(), nonlinear: true };
    let list = [
        (material("beckmann mirror 0.4", mirror(0.4)), false),
        (material("beckmann dielectric 0.3", solid(0.3)), false),
        (material("beckmann plastic 0.3", varnish(0.3)), false),
        (material("diffuse", scene::Bsdf::Diffuse { reflectance: white() }), true),
        (material("rough diffuse 0.5", rough_diffuse(0.5)), true),
        (material("rough diffuse 1", rough_diffuse(1.0)), true),
        (material("blend", blend), false),
        (material("mirror", conductor(0.0)), true),
        (material("conductor 0.1", conductor(0.1)), true),
        (material("conductor 0.6", conductor(0.6)), true),
        (material("conductor 1", conductor(1.0)), true),
        (material("dielectric", dielectric(0.0)), true),
        (material("dielectric 0.2", dielectric(0.2)), true),
        (material("dielectric 0.8", dielectric(0.8)), true),
        (material("thin", scene::Bsdf::ThinDielectric { eta: 1.5, transmittance: white() }), true),
        (material("plastic", plastic(0.0, true)), true),
        (material("plastic 0.15", plastic(0.15, true)), false),
        (material("plastic 0.5 linear", plastic(0.5, false)), false),
        (material("principled rough", principled(Principled::default())), true),
        (material("principled 0.3", principled(Principled { roughness: 0.3.into(), ..Principled::default() })), true),
        (material("principled specular 0", principled(Principled { specular: 0.0.into(), ..Principled::default() })), true),
        (
            material(
                "principled specular 0.4",
                principled(Principled { specular: 0.4.into(), roughness: 0.5.into(), ..Principled::default() }),
            ),
            true,
        ),
        (
            material("principled metal", principled(Principled { metallic: 1.0.into(), roughness: 0.5.into(), ..Principled::default() })),
            false,
        ),
        (
            material(
                "principled glass",
                principled(Principled { transmission: 1.0.into(), roughness: 0.4.into(), solid: true, ..Principled::default() }),
            ),
            false,
        ),
        (
            material(
                "principled velvet",
                principled(Principled { sheen_color: Rgb::splat(0.8).into(), sheen_roughness: 0.4.into(), ..Principled::default() }),
            ),
            false,
        ),
        (
            material(
                "principled thin",
                principled(Principled { transmission: 1.0.into(), roughness: 0.0.into(), ..Principled::default() }),
            ),
            true,
        ),
        (
            material(
                "principled frosted 0.3",
                principled(Principled { transmission: 1.0.into(), roughness: 0.3.into(), ..Principled::default() }),
            ),
            true,
        ),
        (
            material(
                "principled frosted 0.9",
                principled(Principled { transmission: 1.0.into(), roughness: 0.9.into(), ..Principled::default() }),
            ),
            true,
        ),
        (
            material(
                "principled half frosted",
                principled(Principled { transmission: 0.5.into(), roughness: 0.5.into(), metallic: 0.2.into(), ..Principled::default() }),
            ),
            false,
        ),
        (
            material(
                "principled everything",
                principled(Principled {
                    metallic: 0.3.into(),
                    roughness: 0.5.into(),
                    transmission: 0.3.into(),
                    clearcoat: 0.7.into(),
                    clearcoat_roughness: 0.3.into(),
                    sheen_color: Rgb::splat(0.5).into(),
                    sheen_roughness: 0.6.into(),
                    ..Principled::default()
                }),
            ),
            false,
        ),
    ];
    list.into_iter().map(|((name, material), full)| (name, material, full)).collect()
}

fn tables(material: &Material) -> Tables {
    TableMaker::default().tables(&material.bsdf)
}

fn direction(cos: f32) -> Vec3 {
    Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos)
}

fn for_each_case(mut test: impl FnMut(&str, &Bsdf<'_>, Vec3, bool)) {
    for (name, material, full) in models() {
        let (tables, textures) = (tables(&material), Textures::default());
        for (cos_o, outside) in [(0.95, true), (0.5, true), (0.15, true), (0.8, false)] {
            let inputs = Inputs { textures: &textures, uv: Vec2::ZERO, footprint: Footprint::POINT, tables: &tables, cos_o, outside };
            let bsdf = Bsdf::new(&material.bsdf, &inputs);
            test(&format!("{name}, cos {cos_o}, outside {outside}"), &bsdf, direction(cos_o), full);
        }
    }
}

/// Radiance is scaled by eta² across a border; the furnace counts power, so it undoes that.
fn power_of(name: &str, value: Rgb, wi: Vec3) -> f32 {
    let crosses = wi.z < 0.0 && (name.contains("dielectric") || name.contains("glass"));
    let eta2 = if name.contains("outside true") { 2.25 } else { 1.0 / 2.25 };
    value.g * if crosses { eta2 } else { 1.0 }
}

#[test]
fn white_furnace_no_model_creates_light_and_lossless_ones_lose_none() {
    for_each_case(|name, bsdf, wo, full| {
        let mut rng = Rng::new(3);
        let n = 40_000;
        let albedo = Mean::of((0..n).map(|_| {
            let u = [rng.next_f32(), rng.next_f32(), rng.next_f32()];
            bsdf.sample(wo, u).map_or(0.0, |s| f64::from(power_of(name, s.weight.total(bsdf.reflectance), s.wi)))
        }));
        // The coat's table interpolates to a fraction of a percent.
        let (mean, error) = (albedo.value(), 5.0 * albedo.standard_error() + 2e-3);
        assert!(mean <= 1.0 + error, "{name}: albedo {mean} ± {error}");
        assert!(mean >= if full { 0.985 } else { 0.42 }, "{name}: albedo {mean} ± {error}");
    });
}

#[test]
fn sampling_agrees_with_evaluation_and_density() {
    for_each_case(|name, bsdf, wo, _| {
        let mut rng = Rng::new(5);
        let n = 60_000;
        // Test functions over directions whose integral both ways must agree.
        let probes: [fn(Vec3) -> f64; 3] = [|_| 1.0, |w| f64::from(w.x + 0.3 * w.y).max(0.0), |w| if w.z < 0.0 { 1.0 } else { 0.0 }];
        let mut sampled = [const { Mean::EMPTY }; 3];
        let mut uniform = [const { Mean::EMPTY }; 3];
        let mut mass = 0.0f64;
        for _ in 0..n {
            let u = [rng.next_f32(), rng.next_f32(), rng.next_f32()];
            let s = bsdf.sample(wo, u).filter(|s| s.event == Event::Finite);
            let w = warp::sphere([rng.next_f32(), rng.next_f32()]);
            let sphere = 4.0 * std::f64::consts::PI;
            let value = f64::from(bsdf.eval(wo, w).total(bsdf.reflectance).g) * sphere;
            mass += f64::from(bsdf.pdf(wo, w)) * sphere / f64::from(n);
            for (k, probe) in probes.iter().enumerate() {
                sampled[k].add(s.map_or(0.0, |s| f64::from(s.weight.total(bsdf.reflectance).g) * probe(s.wi)));
                uniform[k].add(value * probe(w));
            }
        }
        assert!(mass < 1.25, "{name}: density integrates to {mass}");
        for (k, (sampled, uniform)) in sampled.iter().zip(&uniform).enumerate() {
            sampled.assert_agrees(&format!("{name}, probe {k}"), uniform, models().len() * 12);
        }
    });
}

#[test]
fn reflection_is_reciprocal() {
    let mut rng = Rng::new(9);
    for (name, material, _) in models() {
        let (tables, textures) = (tables(&material), Textures::default());
        for _ in 0..200 {
            let mut up = || warp::cosine_hemisphere([rng.next_f32(), rng.next_f32()]);
            let (a, b) = (up(), up());
            if a.z < 0.05 || b.z < 0.05 {
                continue;
            }
            let value = |wo: Vec3, wi: Vec3| {
                let inputs = Inputs {
                    textures: &textures,
                    uv: Vec2::ZERO,
                    footprint: Footprint::POINT,
                    tables: &tables,
                    cos_o: wo.z,
                    outside: true,
                };
                let bsdf = Bsdf::new(&material.bsdf, &inputs);
                bsdf.eval(wo, wi).total(bsdf.reflectance).g / wi.z
            };
            let (ab, ba) = (value(a, b), value(b, a));
            // The scales of further bounces and of the sheen under a clear-coat follow the viewing direction only.
            if !["conductor", "dielectric", "metal", "glass", "frosted", "everything", "blend"].iter().any(|one_way| name.contains(one_way))
            {
                assert!((ab - ba).abs() <= 2e-3 * ab.max(ba) + 1e-5, "{name}: {ab} against {ba}");
            }
        }
    }
}

#[test]
fn every_sampler_draws_from_its_density() {
    use enfilade_testkit::ChiSquare;
    // Narrower lobes than the cells of the test are covered by the comparison with evaluation above.
    let tests = models().len() * 4;
    for_each_case(|name, bsdf, wo, _| {
        let finite = |u: [f32; 3]| bsdf.sample(wo, u).filter(|s| s.event == Event::Finite).map(|s| s.wi);
        if name.contains("0.1,") || name.contains("plastic 0.15") {
            return;
        }
        ChiSquare::directions(60_000, finite, |w| bsdf.pdf(wo, w)).assert(name, tests);
    });
}

/// Mitsuba 3.9.1: `roughplastic` and `plastic` of index 1.5, GGX, evaluated over the cosine, times π, for the base alone.
#[test]
fn plastic_has_the_values_of_mitsuba() {
    let cosines = [(1.0, 1.0), (0.5, 0.7), (0.1, 0.3)];
    let cases = [
        (0.0, 0.5, false, [1.015_901, 0.952_889, 0.374_132]),
        (0.05, 0.5, false, [0.966_184, 0.903_849, 0.426_875]),
        (0.05, 0.9, true, [0.850_585, 0.795_708, 0.375_801]),
        (0.2, 0.5, false, [0.792_755, 0.729_258, 0.502_749]),
        (0.2, 0.9, true, [0.724_199, 0.666_193, 0.459_272]),
        (0.5, 0.5, false, [0.553_323, 0.470_180, 0.293_573]),
        (0.5, 0.9, true, [0.531_611, 0.451_731, 0.282_054]),
    ];
    for (alpha, diffuse, nonlinear, expected) in cases {
        let (diffuse, specular) = (Rgb::splat(diffuse).into(), Rgb::WHITE.into());
        let material = Material::new("plastic", scene::Bsdf::Plastic { diffuse, eta: 1.5, alpha: alpha.into(), specular, nonlinear });
        let (tables, textures) = (tables(&material), Textures::default());
        for ((cos_o, cos_i), expected) in cosines.into_iter().zip(expected) {
            let inputs = Inputs { textures: &textures, uv: Vec2::ZERO, footprint: Footprint::POINT, tables: &tables, cos_o, outside: true };
            let value =
                Bsdf::new(&material.bsdf, &inputs).eval(direction(cos_o), direction(cos_i)).diffuse.g * std::f32::consts::PI / cos_i;
            assert!((value - expected).abs() < 5e-3 * expected, "alpha {alpha}, cosines {cos_o} {cos_i}: {value}, expected {expected}");
        }
    }
}

/// Values of a material for four pairs of directions.
type FourValues = [f32; 4];

/// Mitsuba 3.9.1, `eval` of `roughplastic` (linear and not) of index 1.5 over 0.7, of `roughconductor` of 0.4 + 2.4i, and of
/// `roughdielectric` of index 1.5, all with `beckmann`.
#[test]
fn beckmanns_facets_have_the_values_of_mitsuba() {
    let turned = |cos: f32, phi: f32, side: f32| {
        let sin = (1.0 - cos * cos).sqrt();
        Vec3::new(sin * phi.cos(), sin * phi.sin(), side * cos)
    };
    let above = [(1.0, 0.9, 2.0, 1.0), (0.6, 0.5, 2.5, 1.0), (0.3, 0.4, 3.0, 1.0), (0.8, 0.7, 0.5, 1.0)];
    let both = [(1.0, 0.9, 2.0, -1.0), (0.6, 0.8, 3.0, -1.0), (0.8, 0.7, 2.9, 1.0), (0.8, 0.9, 3.1, -1.0)];
    let cases: [(f32, [FourValues; 3], [FourValues; 2]); 3] = [
        (
            0.1,
            [[0.19765, 0.100_344, 0.161_788, 0.149_916], [0.140_127, 0.070_868, 0.142_695, 0.105_878], [0.0362, 0.0, 0.489_307, 0.0]],
            [[0.0, 0.103_987, 0.088_399, 31.263_483], [0.0, 0.0, 0.672_259, 0.0]],
        ),
        (
            0.3,
            [
                [0.1961, 0.098_615, 0.385_876, 0.132_312],
                [0.152_059, 0.076_399, 0.37054, 0.098_879],
                [0.432_765, 0.135_392, 1.643_987, 0.000_862],
            ],
            [[0.0, 4.790_527, 0.043_929, 9.936_801], [0.032_986, 0.0, 0.334_073, 0.0]],
        ),
        (
            0.6,
            [
                [0.142_192, 0.08566, 0.140_038, 0.104_391],
                [0.120_401, 0.074_602, 0.131_813, 0.0881],
                [0.167_754, 0.224_894, 0.452_776, 0.087_569],
            ],
            [[0.000_687, 2.095_261, 0.012_638, 2.741_441], [0.670_442, 0.0, 0.09611, 0.091_425]],
        ),
    ];
    for (alpha, upper, glass) in cases {
        let alpha = scene::Roughness { distribution: scene::Distribution::Beckmann, ..alpha.into() };
        let (diffuse, white) = (Rgb::splat(0.7).into(), || Rgb::WHITE.into());
        let plastic = |nonlinear| scene::Bsdf::Plastic { diffuse, eta: 1.5, alpha, specular: white(), nonlinear };
        let metal = scene::Bsdf::Conductor { eta: Rgb::splat(0.4), k: Rgb::splat(2.4), reflectance: white(), alpha };
        let body = || scene::Bsdf::Dielectric { eta: 1.5, alpha, transmittance: white(), absorption: Rgb::BLACK };
        let opaque = [plastic(false), plastic(true), metal].map(|bsdf| (bsdf, true, above));
        let all = opaque.into_iter().chain([(body(), true, both), (body(), false, both)]);
        for ((bsdf, outside, directions), expected) in all.zip(upper.into_iter().chain(glass)) {
            let material = Material::new("beckmann", bsdf);
            let (tables, textures) = (tables(&material), Textures::default());
            for ((cos_o, cos_i, phi, side), expected) in directions.into_iter().zip(expected) {
                let inputs = Inputs { textures: &textures, uv: Vec2::ZERO, footprint: Footprint::POINT, tables: &tables, cos_o, outside };
                let bsdf = Bsdf::new(&material.bsdf, &inputs);
                let value = bsdf.eval(direction(cos_o), turned(cos_i, phi, side)).total(bsdf.reflectance).g;
                // Mitsuba's table of the coat's transmittance has an error of its own.
                let tolerance = 8e-3 * expected + 2e-6;
                assert!((value - expected).abs() < tolerance, "{:?}, {cos_o} {cos_i}: {value}, expected {expected}", material.bsdf);
            }
        }
    }
}

#[test]
fn albedo_is_about_what_sampling_finds() {
    for_each_case(|name, bsdf, wo, _| {
        let mut rng = Rng::new(4);
        let n = 20_000;
        let mut sampled = Mean::EMPTY;
        for _ in 0..n {
            let u = [rng.next_f32(), rng.next_f32(), rng.next_f32()];
            sampled.add(bsdf.sample(wo, u).map_or(0.0, |s| f64::from(power_of(name, s.weight.total(bsdf.reflectance), s.wi))));
        }
        let albedo = bsdf.albedo(wo.z);
        let fraction = albedo.blurred_fraction();
        let albedo = f64::from((albedo.blurred() + albedo.sharp).g);
        // Rough plastics lose light between their facets.
        let tolerance = if name.contains("0.5 linear") { 0.5 } else { 0.25 };
        assert!((albedo - sampled.value()).abs() < tolerance, "{name}: albedo {albedo}, sampled {}", sampled.value());
        assert!((0.0..=1.0).contains(&fraction), "{name}: fraction {fraction}");
    });
}

#[test]
fn what_is_sharp_is_what_sampling_finds_in_single_directions() {
    let mut with = [0; 2];
    for_each_case(|name, bsdf, wo, _| {
        let sharp = bsdf.sharp(wo);
        let (mut rng, mut mirrored, mut through) = (Rng::new(6), Mean::EMPTY, Mean::EMPTY);
        for _ in 0..20_000 {
            let u = [rng.next_f32(), rng.next_f32(), rng.next_f32()];
            let single = bsdf.sample(wo, u).filter(|s| s.event != Event::Finite);
            let power = single.map_or(0.0, |s| f64::from(power_of(name, s.weight.specular, s.wi)));
            let crosses = single.is_some_and(|s| s.wi.z < 0.0);
            mirrored.add(if crosses { 0.0 } else { power });
            through.add(if crosses { power } else { 0.0 });
            if let Some(s) = single {
                let expected = if crosses { sharp.bent.unwrap_or(-wo) } else { Vec3::new(-wo.x, -wo.y, wo.z) };
                assert!(s.wi.distance(expected) < 1e-5, "{name}: {} sampled, {expected} said", s.wi);
            }
        }
        for (way, sampled, said) in [(0, mirrored, sharp.mirrored), (1, through, sharp.through)] {
            let error = (sampled.value() - f64::from(said.g)).abs();
            assert!(error <= 5.0 * sampled.standard_error() + 1e-3, "{name}: {} sampled, {} said", sampled.value(), said.g);
            with[way] += usize::from(said.g > 0.0);
        }
    });
    assert!(with[0] >= 16 && with[1] >= 8, "{with:?}");
}

#[test]
fn metals_and_clear_glasses_keep_all_light_at_every_roughness_and_angle() {
    let white = || Rgb::WHITE.into();
    for alpha in [0.01, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 1.0] {
        let conductor = scene::Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, reflectance: white(), alpha: alpha.into() };
        let dielectric = scene::Bsdf::Dielectric { eta: 1.5, alpha: alpha.into(), transmittance: white(), absorption: Rgb::BLACK };
        for (name, bsdf) in [("conductor", conductor), ("dielectric", dielectric)] {
            let material = Material::new(name, bsdf);
            let (tables, textures) = (tables(&material), Textures::default());
            for (cos_o, outside) in [1.0, 0.8, 0.5, 0.3, 0.2, 0.1, 0.05].into_iter().flat_map(|c| [(c, true), (c, false)]) {
                let inputs = Inputs { textures: &textures, uv: Vec2::ZERO, footprint: Footprint::POINT, tables: &tables, cos_o, outside };
                let bsdf = Bsdf::new(&material.bsdf, &inputs);
                let label = format!("{name} {alpha}, cosine {cos_o}, outside {outside}");
                let mut rng = Rng::new(8);
                let kept = Mean::of((0..20_000).map(|_| {
                    let u = [rng.next_f32(), rng.next_f32(), rng.next_f32()];
                    bsdf.sample(direction(cos_o), u).map_or(0.0, |s| f64::from(power_of(&label, s.weight.specular, s.wi)))
                }));
                let (kept, error) = (kept.value(), 4.0 * kept.standard_error());
                assert!((kept - 1.0).abs() < 0.01 + error, "{label}: {kept} ± {error}");
            }
        }
    }
}

#[test]
fn tiles_under_plastic_reflect_as_much_to_wide_rays_as_their_halves_do() {
    // A picture of one black and one white texel; half the readings find each.
    let pixels = scene::Pixels::RgbF32(vec![[0.0; 3], [1.0; 3]]);
    let images = [scene::Image { name: "tiles".into(), width: 2, height: 1, pixels }.into()];
    let tiles = scene::TextureRef { filter: scene::Filter::Nearest, ..scene::TextureRef::new(0) };
    for nonlinear in [false, true] {
        let plastic = |diffuse| {
            let bsdf = scene::Bsdf::Plastic { diffuse, eta: 1.5, alpha: 0.0.into(), specular: Rgb::WHITE.into(), nonlinear };
            Material::new("tiles", bsdf)
        };
        let reflected = |material: &Material, u: f32, area: f32| {
            let (tables, textures) = (tables(material), Textures::new(&images, std::slice::from_ref(material)));
            let footprint = Footprint { area, sharp: true };
            let inputs = Inputs { textures: &textures, uv: Vec2::new(u, 0.5), footprint, tables: &tables, cos_o: 0.8, outside: true };
            let bsdf = Bsdf::new(&material.bsdf, &inputs);
            bsdf.eval_pdf(direction(0.8), direction(0.6)).0.total(bsdf.reflectance).g
        };
        let tiled = plastic(scene::ColorParam { factor: Rgb::WHITE, texture: Some(tiles) });
        let wide = 0.5 * (reflected(&tiled, 0.25, 1.0) + reflected(&tiled, 0.75, 1.0));
        let halves = 0.5 * (reflected(&plastic(Rgb::BLACK.into()), 0.5, 0.0) + reflected(&plastic(Rgb::WHITE.into()), 0.5, 0.0));
        assert!((wide - halves).abs() < 1e-5 * halves, "nonlinear {nonlinear}: {wide} for {halves}");
    }
}

/// KHR_materials_transmission: what passes a rough thin surface is (1 − F) · base · D · V, with the halfway vector of the viewing direction and
/// the incident one mirrored to its side.
#[test]
fn frosted_sheets_transmit_by_the_formula_of_gltf() {
    let (roughness, ior, base) = (0.25f32, 1.5f32, 0.6f32);
    let bsdf = scene::Bsdf::Principled(Box::new(Principled {
        base_color: Rgb::splat(base).into(),
        roughness: roughness.into(),
        transmission: 1.0.into(),
        ..Principled::default()
    }));
    let material = Material::new("frosted", bsdf);
    let (tables, textures) = (tables(&material), Textures::default());
    for (cos_o, wi) in [(0.9f32, Vec3::new(-0.3, 0.1, -0.8)), (0.6, Vec3::new(-0.9, 0.2, -0.7)), (0.6, Vec3::new(0.3, 0.0, -0.9))] {
        let (wo, wi) = (direction(cos_o), wi.normalize());
        let inputs = Inputs { textures: &textures, uv: Vec2::ZERO, footprint: Footprint::POINT, tables: &tables, cos_o, outside: true };
        let found = f64::from(Bsdf::new(&material.bsdf, &inputs).eval(wo, wi).specular.g);

        let (v, l) = (wo.as_dvec3(), Vec3::new(wi.x, wi.y, -wi.z).as_dvec3());
        let h = (v + l).normalize();
        let a2 = f64::from(roughness).powi(4);
        let d = a2 / (std::f64::consts::PI * (h.z * h.z * (a2 - 1.0) + 1.0).powi(2));
        let smith = |a: f64, b: f64| a * (b * b * (1.0 - a2) + a2).sqrt();
        let visible = 0.5 / (smith(l.z, v.z) + smith(v.z, l.z));
        // Both faces of the sheet reflect, by Fresnel's equations and with all inner reflections.
        let (cos_i, eta) = (v.dot(h), f64::from(ior));
        let cos_t = (1.0 - (1.0 - cos_i * cos_i) / (eta * eta)).sqrt();
        let across = ((cos_i - eta * cos_t) / (cos_i + eta * cos_t)).powi(2);
        let along = ((eta * cos_i - cos_t) / (eta * cos_i + cos_t)).powi(2);
        let r = 0.5 * (across + along);
        let expected = (1.0 - 2.0 * r / (1.0 + r)) * f64::from(base) * d * visible * l.z;
        // Light that bounces between facets adds a little.
        assert!(found >= expected * 0.999 && found <= expected * 1.03, "cosine {cos_o}, {wi}: {found}, by the formula {expected}");
    }
}

/// KHR_materials_specular mixes with the weight specular × Fresnel: without it the base is all there is.
#[test]
fn what_the_specular_factor_takes_from_the_coat_reaches_the_base() {
    let furnace = |specular: f32, tint: Rgb| {
        let bsdf = Principled {
            base_color: Rgb::splat(0.5).into(),
            specular: specular.into(),
            specular_color: tint.into(),
            ..Principled::default()
        };
        let material = Material::new("dull", scene::Bsdf::Principled(Box::new(bsdf)));
        let (tables, textures) = (tables(&material), Textures::default());
        let inputs =
            Inputs { textures: &textures, uv: Vec2::ZERO, footprint: Footprint::POINT, tables: &tables, cos_o: 0.6, outside: true };
        let bsdf = Bsdf::new(&material.bsdf, &inputs);
        let mut rng = Rng::new(3);
        let albedo = Mean::of((0..100_000).map(|_| {
            let u = [rng.next_f32(), rng.next_f32(), rng.next_f32()];
            bsdf.sample(direction(0.6), u).map_or(0.0, |s| f64::from(s.weight.total(bsdf.reflectance).g))
        }));
        (albedo.value(), 4.0 * albedo.standard_error())
    };
    let ((whole, a), (half, b)) = (furnace(1.0, Rgb::WHITE), furnace(0.5, Rgb::WHITE));
    for (none, error) in [furnace(0.0, Rgb::WHITE), furnace(1.0, Rgb::BLACK)] {
        assert!((none - 0.5).abs() < error + 1e-4, "{none}");
        assert!((half - 0.5 * (whole + none)).abs() < a + b + error, "{half} between {none} and {whole}");
    }
}

/// Chrome is often written as a coat of an index of refraction in the hundreds.
#[test]
fn coats_of_very_high_index_stay_finite_and_reflect_what_their_transmittance_says() {
    for (ior, roughness, base) in [(100.0, 0.0, 0.5), (999.0, 0.0, 0.0), (999.0, 0.3, 0.5), (999.0, 0.0, 1.0), (1e30, 0.3, 1.0)] {
        let bsdf = scene::Bsdf::Principled(Box::new(Principled {
            base_color: Rgb::splat(base).into(),
            ior,
            roughness: f32::into(roughness),
            ..Principled::default()
        }));
        let material = Material::new("chrome", bsdf);
        let (tables, textures) = (tables(&material), Textures::default());
        for cos_o in [0.9, 0.3] {
            let inputs = Inputs { textures: &textures, uv: Vec2::ZERO, footprint: Footprint::POINT, tables: &tables, cos_o, outside: true };
            let bsdf = Bsdf::new(&material.bsdf, &inputs);
            let mut rng = Rng::new(3);
            let albedo = Mean::of((0..20_000).map(|_| {
                let u = [rng.next_f32(), rng.next_f32(), rng.next_f32()];
                bsdf.sample(direction(cos_o), u).map_or(0.0, |s| {
                    let value = f64::from(s.weight.total(bsdf.reflectance).g);
                    assert!(value.is_finite(), "ior {ior}, roughness {roughness}, base {base}");
                    value
                })
            }));
            // Nearly all is reflected, and nothing is made.
            let (mean, error) = (albedo.value(), 5.0 * albedo.standard_error() + 2e-3);
            assert!((0.95..=1.0 + error).contains(&mean), "ior {ior}, roughness {roughness}, base {base}: {mean} ± {error}");
        }
    }
}
