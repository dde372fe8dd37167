//! What the depth sensors share: which surface they see, and how far they reach.

use crate::reading::Subject;
use crate::{Amount, SensorError};
use enfilade_frame::tonemap::brightness;
use enfilade_frame::{Layer, traits};
use serde::{Deserialize, Serialize};

/// What a depth sensor sees of glass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Glass {
    /// The glass, as the layers of geometry do.
    #[default]
    Surface,
    /// What is behind it, by `depth_behind_meters`.
    Behind,
    /// Nothing.
    Nothing,
}

/// Which surfaces a depth sensor sees.
pub(crate) struct Optics {
    pub glass: Glass,
    pub mirrors: bool,
    pub range_m: Option<[f64; 2]>,
}

impl Optics {
    /// The layers that tell it.
    pub fn layers(&self) -> Vec<Layer> {
        let mut layers = vec![Layer::DepthMeters];
        if self.glass == Glass::Behind {
            layers.push(Layer::DepthBehindMeters);
        }
        if self.glass == Glass::Nothing || !self.mirrors {
            layers.push(Layer::SurfaceTraits);
        }
        layers
    }

    /// Distances along the rays, metres; NaN where there is nothing to be seen, or too near or too far.
    pub fn distances_m(&self, sensor: &str, subject: &Subject<'_>) -> Result<Vec<f32>, SensorError> {
        let layer = if self.glass == Glass::Behind { Layer::DepthBehindMeters } else { Layer::DepthMeters };
        let mut distances = subject.floats(sensor, layer)?.to_vec();
        let unseen = if self.glass == Glass::Nothing { traits::GLASS } else { 0 } | if self.mirrors { 0 } else { traits::MIRROR };
        if unseen != 0 {
            let found = subject.layer(sensor, Layer::SurfaceTraits)?;
            distances.iter_mut().enumerate().filter(|(i, _)| found.get(*i) as u8 & unseen != 0).for_each(|(_, d)| *d = f32::NAN);
        }
        Ok(distances)
    }

    /// True for what lies within the range.
    pub fn reaches(&self, depth_m: f32) -> bool {
        self.range_m.is_none_or(|[near, far]| (near..=far).contains(&f64::from(depth_m)))
    }

    /// Checks the range.
    pub fn check(&self) -> Result<(), String> {
        match self.range_m {
            Some([near, far]) if !(near >= 0.0 && near < far) => {
                Err(format!("range_m is [{near}, {far}], expected two distances from 0 on, the nearer one first"))
            }
            _ => Ok(()),
        }
    }
}

/// The diffuse reflectance of every pixel as one number, 0 to 1.
pub(crate) fn reflectances(sensor: &str, subject: &Subject<'_>) -> Result<Vec<f64>, SensorError> {
    let reflectance = subject.layer(sensor, Layer::DiffuseReflectance)?;
    Ok((0..subject.frame.pixels()).map(|i| brightness([0, 1, 2].map(|c| reflectance.get(3 * i + c)))).collect())
}

/// Checks that a number, or the whole range of one, lies between two bounds.
pub(crate) fn check_within(key: &str, amount: Amount, [least, most]: [f64; 2]) -> Result<(), String> {
    let [low, high] = amount.bounds();
    if low >= least && high <= most {
        return Ok(());
    }
    let found = if low == high { low.to_string() } else { format!("[{low}, {high}]") };
    let expected = if most == f64::INFINITY { format!("at least {least}") } else { format!("{least} to {most}") };
    Err(format!("{key} is {found}, expected {expected}"))
}

/// Steps of a quantity: the nearest whole multiple; the value itself for a step of 0.
pub(crate) fn in_steps(value: f64, step: f64) -> f64 {
    if step > 0.0 { (value / step).round() * step } else { value }
}
