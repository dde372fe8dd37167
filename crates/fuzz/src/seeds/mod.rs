//! Files to begin with that are made by code: by the builders of the other crates' tests where there are any.

#[cfg(feature = "dataset")]
pub mod dataset;
mod fbx;
mod pictures;

#[path = "../../../import/tests/all/common/mod.rs"]
mod import;
#[cfg(feature = "program")]
#[allow(dead_code, reason = "made for other tests, of which a part is used")]
#[path = "../../../label_page/tests/label/room.rs"]
pub mod room;

use crate::Seed;
use enfilade_geometry::{OccupancyTree, Voxel, VoxelKey};
use enfilade_math::{DAffine3, Rgb, Vec2, Vec3};
use enfilade_scene::{Labels, Light, Material, Part, PartLabel, Scene, to_bytes, to_bytes_with_labels};
use flate2::{Compression, write::ZlibEncoder};
use import::Gltf;
use serde_json::json;
use std::io::Write;
use std::path::Path;

#[cfg(feature = "dataset")]
pub use dataset::{arrays, records, tables};
pub use fbx::fbx;
pub use pictures::pictures;
#[cfg(feature = "program")]
pub use pictures::vray_images;

fn seed(name: &str, bytes: impl Into<Vec<u8>>) -> Seed {
    Seed { name: name.into(), bytes: bytes.into() }
}

/// A triangle with a lamp.
pub fn scene() -> Scene {
    let mesh = enfilade_geometry::Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::Y],
        triangles: vec![[0, 1, 2]],
        ..Default::default()
    };
    Scene {
        meshes: vec![mesh.into()],
        parts: vec![Part { name: "floor".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY }],
        materials: vec![Material::diffuse("oak", Rgb::splat(0.5))],
        lights: vec![Light::Point { name: "lamp".into(), position: Vec3::Z, intensity: Rgb::WHITE }],
        ..Scene::default()
    }
}

