//! Depth by the time that light takes to a surface and back.

use crate::depth::{Optics, check_range, check_within, in_steps, reaches, reflectances};
use crate::reading::{Data, Reading, Subject};
use crate::{Amount, Glass, SensorError};
use enfilade_frame::{Layer, Values};
use enfilade_math::Rng;
use serde::{Deserialize, Serialize};

/// A time-of-flight camera, with its light beside its lens. It gives `depth_meters`: distances along the rays, NaN where nothing returns.
///
/// The light that returns from a surface of diffuse reflectance ρ at distance d, seen at the angle θ, is proportional to the *signal*
/// s = ρ cos θ / d² (1 for a white surface that faces the sensor at one metre), and the error of a distance to 1 / √s, as long as the
/// sensor's own light dominates the noise (Lange 2000, "3D time-of-flight distance measurement with custom solid-state image sensors"). The
/// reflectance is the luminance of the visible one, although real sensors use infrared. Gloss returns nothing, so that with noise glass and
/// smooth metals have no distance. Light that comes back by way of other surfaces (multi-path) is left out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TimeOfFlight {
    /// Name of its folder.
    pub name: String,
    /// Range: nearer or farther surfaces are not seen, metres.
    #[serde(default)]
    pub range_m: Option<[f64; 2]>,
    /// Standard deviation of the distance to a white surface that faces the sensor at one metre, metres.
    #[serde(default = "Amount::nothing")]
    pub noise_m: Amount,
    /// Pixels with a weaker signal than this see nothing, 1/m².
    #[serde(default = "Amount::nothing")]
    pub min_signal: Amount,
    /// How much of its light a pixel gets from its eight neighbours, 0 to 1: at edges the distances of both sides are mixed by their signals
    /// (flying pixels).
    #[serde(default = "Amount::nothing")]
    pub mixing: Amount,
    /// Distances are known up to whole multiples of this, metres: half the wavelength of the modulation (7.5 m at 20 MHz).
    #[serde(default)]
    pub ambiguity_m: Option<f64>,
    /// Distances are whole multiples of this, metres.
    #[serde(default)]
    pub step_m: f64,
    /// How glass is seen.
    #[serde(default)]
    pub glass: Glass,
    /// Whether smooth metals are seen, as surfaces.
    #[serde(default = "crate::depth::seen")]
    pub mirrors: bool,
}

/// Random values drawn for a frame.
struct Drawn {
    noise_m: f64,
    min_signal: f64,
    mixing: f64,
}

impl TimeOfFlight {
    fn optics(&self) -> Optics {
        Optics { glass: self.glass, mirrors: self.mirrors }
    }

    /// True when it matters how much light returns.
    fn measures_signal(&self) -> bool {
        [self.noise_m, self.min_signal, self.mixing].iter().any(|amount| amount.bounds()[1] > 0.0)
    }

    /// The layers that it looks at.
    pub(crate) fn layers(&self) -> Vec<Layer> {
        let mut layers = self.optics().layers();
        if self.measures_signal() {
            layers.extend([Layer::DiffuseReflectance, Layer::NormalCam]);
        }
        layers
    }

    /// Checks every key.
    pub(crate) fn check(&self) -> Result<(), String> {
        check_range(self.range_m)?;
        check_within("noise_m", self.noise_m, [0.0, f64::INFINITY])?;
        check_within("min_signal", self.min_signal, [0.0, f64::INFINITY])?;
        check_within("mixing", self.mixing, [0.0, 1.0])?;
        check_within("step_m", Amount::of(self.step_m), [0.0, f64::INFINITY])?;
        match self.ambiguity_m {
            Some(m) if !(m > 0.0 && m.is_finite()) => Err(format!("ambiguity_m is {m}, expected a length above 0")),
            _ if self.glass == Glass::Behind && self.measures_signal() => {
                Err("glass = \"behind\" goes without noise_m, min_signal and mixing: what is behind glass has no stored reflectance".into())
            }
            _ => Ok(()),
        }
    }

    /// The reading for a frame.
    pub(crate) fn sense(&self, subject: &Subject<'_>, mut rng: Rng) -> Result<Reading, SensorError> {
        let drawn =
            Drawn { noise_m: self.noise_m.draw(&mut rng), min_signal: self.min_signal.draw(&mut rng), mixing: self.mixing.draw(&mut rng) };
        let optics = self.optics();
        let mut distances = optics.distances_m(&self.name, subject)?.to_vec();
        optics.forget_unseen(&self.name, subject, &mut distances)?;
        if self.measures_signal() {
            let (mut signals, reflectances) = (subject.cosines(&self.name)?, reflectances(&self.name, subject)?);
            for ((signal, reflectance), &distance) in signals.iter_mut().zip(reflectances).zip(&distances) {
                *signal = if distance > 0.0 { *signal * reflectance / f64::from(distance).powi(2) } else { 0.0 };
            }
            if drawn.mixing > 0.0 {
                (distances, signals) = mixed(subject.size(), &distances, &signals, drawn.mixing);
            }
            let pixels = rng.fork(0);
            for (i, (distance, &signal)) in distances.iter_mut().zip(&signals).enumerate() {
                if signal < drawn.min_signal || (drawn.noise_m > 0.0 && signal <= 0.0) {
                    *distance = f32::NAN;
                } else if drawn.noise_m > 0.0 {
                    *distance += (drawn.noise_m / signal.sqrt() * pixels.fork(i as u64).normal()) as f32;
                }
            }
        }
        for distance in &mut distances {
            *distance = if reaches(self.range_m, f64::from(*distance)) { self.read_out(*distance) } else { f32::NAN };
        }
        let drawn = vec![("noise_m", drawn.noise_m), ("min_signal", drawn.min_signal), ("mixing", drawn.mixing)];
        Ok(Reading { drawn, data: Data::Layer(Layer::DepthMeters, Values::F32(distances)) })
    }

    /// A distance as the sensor gives it: without whole turns of the phase, in steps.
    fn read_out(&self, distance_m: f32) -> f32 {
        let turned = self.ambiguity_m.map_or(distance_m, |m| f64::from(distance_m).rem_euclid(m) as f32);
        if self.step_m > 0.0 { in_steps(f64::from(turned), self.step_m) as f32 } else { turned }
    }
}

/// Distances and signals where every pixel gets the share `mixing` of its light from its neighbours (except for those beyond the border):
/// two parts from each of the four beside it, one part from each at its corners.
fn mixed([width, height]: [usize; 2], distances_m: &[f32], signals: &[f64], mixing: f64) -> (Vec<f32>, Vec<f64>) {
    let mixed = |i: usize| {
        let (x, y) = (i % width, i / width);
        let (mut light, mut way, mut inside) = (0.0, 0.0, 0.0);
        for v in y.saturating_sub(1)..=(y + 1).min(height - 1) {
            for u in x.saturating_sub(1)..=(x + 1).min(width - 1) {
                let share = match u.abs_diff(x) + v.abs_diff(y) {
                    0 => 1.0 - mixing,
                    1 => mixing / 6.0,
                    _ => mixing / 12.0,
                };
                inside += share;
                let (signal, distance) = (share * signals[v * width + u], f64::from(distances_m[v * width + u]));
                if signal > 0.0 && distance.is_finite() {
                    (light, way) = (light + signal, way + signal * distance);
                }
            }
        }
        (if light > 0.0 { (way / light) as f32 } else { f32::NAN }, light / inside)
    };
    (0..distances_m.len()).map(mixed).unzip()
}
