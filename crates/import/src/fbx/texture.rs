//! Textures of FBX materials: where their pictures are, and how coordinates find their way into them.

use super::reader::of_blender;
use crate::ImportError;
use crate::assembly::{Assembly, Source};
use crate::images::Use;
use enfilade_scene::{Image, Pixels, TextureRef, Wrap};
use ufbx::{TextureType, WrapMode};

/// The textures met so far that had to be turned from white to black.
pub(super) type Inverted = std::collections::HashMap<u32, u32>;

/// The picture of `texture` as `user` uses it. `None` where it has none, with a warning, or where it is missing and that is allowed.
pub(super) fn texture(texture: &ufbx::Texture, usage: Use, user: &str, a: &mut Assembly) -> Result<Option<TextureRef>, ImportError> {
    let file = match texture.type_ {
        TextureType::File => texture,
        kind => {
            let name = &*texture.element.name;
            let Some(first) = texture.file_textures.as_ref().first() else {
                a.warn(user, format!("the texture {name:?} ({kind:?}) has no picture and was left out"));
                return Ok(None);
            };
            a.warn(user, format!("the texture {name:?} is computed from pictures ({kind:?}); the first of them was used alone"));
            first.as_ref()
        }
    };
    if file.content.is_empty() && [&*file.relative_filename, &*file.filename, &*file.absolute_filename].iter().all(|p| p.trim().is_empty())
    {
        a.warn(user, format!("the texture {:?} names no picture and was left out", &*file.element.name));
        return Ok(None);
    }
    let found = if file.content.is_empty() {
        a.image(&Source::File(&path(file, a)), usage, user)?
    } else {
        let name = if file.filename.is_empty() { &*file.element.name } else { &*file.filename };
        a.image(&Source::Embedded(format!("{} ({name})", file.element.element_id), &file.content), usage, user)?
    };
    let wrap = |mode| if mode == WrapMode::Clamp { Wrap::Clamp } else { Wrap::Repeat };
    Ok(found.map(|image| TextureRef {
        uv_transform: uv_transform(file),
        wrap: [wrap(file.wrap_u), wrap(file.wrap_v)],
        ..TextureRef::new(image)
    }))
}

/// From texture coordinates to the picture: scaled, turned and then moved.
///
/// By Autodesk's documentation, a scale above one compresses the picture, and a translation of one is the picture's width after that. So
/// this is the right matrix, although ufbx names it the other way round. Blender writes the reciprocal of the scale, and the rotation
/// backwards and in radians.
fn uv_transform(texture: &ufbx::Texture) -> [[f32; 3]; 2] {
    if !of_blender(&texture.element) {
        let m = &texture.texture_to_uv;
        return [[m.m00 as f32, m.m01 as f32, m.m03 as f32], [m.m10 as f32, m.m11 as f32, m.m13 as f32]];
    }
    let property = |name, default| {
        ufbx::find_prop(&texture.element.props, name).map_or([default; 3], |p| [p.value_vec4.x, p.value_vec4.y, p.value_vec4.z])
    };
    let [translation, rotation, scaling] = [property("Translation", 0.0), property("Rotation", 0.0), property("Scaling", 1.0)];
    let (sin, cos) = (-rotation[2]).sin_cos();
    let [x, y, _] = scaling.map(|s| if s == 0.0 { 1.0 } else { s.recip() });
    [[cos * x, -sin * y, translation[0]], [sin * x, cos * y, translation[1]]].map(|row| row.map(|v| v as f32))
}

/// The path of the picture: its relative path, its absolute one, or, since that is often of another machine, its name beside the file or in
/// the folders into which programs unpack pictures. If it is in none of these places, the path that the file states.
fn path(texture: &ufbx::Texture, a: &Assembly) -> String {
    let written = [&*texture.relative_filename, &*texture.filename, &*texture.absolute_filename];
    let written: Vec<String> = written.into_iter().filter(|p| !p.is_empty()).map(|p| p.replace('\\', "/")).collect();
    let written: Vec<&str> = written.iter().map(String::as_str).collect();
    let stem = a.file().file_stem().map_or(String::new(), |s| s.to_string_lossy().into_owned());
    let found = a.find(&written, &["", &format!("{stem}.fbm/"), "textures/", "Textures/"]);
    found.or(written.first().map(|first| (*first).to_string())).unwrap_or_else(|| texture.element.name.to_string())
}

/// The picture with every colour channel turned from white to black: transparency for opacity, glossiness for roughness.
pub(super) fn inverted(texture: TextureRef, known: &mut Inverted, a: &mut Assembly) -> TextureRef {
    let image = match known.get(&texture.image) {
        Some(&image) => image,
        None => {
            let Image { name, width, height, pixels } = a.image_at(texture.image).clone();
            let pixels = match pixels {
                Pixels::Rgba8 { srgb, texels } => {
                    let texels = texels.into_iter().map(|[r, g, b, alpha]| [255 - r, 255 - g, 255 - b, alpha]).collect();
                    Pixels::Rgba8 { srgb, texels }
                }
                Pixels::RgbF32(texels) => Pixels::RgbF32(texels.into_iter().map(|t| t.map(|v| (1.0 - v).max(0.0))).collect()),
            };
            let image = a.push_image(Image { name: format!("{name} (inverted)"), width, height, pixels });
            known.insert(texture.image, image);
            image
        }
    };
    TextureRef { image, ..texture }
}
