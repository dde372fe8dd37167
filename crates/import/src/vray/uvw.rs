//! The sources of texture coordinates: UVW generators.

use super::plugins::Handle;
use super::reader::Reader;
use crate::ImportError;
use enfilade_scene::Wrap;

/// The mapping from a mesh's texture coordinates to a picture.
pub(super) struct Placement {
    /// Texture channel of the mesh.
    pub channel: i64,
    pub uv_transform: [[f32; 3]; 2],
    pub wrap: [Wrap; 2],
}

impl Default for Placement {
    fn default() -> Self {
        Self { channel: 1, uv_transform: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], wrap: [Wrap::Repeat; 2] }
    }
}

/// Parameters of `UVWGenMayaPlace2dTexture` without a counterpart and the values at which they do nothing.
const MAYA_UNSUPPORTED: [(&str, f64); 7] = [
    ("rotate_frame", 0.0),
    ("translate_frame_u", 0.0),
    ("translate_frame_v", 0.0),
    ("coverage_u", 1.0),
    ("coverage_v", 1.0),
    ("noise_u", 0.0),
    ("noise_v", 0.0),
];

impl<'n> Reader<'n, '_> {
    /// The placement by a texture's `uvwgen`.
    pub(super) fn placement(&mut self, texture: Handle<'n>) -> Result<Placement, ImportError> {
        let Some(generator) = texture.reference("uvwgen")? else { return Ok(Placement::default()) };
        match generator.kind() {
            "UVWGenChannel" => self.by_channel(generator),
            "UVWGenMayaPlace2dTexture" => self.by_maya(generator),
            kind => {
                self.warn(
                    generator,
                    format!("texture coordinates by {kind} are not supported; those of the mesh's first channel were used"),
                );
                Ok(Placement::default())
            }
        }
    }

    fn by_channel(&mut self, g: Handle<'n>) -> Result<Placement, ImportError> {
        self.warn_of_animation(g, &["uvw_transform"]);
        let t = g.transform("uvw_transform")?;
        let m = t.matrix3;
        let rows = [[m.x_axis.x, m.y_axis.x, t.translation.x], [m.x_axis.y, m.y_axis.y, t.translation.y]];
        let wrap = |mode: &str, crop: &str| {
            Ok::<_, ImportError>(if g.flag(crop, false)? {
                Wrap::Clamp
            } else if g.int(mode, 0)? == 2 {
                Wrap::Mirror
            } else {
                Wrap::Repeat
            })
        };
        let wrap = [wrap("wrap_u", "crop_u")?, wrap("wrap_v", "crop_v")?];
        if wrap.contains(&Wrap::Clamp) {
            self.warn(g, "cropped pictures end in their border colour here, not in nothing");
        }
        Ok(Placement { channel: g.int("uvw_channel", 1)?, uv_transform: rows.map(|row| row.map(|v| v as f32)), wrap })
    }

    /// uv' = (turned about the middle, then repeated) + offset.
    fn by_maya(&mut self, g: Handle<'n>) -> Result<Placement, ImportError> {
        let (su, sv) = (self.maya_number(g, "repeat_u", 1.0)?, self.maya_number(g, "repeat_v", 1.0)?);
        let (ou, ov) = (self.maya_number(g, "offset_u", 0.0)?, self.maya_number(g, "offset_v", 0.0)?);
        let (sin, cos) = self.maya_number(g, "rotate_uv", 0.0)?.sin_cos();
        for (parameter, idle) in MAYA_UNSUPPORTED {
            if self.maya_number(g, parameter, idle)? != idle {
                self.warn(g, format!("{parameter} is not supported and was left out"));
            }
        }
        let middle = [0.5 - 0.5 * (cos - sin), 0.5 - 0.5 * (sin + cos)];
        let rows = [[su * cos, -su * sin, su * middle[0] + ou], [sv * sin, sv * cos, sv * middle[1] + ov]];
        let wrap = |parameter: &str| Ok::<_, ImportError>(if g.flag(parameter, false)? { Wrap::Mirror } else { Wrap::Repeat });
        Ok(Placement {
            channel: g.int("uvw_channel", 1)?.max(1),
            uv_transform: rows.map(|row| row.map(|v| v as f32)),
            wrap: [wrap("mirror_u")?, wrap("mirror_v")?],
        })
    }

    /// A number, which one of the same name and `_tex` overrides; a texture there is not supported.
    fn maya_number(&mut self, g: Handle<'n>, parameter: &str, default: f64) -> Result<f64, ImportError> {
        let texture = format!("{parameter}_tex");
        if !g.states_texture(&texture)? {
            return g.number(parameter, default);
        }
        if g.value(&texture)?.is_some_and(|value| value.number().is_some()) {
            return g.number(&texture, default);
        }
        self.warn(g, format!("a texture in {texture} is not supported and was left out"));
        g.number(parameter, default)
    }
}
