//! Lamps with a bulb in a shade or in an opal globe, of class lamp: floor lamps 148 to 162 cm high on a pole or a tripod, table lamps with
//! a turned foot or as a globe, and pendants of five shapes that hang 60 to 110 cm down. Cloth shades are drums, open at both ends. The
//! origin of a pendant is on the ceiling, the origin of the others on what they stand on.

use super::{CONTACT, Furniture, standing};
use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::shape::{Reshape, lathe, rounded_loop, sphere, spline, tube};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// Half the thickness of a cloth shade, metres: it reaches this far out beyond its radius.
const CLOTH: f32 = 0.0012;
/// A drum shade, open at both ends: a thin cloth wall from z = 0 to `height`.
fn drum(bottom: f32, top: f32, height: f32) -> Mesh {
    let profile = [
        [bottom, 0.0],
        [bottom + CLOTH, 0.001],
        [top + CLOTH, height - 0.001],
        [top, height],
        [top - CLOTH, height - 0.001],
        [bottom - CLOTH, 0.001],
        [bottom, 0.0],
    ];
    lathe(&profile.map(Vec2::from_array), 64)
}

/// The wire ring and spokes that carry a shade of `radius` at height `z`.
pub(super) fn carrier(radius: f32, z: f32) -> Mesh {
    let mut mesh = tube(&rounded_loop(2.0 * radius, 2.0 * radius, radius, 10), 0.0018, 6);
    for k in 0..3 {
        let out = Vec2::from_angle(k as f32 * std::f32::consts::TAU / 3.0) * radius;
        mesh = mesh.with(tube(&[Vec3::ZERO, out.extend(0.0)], 0.0016, 6));
    }
    mesh.moved(Vec3::new(0.0, 0.0, z))
}

/// A bulb, whose socket is at the height `socket`, in a cloth drum: `radii` and `z` are of its lower and its upper rim.
fn shaded_bulb(b: &mut Builder, lamp: &Object, radii: [f32; 2], z: [f32; 2], socket: f32) {
    let holder = lathe(&[[0.0, 0.0], [0.02, 0.0], [0.02, 0.05], [0.0, 0.05]].map(Vec2::from_array), 20);
    b.part(lamp, "socket", holder.moved(Vec3::new(0.0, 0.0, socket - 0.0002)), Finish::BlackMetal);
    let ring = socket + 0.004;
    let inside = radii[0] + (radii[1] - radii[0]) * (ring - z[0]) / (z[1] - z[0]) - 0.004;
    b.part(lamp, "carrier", carrier(inside, ring), Finish::Steel);
    b.part(lamp, "bulb", sphere(0.03, 24).moved(Vec3::new(0.0, 0.0, socket + 0.0795)), Finish::Bulb);
    b.part(lamp, "shade", drum(radii[0], radii[1], z[1] - z[0]).moved(Vec3::new(0.0, 0.0, z[0])), Finish::Lampshade);
}

/// A standing lamp with a cloth drum around its bulb.
#[derive(Clone, Copy, Debug)]
pub struct FloorLamp {
    /// Height of the shade's upper rim.
    pub height: f32,
    /// Radius of the shade.
    pub shade: f32,
    /// Radius of the shade's upper rim over the radius of the lower one.
    pub taper: f32,
    /// Stands on three wooden legs instead of a pole.
    pub tripod: bool,
}

impl FloorLamp {
    fn stand(&self, b: &mut Builder, lamp: &Object, joint: f32) {
        if !self.tripod {
            let base = [[0.0, 0.0], [0.135, 0.0], [0.138, 0.004], [0.136, 0.018], [0.12, 0.022], [0.016, 0.026], [0.0, 0.026]];
            b.part(lamp, "base", lathe(&base.map(Vec2::from_array), 48), Finish::BlackMetal);
            b.part(lamp, "pole", tube(&[Vec3::new(0.0, 0.0, 0.0255), Vec3::new(0.0, 0.0, joint)], 0.0095, 16), Finish::BlackMetal);
            return;
        }
        for k in 0..3 {
            let out = Vec2::from_angle(0.3 + k as f32 * std::f32::consts::TAU / 3.0);
            let path = [(out * 0.27).extend(0.0), (out * 0.025).extend(joint - 0.07)];
            b.part(lamp, &format!("leg_{}", k + 1), standing(tube(&path, 0.0125, 14)), Finish::Wood);
        }
        let hub = [
            [0.0, joint - 0.11],
            [0.036, joint - 0.11],
            [0.038, joint - 0.105],
            [0.038, joint - 0.06],
            [0.012, joint - 0.05],
            [0.010, joint],
            [0.0, joint],
        ];
        b.part(lamp, "hub", lathe(&hub.map(Vec2::from_array), 24), Finish::Brass);
    }
}

impl Furniture for FloorLamp {
    fn random(rng: &mut Rng) -> Self {
        Self {
            height: rng.range(1.48, 1.62),
            shade: rng.range(0.19, 0.22),
            taper: [0.99, 0.86, 0.62][rng.below(3)],
            tripod: rng.below(2) == 0,
        }
    }

