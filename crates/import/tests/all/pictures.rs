//! Pictures of many formats, and in the folders in which downloads keep them.

use crate::common::{Folder, png, principled, warnings};
use enfilade_import::{ImportOptions, Imported};
use enfilade_scene::{Bsdf, Pixels};

/// The picture of the colour of the only material: its name, and its first texel.
fn picture(imported: &Imported) -> (&str, [u8; 4]) {
    let texture = match &imported.scene.materials[0].bsdf {
        Bsdf::Diffuse { reflectance } => reflectance.texture,
        bsdf => principled(bsdf).base_color.texture,
    };
    let image = &imported.scene.images[texture.expect("a texture").image as usize];
    let Pixels::Rgba8 { texels, .. } = &image.pixels else { panic!("no bytes") };
    (image.name.as_str(), texels[0])
}

/// A quad in `obj` whose material, in a library beside it, has the picture `map`.
fn write_obj(folder: &Folder, obj: &str, map: &str) {
    let stem = obj.strip_suffix(".obj").unwrap();
    let name = stem.rsplit('/').next().unwrap();
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3 4/4\n";
    folder.write(obj, format!("mtllib {name}.mtl\n{text}")).write(&format!("{stem}.mtl"), format!("newmtl m\nmap_Kd {map}\n"));
}

#[test]
fn pictures_are_found_where_downloads_keep_them() {
    let cases = [
        // As Sketchfab's downloads have them, also converted.
        ("source/model.obj", "wood.png", "textures/wood.png"),
        ("source/model.obj", "C:\\work\\tex\\wood.png", "textures/Wood.PNG"),
        ("source/model.obj", "wood.tga", "textures/wood.tga.png"),
        ("source/model.obj", "wood.tif", "Textures/wood.png"),
        // As Gazebo's models have them.
        ("meshes/model.obj", "wood.png", "materials/textures/wood.png"),
        ("model.obj", "old/wood.png", "Maps/wood.png"),
        ("model.obj", "../elsewhere/wood.png", "wood.png"),
    ];
    for (scene, map, at) in cases {
        let folder = Folder::new();
        write_obj(&folder, scene, map);
        let imported = folder.write(at, png(1, 1, [150, 100, 60, 255])).load(scene).unwrap_or_else(|e| panic!("{map} at {at}: {e}"));
        let (name, texel) = picture(&imported);
        assert!(at.ends_with(name.trim_start_matches("../")), "{name} at {at}");
        assert_eq!(texel, [150, 100, 60, 255]);
    }
}

#[test]
fn the_report_and_the_inputs_say_which_picture_stood_in() {
    let folder = Folder::new();
    write_obj(&folder, "source/model.obj", "wood.png");
    folder.write("textures/wood.png", png(1, 1, [9; 4])).write("textures/wood.jpg", "not this one");
    let imported = folder.load("source/model.obj").unwrap();
    let told = warnings(&imported);
    assert!(told.contains("wood.png is not there; ../textures/wood.png, which is called alike, was used"), "{told}");
    assert_eq!(imported.missing, [folder.path("source/wood.png")]);
    assert!(imported.inputs.iter().any(|input| input.ends_with("textures/wood.png")), "{:?}", imported.inputs);
    // Of two that are called alike with other extensions, neither is taken.
    let folder = Folder::new();
    write_obj(&folder, "a.obj", "wood.bmp");
    folder.write("textures/wood.png", png(1, 1, [9; 4])).write("textures/wood.jpg", "x");
    let message = folder.error("a.obj");
    assert!(message.contains("needs the texture wood.bmp, which cannot be read (No such file"), "{message}");
    let advice = "put the file there, beside the scene or into a folder textures beside it, or correct the path in the scene, or go on with \
                  plain colours: --allow-missing-textures on the command line, allow_missing_textures = true in dataset.toml";
    assert!(message.contains(advice), "{message}");
}

#[test]
fn what_cannot_be_decoded_is_not_asked_for_again() {
    let folder = Folder::new();
    write_obj(&folder, "a.obj", "wood.psd");
    let message = folder.write("wood.psd", "8BPS and more").error("a.obj");
    let expected = "which is not a picture of a known format (PNG, JPEG, TIFF, WebP, GIF, BMP, TGA, DDS, KTX2, PNM, HDR, EXR, PFM); save the picture \
                    as PNG or JPEG, under this name or with the new one in the scene, or go on with plain colours: --allow-missing-textures";
    assert!(message.contains(expected) && !message.contains("put the file there"), "{message}");
    let options = ImportOptions { allow_missing_textures: true, ..ImportOptions::default() };
    let told = warnings(&folder.load_with("a.obj", &options).unwrap());
    assert!(told.contains("a plain grey stands in") && !told.contains("put the file there"), "{told}");
}

#[test]
fn textures_may_be_tiff_webp_gif_dds_or_ktx2() {
    let picture_of = image::RgbaImage::from_pixel(1, 1, image::Rgba([10, 200, 30, 255]));
    let encoded = |format| {
        let mut bytes = std::io::Cursor::new(Vec::new());
        picture_of.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    };
    let mut dds = [0u32; 32];
    (dds[0], dds[1], dds[3], dds[4]) = (u32::from_le_bytes(*b"DDS "), 124, 1, 1);
    dds[20..27].copy_from_slice(&[0x41, 0, 32, 0xff, 0xff00, 0xff_0000, 0xff00_0000]);
    let dds: Vec<u8> = dds.iter().flat_map(|word| word.to_le_bytes()).chain([10, 200, 30, 255]).collect();
    // Vulkan's format 37 of 1×1 pixels, whose one level of 4 bytes follows the header.
    let words = [37u32, 1, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0].into_iter().flat_map(u32::to_le_bytes);
    let longs = [0u64, 0, 104, 4, 4].into_iter().flat_map(u64::to_le_bytes);
    let ktx2: Vec<u8> = b"\xabKTX 20\xbb\r\n\x1a\n".iter().copied().chain(words).chain(longs).chain([10, 200, 30, 255]).collect();
    let files = [
        ("a.ktx2", ktx2),
        ("a.tif", encoded(image::ImageFormat::Tiff)),
        ("a.webp", encoded(image::ImageFormat::WebP)),
        ("a.gif", encoded(image::ImageFormat::Gif)),
        ("a.dds", dds),
    ];
    for (name, bytes) in files {
        let folder = Folder::new();
        write_obj(&folder, "a.obj", name);
        let imported = folder.write(name, bytes).load("a.obj").unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(picture(&imported), (name, [10, 200, 30, 255]));
    }
}
