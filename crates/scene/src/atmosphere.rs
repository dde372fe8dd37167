//! The earth's atmosphere lit by the sun: radiance of the sky by single scattering along the view, and all further orders by the
//! series of Hillaire 2020, "A Scalable and Production Ready Sky and Atmosphere Rendering Technique".
//!
//! The air is modelled as in Bruneton & Neyret 2008 with the ozone of Bruneton 2017, which keeps the zenith blue at dusk; haze is added
//! by Ångström's law. Light is computed in eight bands and seen by the CIE's standard observer: three wavelengths in place of red, green
//! and blue make the sky too blue by day and violet at dusk, since red light, unlike 680 nm, is what ozone absorbs most. Lengths are in
//! kilometres.

use enfilade_math::{DVec3, Rgb, warp};
use std::f64::consts::PI;

const GROUND_KM: f64 = 6360.0;
const TOP_KM: f64 = 6460.0;
/// Height of the eye, so that rounding does not put it below the ground.
const EYE_KM: f64 = 0.002;

const BANDS: usize = 8;
/// Middles of the bands, each 40 nm wide.
const WAVELENGTHS_UM: [f64; BANDS] = [0.41, 0.45, 0.49, 0.53, 0.57, 0.61, 0.65, 0.69];
/// Share of each band, with all that is beyond the first and the last, in the tristimulus values (CIE 1931, 2 degrees) of sunlight above the
/// atmosphere (ASTM G-173), whose luminance is 1.
const SUNLIGHT_XYZ: [[f64; 3]; BANDS] = [
    [0.027_21, 0.000_88, 0.131_09],
    [0.119_84, 0.016_68, 0.643_98],
    [0.023_75, 0.092_92, 0.232_90],
    [0.067_83, 0.312_27, 0.021_33],
    [0.279_59, 0.349_55, 0.001_17],
    [0.337_86, 0.183_02, 0.000_18],
    [0.105_17, 0.040_94, 0.0],
    [0.010_29, 0.003_74, 0.0],
];
/// Scattering by air at sea level and a wavelength of 1 µm, per km; it goes with the inverse fourth power. And the height in which it falls to 1/e.
const RAYLEIGH: f64 = 1.240_62e-3;
const RAYLEIGH_HEIGHT_KM: f64 = 8.0;
/// Absorption by ozone, per km, at the middle of its layer, whose density falls linearly to zero in both directions: 300 Dobson units with
/// the cross-sections of Serdyuchenko et al. 2014 at 233 K.
const OZONE: [f64; BANDS] = [1.407e-5, 1.130e-4, 4.903e-4, 1.288e-3, 2.262e-3, 2.387e-3, 1.339e-3, 5.871e-4];
const OZONE_KM: [f64; 2] = [25.0, 15.0];
/// Haze: the height in which it falls to 1/e, how much of what it takes it scatters, and how far forward.
const HAZE_HEIGHT_KM: f64 = 1.2;
const HAZE_ALBEDO: f64 = 0.908;
const HAZE_ASYMMETRY: f64 = 0.8;
/// Ångström's exponent.
const HAZE_EXPONENT: f64 = 1.3;

/// Steps along a view ray, and along one that gathers for the table of many scatterings.
const VIEW_STEPS: usize = 40;
const GATHER_STEPS: usize = 16;
const GATHER_DIRECTIONS: usize = 32;
/// Steps to the top of the atmosphere.
const TRANSMITTANCE_STEPS: usize = 40;
/// Sizes of the tables: by height, by angle.
const TRANSMITTANCE_TABLE: [usize; 2] = [32, 128];
const MULTIPLE_TABLE: [usize; 2] = [16, 32];
/// Size of the sky's: by elevation, finer near the horizon, and by azimuth from the sun.
const DOME_TABLE: [usize; 2] = [64, 33];

type Spectrum = [f64; BANDS];

