//! Seven kinds of lamps on a ceiling, all of class lamp: flush disks of 30 to 52 cm, chandeliers with five to eight arms, spots on a track,
//! bars of light over a table, paper lanterns, clusters of shades, and a fan with a lamp. The origin is on the ceiling, and all hang below
//! it at negative z.

use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::Furniture;
use crate::pieces::form::{all, around, cylinder, rod, turned, wire};
use crate::shape::{Reshape, bevelled_box, lathe, rounded_box, sphere, spline, tube};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::TAU;

/// Lamps on the ceiling, where their origin is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CeilingLamp {
    /// A flat disk of this radius.
    Flush(f32),
    /// Globes on this many arms.
    Chandelier(usize),
    /// Spots on a rail of this length.
    Track(f32),
    /// A bar of light of this length over a table, and its drop.
    Bar(f32, f32),
    /// A paper lantern of this radius.
    Lantern(f32),
    /// A cluster of this many small shades at different heights.
    Cluster(usize),
    /// A fan with a lamp.
    Fan,
}

impl CeilingLamp {
    fn chandelier(b: &mut Builder, lamp: &Object, arms: usize) {
        b.part(lamp, "canopy", turned(&[[0.0, -0.04], [0.03, -0.038], [0.06, -0.01], [0.062, 0.0], [0.0, 0.0]], 36), Finish::Brass);
        let hub = -0.36;
        b.part(lamp, "rod", rod([0.0, 0.0, -0.03], [0.0, 0.0, hub], 0.006, 12), Finish::Brass);
        let body = [[0.0, hub - 0.09], [0.012, hub - 0.085], [0.03, hub - 0.04], [0.018, hub], [0.014, hub + 0.08], [0.0, hub + 0.09]];
        b.part(lamp, "hub", turned(&body, 28), Finish::Brass);
        let (mut brass, mut globes) = (Vec::new(), Vec::new());
        for d in around(arms, 0.3) {
            let (r, z) = (0.34, hub + 0.03);
            brass.push(wire(
                &[
                    [d.x * 0.02, d.y * 0.02, hub - 0.03],
                    [d.x * 0.15, d.y * 0.15, hub - 0.085],
                    [d.x * 0.29, d.y * 0.29, hub - 0.06],
                    [d.x * r, d.y * r, z - 0.02],
                ],
                0.0055,
                10,
            ));
            let cup = turned(&[[0.0, z - 0.03], [0.016, z - 0.028], [0.03, z - 0.005], [0.03, z], [0.0, z]], 24);
            brass.push(cup.moved((d * r).extend(0.0)));
            globes.push(sphere(0.062, 28).moved((d * r).extend(z + 0.054)));
        }
        b.part(lamp, "arms", all(brass), Finish::Brass);
        b.part(lamp, "globes", all(globes), Finish::OpalGlobe);
    }

    fn track(b: &mut Builder, lamp: &Object, length: f32, white: bool, rng: &mut Rng) {
        let finish = if white { Finish::CoatedWhite } else { Finish::BlackMetal };
        b.part(lamp, "rail", bevelled_box(Vec3::new(length, 0.035, 0.03), 0.002).moved(Vec3::new(0.0, 0.0, -0.015)), finish);
        let spots = (length / 0.32) as usize;
        for k in 0..spots {
            let x = length * ((k as f32 + 0.5) / spots as f32 - 0.5);
            let (yaw, tilt) = (rng.range(0.0, TAU), rng.range(0.3, 0.7));
            let can = turned(&[[0.0, 0.0], [0.028, 0.0], [0.03, 0.004], [0.03, 0.105], [0.026, 0.105], [0.025, 0.09], [0.0, 0.09]], 28);
            let bulb = turned(&[[0.0, 0.0905], [0.0245, 0.0905], [0.0245, 0.093], [0.0, 0.095]], 24);
            // A spot is drawn shining along +z, and is then turned head down.
            let place = |mesh: enfilade_geometry::Mesh| {
                let mesh = mesh.moved(Vec3::new(0.0, 0.0, -0.03)).turned(Vec3::X, std::f32::consts::PI - tilt).turned(Vec3::Z, yaw);
                mesh.moved(Vec3::new(x, 0.0, -0.105))
            };
            b.part(lamp, &format!("spot_{}", k + 1), place(can).with(rod([x, 0.0, -0.029], [x, 0.0, -0.1], 0.006, 8)), finish);
            b.part(lamp, &format!("bulb_{}", k + 1), place(bulb), Finish::Bulb);
        }
    }

