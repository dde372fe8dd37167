//! A scanner of laser beams in the place of the camera.

use crate::depth::{check_range, check_within, in_steps, reaches, reflectances};
use crate::reading::{Data, Reading, Subject};
use crate::{Amount, SensorError};
use enfilade_dataset::Scan;
use enfilade_frame::Layer;
use enfilade_math::{DVec3, Rng};
use enfilade_scene::Projection;
use serde::{Deserialize, Serialize};

/// A lidar at the camera's centre, turned as the camera is: beams in rows of one elevation and columns of one azimuth, as far as they are
/// within the picture. A panorama covers all directions.
///
/// It gives `scan.npz` ([`Scan`]). A beam meets the plane through the three pixels around it that show the same part, so distances on flat
/// surfaces are exact for every camera; where the part is too thin for three, it has the distance of the nearest pixel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lidar {
    /// Name of its folder.
    pub name: String,
    /// Rows: the angle of each above the camera's x-z plane, degrees.
    pub elevations_deg: Vec<f64>,
    /// The first and the last column: angles to the right of the viewing axis, degrees. A whole turn has its last column one step earlier.
    pub azimuth_deg: [f64; 2],
    /// Number of columns.
    pub columns: u32,
    /// Range: nearer or farther surfaces do not return, metres.
    #[serde(default)]
    pub range_m: Option<[f64; 2]>,
    /// Standard deviation of distances, metres.
    #[serde(default = "Amount::nothing")]
    pub noise_m: Amount,
    /// Weaker intensities do not return: ρ cos θ, 0 to 1.
    #[serde(default = "Amount::nothing")]
    pub min_intensity: Amount,
    /// The share of beams that do not return for no reason.
    #[serde(default = "Amount::nothing")]
    pub dropout: Amount,
    /// Distances are whole multiples of this, metres.
    #[serde(default)]
    pub step_m: f64,
}

/// A flat surface may be nearer between pixels than at them by this share of its distance: one that faces the scanner, seen by pixels of up to
/// five degrees.
const FLAT: f64 = 1e-3;

impl Lidar {
    /// The layers that it looks at.
    pub(crate) fn layers(&self) -> Vec<Layer> {
        vec![Layer::DepthMeters, Layer::RenderEntityId, Layer::NormalCam, Layer::DiffuseReflectance]
    }

    /// Checks every key.
    pub(crate) fn check(&self) -> Result<(), String> {
        let turn = self.azimuth_deg[1] - self.azimuth_deg[0];
        if !(0.0..=360.0).contains(&turn) {
            return Err(format!("azimuth_deg is {:?}, expected two angles, the left one first, of at most a whole turn", self.azimuth_deg));
        }
        if self.elevations_deg.is_empty() || !self.elevations_deg.iter().all(|angle| (-90.0..=90.0).contains(angle)) {
            return Err("elevations_deg must have one angle of -90 to 90 for each row".into());
        }
        if self.columns == 0 || self.columns as usize * self.elevations_deg.len() > 1 << 26 {
            return Err(format!("columns is {}, expected at least one, and less than 67 million beams in all", self.columns));
        }
        check_range(self.range_m)?;
        check_within("noise_m", self.noise_m, [0.0, f64::INFINITY])?;
        check_within("min_intensity", self.min_intensity, [0.0, 1.0])?;
        check_within("dropout", self.dropout, [0.0, 1.0])?;
        check_within("step_m", Amount::of(self.step_m), [0.0, f64::INFINITY])
    }

    /// The direction of a beam in camera space.
    fn direction(&self, row: usize, column: u32) -> DVec3 {
        let [first, last] = self.azimuth_deg;
        let steps = if last - first >= 360.0 { self.columns } else { (self.columns - 1).max(1) };
        let azimuth = (first + (last - first) * f64::from(column) / f64::from(steps)).to_radians();
        let elevation = self.elevations_deg[row].to_radians();
        DVec3::new(elevation.cos() * azimuth.sin(), elevation.sin(), -elevation.cos() * azimuth.cos())
    }

