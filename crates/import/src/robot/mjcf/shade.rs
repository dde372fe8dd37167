//! Materials of geoms: by the model's materials, or by a geom's own colour.

use super::pictures::{Layout, Picture, Pictures};
use super::settings::Settings;
use super::tree::Element;
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_math::{Rgb, linear_from_srgb};
use enfilade_scene::{Alpha, Bsdf, ColorParam, Material, Principled, ScalarParam, TextureRef};
use std::collections::BTreeMap;

/// MuJoCo's colour of geoms that state none.
const GREY: [f64; 4] = [0.5, 0.5, 0.5, 1.0];
/// Phong's exponent of a shininess of one (OpenGL's range).
const EXPONENT: f64 = 128.0;
/// A strength of highlights of 0.5, MuJoCo's default, is the reflectance of glass.
const SPECULAR: f64 = 0.5;

/// A material of the model, complete.
pub(super) struct Shade {
    name: String,
    rgba: [f64; 4],
    pub picture: Option<Picture>,
    repeat: [f64; 2],
    /// Whether `repeat` counts by two metres instead of by object.
    uniform: bool,
    emission: f64,
    specular: f64,
    roughness: f64,
    metallic: f64,
    coat: f64,
}

/// The materials of a model, by name, and those of the scene that were made of them.
pub(super) struct Shades {
    elements: BTreeMap<String, Element>,
    pub pictures: Pictures,
    made: Vec<(Material, u32)>,
}

impl Shades {
    /// The materials that a model declares.
    ///
    /// # Errors
    /// When one is of a class that is not there.
    pub(super) fn of(root: &Element, settings: &Settings) -> Result<Self, ImportError> {
        let mut elements = BTreeMap::new();
        for material in root.all("asset").flat_map(|asset| asset.all("material")) {
            elements.insert(material.name().to_string(), settings.complete(material, None)?);
        }
        Ok(Self { elements, pictures: Pictures::of(root, settings)?, made: Vec::new() })
    }

    /// The material of a geom. Its own colour counts if it is not MuJoCo's default.
    ///
    /// # Errors
    /// When the material, its texture or a number is missing or wrong.
    pub(super) fn get(&mut self, geom: &Element, settings: &Settings, a: &mut Assembly) -> Result<Shade, ImportError> {
        let own = geom.vector::<4>("rgba")?;
        let Some(name) = geom.text("material") else {
            return Ok(Shade::plain(own.unwrap_or(GREY)));
        };
        let material = self.elements.get(name).ok_or_else(|| geom.wrong(format!("there is no material {name:?} among the assets")))?;
        let material = material.clone();
        let number = |attribute: &str, default: f64| Ok::<_, ImportError>(material.number(attribute)?.unwrap_or(default));
        let texture = material.text("texture").map(str::to_string).or_else(|| layer(&material, a));
        let picture = match texture {
            Some(texture) => self.pictures.get(&texture, &material, settings, a)?,
            None => None,
        };
        let shininess = number("shininess", 0.5)?.clamp(0.0, 1.0);
        // GGX of Phong's exponent n has the alpha √(2/(n+2)), and glTF's roughness is its root.
        let phong = (2.0 / (EXPONENT * shininess + 2.0)).powf(0.25);
        let stated = |attribute: &str, other: f64| Ok::<_, ImportError>(material.number(attribute)?.filter(|v| *v >= 0.0).unwrap_or(other));
        Ok(Shade {
            name: name.into(),
            rgba: own.filter(|rgba| *rgba != GREY).or(material.vector("rgba")?).unwrap_or([1.0; 4]),
            picture,
            repeat: material.vector("texrepeat")?.unwrap_or([1.0; 2]),
            uniform: material.flag("texuniform").unwrap_or(false),
            emission: number("emission", 0.0)?.max(0.0),
            specular: (number("specular", SPECULAR)? / SPECULAR).clamp(0.0, 2.0),
            roughness: stated("roughness", phong)?.clamp(0.0, 1.0),
            metallic: stated("metallic", 0.0)?.clamp(0.0, 1.0),
            coat: number("reflectance", 0.0)?.clamp(0.0, 1.0),
        })
    }