/// A triangle as text and binary, and one with everything that a glTF may have.
pub fn gltf() -> Vec<Seed> {
    let plain = Gltf::triangle();
    let mut full = Gltf::triangle();
    full.json["images"] = json!([{"uri": "texture.png"}]);
    full.json["samplers"] = json!([{"wrapS": 33071, "magFilter": 9728}]);
    full.json["textures"] = json!([{"source": 0, "sampler": 0}]);
    full.json["extensionsUsed"] = json!(["KHR_lights_punctual", "KHR_materials_ior", "KHR_texture_transform"]);
    full.json["materials"][0] = json!({
        "name": "Wood", "alphaMode": "MASK", "doubleSided": true, "emissiveFactor": [1, 0, 0], "normalTexture": {"index": 0, "scale": 0.5},
        "pbrMetallicRoughness": {
            "baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"scale": [2, 2], "rotation": 1}}}, "metallicFactor": 0
        },
        "extensions": {"KHR_materials_ior": {"ior": 1.4}, "KHR_materials_transmission": {"transmissionFactor": 1},
            "KHR_materials_clearcoat": {"clearcoatFactor": 1}, "KHR_materials_volume": {"attenuationDistance": 2}}
    });
    full.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}]);
    full.json["extensions"] =
        json!({"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {"outerConeAngle": 0.5}, "intensity": 9}]}});
    full.json["nodes"] = json!([
        {"name": "Chair", "mesh": 0, "scale": [1, -1, 1], "children": [1, 2], "extras": {"semantic": "chair", "instance": 3}},
        {"camera": 0, "rotation": [0, 0.7, 0, 0.7]},
        {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [1, 2, 3]}
    ]);
    full.json["accessors"][0]["sparse"] =
        json!({"count": 1, "indices": {"bufferView": 2, "componentType": 5123}, "values": {"bufferView": 0}});
    full.json["scenes"][0]["extras"] = json!({"environment": {"color": [1, 1, 1]}});
    vec![
        seed("triangle.gltf", plain.text()),
        seed("triangle.glb", plain.binary()),
        seed("everything.gltf", full.text()),
        seed("draco.glb", include_bytes!("../../../import/tests/gltf/draco_edgebreaker.glb")),
        seed("meshopt.glb", include_bytes!("../../../import/tests/gltf/meshopt_khr.glb")),
    ]
}

/// A glTF with a light that a photometric profile describes.
pub fn with_profile() -> Vec<u8> {
    let mut gltf = Gltf::triangle();
    gltf.json["extensionsUsed"] = json!(["EXT_lights_ies"]);
    gltf.json["extensions"] = json!({"EXT_lights_ies": {"lights": [{"uri": "lamp.ies"}]}});
    gltf.json["nodes"][0]["extensions"] = json!({"EXT_lights_ies": {"light": 0}});
    gltf.text().into_bytes()
}

/// The scenes that our pictures are compared with Mitsuba's by.
pub fn mitsuba() -> Vec<Seed> {
    Seed::of_folder(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../xtask/oracle"))
        .into_iter()
        .filter(|f| f.name.ends_with(".xml"))
        .collect()
}

const PLY: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n\
    property float nz\nproperty float u\nproperty float v\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";

/// A square as text, and in both byte orders.
pub fn ply() -> Vec<Seed> {
    let corners = [[0.0f32, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| [x, y, 2.0, 0.0, 0.0, 1.0, x, y]);
    let mut text = format!("ply\nformat ascii 1.0\ncomment a square\n{PLY}");
    corners.iter().for_each(|corner| text += &format!("{}\n", corner.map(|v| v.to_string()).join(" ")));
    text += "4 0 1 2 3\n";
    let binary = |order: &str, float: fn(f32) -> [u8; 4], int: fn(i32) -> [u8; 4]| {
        let mut bytes = format!("ply\nformat binary_{order}_endian 1.0\n{PLY}").into_bytes();
        bytes.extend(corners.iter().flatten().flat_map(|&v| float(v)));
        bytes.push(4);
        bytes.extend((0..4).flat_map(int));
        bytes
    };
    vec![
        seed("text.ply", text),
        seed("little.ply", binary("little", f32::to_le_bytes, i32::to_le_bytes)),
        seed("big.ply", binary("big", f32::to_be_bytes, i32::to_be_bytes)),
    ]
}

/// Two meshes of one triangle, in both versions of the format.
pub fn serialized() -> Vec<Seed> {
    [3u16, 4].map(|version| seed(&format!("version_{version}.serialized"), serialized_of(version))).into()
}

fn serialized_of(version: u16) -> Vec<u8> {
    let (mut bytes, mut offsets) = (Vec::new(), Vec::new());
    for double in [false, true] {
        offsets.push(bytes.len() as u64);
        bytes.extend([0x1c, 0x04, version as u8, 0]);
        // Normals, texture coordinates, and the width of the numbers.
        let flags: u32 = 3 | if double { 0x2000 } else { 0x1000 };
        let mut raw = flags.to_le_bytes().to_vec();
        raw.extend_from_slice(if version == 4 { b"name\0" } else { b"" });
        raw.extend([3u64, 1].iter().flat_map(|n| n.to_le_bytes()));
        for v in (0..24).map(|i| f64::from(i * 5 % 7)) {
            if double { raw.extend(v.to_le_bytes()) } else { raw.extend((v as f32).to_le_bytes()) }
        }
        raw.extend([0u32, 1, 2].iter().flat_map(|i| i.to_le_bytes()));
        bytes.extend(deflated(&raw));
    }
    for offset in offsets {
        bytes.extend(if version == 4 { offset.to_le_bytes().to_vec() } else { (offset as u32).to_le_bytes().to_vec() });
    }
    bytes.extend(2u32.to_le_bytes());
    bytes
}

fn deflated(raw: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(raw).expect("writing to memory cannot fail");
    encoder.finish().expect("writing to memory cannot fail")
}

/// Packages with and without labels and pictures; one without the line and the checksum before it.
pub fn packages() -> Vec<Seed> {
    let image = |pixels| enfilade_scene::Image { name: "p".into(), width: 2, height: 1, pixels }.into();
    let mut pictured = scene();
    pictured.images = vec![
        image(enfilade_scene::Pixels::Rgba8 { srgb: true, texels: vec![[1, 2, 3, 4], [9; 4]] }),
        image(enfilade_scene::Pixels::RgbF32(vec![[0.5; 3]; 2])),
    ];
    let plain = to_bytes(&scene());
    let labels = Labels { parts: vec![PartLabel { semantic: 2, instance: 1 }] };
    let labelled = to_bytes_with_labels(&pictured, &labels);
    // 17 bytes of the line, 32 of the checksum.
    vec![seed("body", &labelled[49..]), seed("whole", plain)]
}

/// A small tree as `.bt`.
pub fn octrees() -> Vec<Seed> {
    let mut tree = OccupancyTree::new(0.1);
    for (x, voxel) in [(0, Voxel::Free), (1, Voxel::Occupied), (700, Voxel::Free)] {
        tree.set(VoxelKey([32768 + x, 32768, 32760]), voxel);
    }
    vec![seed("tree.bt", tree.to_bt())]
}

/// The room of the importer's tests, as text and binary.
pub fn usd() -> Vec<Seed> {
    vec![
        seed("room.usda", include_bytes!("../../../import/tests/usd/room.usda")),
        seed("room.usdc", include_bytes!("../../../import/tests/usd/room.usdc")),
    ]
}

/// Seeds of the same room as an archive.
pub fn usdz() -> Vec<Seed> {
    vec![seed("room.usdz", include_bytes!("../../../import/tests/usd/room.usdz"))]
}

/// Entries of a catalogue, and a complete catalogue.
#[cfg(feature = "program")]
pub fn catalogues() -> Vec<Seed> {
    let text = "license=CC-BY 3.0\nname#1=Wardrobe\nid#1=t#wardrobe\ncategory#1=Bedroom\nmodel#1=/w/w.obj\nwidth#1=120\ndepth#1=60\n\
        height#1=205.5\ncreator#1=Ann\nmodelRotation#1=0 0 1 0 1 0 -1 0 0\nname#2=Door\ncategory#2=Doors and windows\nmodel#2=/d.obj\n\
        name#3=Lamp\ncategory#3=Lights\nmodel#3=/w/w.obj\nwidth#3=30\ndepth#3=30\nheight#3=45\nlightSourceX#3=15\nlightSourceY#3=15\n\
        lightSourceZ#3=30\n";
    let table = "licence = \"CC0\"\n[models.\"t#wardrobe\"]\nclass = \"wardrobe\"\nsize = [1.2, 0.6, 2.0]\nfront = \"-z\"\nweight = 2\n";
    vec![seed("list.properties", text), seed("assets.toml", table), seed("whole.sh3f", archive(text.as_bytes()))]
}

/// A catalogue that lists this, with a box as a model.
#[cfg(feature = "program")]
pub fn archive(list: &[u8]) -> Vec<u8> {
    let obj = "mtllib w.mtl\nusemtl oak\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
    zip(&[("PluginFurnitureCatalog.properties", list), ("w/w.obj", obj.as_bytes()), ("w/w.mtl", b"newmtl oak\nKd 0.4 0.3 0.2\n")])
}

/// An archive of these files.
pub fn zip(files: &[(&str, &[u8])]) -> Vec<u8> {
    use zip::{ZipWriter, write::SimpleFileOptions};
    let mut archive = ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, bytes) in files {
        archive.start_file(*name, SimpleFileOptions::default()).expect("writing to memory cannot fail");
        archive.write_all(bytes).expect("writing to memory cannot fail");
    }
    archive.finish().expect("writing to memory cannot fail").into_inner()
}