/// An atmosphere with its tables.
pub(crate) struct Atmosphere {
    /// Extinction of haze at sea level, per km.
    haze: Spectrum,
    /// Scattering by air at sea level, per km.
    air: Spectrum,
    ground_albedo: f64,
    transmittance: Vec<Spectrum>,
}

/// The sky seen from the ground. What the phase functions multiply is smooth and tabled; they themselves are not.
pub(crate) struct Dome {
    to_sun: DVec3,
    /// Tristimulus values of what was scattered once by air, once by haze, and more often.
    parts: [Vec<[f64; 3]>; 3],
}

impl Atmosphere {
    /// With Preetham's turbidity (1: no haze at all), by the vertical optical depth of haze that he gives for it.
    pub fn new(turbidity: f64, ground_albedo: f64) -> Self {
        let depth = |wavelength_um: f64| (0.046_08 * turbidity - 0.045_86).max(0.0) * wavelength_um.powf(-HAZE_EXPONENT);
        let haze = WAVELENGTHS_UM.map(|w| depth(w) / HAZE_HEIGHT_KM);
        let mut air = Self { haze, air: WAVELENGTHS_UM.map(|w| RAYLEIGH / w.powi(4)), ground_albedo, transmittance: Vec::new() };
        let [rows, columns] = TRANSMITTANCE_TABLE;
        air.transmittance = (0..rows * columns)
            .map(|i| {
                let (r, mu) = radius_and_angle((i / columns) as f64 / (rows - 1) as f64, (i % columns) as f64 / (columns - 1) as f64);
                air.integrated_transmittance(r, mu)
            })
            .collect();
        air
    }

    /// Share of sunlight that reaches the ground, for the cosine of the sun's angle from the zenith; averaged over the disk.
    pub fn sun_transmittance(&self, mu_sun: f64, angular_radius_rad: f64) -> Rgb {
        let n = 8;
        let theta = mu_sun.clamp(-1.0, 1.0).acos();
        let sum = (0..n).fold([0.0; BANDS], |sum, k| {
            let offset = angular_radius_rad * ((f64::from(k) + 0.5) / f64::from(n) * 2.0 - 1.0);
            let weight = (1.0 - (offset / angular_radius_rad).powi(2)).max(0.0).sqrt() * 4.0 / PI;
            let t = self.to_sun(GROUND_KM + EYE_KM, (theta + offset).cos());
            std::array::from_fn(|c| sum[c] + weight * t[c] / f64::from(n))
        });
        Rgb::from_xyz(xyz(&sum))
    }

    /// The sky seen from the ground, with the unit direction to the sun, z up.
    pub fn dome(&self, to_sun: DVec3) -> Dome {
        // Light scattered twice or more, by height and by the sun's angle from the zenith.
        let [rows, columns] = MULTIPLE_TABLE;
        let multiple: Vec<Spectrum> = (0..rows * columns)
            .map(|i| {
                let height = (i / columns) as f64 / (rows - 1) as f64 * (TOP_KM - GROUND_KM);
                let mu_sun = (i % columns) as f64 / (columns - 1) as f64 * 2.0 - 1.0;
                self.gathered(GROUND_KM + height.max(EYE_KM), mu_sun)
            })
            .collect();

        // The three parts of the sky, by elevation and by azimuth from the sun.
        let sun = DVec3::new(to_sun.x.hypot(to_sun.y), 0.0, to_sun.z);
        let [rows, columns] = DOME_TABLE;
        let mut parts: [Vec<[f64; 3]>; 3] = Default::default();
        for i in 0..rows * columns {
            let (sin_elevation, cos_elevation) = elevation((i / columns) as f64 / (rows - 1) as f64).sin_cos();
            let (sin, cos) = ((i % columns) as f64 / (columns - 1) as f64 * PI).sin_cos();
            let seen = self.seen(DVec3::new(cos_elevation * cos, cos_elevation * sin, sin_elevation), sun, &multiple);
            for (part, value) in parts.iter_mut().zip(seen) {
                part.push(xyz(&value));
            }
        }
        Dome { to_sun, parts }
    }

