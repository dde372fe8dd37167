use super::{CONTACT, Furniture, standing};
use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::shape::{Reshape, lathe, rounded_loop, sphere, tube};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// A drum shade, open at both ends: a thin cloth wall from z = 0 to `height`.
fn drum(bottom: f32, top: f32, height: f32) -> Mesh {
    const CLOTH: f32 = 0.0012;
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
fn carrier(radius: f32, z: f32) -> Mesh {
    let mut mesh = tube(&rounded_loop(2.0 * radius, 2.0 * radius, radius, 10), 0.0018, 6);
    for k in 0..3 {
        let out = Vec2::from_angle(k as f32 * std::f32::consts::TAU / 3.0) * radius;
        mesh = mesh.with(tube(&[Vec3::ZERO, out.extend(0.0)], 0.0016, 6));
    }
    mesh.moved(Vec3::new(0.0, 0.0, z))
}

/// A standing lamp with a cloth drum around its bulb.
#[derive(Clone, Copy, Debug)]
pub struct FloorLamp {
    /// Height of the shade's upper rim.
    pub height: f32,
    /// Radius of the shade.
    pub shade: f32,
    /// On three wooden legs instead of a pole.
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
        Self { height: rng.range(1.48, 1.62), shade: rng.range(0.19, 0.22), tripod: rng.below(2) == 0 }
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
        b.part(
            &lamp,
            "socket",
            lathe(&[[0.0, 0.0], [0.02, 0.0], [0.02, 0.05], [0.0, 0.05]].map(Vec2::from_array), 20).moved(Vec3::new(
                0.0,
                0.0,
                socket - 0.0002,
            )),
            Finish::BlackMetal,
        );
        b.part(&lamp, "carrier", carrier(self.shade - 0.003, socket + 0.004), Finish::Steel);
        b.part(&lamp, "bulb", sphere(0.036, 24).moved(Vec3::new(0.0, 0.0, socket + 0.05 + 0.0358)), Finish::Bulb);
        b.part(&lamp, "shade", drum(self.shade, 0.86 * self.shade, drum_height).moved(Vec3::new(0.0, 0.0, bottom)), Finish::Lampshade);
    }
}

/// A table lamp: an opal globe on a small foot.
#[derive(Clone, Copy, Debug)]
pub struct TableLamp {
    /// Radius of the globe.
    pub globe: f32,
}

impl Furniture for TableLamp {
    fn random(rng: &mut Rng) -> Self {
        Self { globe: rng.range(0.1, 0.14) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(2.0 * self.globe, 2.0 * self.globe, 0.06 + 2.0 * self.globe)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let lamp = b.object("table_lamp", Class::Lamp, pose);
        let foot = 0.62 * self.globe;
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
        b.part(&lamp, "foot", lathe(&profile.map(Vec2::from_array), 40).moved(Vec3::new(0.0, 0.0, CONTACT)), Finish::Brass);
        let sunk = self.globe - (self.globe * self.globe - (0.46 * foot).powi(2)).sqrt();
        b.part(&lamp, "globe", sphere(self.globe, 40).moved(Vec3::new(0.0, 0.0, 0.0565 + self.globe - sunk)), Finish::OpalGlobe);
    }
}

/// A lamp that hangs from the ceiling: a metal bell over a glowing disk. Its origin is on the ceiling.
#[derive(Clone, Copy, Debug)]
pub struct Pendant {
    /// Length from the ceiling to the lower rim.
    pub drop: f32,
    /// Radius of the bell.
    pub radius: f32,
}

impl Furniture for Pendant {
    fn random(rng: &mut Rng) -> Self {
        Self { drop: rng.range(0.6, 1.1), radius: rng.range(0.15, 0.24) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(2.0 * self.radius, 2.0 * self.radius, self.drop)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let lamp = b.object("pendant", Class::Lamp, pose);
        let canopy = [[0.0, -0.03], [0.045, -0.03], [0.05, -0.026], [0.05, 0.001], [0.0, 0.001]];
        b.part(&lamp, "canopy", lathe(&canopy.map(Vec2::from_array), 32), Finish::BlackMetal);
        let (r, bell) = (self.radius, 0.75 * self.radius);
        let rim = -self.drop;
        b.part(&lamp, "cord", tube(&[Vec3::new(0.0, 0.0, -0.0295), Vec3::new(0.0, 0.0, rim + bell)], 0.003, 8), Finish::BlackPlastic);
        let mut outside = vec![Vec2::new(r, rim)];
        let wall = |k: usize, shrink: f32| {
            let (sin, cos) = (std::f32::consts::FRAC_PI_2 * k as f32 / 14.0).sin_cos();
            Vec2::new((r - shrink) * cos.max(0.0).powf(0.8), rim + (bell - shrink) * sin)
        };
        outside.extend((1..14).map(|k| wall(k, 0.0)));
        outside.push(Vec2::new(0.0, rim + bell));
        outside.push(Vec2::new(0.0, rim + bell - 0.002));
        outside.extend((1..14).rev().map(|k| wall(k, 0.002)));
        outside.push(Vec2::new(r - 0.002, rim));
        outside.push(Vec2::new(r, rim));
        b.part(&lamp, "bell", lathe(&outside, 56), Finish::Ceramic(0));
        b.part(&lamp, "bulb", sphere(0.045, 24).moved(Vec3::new(0.0, 0.0, rim + 0.45 * bell)), Finish::OpalGlobe);
        b.part(
            &lamp,
            "socket",
            tube(&[Vec3::new(0.0, 0.0, rim + 0.45 * bell + 0.043), Vec3::new(0.0, 0.0, rim + bell - 0.0022)], 0.016, 16),
            Finish::BlackPlastic,
        );
    }
}
