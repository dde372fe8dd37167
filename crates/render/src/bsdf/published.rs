//! Every lobe against the published formula, written again in double precision and integrated on a grid.
//!
//! Formulas here are values *without* the cosine; [`albedo`] multiplies by it. Nothing is shared with the lobes but the meaning of their
//! parameters, so that a factor which a lobe forgets in its value, its density and its tables alike shows here.

use super::coat::{Bounces, CoatSpec, CoatTable};
use super::coated::Coated;
use super::ggx::Facets;
use super::rough_diffuse::RoughDiffuse;
use super::sheen::Sheen;
use super::*;
use enfilade_math::{DVec3, Rng};
use enfilade_scene as scene;
use enfilade_testkit::Mean;
use std::f64::consts::PI;

/// Viewing cosines.
const COSINES: [f64; 4] = [0.91, 0.6, 0.45, 0.2];

fn viewer(cos: f64) -> DVec3 {
    DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos)
}

/// ∫ f |cosθ| dω over the upper hemisphere, or with `below` over the lower one.
fn albedo(f: impl Fn(DVec3) -> f64, below: bool) -> f64 {
    let n = 300;
    let middle = |i: usize| (i as f64 + 0.5) / n as f64;
    let mut sum = 0.0;
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        // z = t², which puts more points at the horizon.
        let (z, phi) = (middle(i).powi(2), PI * middle(j));
        let sin = (1.0 - z * z).sqrt();
        let wi = DVec3::new(sin * phi.cos(), sin * phi.sin(), if below { -z } else { z });
        sum += f(wi) * z * 2.0 * middle(i);
    }
    sum * 2.0 * PI / (n * n) as f64
}

/// The lobe's values at many directions, and the mean of its samples, against `f`: pairs of the diffuse part for a reflectance of one,
/// and of everything else.
fn assert_is_published(name: &str, lobe: &Lobe<'_>, wo: DVec3, tolerance: f64, f: impl Fn(DVec3) -> [f64; 2]) {
    let mut rng = Rng::new(11);
    let view = wo.as_vec3();
    let transmits = matches!(lobe, Lobe::Refraction { .. });
    for _ in 0..400 {
        let wi = enfilade_math::warp::sphere([rng.next_f32(), rng.next_f32()]).as_dvec3();
        if wi.z < 0.01 && !(transmits && wi.z < -0.01) {
            continue;
        }
        let (value, _) = lobe.eval_pdf(view, wi.as_vec3());
        for (ours, published) in [f64::from(value.diffuse.g), f64::from(value.specular.g)].into_iter().zip(f(wi)) {
            let published = published * wi.z.abs();
            assert!((ours - published).abs() <= tolerance * published + 1e-6, "{name}, {wo} to {wi}: {ours}, published {published}");
        }
    }
    let integral = |part: usize| albedo(|wi| f(wi)[part], false) + if transmits { albedo(|wi| f(wi)[part], true) } else { 0.0 };
    let sampled = |part: fn(Value) -> Rgb| {
        let mut rng = Rng::new(12);
        Mean::of((0..60_000).map(|_| {
            let u = [rng.next_f32(), rng.next_f32(), rng.next_f32()];
            lobe.sample(view, u).map_or(0.0, |s| f64::from(part(s.weight).g))
        }))
    };
    for (sampled, integral) in [(sampled(|v| v.diffuse), integral(0)), (sampled(|v| v.specular), integral(1))] {
        let error = 5.0 * sampled.standard_error() + tolerance * integral + 2e-4;
        assert!((sampled.value() - integral).abs() < error, "{name}, {wo}: albedo {} ± {error}, published {integral}", sampled.value());
    }
}