    fn size(&self) -> Vec3 {
        let width = if self.tripod { 0.56 } else { 2.0 * self.shade };
        Vec3::new(width.max(2.0 * self.shade), width.max(2.0 * self.shade), self.height)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let lamp = b.object("floor_lamp", Class::Lamp, pose);
        let drum_height = 0.27;
        let bottom = self.height - drum_height;
        let socket = bottom + 0.055;
        self.stand(b, &lamp, socket);
        shaded_bulb(b, &lamp, [self.shade, self.taper * self.shade], [bottom, self.height], socket);
    }
}

/// A table lamp.
#[derive(Clone, Copy, Debug)]
pub enum TableLamp {
    /// An opal globe of this radius on a small foot.
    Globe(f32),
    /// A turned foot of this height under a cloth shade of this radius, and the shade's taper.
    Shaded(f32, f32, f32),
}

/// Height of the shade of a table lamp, which hides the bulb.
fn shade_height(radius: f32) -> f32 {
    radius + 0.045
}

impl TableLamp {
    fn globe(b: &mut Builder, lamp: &Object, radius: f32) {
        let foot = 0.62 * radius;
        let profile = [
            [0.0, 0.0],
            [foot, 0.0],
            [foot + 0.002, 0.003],
            [foot, 0.012],
            [0.6 * foot, 0.02],
            [0.5 * foot, 0.052],
            [0.46 * foot, 0.056],
            [0.0, 0.056],
        ];
        b.part(lamp, "foot", lathe(&profile.map(Vec2::from_array), 40).moved(Vec3::new(0.0, 0.0, CONTACT)), Finish::Brass);
        let sunk = radius - (radius * radius - (0.46 * foot).powi(2)).sqrt();
        b.part(lamp, "globe", sphere(radius, 40).moved(Vec3::new(0.0, 0.0, 0.0565 + radius - sunk)), Finish::OpalGlobe);
    }

    fn shaded(b: &mut Builder, lamp: &Object, [height, radius, taper]: [f32; 3], rng: &mut Rng) {
        // A bottle, a ball or a candlestick: [radius over the shade's radius, share of the height].
        let shapes = [
            [[0.34, 0.0], [0.46, 0.16], [0.44, 0.5], [0.16, 0.78], [0.1, 0.96]],
            [[0.36, 0.0], [0.5, 0.3], [0.42, 0.64], [0.13, 0.84], [0.1, 0.96]],
            [[0.46, 0.0], [0.44, 0.07], [0.09, 0.16], [0.12, 0.55], [0.08, 0.96]],
        ];
        let curve = spline(&shapes[rng.below(3)].map(|[r, z]| [r * radius, z * height]), 6);
        let mut profile = vec![Vec2::ZERO];
        profile.extend(curve.iter().map(|p| Vec2::new(p.x, p.y.clamp(0.0, height))));
        profile.extend([Vec2::new(0.011, height), Vec2::new(0.0, height)]);
        let finish = [Finish::Ceramic(0), Finish::Ceramic(1), Finish::Ceramic(2), Finish::Brass, Finish::DarkWood, Finish::Terracotta];
        b.part(lamp, "foot", lathe(&profile, 44).moved(Vec3::new(0.0, 0.0, CONTACT)), finish[rng.below(6)]);
        let low = height - 0.03;
        shaded_bulb(b, lamp, [radius, taper * radius], [low, low + shade_height(radius)], height);
    }
}

impl Furniture for TableLamp {
    fn random(rng: &mut Rng) -> Self {
        if rng.below(3) == 0 {
            Self::Globe(rng.range(0.085, 0.125))
        } else {
            Self::Shaded(rng.range(0.16, 0.26), rng.range(0.105, 0.145), [0.98, 0.8, 0.62][rng.below(3)])
        }
    }

    fn size(&self) -> Vec3 {
        match *self {
            Self::Globe(r) => Vec3::new(2.0 * r, 2.0 * r, 0.06 + 2.0 * r),
            Self::Shaded(height, r, _) => Vec3::new(2.0 * r + 2.0 * CLOTH, 2.0 * r + 2.0 * CLOTH, height - 0.03 + shade_height(r)),
        }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let lamp = b.object("table_lamp", Class::Lamp, pose);
        match *self {
            Self::Globe(radius) => Self::globe(b, &lamp, radius),
            Self::Shaded(height, radius, taper) => Self::shaded(b, &lamp, [height, radius, taper], rng),
        }
    }
}

/// A lamp that hangs from the ceiling; its origin is on the ceiling.
#[derive(Clone, Copy, Debug)]
pub struct Pendant {
    /// Length from the ceiling to the lower rim.
    pub drop: f32,
    /// Radius of the shade, or of the globe in its place.
    pub radius: f32,
    /// Shade that hides the bulb.
    pub shade: PendantShade,
    /// Finish of shade and canopy.
    pub finish: Finish,
}

/// The shade of a pendant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PendantShade {
    /// Half of a ball.
    Bell,
    /// A cone with a short neck.
    Cone,
    /// A narrow tube.
    Tube,
    /// A drum of cloth, open at both ends.
    Drum,
    /// No shade: an opal globe.
    Globe,
}