    /// The components of the sky's radiance in the direction `d`: see [`Dome`].
    fn seen(&self, d: DVec3, to_sun: DVec3, multiple: &[Spectrum]) -> [Spectrum; 3] {
        let eye = DVec3::new(0.0, 0.0, GROUND_KM + EYE_KM);
        let length = to_top(eye.z, d.z);
        let mut parts = [[0.0; BANDS]; 3];
        let mut through = [1.0; BANDS];
        for k in 0..VIEW_STEPS {
            // Short steps near the eye, where the haze is.
            let edge = |k: usize| (k as f64 / VIEW_STEPS as f64).powi(2) * length;
            let (near, far) = (edge(k), edge(k + 1));
            let p = eye + d * (0.5 * (near + far));
            let r = p.length();
            let mu_sun = p.dot(to_sun) / r;

            // Light that arrives there and is scattered: sunlight, and light that was scattered before.
            let (air, haze, extinction) = self.coefficients(r);
            let sun = self.to_sun(r, mu_sun);
            let many = bilinear(multiple, MULTIPLE_TABLE, (r - GROUND_KM) / (TOP_KM - GROUND_KM), 0.5 * mu_sun + 0.5);

            // The share that reaches the eye, with the extinction within the step integrated exactly.
            for c in 0..BANDS {
                let step = (-extinction[c] * (far - near)).exp();
                let weight = through[c] * if extinction[c] > 1e-12 { (1.0 - step) / extinction[c] } else { far - near };
                parts[0][c] += weight * sun[c] * air[c];
                parts[1][c] += weight * sun[c] * haze[c];
                parts[2][c] += weight * many[c] * (air[c] + haze[c]);
                through[c] *= step;
            }
        }
        parts
    }

    /// Scattering by air and by haze, and the extinction, per km at the distance `r` from the earth's centre.
    fn coefficients(&self, r: f64) -> (Spectrum, Spectrum, Spectrum) {
        let height = (r - GROUND_KM).max(0.0);
        let (air, haze) = ((-height / RAYLEIGH_HEIGHT_KM).exp(), (-height / HAZE_HEIGHT_KM).exp());
        let ozone = (1.0 - (height - OZONE_KM[0]).abs() / OZONE_KM[1]).max(0.0);
        let scattered_by_air = self.air.map(|s| s * air);
        let scattered_by_haze = self.haze.map(|e| e * haze * HAZE_ALBEDO);
        let extinction = std::array::from_fn(|c| scattered_by_air[c] + self.haze[c] * haze + OZONE[c] * ozone);
        (scattered_by_air, scattered_by_haze, extinction)
    }

    /// Transmittance to the top of the atmosphere for the cosine `mu` from the vertical; the ground is not in the way.
    fn integrated_transmittance(&self, r: f64, mu: f64) -> Spectrum {
        let length = to_top(r, mu);
        let step = length / TRANSMITTANCE_STEPS as f64;
        let mut depth = [0.0; BANDS];
        for k in 0..TRANSMITTANCE_STEPS {
            let t = (k as f64 + 0.5) * step;
            let at = (r * r + t * t + 2.0 * r * t * mu).sqrt();
            let (_, _, extinction) = self.coefficients(at);
            for c in 0..BANDS {
                depth[c] += extinction[c] * step;
            }
        }
        depth.map(|d| (-d).exp())
    }

    /// Transmittance towards the sun; none when the earth is in the way.
    fn to_sun(&self, r: f64, mu: f64) -> Spectrum {
        if meets_ground(r, mu) {
            return [0.0; BANDS];
        }
        let (x, y) = table_coordinates(r, mu);
        bilinear(&self.transmittance, TRANSMITTANCE_TABLE, x, y)
    }