fn dielectric(cos_i: f64, eta: f64) -> f64 {
    let sin2_t = (1.0 - cos_i * cos_i) / (eta * eta);
    if sin2_t >= 1.0 {
        return 1.0;
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    let (s, p) = ((cos_i - eta * cos_t) / (cos_i + eta * cos_t), (eta * cos_i - cos_t) / (eta * cos_i + cos_t));
    0.5 * (s * s + p * p)
}

/// Walter et al. 2007, equation 33.
fn ggx(m: DVec3, alpha: f64) -> f64 {
    let tan2 = (1.0 - m.z * m.z) / (m.z * m.z);
    alpha * alpha / (PI * m.z.powi(4) * (alpha * alpha + tan2).powi(2))
}

/// Heitz 2014, equation 72.
fn lambda(cos: f64, alpha: f64) -> f64 {
    0.5 * ((1.0 + alpha * alpha * (1.0 - cos * cos) / (cos * cos)).sqrt() - 1.0)
}

/// Cook & Torrance's reflection with Heitz's height-correlated masking (2014, equation 99), for a reflectance of `fresnel`.
fn reflection(wo: DVec3, wi: DVec3, alpha: f64, fresnel: impl Fn(f64) -> f64) -> f64 {
    let m = (wo + wi).normalize();
    fresnel(wo.dot(m)) * ggx(m, alpha) / (1.0 + lambda(wo.z, alpha) + lambda(wi.z, alpha)) / (4.0 * wo.z * wi.z)
}

#[test]
fn lamberts_law() {
    for cos in COSINES {
        assert_is_published("lambert", &Lobe::Lambert, viewer(cos), 1e-6, |_| [1.0 / PI, 0.0]);
    }
}

/// Portsmouth, Kutz & Hill 2024, equations 13 to 26, with the exact albedo.
#[test]
fn rough_diffuse() {
    let (rho, r) = (0.6, 0.8);
    let a = 1.0 / (1.0 + (0.5 - 2.0 / (3.0 * PI)) * r);
    let g = |cos: f64| {
        let (theta, sin) = (cos.acos(), (1.0 - cos * cos).sqrt());
        sin * (theta - sin * cos - 2.0 / 3.0) + 2.0 / 3.0 * (sin / cos) * (1.0 - sin.powi(3))
    };
    let once = |cos: f64| a * (1.0 + r * g(cos) / PI);
    let mean = a * (1.0 + (2.0 / 3.0 - 28.0 / (15.0 * PI)) * r);
    for cos in COSINES {
        let wo = viewer(cos);
        let f = |wi: DVec3| {
            let s = wo.x * wi.x + wo.y * wi.y;
            let s_over_t = if s > 0.0 { s / wo.z.max(wi.z) } else { s };
            let single = rho / PI * a * (1.0 + r * s_over_t);
            let further = rho * rho * mean / (1.0 - rho * (1.0 - mean)) / PI * (1.0 - once(wo.z)) * (1.0 - once(wi.z)) / (1.0 - mean);
            [(single + further) / rho, 0.0]
        };
        let lobe = Lobe::RoughDiffuse(RoughDiffuse::new(Rgb::splat(0.6), 0.8, cos as f32));
        assert_is_published("rough diffuse", &lobe, wo, 3e-3, f);
    }
}

#[test]
fn reflection_at_rough_metals_and_dielectrics() {
    let schlick = |cos: f64| 0.3 + 0.7 * (1.0 - cos).powi(5);
    let gold = |cos: f64| {
        // Born & Wolf: complex Fresnel equations by their moduli, written with complex numbers.
        let (eta, k) = (0.4, 2.4);
        let (re, im) = (eta * eta - k * k - (1.0 - cos * cos), 2.0 * eta * k);
        let modulus = (re * re + im * im).sqrt();
        let (u, v) = ((0.5 * (modulus + re)).sqrt(), (0.5 * (modulus - re)).sqrt());
        let (n2_re, n2_im) = (eta * eta - k * k, 2.0 * eta * k);
        let ratio = |a: f64, b: f64, c: f64, d: f64| (a * a + b * b) / (c * c + d * d);
        let s = ratio(cos - u, -v, cos + u, v);
        let p = ratio(n2_re * cos - u, n2_im * cos - v, n2_re * cos + u, n2_im * cos + v);
        0.5 * (s + p)
    };
    let (eta, k) = (Rgb::splat(0.4), Rgb::splat(2.4));
    let cases: [(Fresnel<'_>, &dyn Fn(f64) -> f64); 3] = [
        (Fresnel::Schlick { f0: Rgb::splat(0.3) }, &schlick),
        (Fresnel::Conductor { eta: &eta, k: &k }, &gold),
        (Fresnel::Dielectric { eta: 1.5 }, &|cos| dielectric(cos, 1.5)),
    ];
    for ((fresnel, published), cos, alpha) in cases.into_iter().flat_map(|case| COSINES.map(move |cos| (case, cos, 0.35))) {
        let (wo, facets) = (viewer(cos), Facets::new(alpha as f32, cos as f32));
        let lobe = Lobe::Reflection { facets, fresnel, tint: Rgb::splat(0.8) };
        assert_is_published(&format!("{fresnel:?}"), &lobe, wo, 2e-3, |wi| [0.0, 0.8 * reflection(wo, wi, alpha, published)]);
    }
}

/// Turquin 2019, equation 16: a white metal is what one bounce sends out over its albedo.
#[test]
fn further_bounces_of_metals() {
    for (alpha, cos) in [0.3, 0.6, 1.0].into_iter().flat_map(|alpha| COSINES.map(|cos| (alpha, cos))) {
        let wo = viewer(cos);
        let kept = albedo(|wi| reflection(wo, wi, alpha, |_| 1.0), false);
        let scale = f64::from(energy::of_metal(cos as f32, alpha as f32, Rgb::WHITE).g);
        assert!((scale * kept - 1.0).abs() < 4e-3, "alpha {alpha}, cosine {cos}: {scale} × {kept}");
    }
}

/// Walter et al. 2007, equations 20 and 21, with height-correlated masking; transmitted radiance is compressed by eta².
#[test]
fn refraction() {
    for (eta, cos) in [1.5, 1.0 / 1.5].into_iter().flat_map(|eta| COSINES.map(|cos| (eta, cos))) {
        let (wo, alpha, tint) = (viewer(cos), 0.4, 0.7);
        let f = |wi: DVec3| {
            if wi.z > 0.0 {
                return [0.0, reflection(wo, wi, alpha, |cos| dielectric(cos, eta))];
            }
            let h = -(wo + eta * wi);
            let m = h.normalize() * if h.z < 0.0 { -1.0 } else { 1.0 };
            let (o, i) = (wo.dot(m), wi.dot(m));
            if o <= 0.0 || i >= 0.0 {
                return [0.0, 0.0];
            }
            let masking = 1.0 / (1.0 + lambda(wo.z, alpha) + lambda(wi.z.abs(), alpha));
            let common = (o * i / (wo.z * wi.z)).abs() * eta * eta * (1.0 - dielectric(o, eta)) * masking * ggx(m, alpha);
            [0.0, tint * common / (o + eta * i).powi(2) / (eta * eta)]
        };
        let facets = Facets::new(alpha as f32, cos as f32);
        let lobe = Lobe::Refraction { facets, eta: eta as f32, tint: Rgb::splat(tint as f32), scale: 1.0 };
        assert_is_published(&format!("refraction {eta}"), &lobe, wo, 1e-2, f);
    }
}

/// Airy's sum without interference: r + (1 − r)² r / (1 − r²) is reflected, the rest transmitted.
#[test]
fn thin_panes() {
    for cos in COSINES {
        let (r, mut rng) = (dielectric(cos, 1.5), Rng::new(3));
        let (mut reflected, mut transmitted) = (Mean::EMPTY, Mean::EMPTY);
        for _ in 0..40_000 {
            let lobe = Lobe::Thin { facets: Facets::new(0.0, cos as f32), eta: 1.5, tint: Rgb::splat(0.5), scale: 1.0 };
            let s = lobe.sample(viewer(cos).as_vec3(), [0.0, 0.0, rng.next_f32()]).expect("it loses nothing");
            let value = f64::from(s.weight.specular.g);
            reflected.add(if s.wi.z > 0.0 { value } else { 0.0 });
            transmitted.add(if s.wi.z > 0.0 { 0.0 } else { value });
        }
        let published = r + (1.0 - r).powi(2) * r / (1.0 - r * r);
        reflected.assert_is("reflected by a pane", published, 8);
        transmitted.assert_is("transmitted by a pane", 0.5 * (1.0 - published), 8);
    }
}

/// Ashikhmin & Shirley's coupling (2000) with the coat's own transmittance: the base sees what the coat does not reflect in one bounce.
#[test]
fn base_under_a_coat() {
    let (eta, alpha, rho) = (1.5, 0.3, 0.6);
    let through = |cos: f64| 1.0 - albedo(|wi| reflection(viewer(cos), wi, alpha, |c| dielectric(c, eta)), false);
    let table: Vec<f64> = (0..=64).map(|i| through((f64::from(i) / 64.0).max(1e-3))).collect();
    let interpolated = |cos: f64| {
        let i = ((cos * 64.0) as usize).min(63);
        let fraction = cos * 64.0 - i as f64;
        table[i] * (1.0 - fraction) + table[i + 1] * fraction
    };
    let mean = albedo(|wi| interpolated(wi.z) / PI, false);
    // By reciprocity the base's light escapes as well as diffuse light enters, over eta².
    let escapes = mean / (eta * eta);
    let coats = CoatTable::new(CoatSpec { eta: 1.5, alpha: Some(0.3), distribution: scene::Distribution::Ggx, bounces: Bounces::All });
    for cos in COSINES {
        let wo = viewer(cos);
        let through_o = through(cos);
        let base = |wi: DVec3| through_o * interpolated(wi.z) / (PI * eta * eta) / (1.0 - rho * (1.0 - escapes));
        let f = |wi: DVec3| [base(wi), reflection(wo, wi, alpha, |c| dielectric(c, eta))];
        let lobe = Coated::new(coats.at(0.3), 0.3, Rgb::splat(0.6), Rgb::WHITE, true, 1.0, cos as f32);
        assert_is_published("coated", &Lobe::Coated(lobe), wo, 6e-3, f);
    }
}

/// `KHR_materials_sheen`, section "Sheen BRDF" with the visibility of Neubelt & Pettineo.
fn sheen(wo: DVec3, wi: DVec3, roughness: f64) -> f64 {
    let cos = (wo + wi).normalize().z;
    let inverse = 1.0 / (roughness * roughness);
    let d = (2.0 + inverse) * (1.0 - cos * cos).max(0.0).powf(0.5 * inverse) / (2.0 * PI);
    d / (4.0 * (wi.z + wo.z - wi.z * wo.z))
}

#[test]
fn fuzz_of_cloth() {
    // By another integration: 0.0547 and 0.2617 at a roughness of 0.5.
    assert!((albedo(|wi| sheen(viewer(0.91), wi, 0.5), false) - 0.0547).abs() < 1e-4);
    assert!((albedo(|wi| sheen(viewer(0.45), wi, 0.5), false) - 0.2617).abs() < 2e-4);
    for (roughness, cos) in [0.2, 0.5, 0.8, 1.0].into_iter().flat_map(|r| COSINES.map(|cos| (r, cos))) {
        let (wo, fuzz) = (viewer(cos), Sheen::new(roughness as f32, Rgb::splat(0.7), cos as f32));
        assert_is_published("sheen", &Lobe::Sheen(fuzz), wo, 1e-3, |wi| [0.0, 0.7 * sheen(wo, wi, roughness)]);
        let (known, table) =
            (albedo(|wi| sheen(wo, wi, roughness), false), f64::from(super::sheen::unit_albedo(cos as f32, roughness as f32)));
        assert!((known - table).abs() < 0.02 * known + 2e-3, "roughness {roughness}, cosine {cos}: {table}, expected {known}");
    }
}

/// Layers under sheen get the light that sheen does not reflect in either direction; the clear-coat above takes Fresnel's share both ways.
#[test]
fn layers_dim_what_is_below() {
    let e = |cos: f64| albedo(|wi| sheen(viewer(cos), wi, 0.5), false);
    for (o, i) in [(0.91, 0.45), (0.45, 0.91), (0.6, 0.2), (0.2, 0.2)] {
        let cloth = Layers { clearcoat: 0.0, sheen: 0.7, sheen_roughness: 0.5 };
        let published = (1.0 - 0.7 * e(o)).min(1.0 - 0.7 * e(i));
        assert!((f64::from(cloth.passes(o as f32, i as f32)) - published).abs() < 3e-3, "cosines {o} {i}");
        let varnish = Layers { clearcoat: 0.6, sheen: 0.0, sheen_roughness: 0.5 };
        let published = (1.0 - 0.6 * dielectric(o, 1.5)) * (1.0 - 0.6 * dielectric(i, 1.5));
        assert!((f64::from(varnish.passes(o as f32, i as f32)) - published).abs() < 1e-5, "cosines {o} {i}");
    }
}