    fn lantern(b: &mut Builder, lamp: &Object, r: f32) {
        let drop = 0.08 + r;
        b.part(lamp, "canopy", turned(&[[0.0, -0.03], [0.04, -0.03], [0.045, -0.025], [0.045, 0.0], [0.0, 0.0]], 28), Finish::WhitePlastic);
        b.part(lamp, "cord", rod([0.0, 0.0, -0.0295], [0.0, 0.0, -drop], 0.0025, 6), Finish::WhitePlastic);
        // Paper sags inward between the ribs.
        let rows = 64;
        let profile: Vec<Vec2> = (2..=rows - 2)
            .map(|j| {
                let t = std::f32::consts::PI * j as f32 / rows as f32;
                let sag = 0.012 * r * (1.0 - (4.0 * t * 4.0).sin().abs());
                Vec2::new((r - sag) * t.sin(), -drop - (r - sag) * t.cos())
            })
            .collect();
        let mut shell = profile.clone();
        shell.extend(profile.iter().rev().map(|p| Vec2::new((p.x - 0.001).max(0.001), p.y)));
        shell.push(profile[0]);
        b.part(lamp, "paper", lathe(&shell, 56), Finish::Lampshade);
        // A wire across its upper opening hangs on the cord.
        let rim = profile[profile.len() - 1];
        b.part(lamp, "spoke", rod([-rim.x, 0.0, rim.y], [rim.x, 0.0, rim.y], 0.0012, 6), Finish::WhitePlastic);
        b.part(lamp, "bulb", sphere(0.045, 20).moved(Vec3::new(0.0, 0.0, -drop - 0.045)), Finish::Bulb);
    }

    fn cluster(b: &mut Builder, lamp: &Object, count: usize, rng: &mut Rng) {
        let metal = [Finish::BlackMetal, Finish::Brass][rng.below(2)];
        b.part(lamp, "canopy", cylinder(0.14, 0.025, 48).moved(Vec3::new(0.0, 0.0, -0.025)), metal);
        let kind = rng.below(2);
        for (k, d) in around(count, rng.next_f32()).enumerate() {
            // Cords hang straight down from the rim of the canopy.
            let at = d * 0.12;
            let drop = 0.45 + 0.18 * k as f32;
            let cord = tube(&[at.extend(-0.024), at.extend(-drop)], 0.0022, 6);
            b.part(lamp, &format!("cord_{}", k + 1), cord, Finish::BlackPlastic);
            let curve = spline(&[[0.012, 0.0], [0.04, -0.02], [0.062, -0.07], [0.075, -0.14]], 5);
            let mut shade = vec![[0.075, -0.14]];
            shade.extend(curve.iter().rev().skip(1).map(Vec2::to_array));
            shade.extend([[0.0, 0.001], [0.0, -0.002]]);
            shade.extend(curve.iter().map(|p| [(p.x - 0.0018).max(0.001), p.y - 0.001]));
            shade.push([0.075, -0.14]);
            let move_to = at.extend(-drop);
            let finish = if kind == 0 { metal } else { Finish::Ceramic(k as u8) };
            b.part(lamp, &format!("shade_{}", k + 1), turned(&shade, 40).moved(move_to), finish);
            b.part(lamp, &format!("bulb_{}", k + 1), sphere(0.035, 20).moved(move_to - Vec3::new(0.0, 0.0, 0.08)), Finish::Bulb);
            let socket = cylinder(0.011, 0.048, 16).moved(move_to - Vec3::new(0.0, 0.0, 0.049));
            b.part(lamp, &format!("socket_{}", k + 1), socket, Finish::BlackPlastic);
        }
    }

    fn fan(b: &mut Builder, lamp: &Object) {
        b.part(lamp, "canopy", turned(&[[0.0, -0.05], [0.05, -0.05], [0.07, -0.02], [0.07, 0.0], [0.0, 0.0]], 36), Finish::BlackMetal);
        b.part(lamp, "rod", cylinder(0.013, 0.2, 16).moved(Vec3::new(0.0, 0.0, -0.24)), Finish::BlackMetal);
        b.part(
            lamp,
            "motor",
            turned(&[[0.0, -0.36], [0.08, -0.355], [0.11, -0.33], [0.11, -0.27], [0.07, -0.235], [0.0, -0.235]], 40),
            Finish::BlackMetal,
        );
        // Height of the blades.
        let level = -0.3;
        let blade = |d: Vec2| {
            let board = rounded_box(Vec3::new(0.5, 0.13, 0.009), 0.004, 2)
                .deformed(|p| Vec3::new(p.x, p.y * (0.85 + 0.5 * (p.x + 0.25)), p.z))
                .smoothed(40.0);
            board.turned(Vec3::X, 0.2).moved(Vec3::new(0.4, 0.0, level)).turned(Vec3::Z, d.to_angle())
        };
        b.part(lamp, "blades", all(around(5, 0.4).map(blade)), Finish::Wood);
        // Each blade is held by an iron that comes out of the motor.
        let iron = |d: Vec2| rod((d * 0.09).extend(level).to_array(), (d * 0.2).extend(level).to_array(), 0.008, 12);
        b.part(lamp, "irons", all(around(5, 0.4).map(iron)), Finish::BlackMetal);
        b.part(
            lamp,
            "globe",
            turned(&[[0.0, -0.43], [0.06, -0.42], [0.092, -0.385], [0.095, -0.3605], [0.0, -0.3605]], 40),
            Finish::OpalGlobe,
        );
    }
}