    /// The scene's material of a shade on a thing of half sides `half` (x and y, metres); `own_uvs` says whether the thing has texture
    /// coordinates of its own.
    pub(super) fn push(&mut self, shade: &Shade, half: [f64; 2], own_uvs: bool, a: &mut Assembly) -> u32 {
        let material = shade.material(half, own_uvs);
        if let Some((_, known)) = self.made.iter().find(|(known, _)| *known == material) {
            return *known;
        }
        let index = a.push_material(material.clone());
        self.made.push((material, index));
        index
    }
}

/// The texture of colours among the layers of a material.
fn layer(material: &Element, a: &mut Assembly) -> Option<String> {
    let layers: Vec<&Element> = material.all("layer").collect();
    if layers.iter().any(|layer| !matches!(layer.text("role"), Some("rgb" | "rgba"))) {
        let place = material.place(a);
        a.warn(place, "of its layers only the colour (rgb, rgba) was used");
    }
    layers.iter().find(|layer| matches!(layer.text("role"), Some("rgb" | "rgba")))?.text("texture").map(str::to_string)
}

impl Shade {
    fn plain(rgba: [f64; 4]) -> Self {
        let [r, g, b, _] = rgba.map(|v| (v.clamp(0.0, 1.0) * 255.0).round() as u8);
        Self {
            name: format!("rgb_{r:02x}{g:02x}{b:02x}"),
            rgba,
            picture: None,
            repeat: [1.0; 2],
            uniform: false,
            emission: 0.0,
            specular: 1.0,
            roughness: (2.0 / (0.5 * EXPONENT + 2.0)).powf(0.25),
            metallic: 0.0,
            coat: 0.0,
        }
    }

    /// Whether nothing of it is seen.
    pub(super) fn is_invisible(&self) -> bool {
        self.rgba[3] <= 0.0
    }

    fn material(&self, half: [f64; 2], own_uvs: bool) -> Material {
        let [r, g, b, opacity] = self.rgba.map(|v| v.clamp(0.0, 1.0) as f32);
        let factor = Rgb::new(linear_from_srgb(r), linear_from_srgb(g), linear_from_srgb(b));
        let texture = self.picture.map(|picture| self.texture(picture, half, own_uvs));
        let color = ColorParam { factor, texture };
        let principled = Principled {
            base_color: color,
            metallic: (self.metallic as f32).into(),
            roughness: (self.roughness as f32).into(),
            specular: (self.specular.min(1.0) as f32).into(),
            clearcoat: (self.coat as f32).into(),
            ..Principled::default()
        };
        let mut material = Material::new(self.name.clone(), Bsdf::Principled(Box::new(principled)));
        if self.emission > 0.0 {
            material.emission = ColorParam { factor: factor * self.emission as f32, ..color };
            material.emits_both_sides = true;
        }
        if opacity < 1.0 {
            material.alpha = Alpha::Blend { opacity: ScalarParam::from(opacity) };
        }
        material
    }

    fn texture(&self, picture: Picture, half: [f64; 2], own_uvs: bool) -> TextureRef {
        let texture = TextureRef::new(picture.image);
        let [flip_u, flip_v] = picture.flips.map(|flip| if flip { -1.0 } else { 1.0 });
        let rows = match picture.layout {
            Layout::Cube | Layout::Sides => [[flip_u, 0.0, 0.0], [0.0, flip_v, 0.0]],
            Layout::Flat if own_uvs => {
                let [u, v] = self.repeat.map(|repeat| repeat as f32);
                // MuJoCo counts v downward, from the upper edge.
                [[u * flip_u, 0.0, 0.0], [0.0, v * flip_v, 1.0 - v]]
            }
            Layout::Flat => {
                // Coordinates are −1 to 1 over the object; as in MuJoCo, `repeat` counts from its edge, by object or by two metres.
                let scale = |axis: usize| (0.5 * self.repeat[axis] * if self.uniform { half[axis] } else { 1.0 }) as f32;
                [[scale(0) * flip_u, 0.0, scale(0)], [0.0, scale(1) * flip_v, scale(1)]]
            }
        };
        TextureRef { uv_transform: rows, ..texture }
    }
}