impl Pendant {
    /// The outside of the shade from rim to crown as a profile [radius, height], both divided by its radius.
    fn outline(&self) -> Vec<[f32; 2]> {
        match self.shade {
            PendantShade::Cone => vec![[1.0, 0.0], [0.2, 0.68], [0.17, 0.72], [0.17, 0.85], [0.0, 0.86]],
            PendantShade::Tube => vec![[0.42, 0.0], [0.42, 1.25], [0.38, 1.3], [0.0, 1.3]],
            _ => {
                let round = |k: usize| {
                    let (sin, cos) = (std::f32::consts::FRAC_PI_2 * k as f32 / 14.0).sin_cos();
                    [if k == 14 { 0.0 } else { cos.powf(0.8) }, 0.75 * sin]
                };
                (0..=14).map(round).collect()
            }
        }
    }

    /// A shell of sheet metal around the bulb; returns the height of its crown above its rim.
    fn metal(&self, b: &mut Builder, lamp: &Object) -> f32 {
        /// Thickness of the sheet metal, metres.
        const SHEET: f32 = 0.002;
        let rim = -self.drop;
        let outside: Vec<Vec2> = self.outline().into_iter().map(|p| self.radius * Vec2::from_array(p) + Vec2::new(0.0, rim)).collect();
        let crown = outside[outside.len() - 1].y - rim;
        let inside = outside.iter().rev().map(|p| Vec2::new((p.x - SHEET).max(0.0), (p.y - SHEET).max(rim)));
        let shell: Vec<Vec2> = outside.iter().copied().chain(inside).chain([outside[0]]).collect();
        b.part(lamp, "shade", lathe(&shell, 56).smoothed(30.0), self.finish);
        let bulb = rim + 0.45 * crown;
        b.part(lamp, "bulb", sphere(0.045, 24).moved(Vec3::new(0.0, 0.0, bulb)), Finish::OpalGlobe);
        let socket = tube(&[Vec3::new(0.0, 0.0, bulb + 0.043), Vec3::new(0.0, 0.0, rim + crown - SHEET)], 0.016, 16);
        b.part(lamp, "socket", socket, Finish::BlackPlastic);
        crown
    }
}

impl Furniture for Pendant {
    fn random(rng: &mut Rng) -> Self {
        use PendantShade::{Bell, Cone, Drum, Globe, Tube};
        let finishes =
            [Finish::Ceramic(0), Finish::BlackMetal, Finish::CoatedWhite, Finish::Brass, Finish::Copper, Finish::ColoredMetal(0)];
        Self {
            drop: rng.range(0.6, 1.1),
            radius: rng.range(0.15, 0.24),
            shade: [Bell, Cone, Tube, Drum, Globe][rng.below(5)],
            finish: finishes[rng.below(finishes.len())],
        }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(2.0 * self.radius + 2.0 * CLOTH, 2.0 * self.radius + 2.0 * CLOTH, self.drop)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let lamp = b.object("pendant", Class::Lamp, pose);
        let canopy = [[0.0, -0.03], [0.045, -0.03], [0.05, -0.026], [0.05, 0.001], [0.0, 0.001]];
        b.part(&lamp, "canopy", lathe(&canopy.map(Vec2::from_array), 32), self.finish);
        let (r, rim) = (self.radius, -self.drop);
        let crown = match self.shade {
            PendantShade::Globe => {
                b.part(&lamp, "globe", sphere(0.8 * r, 40).moved(Vec3::new(0.0, 0.0, rim + 0.8 * r)), Finish::OpalGlobe);
                let cap = lathe(&[[0.0, -0.02], [0.03, -0.02], [0.03, 0.02], [0.0, 0.024]].map(Vec2::from_array), 24);
                b.part(&lamp, "cap", cap.moved(Vec3::new(0.0, 0.0, rim + 1.6 * r)), self.finish);
                1.6 * r + 0.02
            }
            PendantShade::Drum => {
                let socket = rim + 0.55 * r;
                // The bulb hangs head down below the wires that carry the shade.
                b.part(&lamp, "carrier", carrier(r - 0.003, socket), Finish::Steel);
                b.part(&lamp, "shade", drum(r, r, r).moved(Vec3::new(0.0, 0.0, rim)), Finish::Lampshade);
                b.part(&lamp, "bulb", sphere(0.035, 24).moved(Vec3::new(0.0, 0.0, socket - 0.036)), Finish::Bulb);
                b.part(
                    &lamp,
                    "socket",
                    tube(&[Vec3::new(0.0, 0.0, socket - 0.003), Vec3::new(0.0, 0.0, socket + 0.05)], 0.016, 16),
                    self.finish,
                );
                0.55 * r + 0.048
            }
            _ => self.metal(b, &lamp),
        };
        let cord = tube(&[Vec3::new(0.0, 0.0, -0.0295), Vec3::new(0.0, 0.0, rim + crown - 0.001)], 0.003, 8);
        b.part(&lamp, "cord", cord, Finish::BlackPlastic);
    }
}
