//! What people hang on walls themselves: posters, calendars and drawings without a frame, held by tape (class picture; drawings paper), and
//! clothes on a hanger from a hook (class clothes; the hook is other prop). The origin is on the wall, in the middle of the back; +y is into
//! the room.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::palette::Palette;
use crate::pieces::bedroom::{Garment, hang_garment};
use crate::pieces::form::{all, cylinder, to_front, wire};
use crate::pieces::wall_art::printed;
use crate::pieces::{CONTACT, Furniture, board, on};
use crate::shape::{Reshape, grid};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rgb, Rng, Vec2, Vec3};
use enfilade_scene::{Bsdf, ColorParam, Material, TextureRef};
use enfilade_textures::{Display, PaintingStyle, display};

/// A sheet that is taped to a wall.
#[derive(Clone, Copy, Debug)]
pub struct Poster {
    /// Width and height.
    pub size: Vec2,
    /// Turn from the upright, radians.
    pub askew: f32,
    /// What it shows: a picture, or print.
    pub style: Option<PaintingStyle>,
}

/// Rows of cells of a sheet.
const ROWS: usize = 18;
/// Distance of a sheet's lower edge from the wall, metres.
const CURL: f32 = 0.014;
/// Sheets of DIN A4, A3, A2, A1 and a poster of 61 × 91 cm, upright, metres.
const SHEETS: [[f32; 2]; 5] = [[0.21, 0.297], [0.297, 0.42], [0.42, 0.594], [0.594, 0.841], [0.61, 0.91]];

impl Poster {
    /// Distance from the wall at this share of the height: the lower end curls away from it.
    fn out(share: f32) -> f32 {
        CONTACT + CURL * ((0.22 - share) / 0.22).max(0.0).powi(2)
    }

    /// The front, its border left out, `above` the sheet.
    fn curled(&self, border: f32, above: f32) -> Mesh {
        let size = self.size - 2.0 * border;
        let share = |j: usize| j as f32 / ROWS as f32;
        // The wall's x axis points to the viewer's left and u to the right: u runs against x.
        let point = |i: usize, j: usize| Vec3::new(size.x * (0.5 - i as f32), Self::out(share(j)) + above, size.y * (share(j) - 0.5));
        grid(1, ROWS, point, |i, j| Vec2::new(i as f32, share(j))).smoothed(60.0)
    }

    /// The back of the sheet.
    fn back(&self) -> Mesh {
        let front = self.curled(0.0, -0.0002);
        let triangles = front.triangles.iter().map(|&[p, q, r]| [p, r, q]).collect();
        Mesh { triangles, normals: Vec::new(), ..front }.smoothed(60.0)
    }

    /// The material of what is printed on it.
    fn print(&self, b: &mut Builder, rng: &mut Rng) -> u32 {
        let palette = Palette::all()[rng.below(5)];
        if let Some(style) = self.style {
            return printed(b, "poster", style, &palette, rng);
        }
        let shown = [Display::Cards, Display::Desktop][rng.below(2)];
        let image = b.image(display("printed poster", shown, &palette.art, rng.next_u64() as u32));
        let reflectance = ColorParam { factor: Rgb::WHITE, texture: Some(TextureRef::new(image)) };
        b.material(Material::new("poster", Bsdf::Diffuse { reflectance }))
    }
}

impl Furniture for Poster {
    fn random(rng: &mut Rng) -> Self {
        let [width, height] = SHEETS[rng.below(SHEETS.len())];
        let size = if rng.below(4) == 0 { Vec2::new(height, width) } else { Vec2::new(width, height) };
        let styles = [Some(PaintingStyle::Hills), Some(PaintingStyle::Shapes), Some(PaintingStyle::Bands), None];
        Self { size, askew: rng.range(-0.03, 0.03), style: styles[rng.below(4)] }
    }

    fn size(&self) -> Vec3 {
        let (sin, cos) = self.askew.abs().sin_cos();
        Vec3::new(cos * self.size.x + sin * self.size.y, CURL + 0.001, cos * self.size.y + sin * self.size.x)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let turned = pose * DAffine3::from_rotation_y(f64::from(self.askew));
        let poster = b.object("poster", Class::Picture, turned);
        b.part(&poster, "sheet", self.curled(0.0, 0.0).with(self.back()), Finish::Paper);
        let material = self.print(b, rng);
        b.part(&poster, "print", self.curled(0.004, 0.0003), material);
        let tape = |x: f32, z: f32| board([x - 0.012, CONTACT + 0.0002, z - 0.009], [x + 0.012, CONTACT + 0.0008, z + 0.009], 0.0001);
        let corner = 0.5 * self.size - 0.011;
        b.part(&poster, "tape", all([-1.0f32, 1.0].map(|x| tape(x * corner.x, corner.y))), Finish::WhitePlastic);
    }
}

/// Clothes on a hanger from a hook in the wall.
#[derive(Clone, Copy, Debug)]
pub struct HungClothes {
    /// The garment.
    pub garment: Garment,
}

/// Distance of a garment's middle from the wall, metres.
const OUT: f32 = 0.075;

impl Furniture for HungClothes {
    fn random(rng: &mut Rng) -> Self {
        Self { garment: Garment::random(rng) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.56, 2.0 * OUT, 1.3)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let top = 0.5 * self.size().z - 0.06;
        let hook = b.object("wall_hook", Class::OtherProp, on(pose, Vec3::new(0.0, CONTACT, top), 0.0));
        b.part(&hook, "plate", to_front(cylinder(0.018, 0.006, 24)), Finish::BlackMetal);
        let arm = wire(&[[0.0, 0.004, 0.0], [0.0, 0.04, -0.006], [0.0, OUT, -0.004], [0.0, OUT + 0.022, 0.02]], 0.0045, 10);
        b.part(&hook, "arm", arm, Finish::BlackMetal);
        hang_garment(b, on(pose, Vec3::new(0.0, OUT - 0.004, top - 0.0005), 0.0), self.garment, rng);
    }
}
