//! Textures as pictures in the file: those that came as PNG or JPEG unchanged, others and those computed texel by texel as PNG; and the
//! surroundings as OpenEXR.

use super::document::{Document, TextureUse};
use enfilade_math::{Rgb, linear_from_srgb, srgb_from_linear};
use enfilade_scene::{Environment, Filter, Image, MapRows, Pixels, PngEffort, Scene, TextureRef, Wrap, smallest_png};
use exr::prelude::{Encoding, Image as ExrImage, Layer as ExrLayer, LayerAttributes, SpecificChannels, WritableImage};
use serde_json::{Value, json};
use std::io::Cursor;

/// Numbers of the specification for samplers.
const NEAREST: u32 = 9728;
const LINEAR: u32 = 9729;
const LINEAR_MIPMAP_LINEAR: u32 = 9987;

/// A reference to a picture of the scene, as glTF writes it. The same picture with the same sampler is one texture.
pub(super) fn reference(document: &mut Document, scene: &Scene, texture: &TextureRef, usage: TextureUse, user: &str) -> Value {
    let image = &scene.images[texture.image as usize];
    let source = document.pictures.get(&(texture.image, usage)).copied().unwrap_or_else(|| {
        if matches!(image.pixels, Pixels::RgbF32(_)) {
            document.notes.push(format!("{user}: the picture {:?} was rounded to 8 bits and cut off at 1", image.name));
        }
        match document.files.get(&texture.image).filter(|_| is_as_stored(image, usage)) {
            Some(file) => add_file(document, &image.name, &file.bytes, file.media_type),
            None => add_picture(document, &image.name, image, &texels(image, usage)),
        }
    });
    document.pictures.insert((texture.image, usage), source);
    referring(document, source, texture, user)
}

/// A reference to a picture computed from the picture of `texture`, texel by texel (column and row from the upper left).
pub(super) fn computed(
    document: &mut Document,
    scene: &Scene,
    texture: &TextureRef,
    name: &str,
    texel: impl Fn(usize, usize) -> [u8; 3],
) -> Value {
    let image = &scene.images[texture.image as usize];
    let (width, height) = (image.width as usize, image.height as usize);
    let opaque = |(x, y)| {
        let [r, g, b] = texel(x, y);
        [r, g, b, 255]
    };
    let texels: Vec<[u8; 4]> = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(opaque).collect();
    let source = add_picture(document, name, image, &texels);
    referring(document, source, texture, name)
}

fn add_picture(document: &mut Document, name: &str, size: &Image, texels: &[[u8; 4]]) -> usize {
    add_file(document, name, &smallest_png([size.width, size.height], texels, PngEffort::Balanced), "image/png")
}

fn add_file(document: &mut Document, name: &str, file: &[u8], media_type: &str) -> usize {
    let view = document.buffer.view(file);
    document.images.push(json!({ "name": name, "bufferView": view, "mimeType": media_type }));
    document.images.len() - 1
}

/// True where glTF reads a picture's stored bytes as the scene does.
fn is_as_stored(image: &Image, usage: TextureUse) -> bool {
    matches!(
        (&image.pixels, usage),
        (Pixels::Rgba8 { srgb: true, .. }, TextureUse::Color) | (Pixels::Rgba8 { srgb: false, .. }, TextureUse::Data)
    )
}

/// Texels as glTF understands them at this place.
fn texels(image: &Image, usage: TextureUse) -> Vec<[u8; 4]> {
    let quantized = |v: f32| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    let encoded = |v: f32| if usage == TextureUse::Color { quantized(srgb_from_linear(v.clamp(0.0, 1.0))) } else { quantized(v) };
    match &image.pixels {
        Pixels::Rgba8 { srgb, texels } => {
            let code = |v: u8| match (usage, srgb) {
                (TextureUse::Color, true) | (TextureUse::Data, false) => v,
                (TextureUse::Color, false) => encoded(f32::from(v) / 255.0),
                (TextureUse::Data, true) => quantized(linear_from_srgb(f32::from(v) / 255.0)),
            };
            let table: [u8; 256] = std::array::from_fn(|v| code(v as u8));
            texels.iter().map(|&[r, g, b, a]| [table[usize::from(r)], table[usize::from(g)], table[usize::from(b)], a]).collect()
        }
        Pixels::RgbF32(texels) => texels.iter().map(|&[r, g, b]| [encoded(r), encoded(g), encoded(b), 255]).collect(),
    }
}

