//! Fresnel's equations: how much light a smooth interface reflects.

use enfilade_math::Rgb;

/// Reflectance of an interface between dielectrics, and the cosine of the refracted direction (0 at total reflection).
///
/// `cos_i` ≥ 0 is the cosine on the incident side, `eta` the index beyond the interface over the index before it.
#[inline]
pub fn dielectric(cos_i: f32, eta: f32) -> (f32, f32) {
    let sin2_t = (1.0 - cos_i * cos_i) / (eta * eta);
    if sin2_t >= 1.0 {
        return (1.0, 0.0);
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    let parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    (0.5 * (parallel * parallel + perpendicular * perpendicular), cos_t)
}

/// Reflectance of a metal with complex index `eta` + i `k`, seen from air; both zero means a perfect mirror.
#[inline]
pub fn conductor(cos_i: f32, eta: Rgb, k: Rgb) -> Rgb {
    let channel = |eta: f32, k: f32| {
        if eta == 0.0 && k == 0.0 {
            return 1.0;
        }
        let (c2, s2) = (cos_i * cos_i, 1.0 - cos_i * cos_i);
        let (eta2, k2) = (eta * eta, k * k);
        let t0 = eta2 - k2 - s2;
        let a2_plus_b2 = (t0 * t0 + 4.0 * eta2 * k2).max(0.0).sqrt();
        let a = (0.5 * (a2_plus_b2 + t0)).max(0.0).sqrt();
        let t1 = a2_plus_b2 + c2;
        let t2 = 2.0 * a * cos_i;
        let perpendicular = (t1 - t2) / (t1 + t2);
        let t3 = c2 * a2_plus_b2 + s2 * s2;
        let t4 = t2 * s2;
        let parallel = perpendicular * (t3 - t4) / (t3 + t4);
        0.5 * (parallel + perpendicular)
    };
    Rgb::new(channel(eta.r, k.r), channel(eta.g, k.g), channel(eta.b, k.b))
}

/// Schlick's approximation between `f0` at normal incidence and `f90` at grazing.
#[inline]
pub fn schlick(cos_i: f32, f0: Rgb, f90: Rgb) -> Rgb {
    f0.lerp(f90, (1.0 - cos_i).clamp(0.0, 1.0).powi(5))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values() {
        assert!((dielectric(1.0, 1.5).0 - 0.04).abs() < 1e-6);
        assert!((dielectric(1.0, 1.0 / 1.5).0 - 0.04).abs() < 1e-6);
        assert_eq!(dielectric(0.5, 1.0 / 1.5), (1.0, 0.0), "beyond the critical angle of 41.8 degrees");
        assert!((dielectric(0.0, 1.5).0 - 1.0).abs() < 1e-6);
        let brewster = (1.5f32).atan().cos();
        let (r, _) = dielectric(brewster, 1.5);
        assert!((r - 0.5 * ((1.5f32 * 1.5 - 1.0) / (1.5 * 1.5 + 1.0)).powi(2)).abs() < 1e-5, "only the perpendicular half is left");
        // Normal incidence: ((n−1)² + k²) / ((n+1)² + k²).
        let gold = conductor(1.0, Rgb::splat(0.143), Rgb::splat(3.983));
        assert!((gold.r - (0.857f32.powi(2) + 3.983f32.powi(2)) / (1.143f32.powi(2) + 3.983f32.powi(2))).abs() < 1e-5);
        assert_eq!(conductor(0.3, Rgb::BLACK, Rgb::BLACK), Rgb::WHITE);
        assert_eq!(conductor(1.0, Rgb::new(0.0, 1.0, 1.0), Rgb::new(0.0, 2.0, 2.0)).r, 1.0, "in one channel alone");
    }
}
