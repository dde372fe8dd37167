//! The picture of a texture: an extension's if it can be read, else the plain one.

use super::container::{Document, ImageAt};
use crate::ImportError;
use crate::assembly::{Assembly, Source};
use crate::images::Use;
use gltf::json::texture::Texture;
use serde_json::Value;

/// Extensions by which a texture has a picture of another format. All formats are recognised by their content; AVIF alone is not read; it
/// is listed for its message.
const EXTENSIONS: [&str; 4] = ["KHR_texture_basisu", "EXT_texture_webp", "MSFT_texture_dds", "EXT_texture_avif"];

/// Marks a texture without a plain picture.
const NONE: usize = u32::MAX as usize;

/// The index of a texture's picture in the scene; `None` when it is missing and the options allow that.
///
/// # Errors
/// When there is no such texture or picture, or none of its pictures can be read.
pub(super) fn image(document: &Document, index: usize, usage: Use, user: &str, a: &mut Assembly) -> Result<Option<u32>, ImportError> {
    let textures = &document.root.textures;
    let Some(texture) = textures.get(index) else {
        return Err(a.malformed(user, format!("it refers to texture {index}, but there are only {}", textures.len())));
    };
    let mut pictures = pictures(texture).into_iter().peekable();
    while let Some(picture) = pictures.next() {
        if pictures.peek().is_none() {
            return match with_source(document, picture, user, a, |source, a| a.image(source, usage, user)) {
                Err(error @ ImportError::Texture { .. }) if a.allows_missing_textures() => {
                    a.warn(user, format!("a texture is missing ({error}); a plain grey stands in"));
                    Ok(None)
                }
                read => read?,
            };
        }
        let (name, problem) = match with_source(document, picture, user, a, |source, a| a.try_image(source, usage, user)) {
            Ok(read) => match read? {
                Ok(image) => return Ok(Some(image)),
                Err(failed) => failed,
            },
            Err(problem) => (format!("images[{picture}]"), format!("cannot be read ({problem})")),
        };
        a.warn(user, format!("the texture {name} {problem}; the plain picture that the file has besides was used"));
    }
    Err(a.malformed(user, format!("textures[{index}] has no picture; export with PNG, JPEG, WebP or KTX2 textures")))
}

/// False for a texture that names no picture, or one without a place. A texture that does not exist counts as having one: that is damage.
pub(super) fn has_picture(document: &Document, index: usize) -> bool {
    let Some(texture) = document.root.textures.get(index) else { return true };
    // A picture by an extension that is not read is not the same as none.
    let others = texture.extensions.as_ref().map(|e| &e.others);
    if others.is_some_and(|others| others.values().any(|extension| extension.get("source").is_some())) {
        return true;
    }
    let is_somewhere = |i: &usize| {
        document.root.images.get(*i).is_none_or(|image| {
            let in_uri = image.uri.as_deref().is_some_and(|uri| !uri.trim().is_empty());
            in_uri || image.buffer_view.is_some()
        })
    };
    pictures(texture).iter().any(is_somewhere)
}

/// The indices of a texture's pictures, the one to prefer first.
fn pictures(texture: &Texture) -> Vec<usize> {
    let others = texture.extensions.as_ref().map(|e| &e.others);
    let source = |name: &str| others?.get(name)?.get("source").and_then(Value::as_u64).and_then(|i| usize::try_from(i).ok());
    let plain = Some(texture.source.value()).filter(|&i| i != NONE);
    EXTENSIONS.into_iter().filter_map(source).chain(plain).collect()
}

/// The result of `read` for a picture of the file.
///
/// # Errors
/// When the file does not have it.
fn with_source<T>(
    document: &Document,
    picture: usize,
    user: &str,
    a: &mut Assembly,
    read: impl FnOnce(&Source, &mut Assembly) -> T,
) -> Result<T, ImportError> {
    let images = &document.root.images;
    let Some(image) = images.get(picture) else {
        return Err(a.malformed(user, format!("it refers to image {picture}, but there are only {}", images.len())));
    };
    match document.embedded_image(picture, image) {
        Ok((place, bytes)) => Ok(read(&Source::Embedded(place, &bytes), a)),
        Err(ImageAt::File(path)) => Ok(read(&Source::File(&path), a)),
        Err(ImageAt::Nowhere(problem)) => {
            let texture = format!("images[{picture}]");
            let problem = problem.strip_prefix(&texture).unwrap_or(&problem).trim_start().to_string();
            Err(ImportError::Texture { file: a.file().to_path_buf(), user: user.to_string(), texture, problem })
        }
    }
}
