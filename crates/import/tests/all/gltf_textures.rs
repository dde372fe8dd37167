//! Textures of glTF in formats of extensions, and extensions of materials that are only reported.

use crate::common::{Folder, Gltf, base64, png, principled, warnings};
use enfilade_import::{ImportError, Imported};
use enfilade_scene::Pixels;
use serde_json::json;

const UASTC: &[u8] = include_bytes!("../ktx2/uastc.ktx2");

/// A WebP of one red pixel.
fn webp() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::RgbaImage::from_pixel(1, 1, image::Rgba([255, 0, 0, 255])).write_to(&mut bytes, image::ImageFormat::WebP).unwrap();
    bytes.into_inner()
}

/// A DDS of one green pixel: red, green, blue and alpha by their masks.
fn dds() -> Vec<u8> {
    let mut words = [0u32; 32];
    words[..5].copy_from_slice(&[u32::from_le_bytes(*b"DDS "), 124, 0x1007, 1, 1]);
    words[19..27].copy_from_slice(&[32, 0x41, 0, 32, 0xff, 0xff00, 0xff_0000, 0xff00_0000]);
    words.into_iter().flat_map(u32::to_le_bytes).chain([0, 255, 0, 255]).collect()
}

/// A triangle whose base colour is a texture with a picture by an extension, and a blue plain one where that is wanted.
fn textured(extension: &str, picture: &[u8], plain: bool) -> Result<Imported, ImportError> {
    let mut g = Gltf::triangle();
    g.json["materials"][0]["pbrMetallicRoughness"] = json!({"baseColorTexture": {"index": 0}});
    g.json["extensionsUsed"] = json!([extension]);
    let folder = Folder::new();
    folder.write("plain.png", png(1, 1, [0, 0, 255, 255]));
    g.json["images"] = json!([{"uri": "plain.png"}, {"uri": format!("data:image/x;base64,{}", base64(picture))}]);
    g.json["textures"] = json!([{"extensions": {extension: {"source": 1}}}]);
    if plain {
        g.json["textures"][0]["source"] = json!(0);
    } else {
        g.json["extensionsRequired"] = json!([extension]);
    }
    folder.write("a.gltf", g.text()).load("a.gltf")
}

/// The first texel of the only picture.
fn first(imported: &Imported) -> [u8; 4] {
    assert_eq!(imported.scene.images.len(), 1);
    match &imported.scene.images[0].pixels {
        Pixels::Rgba8 { srgb: true, texels } => texels[0],
        other => panic!("{other:?}"),
    }
}

#[test]
fn pictures_of_extensions_are_read_and_preferred() {
    for plain in [false, true] {
        let imported = textured("KHR_texture_basisu", UASTC, plain).unwrap();
        let [r, g, b, a] = first(&imported);
        assert!(r < 12 && g < 12 && b.abs_diff(128) < 12 && a == 255, "{r} {g} {b} {a}");
        assert_eq!((imported.scene.images[0].width, imported.scene.images[0].height), (24, 18));
        assert_eq!(warnings(&imported), "");
        assert_eq!(first(&textured("EXT_texture_webp", &webp(), plain).unwrap()), [255, 0, 0, 255]);
        assert_eq!(first(&textured("MSFT_texture_dds", &dds(), plain).unwrap()), [0, 255, 0, 255]);
    }
}

#[test]
fn plain_pictures_stand_in_for_those_that_cannot_be_read() {
    let avif = b"\0\0\0\x1cftypavif\0\0\0\0";
    for (extension, picture, problem) in [
        ("KHR_texture_basisu", &UASTC[..90], "is a KTX2 that is cut short in its header"),
        ("EXT_texture_avif", &avif[..], "is an AVIF, which is not read"),
    ] {
        let imported = textured(extension, picture, true).unwrap();
        assert_eq!(first(&imported), [0, 0, 255, 255]);
        let told = warnings(&imported);
        assert!(told.contains(problem) && told.contains("the plain picture that the file has besides was used"), "{told}");
        assert_eq!(told.lines().count(), 1, "{told}");
    }
    let required = textured("EXT_texture_avif", avif, false).unwrap_err().to_string();
    assert!(
        required.contains("requires EXT_texture_avif, which is not supported; export with PNG, JPEG, WebP or KTX2 textures"),
        "{required}"
    );
    let damaged = textured("KHR_texture_basisu", &UASTC[..90], false).unwrap_err().to_string();
    assert!(damaged.contains("needs the texture images[1], which is a KTX2 that is cut short in its header"), "{damaged}");
}

#[test]
fn textures_without_any_picture_say_so() {
    let mut g = Gltf::triangle();
    g.json["materials"][0]["pbrMetallicRoughness"] = json!({"baseColorTexture": {"index": 0}});
    g.json["textures"] = json!([{"extensions": {"ACME_texture": {"source": 0}}}]);
    let error = Folder::new().write("a.gltf", g.text()).error("a.gltf");
    assert!(error.contains("textures[0] has no picture; export with PNG, JPEG, WebP or KTX2 textures"), "{error}");
}

#[test]
fn textures_that_name_no_picture_leave_the_plain_colour_and_say_so() {
    for (textures, images) in
        [(json!([{}]), json!([])), (json!([{"sampler": 0}]), json!([])), (json!([{"source": 0}]), json!([{"name": "Oak"}]))]
    {
        let mut g = Gltf::triangle();
        let texture = json!({"index": 0});
        g.json["materials"][0] = json!({"name": "Wood", "normalTexture": texture, "pbrMetallicRoughness":
            {"baseColorFactor": [0.2, 0.4, 0.6, 1.0], "baseColorTexture": texture, "metallicRoughnessTexture": texture, "metallicFactor": 0.0}});
        g.json["textures"] = textures;
        g.json["images"] = images;
        let imported = Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap();
        let material = &imported.scene.materials[imported.scene.parts[0].material as usize];
        assert_eq!(principled(&material.bsdf).base_color, enfilade_math::Rgb::new(0.2, 0.4, 0.6).into());
        assert!(material.normal_map.is_none());
        let told = warnings(&imported);
        assert_eq!(told, "a.gltf: material \"Wood\": textures[0] names no picture; its plain colour or number holds\n");
    }
}

#[test]
fn what_materials_have_beyond_the_scene_is_told_once() {
    let mut g = Gltf::triangle();
    g.json["extensionsRequired"] = json!(["KHR_materials_dispersion"]);
    g.json["extensionsUsed"] = json!(["KHR_materials_dispersion", "KHR_materials_anisotropy", "KHR_materials_iridescence"]);
    let extensions = json!({"KHR_materials_dispersion": {"dispersion": 0.1}, "KHR_materials_anisotropy": {"anisotropyStrength": 0.5}});
    g.json["materials"][0]["extensions"] = extensions.clone();
    for name in ["Gem", "Prism", "Drop"] {
        g.json["materials"].as_array_mut().unwrap().push(json!({"name": name, "extensions": extensions}));
    }
    let imported = Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap();
    let expected = "a.gltf: KHR_materials_anisotropy: not rendered, materials \"Wood\", \"Gem\", \"Prism\" and 1 more: their highlights are \
        as wide in all directions, by the roughness\na.gltf: KHR_materials_dispersion: not rendered, materials \"Wood\", \"Gem\", \"Prism\" \
        and 1 more: they refract all colours alike, by the index of refraction\n";
    assert_eq!(warnings(&imported), expected);
}