    /// The reading for a frame.
    pub(crate) fn sense(&self, subject: &Subject<'_>, mut rng: Rng) -> Result<Reading, SensorError> {
        let [noise_m, min_intensity, dropout] = [self.noise_m, self.min_intensity, self.dropout].map(|amount| amount.draw(&mut rng));
        let surfaces = Surfaces {
            subject,
            distances_m: subject.floats(&self.name, Layer::DepthMeters)?,
            parts: subject.layer(&self.name, Layer::RenderEntityId)?,
        };
        let (cosines, reflectances) = (subject.cosines(&self.name)?, reflectances(&self.name, subject)?);
        let mut scan = Scan::empty([self.elevations_deg.len(), self.columns as usize]);
        let beams = rng.fork(0);
        for beam in 0..scan.distances_m.len() {
            let direction = self.direction(beam / self.columns as usize, (beam % self.columns as usize) as u32);
            let Some((pixel, distance)) = surfaces.meet(direction) else { continue };
            let intensity = cosines[pixel] * reflectances[pixel];
            let mut rng = beams.fork(beam as u64);
            let lost = rng.next_f64() < dropout;
            let noise = if noise_m > 0.0 { noise_m * rng.normal() } else { 0.0 };
            let told = in_steps(distance + noise, self.step_m);
            if lost || intensity < min_intensity || !reaches(self.range_m, told) {
                continue;
            }
            scan.distances_m[beam] = told as f32;
            scan.points[beam] = (direction * told).as_vec3().to_array();
            scan.intensities[beam] = intensity as f32;
            scan.parts[beam] = surfaces.parts.get(pixel) as i16;
        }
        let drawn = vec![("noise_m", noise_m), ("min_intensity", min_intensity), ("dropout", dropout)];
        Ok(Reading { drawn, data: Data::File { name: "scan.npz", bytes: scan.to_npz() } })
    }
}

/// The surfaces that a frame's pixels show.
struct Surfaces<'a> {
    subject: &'a Subject<'a>,
    distances_m: &'a [f32],
    parts: &'a enfilade_frame::Values,
}

impl Surfaces<'_> {
    /// The point that a pixel shows, camera space; `None` where it shows nothing.
    fn point(&self, pixel: usize) -> Option<DVec3> {
        let distance = f64::from(self.distances_m[pixel]);
        Some(self.subject.ray(pixel).filter(|_| distance.is_finite())? * distance)
    }

    /// The hit of a beam from the camera's centre: the pixel, and the distance in metres.
    fn meet(&self, direction: DVec3) -> Option<(usize, f64)> {
        let [width, height] = self.subject.size();
        let (x, y) = match self.subject.projection {
            // All around: straight back is at either border, straight down at the lower one.
            panorama @ Projection::Equirectangular { .. } => {
                let (x, y) = panorama.project(direction)?;
                (x.rem_euclid(width as f64), y.min((height as f64).next_down()))
            }
            projection => projection.project(direction)?,
        };
        if !(0.0..width as f64).contains(&x) || !(0.0..height as f64).contains(&y) {
            return None;
        }
        let (column, row) = (x as usize, y as usize);
        let pixel = row * width + column;
        let nearest = self.point(pixel)?;
        // Beside the pixel and above or below it: on the beam's side of its centre, if the part continues there.
        let beside = |at: usize, fraction: f64, side: usize| {
            let (before, after) = (at.checked_sub(1), Some(at + 1).filter(|&at| at < side));
            if fraction < 0.5 { [before, after] } else { [after, before] }
        };
        let same = |other: &usize| self.parts.get(*other) == self.parts.get(pixel);
        let first = |[a, b]: [Option<usize>; 2]| a.filter(same).or(b.filter(same)).and_then(|other| self.point(other));
        let plane = || {
            let a = first(beside(column, x.fract(), width).map(|column| Some(row * width + column?)))?;
            let b = first(beside(row, y.fract(), height).map(|row| Some(row? * width + column)))?;
            let normal = (a - nearest).cross(b - nearest);
            let distance = normal.dot(nearest) / normal.dot(direction);
            // Far beyond what the pixels around show, the surface is not flat.
            let around = [nearest, a, b].map(DVec3::length);
            let (near, far) = around.iter().fold((f64::INFINITY, 0.0f64), |(near, far), &d| (near.min(d), far.max(d)));
            let margin = far - near + FLAT * far;
            (near - margin..=far + margin).contains(&distance).then_some(distance)
        };
        Some((pixel, plane().unwrap_or(nearest.length())))
    }
}
