//! `enfilade.Material`: what parts of scenes are made of.

use crate::numbers::{color, within};
use enfilade_math::Rgb;
use enfilade_scene::{Bsdf, ColorParam, Image, MaterialChoice, Pixels, Principled, TextureRef};
use numpy::PyReadonlyArray3;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use std::sync::Arc;

/// A material for parts: paint, plastic, metal, or a lamp. It scatters on both sides and emits on the front.
///
/// color: linear red, green and blue, 0 to 1, or one number for grey: the share of light that a matte surface reflects, and what a metal mirrors.
/// Grey (0.5) unless given; white with a texture, black with an emission.
/// name: where the scene has a different material of the name, it gets a number.
/// roughness: None is matte (Lambert's law). 0 (a mirror) to 1 adds the reflection of plastic or varnish (glTF's roughness, index 1.5), or of metal.
/// metallic: 0 to 1, glTF's; metals need a roughness.
/// emission: radiance in W/(sr m2), one number or linear red, green and blue, of 0 or more: a lamp of area a emits pi times as much per a.
/// texture: uint8, height x width x 3 or 4, sRGB, row 0 on top; it multiplies the colour, and its fourth channel is not used. The parts' meshes need
/// texture coordinates.
///
/// Numbers out of their ranges are refused with a ValueError.
#[pyclass(module = "enfilade", frozen)]
pub struct Material {
    material: enfilade_scene::Material,
    images: Vec<Arc<Image>>,
}

impl Material {
    /// The choice of a material, or of a name of one that the scene has.
    pub fn choice(value: &Bound<'_, PyAny>) -> PyResult<MaterialChoice> {
        if let Ok(material) = value.cast::<Self>() {
            let Self { material, images } = material.get();
            return Ok(MaterialChoice::New { material: Box::new(material.clone()), images: images.clone() });
        }
        let wrong =
            |_| PyTypeError::new_err(format!("a material is {value:?}; expected an enfilade.Material, or the name of one in the scene"));
        value.extract().map(MaterialChoice::Named).map_err(wrong)
    }

    /// A grey that nobody chose.
    pub fn plain() -> MaterialChoice {
        enfilade_scene::Material::diffuse("grey", Rgb::splat(0.5)).into()
    }
}

#[pymethods]
impl Material {
    #[new]
    #[pyo3(signature = (color=None, *, name="material", roughness=None, metallic=0.0, emission=None, texture=None))]
    fn new(
        color: Option<&Bound<'_, PyAny>>,
        name: &str,
        roughness: Option<f64>,
        metallic: f64,
        emission: Option<&Bound<'_, PyAny>>,
        texture: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let usual = if texture.is_some() {
            1.0
        } else if emission.is_some() {
            0.0
        } else {
            0.5
        };
        let factor = color.map_or(Ok(Rgb::splat(usual)), |value| self::color("color", value, 0.0..=1.0))?;
        let images: Vec<Arc<Image>> = texture.map(|texture| picture(name, texture)).transpose()?.into_iter().collect();
        let base = ColorParam { factor, texture: texture.map(|_| TextureRef::new(0)) };
        let metallic = within("metallic", metallic, 0.0..=1.0)? as f32;
        let bsdf = match roughness {
            None if metallic > 0.0 => return Err(PyValueError::new_err("metallic is more than 0; give the metal a roughness, 0 to 1")),
            None => Bsdf::Diffuse { reflectance: base },
            Some(roughness) => {
                let roughness = within("roughness", roughness, 0.0..=1.0)? as f32;
                Bsdf::Principled(Box::new(Principled {
                    base_color: base,
                    metallic: metallic.into(),
                    roughness: roughness.into(),
                    ..Principled::default()
                }))
            }
        };
        let emission = emission.map_or(Ok(Rgb::BLACK), |value| self::color("emission", value, 0.0..=f64::INFINITY))?;
        Ok(Self { material: enfilade_scene::Material { emission: emission.into(), ..enfilade_scene::Material::new(name, bsdf) }, images })
    }

    /// Name of the material.
    #[getter]
    fn name(&self) -> &str {
        &self.material.name
    }

    fn __repr__(&self) -> String {
        let texture = if self.images.is_empty() { "" } else { ", with a texture" };
        let shines = if self.material.emission.factor.is_black() { "" } else { ", a lamp" };
        format!("<enfilade.Material {:?}{texture}{shines}>", self.material.name)
    }
}

/// A texture of colours.
fn picture(name: &str, texture: &Bound<'_, PyAny>) -> PyResult<Arc<Image>> {
    let expected = "expected uint8, height x width x 3 or 4";
    let array: PyReadonlyArray3<'_, u8> =
        texture.extract().map_err(|_| PyTypeError::new_err(format!("texture is no picture; {expected}")))?;
    let array = array.as_array();
    let &[height, width, channels @ (3 | 4)] = array.shape() else {
        return Err(PyValueError::new_err(format!("texture has the shape {:?}; {expected}", array.shape())));
    };
    let texel = |pixel: usize| {
        let [row, column] = [pixel / width, pixel % width];
        [
            array[[row, column, 0]],
            array[[row, column, 1]],
            array[[row, column, 2]],
            if channels == 4 { array[[row, column, 3]] } else { 255 },
        ]
    };
    let size = |length: usize| u32::try_from(length).ok().filter(|length| *length > 0);
    let (Some(height_u32), Some(width_u32)) = (size(height), size(width)) else {
        return Err(PyValueError::new_err(format!("texture has the shape {:?}; {expected}", array.shape())));
    };
    let pixels = Pixels::Rgba8 { srgb: true, texels: (0..height * width).map(texel).collect() };
    Ok(Image { name: name.into(), width: width_u32, height: height_u32, pixels }.into())
}
