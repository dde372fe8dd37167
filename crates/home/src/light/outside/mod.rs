//! The surroundings outside the windows, painted into the sky's picture: gardens, streets, a skyline, open country.
//!
//! A view is a stack of rings about the home, each as far away as its things would be: on a ring, x counts metres around and y metres
//! above the ground. What is nearer hides what is farther.

mod garden;
mod houses;
mod skyline;

use enfilade_math::{Rgb, Vec2, Vec3};
use enfilade_options::words;
use enfilade_textures::noise::smoothstep;
use serde::{Deserialize, Serialize};
use std::f32::consts::{PI, TAU};

words! {
    /// A kind of surroundings.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum Outside {
        /// Lawn, shrubs and trees.
        #[default]
        Garden = "garden",
        /// A row of town houses across the street, seen from the first floor.
        Street = "street",
        /// Detached houses among trees.
        Suburb = "suburb",
        /// Towers near and far, seen from high up.
        Skyline = "skyline",
        /// Meadows, hedges and hills.
        Country = "country",
    }
}

/// Surroundings in the light of a moment. Illuminances are in kilo-lux, radiances in kcd/m².
pub(super) struct Surroundings {
    /// The kind of surroundings.
    pub kind: Outside,
    /// Unit direction to the sun.
    pub to_sun: Vec3,
    /// By the sun, on a surface that faces it.
    pub sun_klx: Rgb,
    /// By the sky, on level ground.
    pub sky_klx: Rgb,
    /// Decides trees and houses.
    pub seed: u32,
}

/// One direction of view.
struct View {
    /// Bearing as a share of the full circle.
    turn: f32,
    /// Level unit direction.
    level: Vec2,
    /// Tangent of the elevation.
    rise: f32,
    elevation_deg: f32,
    /// Radiance of the haze between the viewer and a thing far away.
    haze: Rgb,
}

impl View {
    /// The point at which this direction meets a ring of the given radius: metres along the ring, and metres above the ground, seen from
    /// `eye` metres above it.
    fn on_ring(&self, radius: f32, eye: f32) -> Vec2 {
        Vec2::new(self.turn * TAU * radius, eye + self.rise * radius)
    }

    /// Distance to the ground, seen from `eye` metres above it; infinite above the horizon.
    fn to_ground(&self, eye: f32) -> f32 {
        if self.rise < 0.0 { -eye / self.rise } else { f32::INFINITY }
    }
}

impl Surroundings {
    /// Radiance in the unit direction `d`; `sky` is the radiance of the sky there, or mirrored at the horizon.
    pub fn radiance(&self, d: Vec3, sky: Rgb) -> Rgb {
        if d.z > 0.75 {
            return sky;
        }
        let across = d.truncate().length().max(1e-3);
        let view = View {
            turn: d.y.atan2(d.x) / TAU + 0.5,
            level: d.truncate() / across,
            rise: d.z / across,
            elevation_deg: d.z.asin().to_degrees(),
            haze: sky,
        };
        match self.kind {
            Outside::Garden => self.garden(&view, sky),
            Outside::Street => self.street(&view, sky),
            Outside::Suburb => self.suburb(&view, sky),
            Outside::Skyline => self.skyline(&view, sky),
            Outside::Country => self.country(&view, sky),
        }
    }

    /// A level Lambert surface.
    fn level(&self, albedo: Rgb) -> Rgb {
        albedo * (self.sun_klx * self.to_sun.z.max(0.0) + self.sky_klx + STREET_LAMPS * self.dark()) * (1.0 / PI)
    }

    /// An upright Lambert surface that faces the home from the direction of `view`: half the sky, sun, and what the ground reflects.
    fn upright(&self, view: &View, albedo: Rgb) -> Rgb {
        let cos = (-view.level).extend(0.0).dot(self.to_sun).max(0.0);
        let ground = (self.sun_klx * self.to_sun.z.max(0.0) + self.sky_klx) * 0.1;
        albedo * (self.sun_klx * cos + self.sky_klx * 0.5 + ground + STREET_LAMPS * self.dark()) * (1.0 / PI)
    }

    /// A crown of leaves, which catches light from all sides.
    fn leaves(&self, albedo: Rgb) -> Rgb {
        albedo
            * (self.sun_klx * (0.35 + 0.4 * self.to_sun.z.max(0.0)) + self.sky_klx * 0.8 + STREET_LAMPS * (0.3 * self.dark()))
            * (1.0 / PI)
    }

    /// 0 by day, 1 when lamps are lit outside: they are switched on below some tens of lux.
    fn dark(&self) -> f32 {
        smoothstep(0.10, 0.02, self.sky_klx.luminance())
    }
}

/// Illuminance of streets and façades by street lamps, kilo-lux (EN 13201: 5 to 15 lx), of warm white light.
const STREET_LAMPS: Rgb = Rgb::new(0.010, 0.0068, 0.0036);
/// Luminance of lit windows, kcd/m².
const LIT_WINDOW: Rgb = Rgb::new(0.050, 0.030, 0.0125);

/// `near` in front of `far`, whitened by `depth` of haze on [0,1].
fn hazed(near: Rgb, haze: Rgb, depth: f32) -> Rgb {
    near.lerp(haze, depth)
}