    /// Radiance scattered twice or more at a point, in every direction alike: light scattered once or reflected by the ground that
    /// arrives from all sides, and the geometric series of what is scattered on again.
    fn gathered(&self, r: f64, mu_sun: f64) -> Spectrum {
        let to_sun = DVec3::new((1.0 - mu_sun * mu_sun).max(0.0).sqrt(), 0.0, mu_sun);
        let eye = DVec3::new(0.0, 0.0, r);
        let (mut second, mut again) = ([0.0; BANDS], [0.0; BANDS]);
        for k in 0..GATHER_DIRECTIONS {
            let d = warp::fibonacci_sphere(k, GATHER_DIRECTIONS);
            let ground = to_ground(r, d.z);
            let length = ground.unwrap_or_else(|| to_top(r, d.z));

            // Along the ray: sunlight scattered toward the point, and the share of light from all sides that would be.
            let mut through = [1.0; BANDS];
            for step in 0..GATHER_STEPS {
                let dt = length / GATHER_STEPS as f64;
                let p = eye + d * ((step as f64 + 0.5) * dt);
                let at = p.length();
                let (air, haze, extinction) = self.coefficients(at);
                let sun = self.to_sun(at, p.dot(to_sun) / at);
                for c in 0..BANDS {
                    let scattered = air[c] + haze[c];
                    let dimmed = (-extinction[c] * dt).exp();
                    let share = if extinction[c] > 1e-12 { (1.0 - dimmed) / extinction[c] } else { dt };
                    second[c] += through[c] * scattered * share * sun[c] / (4.0 * PI);
                    again[c] += through[c] * scattered * share;
                    through[c] *= dimmed;
                }
            }

            // At its end: sunlight that the ground reflects.
            if ground.is_some() {
                let p = eye + d * length;
                let cos = (p.dot(to_sun) / p.length()).max(0.0);
                let sun = self.to_sun(GROUND_KM + EYE_KM, cos);
                for c in 0..BANDS {
                    second[c] += through[c] * self.ground_albedo / PI * cos * sun[c];
                }
            }
        }

        // All further orders: second · (1 + again + again² + …).
        std::array::from_fn(|c| {
            let n = GATHER_DIRECTIONS as f64;
            second[c] / n / (1.0 - (again[c] / n).min(0.99))
        })
    }
}

impl Dome {
    /// Radiance in the unit direction `d`, not below the horizon, for sunlight of unit irradiance above the atmosphere.
    pub fn radiance(&self, d: DVec3) -> Rgb {
        let row = (d.z.clamp(0.0, 1.0).asin() / (0.5 * PI)).sqrt();
        let azimuth = (d.x * self.to_sun.y - d.y * self.to_sun.x).abs().atan2(d.x * self.to_sun.x + d.y * self.to_sun.y);
        let cos = d.dot(self.to_sun);
        let [air, haze, many] = [0, 1, 2].map(|part| bilinear(&self.parts[part], DOME_TABLE, row, azimuth / PI));
        Rgb::from_xyz(std::array::from_fn(|c| air[c] * rayleigh_phase(cos) + haze[c] * haze_phase(cos) + many[c]))
    }
}

/// The elevation, radians, of a row of the sky's table, on [0, 1].
fn elevation(row: f64) -> f64 {
    0.5 * PI * row * row
}

/// Tristimulus values of sunlight that was dimmed so.
fn xyz(s: &Spectrum) -> [f64; 3] {
    std::array::from_fn(|c| s.iter().zip(&SUNLIGHT_XYZ).map(|(value, sunlight)| value * sunlight[c]).sum())
}

/// Per steradian, for the cosine between the directions of travel.
fn rayleigh_phase(cos: f64) -> f64 {
    3.0 / (16.0 * PI) * (1.0 + cos * cos)
}

/// Cornette & Shanks 1992.
fn haze_phase(cos: f64) -> f64 {
    let g = HAZE_ASYMMETRY;
    3.0 / (8.0 * PI) * (1.0 - g * g) * (1.0 + cos * cos) / ((2.0 + g * g) * (1.0 + g * g - 2.0 * g * cos).powf(1.5))
}

