//! Common parts of the depth sensors: which surface they see, and their range.

use crate::reading::Subject;
use crate::{Amount, SensorError};
use enfilade_frame::tonemap::brightness;
use enfilade_frame::{Layer, traits};
use serde::{Deserialize, Serialize};

/// How a depth sensor sees glass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Glass {
    /// The glass, as the layers of geometry do.
    #[default]
    Surface,
    /// The surface behind it, by `depth_behind_meters`.
    Behind,
    /// Nothing.
    Nothing,
}

/// Which surfaces a depth sensor sees.
pub(crate) struct Optics {
    pub glass: Glass,
    pub mirrors: bool,
}

impl Optics {
    /// The layers needed to find it.
    pub fn layers(&self) -> Vec<Layer> {
        let mut layers = vec![Layer::DepthMeters];
        if self.glass == Glass::Behind {
            layers.push(Layer::DepthBehindMeters);
        }
        if self.hidden_traits() != 0 {
            layers.push(Layer::SurfaceTraits);
        }
        layers
    }

    /// Bits of `surface_traits` of what it does not see.
    fn hidden_traits(&self) -> u8 {
        let glass = if self.glass == Glass::Nothing { traits::GLASS } else { 0 };
        glass | if self.mirrors { 0 } else { traits::MIRROR }
    }

    /// Distances along the rays to the surfaces that are there, seen or not, metres; NaN where there are none.
    pub fn distances_m<'a>(&self, sensor: &str, subject: &Subject<'a>) -> Result<&'a [f32], SensorError> {
        subject.floats(sensor, if self.glass == Glass::Behind { Layer::DepthBehindMeters } else { Layer::DepthMeters })
    }

    /// Forgets the depth of what is not seen.
    pub fn forget_unseen(&self, sensor: &str, subject: &Subject<'_>, depths: &mut [f32]) -> Result<(), SensorError> {
        let hidden = self.hidden_traits();
        if hidden != 0 {
            let found = subject.layer(sensor, Layer::SurfaceTraits)?;
            forget(depths, (0..found.len()).map(|i| found.get(i) as u8 & hidden != 0));
        }
        Ok(())
    }
}

/// Leaves out the depth of some pixels.
pub(crate) fn forget(depths: &mut [f32], unseen: impl Iterator<Item = bool>) {
    depths.iter_mut().zip(unseen).filter(|(_, unseen)| *unseen).for_each(|(depth, _)| *depth = f32::NAN);
}

/// True if the depth is in front of the sensor and within its range.
pub(crate) fn reaches(range_m: Option<[f64; 2]>, depth_m: f64) -> bool {
    depth_m > 0.0 && range_m.is_none_or(|[near, far]| (near..=far).contains(&depth_m))
}

/// Checks a range.
pub(crate) fn check_range(range_m: Option<[f64; 2]>) -> Result<(), String> {
    match range_m {
        Some([near, far]) if !(near >= 0.0 && near < far && far.is_finite()) => {
            Err(format!("range_m is [{near}, {far}], expected two distances from 0 on, the nearer one first"))
        }
        _ => Ok(()),
    }
}

/// The diffuse reflectance of every pixel as one number, 0 to 1.
pub(crate) fn reflectances(sensor: &str, subject: &Subject<'_>) -> Result<Vec<f64>, SensorError> {
    let reflectance = subject.layer(sensor, Layer::DiffuseReflectance)?;
    Ok((0..subject.frame.pixels()).map(|i| brightness([0, 1, 2].map(|c| reflectance.get(3 * i + c)))).collect())
}

/// Checks that a number, or the whole range of one, is between two bounds.
pub(crate) fn check_within(key: &str, amount: Amount, [least, most]: [f64; 2]) -> Result<(), String> {
    let [low, high] = amount.bounds();
    if low >= least && high <= most && high.is_finite() {
        return Ok(());
    }
    let found = if low == high { low.to_string() } else { format!("[{low}, {high}]") };
    let expected = if most == f64::INFINITY { format!("at least {least}") } else { format!("{least} to {most}") };
    Err(format!("{key} is {found}, expected {expected}"))
}

/// Default of a switch that is on.
pub(crate) const fn seen() -> bool {
    true
}

/// Steps of a quantity: the nearest whole multiple; the value itself for a step of 0.
pub(crate) fn in_steps(value: f64, step: f64) -> f64 {
    if step > 0.0 { (value / step).round() * step } else { value }
}
