//! Inputs of a surface shader as parameters: a value, or a texture times a scale plus a bias.

use super::foreign::number;
use super::shader::{Source, id, source};
use super::stage::Prim;
use super::texture::{Kept, Texture, Textures, rgb};
use crate::ImportError;
use crate::images::Use;
use enfilade_math::Rgb;
use enfilade_scene::{ColorParam, NormalMap, ScalarParam};
use std::rc::Rc;

/// Grey in place of a missing texture.
const STAND_IN: f32 = 0.5;

fn channel(output: &str) -> Option<usize> {
    ["r", "g", "b", "a"].iter().position(|c| *c == output)
}

impl Textures<'_, '_, '_> {
    /// A colour.
    pub(super) fn color(&mut self, shader: &Rc<Prim>, name: &str, default: Rgb) -> Result<ColorParam, ImportError> {
        let (prim, output) = match source(self.stage, shader, name, self.a)? {
            Source::Default => return Ok(default.into()),
            Source::Value(value, _) => return Ok(rgb(&value).unwrap_or(default).into()),
            Source::Shader(prim, output) => (prim, output),
        };
        if name == "inputs:diffuseColor" && id(&prim) == "UsdPrimvarReader_float3" {
            let primvar = self.token(&prim, "inputs:varname")?;
            self.color_name = Some(format!("primvars:{primvar}"));
            return Ok(self.fallback_of(&prim)?.unwrap_or(default).into());
        }
        let Some(t) = self.read(&prim, &output, Use::Color)? else {
            return Ok(self.fallback_of(&prim)?.unwrap_or(default).into());
        };
        let Some(mut texture) = t.texture else {
            return Ok(t.fallback.map_or(Rgb::splat(STAND_IN), |[r, g, b, _]| Rgb::new(r, g, b)).into());
        };
        let plain = t.bias[..3] == [0.0; 3] && channel(&t.output).is_none();
        if plain {
            return Ok(ColorParam { factor: Rgb::new(t.scale[0], t.scale[1], t.scale[2]), texture: Some(texture) });
        }
        let Texture { scale, bias, output, .. } = t;
        let read = channel(&output).map_or(0..3, |c| c..c + 1);
        let kept = self.kept(texture.image, &scale[read.clone()], &bias[read]);
        texture.image = self.baked(texture.image, &format!("{scale:?}{bias:?}{output}"), kept, |texel| {
            let v: [f32; 4] = std::array::from_fn(|i| texel[i] * scale[i] + bias[i]);
            channel(&output).map_or([v[0], v[1], v[2]], |c| [v[c]; 3])
        });
        Ok(ColorParam { factor: Rgb::WHITE, texture: Some(texture) })
    }

    /// A number; of a colour the mean.
    pub(super) fn scalar(&mut self, shader: &Rc<Prim>, name: &str, default: f32) -> Result<ScalarParam, ImportError> {
        let (prim, output) = match source(self.stage, shader, name, self.a)? {
            Source::Default => return Ok(default.into()),
            Source::Value(value, _) => return Ok(number(&value).unwrap_or(default).into()),
            Source::Shader(prim, output) => (prim, output),
        };
        let Some(t) = self.read(&prim, &output, Use::Data)? else {
            return Ok(self.fallback_of(&prim)?.map_or(default, |c| c.r).into());
        };
        let c = channel(&t.output).unwrap_or(0);
        let Some(mut texture) = t.texture else { return Ok(t.fallback.map_or(default, |f| f[c]).into()) };
        let (scale, bias) = (t.scale[c], t.bias[c]);
        if bias == 0.0 {
            return Ok(ScalarParam { factor: scale, texture: Some((texture, c as u8)) });
        }
        let kept = self.kept(texture.image, &[scale], &[bias]);
        texture.image = self.baked(texture.image, &format!("{scale} {bias} {c}"), kept, |texel| [texel[c] * scale + bias; 3]);
        Ok(ScalarParam { factor: 1.0, texture: Some((texture, 0)) })
    }

    /// A normal map. The texture's scale and bias take texels to [−1,1]: 2 and −1.
    pub(super) fn normal(&mut self, shader: &Rc<Prim>, name: &str) -> Result<Option<NormalMap>, ImportError> {
        let Source::Shader(prim, output) = source(self.stage, shader, name, self.a)? else { return Ok(None) };
        let Some(t) = self.read(&prim, &output, Use::Data)? else { return Ok(None) };
        let Some(mut texture) = t.texture else { return Ok(None) };
        let (mut scale, mut bias) = (t.scale, t.bias);
        if scale[..3] == [1.0; 3] && bias[..3] == [0.0; 3] {
            self.warn("its normal map has no scale and bias; 2 and −1 were guessed");
            (scale, bias) = ([2.0; 4], [-1.0; 4]);
        }
        // Equal scales of x and y only make the map stronger or weaker.
        let strength = 0.5 * scale[0];
        let standard =
            scale[0] > 0.0 && scale[..2] == [scale[0]; 2] && bias[..2] == [-0.5 * scale[0]; 2] && scale[2] == 2.0 && bias[2] == -1.0;
        if standard {
            return Ok(Some(NormalMap::Normal { texture, scale: strength }));
        }
        texture.image = self.baked(texture.image, &format!("normal {scale:?}{bias:?}"), Kept::Linear, |texel| {
            std::array::from_fn(|i| 0.5 * (texel[i] * scale[i] + bias[i]) + 0.5)
        });
        Ok(Some(NormalMap::Normal { texture, scale: 1.0 }))
    }

    /// The fallback of a shader that is not supported.
    fn fallback_of(&mut self, shader: &Rc<Prim>) -> Result<Option<Rgb>, ImportError> {
        Ok(match source(self.stage, shader, "inputs:fallback", self.a)? {
            Source::Value(value, _) => rgb(&value),
            _ => None,
        })
    }
}