/// Distance to the top of the atmosphere.
fn to_top(r: f64, mu: f64) -> f64 {
    -r * mu + (r * r * (mu * mu - 1.0) + TOP_KM * TOP_KM).max(0.0).sqrt()
}

/// Distance to the ground, if it is met.
fn to_ground(r: f64, mu: f64) -> Option<f64> {
    meets_ground(r, mu).then(|| (-r * mu - (r * r * (mu * mu - 1.0) + GROUND_KM * GROUND_KM).max(0.0).sqrt()).max(0.0))
}

fn meets_ground(r: f64, mu: f64) -> bool {
    mu < 0.0 && r * r * (mu * mu - 1.0) + GROUND_KM * GROUND_KM >= 0.0
}

/// Coordinates of a height and an angle in the table of transmittances, on [0, 1]²: by distances to the horizon and to the top, which
/// resolves the horizon (Bruneton & Neyret 2008, section 4).
fn table_coordinates(r: f64, mu: f64) -> (f64, f64) {
    let horizon = (TOP_KM * TOP_KM - GROUND_KM * GROUND_KM).sqrt();
    let rho = (r * r - GROUND_KM * GROUND_KM).max(0.0).sqrt();
    let (nearest, farthest) = (TOP_KM - r, rho + horizon);
    (rho / horizon, (to_top(r, mu) - nearest) / (farthest - nearest))
}

/// The inverse of [`table_coordinates`].
fn radius_and_angle(x: f64, y: f64) -> (f64, f64) {
    let horizon = (TOP_KM * TOP_KM - GROUND_KM * GROUND_KM).sqrt();
    let rho = x * horizon;
    let r = (rho * rho + GROUND_KM * GROUND_KM).sqrt();
    let (nearest, farthest) = (TOP_KM - r, rho + horizon);
    let distance = nearest + y * (farthest - nearest);
    let mu = if distance <= 0.0 { 1.0 } else { (horizon * horizon - rho * rho - distance * distance) / (2.0 * r * distance) };
    (r, mu.clamp(-1.0, 1.0))
}