impl Furniture for CeilingLamp {
    fn random(rng: &mut Rng) -> Self {
        match rng.below(7) {
            0 => Self::Flush(rng.range(0.15, 0.26)),
            1 => Self::Chandelier(5 + rng.below(4)),
            2 => Self::Track(rng.range(0.9, 1.6)),
            3 => Self::Bar(rng.range(0.9, 1.3), rng.range(0.6, 0.9)),
            4 => Self::Lantern(rng.range(0.2, 0.3)),
            5 => Self::Cluster(3 + rng.below(3)),
            _ => Self::Fan,
        }
    }

    fn size(&self) -> Vec3 {
        match *self {
            Self::Flush(r) => Vec3::new(2.0 * r, 2.0 * r, 0.085),
            Self::Chandelier(_) => Vec3::new(0.81, 0.81, 0.45),
            Self::Track(w) => Vec3::new(w, 0.2, 0.2),
            Self::Bar(w, drop) => Vec3::new(w, 0.08, drop),
            Self::Lantern(r) => Vec3::new(2.0 * r, 2.0 * r, 0.08 + 2.0 * r),
            Self::Cluster(n) => Vec3::new(0.5, 0.5, 0.6 + 0.18 * (n - 1) as f32),
            Self::Fan => Vec3::new(1.32, 1.32, 0.43),
        }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let lamp = b.object("ceiling_lamp", Class::Lamp, pose);
        match *self {
            Self::Flush(r) => {
                let metal = [Finish::Brass, Finish::BlackMetal, Finish::CoatedWhite, Finish::Wood][rng.below(4)];
                let ring = [
                    [r - 0.02, -0.045],
                    [r - 0.004, -0.045],
                    [r, -0.04],
                    [r, 0.0],
                    [0.0, 0.0],
                    [0.0, -0.03],
                    [r - 0.02, -0.03],
                    [r - 0.02, -0.045],
                ];
                b.part(&lamp, "ring", turned(&ring, 64), metal);
                let glass = [[0.0, -0.084], [0.5 * r, -0.08], [0.86 * r, -0.062], [r - 0.021, -0.04], [r - 0.021, -0.031], [0.0, -0.031]];
                b.part(&lamp, "glass", turned(&glass, 64), Finish::OpalGlobe);
            }
            Self::Chandelier(arms) => Self::chandelier(b, &lamp, arms),
            Self::Track(w) => Self::track(b, &lamp, w, rng.below(2) == 0, rng),
            Self::Bar(w, drop) => {
                let metal = [Finish::Brass, Finish::BlackMetal][rng.below(2)];
                b.part(&lamp, "canopy", bevelled_box(Vec3::new(0.24, 0.06, 0.025), 0.003).moved(Vec3::new(0.0, 0.0, -0.0125)), metal);
                let wires = [-1.0f32, 1.0].map(|s| rod([s * 0.09, 0.0, -0.02], [s * 0.35 * w, 0.0, -drop + 0.03], 0.0011, 5));
                b.part(&lamp, "wires", all(wires), Finish::BlackMetal);
                b.part(&lamp, "bar", rounded_box(Vec3::new(w, 0.042, 0.036), 0.008, 3).moved(Vec3::new(0.0, 0.0, -drop + 0.022)), metal);
                b.part(
                    &lamp,
                    "light",
                    rounded_box(Vec3::new(w - 0.03, 0.03, 0.008), 0.002, 1).moved(Vec3::new(0.0, 0.0, -drop + 0.0035)),
                    Finish::OpalGlobe,
                );
            }
            Self::Lantern(r) => Self::lantern(b, &lamp, r),
            Self::Cluster(n) => Self::cluster(b, &lamp, n, rng),
            Self::Fan => Self::fan(b, &lamp),
        }
    }
}
