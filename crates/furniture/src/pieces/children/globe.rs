//! A globe of 20 to 30 cm on its stand, of class other prop: the ball with a printed map of sea, land and ice, held by half a ring of
//! brass, chrome or wood. Its axis is tilted towards +x; the map is computed here.

use crate::builder::{Builder, Class};
use crate::materials::{Finish, coated};
use crate::pieces::form::{rod, turned};
use crate::pieces::{CONTACT, Furniture, on};
use crate::shape::{Reshape, sphere, tube};
use enfilade_math::{DAffine3, Rgb, Rng, Vec2, Vec3};
use enfilade_scene::{ColorParam, TextureRef};
use enfilade_textures::paint;
use std::f32::consts::{PI, TAU};

/// A globe on its stand.
#[derive(Clone, Copy, Debug)]
pub struct Globe {
    /// Radius of the ball.
    pub radius: f32,
}

/// Tilt of the earth's axis, radians: 23.4°.
const TILT: f32 = 0.409;

/// Rough continents and islands as caps of the sphere: longitude and latitude of their middle and their radius, degrees.
const LANDS: [[f32; 3]; 17] = [
    [20.0, 5.0, 22.0],
    [10.0, 18.0, 20.0],
    [25.0, -20.0, 14.0],
    [15.0, 48.0, 15.0],
    [50.0, 55.0, 22.0],
    [85.0, 55.0, 28.0],
    [120.0, 58.0, 22.0],
    [78.0, 22.0, 12.0],
    [105.0, 30.0, 18.0],
    [134.0, -25.0, 17.0],
    [-100.0, 48.0, 22.0],
    [-85.0, 40.0, 14.0],
    [-120.0, 60.0, 16.0],
    [-60.0, -8.0, 18.0],
    [-65.0, -30.0, 10.0],
    [-42.0, 74.0, 12.0],
    [0.0, -90.0, 18.0],
];

/// Sea, land and ice at longitude and latitude (radians), with a grid of meridians and parallels.
fn earth(uv: Vec2) -> Rgb {
    let (longitude, latitude) = (TAU * (uv.x - 0.5), PI * (uv.y - 0.5));
    let direction = |a: f32, b: f32| Vec3::new(b.cos() * a.cos(), b.cos() * a.sin(), b.sin());
    let here = direction(longitude, latitude);
    let ragged = 0.06 * ((9.0 * longitude).sin() * (13.0 * latitude).cos() + 0.6 * (23.0 * longitude + 17.0 * latitude).sin());
    let inside =
        |[a, b, r]: &[f32; 3]| here.angle_between(direction(a.to_radians(), b.to_radians())) < r.to_radians() * (1.0 + 2.0 * ragged);
    let net = |v: f32| ((v / 15.0_f32.to_radians()).fract().abs() - 0.5).abs() > 0.488;
    let shade = if net(longitude) || net(latitude) { 0.8 } else { 1.0 };
    let color = if latitude.abs() > 1.28 {
        Rgb::new(0.75, 0.76, 0.74)
    } else if LANDS.iter().any(inside) {
        let dry = (1.0 - ((latitude.abs() - 0.42) / 0.2).powi(2)).clamp(0.0, 1.0);
        Rgb::new(0.28, 0.36, 0.16).lerp(Rgb::new(0.58, 0.46, 0.24), dry)
    } else {
        Rgb::new(0.10, 0.25, 0.38)
    };
    color * shade
}

impl Furniture for Globe {
    fn random(rng: &mut Rng) -> Self {
        Self { radius: rng.range(0.1, 0.15) }
    }

    fn size(&self) -> Vec3 {
        let r = self.radius + 0.02;
        Vec3::new(2.0 * r, 2.0 * r, 0.085 + 2.0 * r)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let globe = b.object("globe", Class::OtherProp, on(pose, Vec3::new(0.0, 0.0, CONTACT), 0.0));
        let (r, metal) = (self.radius, [Finish::Brass, Finish::Chrome, Finish::Wood][rng.below(3)]);
        let z = 0.075 + 0.014 + r;
        let foot = [[0.0, 0.0], [0.07, 0.0], [0.073, 0.004], [0.068, 0.014], [0.018, 0.024], [0.011, 0.05], [0.011, 0.076], [0.0, 0.076]];
        b.part(&globe, "foot", turned(&foot, 40), metal);
        let axis = Vec3::new(TILT.sin(), 0.0, TILT.cos());
        let ring = r + 0.012;
        let arc: Vec<Vec3> = (0..=24)
            .map(|k| {
                // From the lower pole below the ball, where the foot holds it, and up the right side to the upper pole.
                let a = -0.5 * PI - TILT + PI * k as f32 / 24.0;
                Vec3::new(ring * a.cos(), 0.0, ring * a.sin() + z)
            })
            .collect();
        b.part(&globe, "meridian", tube(&arc, 0.004, 10), metal);
        let pole = axis * ring;
        let center = Vec3::new(0.0, 0.0, z);
        b.part(&globe, "axle", rod((center - pole).to_array(), (center + pole).to_array(), 0.003, 8), metal);
        let picture = b.image(paint("globe", 512, 256, earth));
        let map = ColorParam { factor: Rgb::WHITE, texture: Some(TextureRef::new(picture)) };
        let material = b.material(coated("printed globe", map, 0.15));
        let mut ball = sphere(r, 48);
        // The map runs over the unit square: around the axis and from pole to pole.
        let girth = TAU * r;
        ball.uvs
            .iter_mut()
            .zip(&ball.positions)
            .for_each(|(uv, p)| *uv = Vec2::new(uv.x / girth, 0.5 + (p.z / r).clamp(-1.0, 1.0).asin() / PI));
        b.part(&globe, "ball", ball.turned(Vec3::Z, rng.range(0.0, TAU)).turned(Vec3::Y, TILT).moved(center), material);
    }
}
