//! Colours and pictures of walls, floors and furniture.

use super::xml::Element;
use crate::ImportError;
use crate::assembly::{Assembly, Source};
use crate::images::Use;
use enfilade_math::{DMat2, DVec2, Rgb};
use enfilade_scene::{Bsdf, ColorParam, Material, TextureRef};

/// Reflectance of what has neither colour nor picture: white paint.
const WHITE_PAINT: f32 = 0.8;
/// Phong's exponent at full shininess.
const SHINIEST: f64 = 128.0;
/// Width and height of pictures that do not state their size, centimetres.
const PICTURE_CM: f64 = 100.0;

/// The covering of a surface.
#[derive(Clone, Copy)]
pub(super) struct Paint<'x> {
    /// Opacity and linear colour.
    pub color: Option<(u8, Rgb)>,
    pub texture: Option<Element<'x>>,
    /// 0 … 1.
    pub shininess: f64,
}

impl Paint<'_> {
    /// Equal for paints that look the same, and a name for them.
    pub fn key(&self) -> (String, String) {
        let texture = self.texture.map(|t| t.attributes());
        let name = self.texture.and_then(|t| t.text("name")).unwrap_or("paint").to_string();
        (format!("{:?} {texture:?} {}", self.color, self.shininess), name)
    }

    /// The material; a picture takes precedence over a colour.
    pub fn material(&self, name: &str, a: &mut Assembly) -> Result<Material, ImportError> {
        let plain = self.color.map_or(Rgb::splat(WHITE_PAINT), |(_, rgb)| rgb);
        let reflectance = match self.texture {
            Some(element) => match texture(element, name, a)? {
                Some(texture) => ColorParam { factor: Rgb::WHITE, texture: Some(texture) },
                None => Rgb::splat(0.5).into(),
            },
            None => plain.into(),
        };
        Ok(Material::new(name, bsdf(reflectance, self.shininess)))
    }
}

/// A diffuse surface, under a clear coat where it shines.
pub(super) fn bsdf(diffuse: ColorParam, shininess: f64) -> Bsdf {
    if shininess <= 0.0 {
        return Bsdf::Diffuse { reflectance: diffuse };
    }
    let alpha = (2.0 / (shininess.min(1.0) * SHINIEST + 2.0)).sqrt() as f32;
    Bsdf::Plastic { diffuse, eta: 1.5, alpha: alpha.into(), specular: Rgb::WHITE.into(), nonlinear: false }
}

/// A picture laid over centimetres. `None` where it is missing and may be.
pub(super) fn texture(element: Element, user: &str, a: &mut Assembly) -> Result<Option<TextureRef>, ImportError> {
    let stated = DVec2::new(element.number_or("width", PICTURE_CM)?, element.number_or("height", PICTURE_CM)?);
    sized(element, if stated.min_element() > 0.0 { stated } else { DVec2::splat(PICTURE_CM) }, user, a)
}

/// A picture laid over a model's own texture coordinates, whatever its size. `None` where it is missing and may be.
pub(super) fn texture_of_model(element: Element, user: &str, a: &mut Assembly) -> Result<Option<TextureRef>, ImportError> {
    sized(element, DVec2::ONE, user, a)
}

/// A picture that is `stated` wide and high, unless it is scaled, in the unit of the coordinates that it is laid over.
fn sized(element: Element, stated: DVec2, user: &str, a: &mut Assembly) -> Result<Option<TextureRef>, ImportError> {
    let file = element.text("image").ok_or_else(|| element.error("the texture has no image; save the home again"))?;
    let scale = Some(element.number_or("scale", 1.0)?).filter(|s| *s > 0.0).unwrap_or(1.0);
    let offset = DVec2::new(element.number_or("xOffset", 0.0)?, element.number_or("yOffset", 0.0)?);
    let size = stated * scale;
    // Moved in pictures, then turned, then laid over.
    let m = DMat2::from_diagonal(size.recip()) * DMat2::from_angle(element.number_or("angle", 0.0)?);
    let moved = m * (-offset * size);
    let found = a.image(&Source::File(file), Use::Color, user)?;
    let row = |i: usize| [m.x_axis[i] as f32, m.y_axis[i] as f32, moved[i] as f32];
    Ok(found.map(|image| TextureRef { uv_transform: [row(0), row(1)], ..TextureRef::new(image) }))
}
