//! Framed pictures, 30 to 90 cm on the short side (class picture), and round mirrors, 44 to 80 cm across (class mirror). A picture is a
//! frame of wood or black metal, a white mount and a print of a painting of its own. The origin is the middle of the back, on the wall's
//! face; they face +y.

use super::{Furniture, grained};
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::palette::Palette;
use crate::shape::{Reshape, grid, lathe, picture_frame};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use enfilade_scene::{Bsdf, ColorParam, Material, TextureRef};
use enfilade_textures::{PaintingStyle, painting};

/// A framed picture; its origin is the middle of its back, on the wall's face.
#[derive(Clone, Copy, Debug)]
pub struct PictureOnWall {
    /// Outer size of the frame.
    pub size: Vec2,
    /// Width of the white mount around the picture.
    pub mount: f32,
    /// Style of the painting.
    pub style: PaintingStyle,
    /// The colours of what it shows.
    pub palette: Palette,
    /// Frame of black metal instead of wood.
    pub black: bool,
}

/// The material of a picture that only one thing has, in the colours of `palette`.
pub fn printed(b: &mut Builder, name: &str, style: PaintingStyle, palette: &Palette, rng: &mut Rng) -> u32 {
    let image = b.image(painting(&format!("{name} {style:?}"), style, &palette.art, rng.next_u64() as u32));
    let reflectance = ColorParam { factor: enfilade_math::Rgb::WHITE, texture: Some(TextureRef::new(image)) };
    b.material(Material::new(name, Bsdf::Diffuse { reflectance }))
}

/// A rectangle in the xz plane at depth `y`, facing +y, its texture upright over the unit square.
fn sheet(size: Vec2, y: f32) -> Mesh {
    let corner = |i: usize, j: usize| Vec2::new(i as f32, j as f32);
    // The wall's x axis points to the viewer's left and u to the right: u runs against x.
    grid(1, 1, |i, j| Vec3::new(size.x * (0.5 - corner(i, j).x), y, size.y * (corner(i, j).y - 0.5)), corner)
}

impl Furniture for PictureOnWall {
    fn random(rng: &mut Rng) -> Self {
        let style = [PaintingStyle::Hills, PaintingStyle::Shapes, PaintingStyle::Bands][rng.below(3)];
        let size = rng.range(0.3, 0.9) * [Vec2::new(1.0, 1.3), Vec2::new(1.3, 1.0), Vec2::ONE][rng.below(3)];
        let mount = rng.range(0.08, 0.12) * size.min_element();
        Self { size, mount, style, palette: Palette::all()[rng.below(5)], black: rng.below(2) == 0 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.size.x, 0.025, self.size.y)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let picture = b.object("picture", Class::Picture, pose);
        let section = [[0.0, -0.0005], [0.0, 0.021], [0.002, 0.0235], [0.016, 0.0235], [0.018, 0.0215], [0.018, -0.0005]];
        let frame = picture_frame(self.size.x, self.size.y, &section);
        let frame_material = if self.black { Finish::BlackMetal } else { Finish::Wood };
        b.part(&picture, "frame", grained(frame, rng), frame_material);
        let inside = self.size - 0.034;
        b.part(&picture, "mount", sheet(inside, 0.010), Finish::Paper);
        let material = printed(b, "painting", self.style, &self.palette, rng);
        b.part(&picture, "print", sheet(inside - 2.0 * self.mount, 0.0108), material);
    }
}

/// A round mirror with a thin rim; its origin is the middle of its back, on the wall's face.
#[derive(Clone, Copy, Debug)]
pub struct Mirror {
    /// Radius over the rim.
    pub radius: f32,
}

impl Furniture for Mirror {
    fn random(rng: &mut Rng) -> Self {
        Self { radius: rng.range(0.22, 0.4) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(2.0 * self.radius, 0.03, 2.0 * self.radius)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let mirror = b.object("mirror", Class::Mirror, pose);
        let r = self.radius;
        let upright = |mesh: Mesh| mesh.turned(Vec3::X, -std::f32::consts::FRAC_PI_2);
        let rim = [[r - 0.012, 0.0], [r, 0.0], [r, 0.024], [r - 0.002, 0.026], [r - 0.01, 0.026], [r - 0.012, 0.024], [r - 0.012, 0.0]];
        b.part(&mirror, "rim", upright(lathe(&rim.map(Vec2::from_array), 96)), Finish::Brass);
        b.part(&mirror, "glass", upright(crate::shape::disk(r - 0.0115, 96)).moved(Vec3::new(0.0, 0.014, 0.0)), Finish::Mirror);
    }
}