fn bilinear<const N: usize>(table: &[[f64; N]], [rows, columns]: [usize; 2], x: f64, y: f64) -> [f64; N] {
    let place = |v: f64, n: usize| {
        let at = v.clamp(0.0, 1.0) * (n - 1) as f64;
        let low = (at as usize).min(n - 2);
        (low, at - low as f64)
    };
    let ((row, fx), (column, fy)) = (place(x, rows), place(y, columns));
    let at = |r: usize, c: usize| table[(row + r) * columns + column + c];
    let (a, b, c, d) = (at(0, 0), at(0, 1), at(1, 0), at(1, 1));
    std::array::from_fn(|k| (a[k] * (1.0 - fy) + b[k] * fy) * (1.0 - fx) + (c[k] * (1.0 - fy) + d[k] * fy) * fx)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phase_functions_integrate_to_one() {
        for phase in [rayleigh_phase, haze_phase] {
            let n = 20_000;
            let sum: f64 = (0..n).map(|k| phase((f64::from(k) + 0.5) / f64::from(n) * 2.0 - 1.0)).sum();
            assert!((sum * 4.0 * PI / f64::from(n) - 1.0).abs() < 1e-4);
        }
    }

    #[test]
    fn tabled_transmittance_is_that_of_the_integral() {
        let air = Atmosphere::new(3.0, 0.2);
        for (height, mu) in [(0.002, 1.0), (0.002, 0.1), (0.002, 0.0), (5.0, 0.5), (30.0, -0.05)] {
            let (tabled, exact) = (air.to_sun(GROUND_KM + height, mu), air.integrated_transmittance(GROUND_KM + height, mu));
            for c in 0..BANDS {
                assert!((tabled[c] - exact[c]).abs() < 0.01 * exact[c] + 2e-3, "{height} {mu}: {tabled:?} {exact:?}");
            }
        }
        // The optical depth of air at 0.53 µm straight up is 0.123 (Bodhaine et al. 1999, sea level, 45°N), with ozone's 0.019.
        let clear = Atmosphere::new(1.0, 0.0).integrated_transmittance(GROUND_KM, 1.0);
        assert!((-clear[3].ln() - 0.123 - 0.019).abs() < 5e-3, "{}", -clear[3].ln());
    }

    /// Chromaticity of a colour.
    fn xy(color: Rgb) -> [f64; 2] {
        let [r, g, b] = color.to_array().map(f64::from);
        let [x, y, z] = [0.4124 * r + 0.3576 * g + 0.1805 * b, 0.2126 * r + 0.7152 * g + 0.0722 * b, 0.0193 * r + 0.1192 * g + 0.9505 * b];
        [x / (x + y + z), y / (x + y + z)]
    }

    #[test]
    fn sunlight_above_the_air_has_the_colour_that_was_measured() {
        let total: [f64; 3] = std::array::from_fn(|c| SUNLIGHT_XYZ.iter().map(|band| band[c]).sum());
        assert!((total[1] - 1.0).abs() < 1e-4);
        // A black body of 5772 K, the sun's effective temperature, has (0.3262, 0.3354).
        let [x, y] = xy(Rgb::from_xyz(total));
        assert!((x - 0.3262).abs() < 0.004 && (y - 0.3354).abs() < 0.004, "{x} {y}");
    }

    #[test]
    fn clear_skies_have_colours_of_the_daylight_locus_also_at_dusk() {
        // Judd, MacAdam & Wyszecki 1964: y = −3.000 x² + 2.870 x − 0.275. Measured twilights go on along it (Lee & Hernández-Andrés 2003).
        let air = Atmosphere::new(3.0, 0.2);
        for elevation_deg in [60.0f64, 30.0, 10.0, 2.0, -2.0, -4.0, -6.0] {
            let (sin, cos) = elevation_deg.to_radians().sin_cos();
            let dome = air.dome(DVec3::new(cos, 0.0, sin));
            for d in [DVec3::Z, DVec3::new(-0.5, 0.3, 0.8), DVec3::new(-0.2, -0.9, 0.4)] {
                let [x, y] = xy(dome.radiance(d.normalize()));
                let locus = (2.870 - 3.0 * x) * x - 0.275;
                assert!((y - locus).abs() < 0.012 && x < 0.34, "sun at {elevation_deg}°, {d}: {x:.4} {y:.4}, expected {locus:.4}");
            }
        }
    }

    #[test]
    fn the_tabled_sky_is_that_of_the_integral() {
        let air = Atmosphere::new(3.0, 0.2);
        let to_sun = DVec3::new(0.3, -0.6, 0.4).normalize();
        let dome = air.dome(to_sun);
        for d in [DVec3::new(0.2, 0.1, 0.5), DVec3::new(-0.9, 0.3, 0.05), DVec3::new(0.35, -0.55, 0.4), DVec3::Z] {
            let d = d.normalize();
            let [one, haze, _] = air.seen(d, to_sun, &[[0.0; BANDS]; MULTIPLE_TABLE[0] * MULTIPLE_TABLE[1]]);
            let cos = d.dot(to_sun);
            let once =
                Dome { to_sun, parts: [dome.parts[0].clone(), dome.parts[1].clone(), vec![[0.0; 3]; DOME_TABLE[0] * DOME_TABLE[1]]] };
            let (tabled, exact) = (once.radiance(d), xyz(&one)[1] * rayleigh_phase(cos) + xyz(&haze)[1] * haze_phase(cos));
            assert!((f64::from(tabled.luminance()) / exact - 1.0).abs() < 0.02, "{d}: {tabled:?} {exact}");
        }
    }

    #[test]
    fn at_night_the_sky_is_dark() {
        let air = Atmosphere::new(2.0, 0.3);
        assert!(air.dome(DVec3::new(0.0, 0.8, -0.6)).radiance(DVec3::Z).luminance() < 1e-6);
    }
}