/// Sampler, texture and transform of a picture.
fn referring(document: &mut Document, source: usize, texture: &TextureRef, user: &str) -> Value {
    let wrap = |wrap: Wrap| match wrap {
        Wrap::Repeat => 10497,
        Wrap::Clamp => 33071,
        Wrap::Mirror => 33648,
    };
    let (near, far) = if texture.filter == Filter::Nearest { (NEAREST, NEAREST) } else { (LINEAR, LINEAR_MIPMAP_LINEAR) };
    let sampler = json!({ "magFilter": near, "minFilter": far, "wrapS": wrap(texture.wrap[0]), "wrapT": wrap(texture.wrap[1]) });
    let sampler = index_of(&mut document.samplers, sampler);
    let index = index_of(&mut document.textures, json!({ "source": source, "sampler": sampler }));
    let mut reference = json!({ "index": index });
    if let Some(transform) = transform(document, texture, user) {
        reference["extensions"] = json!({ "KHR_texture_transform": transform });
        document.extensions.insert("KHR_texture_transform");
    }
    reference
}

fn index_of(list: &mut Vec<Value>, entry: Value) -> usize {
    list.iter().position(|known| *known == entry).unwrap_or_else(|| {
        list.push(entry);
        list.len() - 1
    })
}

/// The transform of texture coordinates, which point down in glTF: with F the flip (u, v) → (u, 1 − v) and M ours, F·M·F as offset,
/// rotation and scale. Nothing for the identity.
fn transform(document: &mut Document, texture: &TextureRef, user: &str) -> Option<Value> {
    let [[a, b, c], [d, e, f]] = texture.uv_transform;
    let [[a, b, x], [d, e, y]] = [[a, -b, b + c], [-d, e, 1.0 - e - f]];
    if [a, b, x, d, e, y] == [1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        return None;
    }
    let rotation = (-d).atan2(a);
    let (sin, cos) = rotation.sin_cos();
    let scale = [a * cos - d * sin, b * sin + e * cos];
    let shear = (b - scale[1] * sin).abs().max((e - scale[1] * cos).abs());
    if shear > 1e-4 * (b.abs() + e.abs()) {
        document.notes.push(format!("{user}: its texture coordinates are sheared, which glTF cannot say; the shear was left out"));
    }
    Some(json!({ "offset": [x, y], "rotation": rotation, "scale": scale }))
}

/// The surroundings, as the scene's `extras.environment`.
pub(super) fn environment(document: &mut Document, scene: &Scene) -> Option<Value> {
    match scene.environment.as_ref()? {
        Environment::Constant { radiance } => Some(json!({ "radiance": radiance.to_array() })),
        Environment::Map { image, rows, scale, map_from_world } => {
            let view = document.buffer.view(&environment_file(&scene.images[*image as usize], *scale));
            // From the map's space to glTF's, row by row: world x, y, z are glTF's x, −z, y.
            let m = map_from_world.transpose();
            let [x, y, z] = [m.row(0), m.row(1), m.row(2)].map(|row| row.to_array());
            let rows_lie = if *rows == MapRows::PoleToPole { "pole_to_pole" } else { "bands" };
            let gltf_from_map = [x, z, y.map(|v| -v)].concat();
            Some(json!({ "bufferView": view, "mimeType": "image/x-exr", "rows": rows_lie, "gltf_from_map": gltf_from_map }))
        }
    }
}

/// The picture of the surroundings as OpenEXR: linear radiance.
fn environment_file(image: &Image, scale: Rgb) -> Vec<u8> {
    let pixel = |at: exr::math::Vec2<usize>| {
        let [r, g, b] = (image.texel(at.x(), at.y()).0 * scale).to_array();
        (r, g, b)
    };
    let size = (image.width as usize, image.height as usize);
    let layer = ExrLayer::new(size, LayerAttributes::default(), Encoding::SMALL_LOSSLESS, SpecificChannels::rgb(pixel));
    let mut file = Vec::new();
    let written = ExrImage::from_layer(layer).write().non_parallel().to_buffered(Cursor::new(&mut file));
    written.expect("a picture in memory can be written to memory");
    file
}
