//! Wavefront OBJ with MTL materials.
//!
//! | feature | what becomes of it |
//! |---|---|
//! | faces | any number of corners: convex polygons as fans, concave ones cut properly; negative indices; faces before their vertices |
//! | indices | one of a vertex that the file lacks is an error; one of a texture coordinate or normal is dropped, with a warning |
//! | objects, groups | one part per object, group and material, named after the group (`o` or `g`, whichever came last), with `.<material>` appended where a group has several; without a group after the material, else `part`. Each `o` begins an object, also of a name that occurred before. Several names on a `g` line are groups within each other, the first innermost, unless they seem to be a name with spaces |
//! | names, paths | the whole rest of the line, so spaces and `#` are part of them; elsewhere `#` begins a comment |
//! | normals | as in the file; without any, smooth within smoothing groups (`s 1` and above), across parts too, and flat elsewhere |
//! | colours of vertices | their mean, read as sRGB, is the colour of a part without a material, and the report says so |
//! | text | UTF-8, UTF-16 or Windows-1252, with or without a byte order mark; lines end as on any system; keywords in any case |
//! | numbers | with a decimal comma too, and indices as `3.0` |
//! | libraries, pictures | at their path; else by their name beside the file that names them (pictures also in `textures/`), a name in other case with a warning; for a library that is missing or not named that which is called like the OBJ file |
//! | `Kd Ks Ns Ni d Tr Ke illum`, `map_Kd map_Ke map_d map_Ks` | a diffuse surface; with `Ks`, unless `illum` is 0 or 1, a clear-coated one of GGX alpha √(2/(Ns+2)), or on black `Kd` a mirror of that colour; with `illum` 6 or 7 a solid dielectric, with 4 or 9 only where `Kd` is black and `d` is 1 |
//! | the same of Blender, by the heads of its files | a clear-coated surface of roughness 1 − √(Ns/1000), before 3.2 1 − √(Ns/900), its highlight tinted by twice `Ks`; on black `Kd` too. Before 2.80 of GGX alpha √(2/(0.51·Ns+3)) |
//! | `Pr Pm Pc Pcr Ps`, `map_Pr map_Pm` | metallic-roughness |
//! | `norm` | a normal map |
//! | `map_Bump`, `bump` | a normal map if the picture looks like one (most texels as long as a unit vector, out of the surface on average), else heights by its luminance (guessed: one means 5 mm times `-bm`) |
//! | `d 0`, `Tr 1` | `d 0` is not seen, a `Tr` of one without `d` is taken for opaque, each with a warning |
//! | `map_Ke` with a black `Ke` | taken for white, with a warning |
//! | options of `map_…` | `-s`, `-o`, `-clamp`, `-bm`, `-imfchan` for numbers, `-colorspace` of linear colours; the others are skipped, with a warning |
//! | ambient colours, `sharpness` | without effect |
//! | dropped with a warning | lines, points, curves, and all other statements of materials, such as displacement and reflection maps, anisotropy, `map_Ns` |
//!
//! OBJ knows no sides, so every surface has two, and emits on both. It knows neither lights nor cameras nor units. A missing material
//! library or material is a warning, and is replaced by grey.

mod blender;
mod check;
mod file;
mod groups;
mod library;
mod map;
mod mtl;
mod objects;
mod reader;
mod smooth;
mod text;

pub(crate) use file::ObjFile;
pub(crate) use library::Library;

use crate::assembly::Assembly;
use crate::{ImportError, Imported};
use enfilade_math::{DAffine3, Rgb, linear_from_srgb};
use enfilade_scene::{Material, PartLabel, decoded_text};
use mtl::GREY;
use objects::Objects;
use std::collections::HashMap;

/// Bytes at the beginning of a file that contain its first line.
const HEAD_BYTES: usize = 256;

/// Imports an OBJ file.
pub(crate) fn load(assembly: Assembly) -> Result<Imported, ImportError> {
    load_with(assembly, Library::new())
}

/// Imports an OBJ file of a program that is built on Java 3D, whose loader knows materials that no library defines.
pub(crate) fn load_java3d(assembly: Assembly) -> Result<Imported, ImportError> {
    load_with(assembly, library::java3d())
}

/// Imports an OBJ file; `known` are materials besides those of its libraries.
fn load_with(mut assembly: Assembly, known: Library) -> Result<Imported, ImportError> {
    let file = assembly.file().to_path_buf();
    let bytes = assembly.read_scene_file()?;
    let mut obj = ObjFile::parse(&bytes, &file)?;
    let blender = blender::version(&decoded_text(&bytes[..bytes.len().min(HEAD_BYTES)]));
    obj.settle(assembly.meters_per_unit());
    obj.smooth();
    report(&obj, &mut assembly);
    let own = file.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned());
    let uses_materials = obj.groups.iter().any(|group| group.material.is_some());
    let library = match obj.libraries.is_empty() && uses_materials {
        true => library::read_own_library((&own, blender), known, &mut assembly)?,
        false => library::read_libraries(&obj.libraries, (&own, blender), known, &mut assembly)?,
    };
    let mut materials: HashMap<(Option<&str>, Option<[u8; 3]>), u32> = HashMap::new();
    let mut sharing: HashMap<(usize, Option<&str>), usize> = HashMap::new();
    obj.groups.iter().for_each(|group| *sharing.entry((group.object, group.name.as_deref())).or_default() += 1);
    let mut objects = Objects::new(&obj);
    for (i, group) in obj.groups.iter().enumerate() {
        assembly.progress(i + 1, obj.groups.len());
        let wanted = group.material.as_deref();
        let color = if wanted.is_none() { obj.mean_color(group).map(|c| (c * 255.0).to_array().map(|v| v.round() as u8)) } else { None };
        let material = match materials.get(&(wanted, color)) {
            Some(&known) => known,
            None => {
                let material = match color {
                    Some(rgb) => Material::diffuse("colours", Rgb::from(rgb.map(|v| linear_from_srgb(f32::from(v) / 255.0)))),
                    None => convert(wanted, &library, &mut assembly)?,
                };
                let index = assembly.push_material(material);
                materials.insert((wanted, color), index);
                index
            }
        };
        let shared = sharing[&(group.object, group.name.as_deref())] > 1;
        let name = match (&group.name, wanted) {
            (Some(name), Some(material)) if shared => format!("{name}.{material}"),
            (Some(name), _) => name.clone(),
            (None, Some(material)) => material.to_string(),
            (None, None) => "part".to_string(),
        };
        let mesh = assembly.push_mesh_from(obj.origin, obj.mesh(std::iter::once(group)), &file, &format!("part {name:?}"))?;
        if let Some(mesh) = mesh {
            let object = objects.of(group, &name, &mut assembly);
            assembly.push_part_of(object, &name, mesh, material, DAffine3::IDENTITY, PartLabel::NONE);
        }
    }
    assembly.finish()
}

/// Reports what was ignored. The mean of the vertices' colours is the colour of parts without a material.
fn report(obj: &ObjFile, a: &mut Assembly) {
    let has_parts_without = obj.groups.iter().any(|group| group.material.is_none() && obj.mean_color(group).is_some());
    for note in &obj.notes {
        let used = note == reader::COLORS_DROPPED && has_parts_without;
        let mean = "colours of vertices are not supported; the mean of a part's is its colour where it has no material";
        a.warn("whole file", if used { mean } else { note });
    }
}

/// The materials of the libraries `names`, which the OBJ file at `path` names; a scene of another format refers to it by that path.
pub(crate) fn libraries(names: &[String], path: &str, assembly: &mut Assembly) -> Result<Library, ImportError> {
    library::read_libraries(names, (path, None), Library::new(), assembly)
}

/// The material of a name; `None` where the library does not define it.
pub(crate) fn material(name: &str, library: &Library, assembly: &mut Assembly) -> Result<Option<Material>, ImportError> {
    library.get(name).map(|entry| mtl::material(entry, assembly)).transpose()
}

fn convert(name: Option<&str>, library: &Library, assembly: &mut Assembly) -> Result<Material, ImportError> {
    if let Some(entry) = library.get(name.unwrap_or_default()) {
        return mtl::material(entry, assembly);
    }
    if let Some(entry) = name.and_then(|name| library::in_other_case(library, name)) {
        assembly.warn(format!("usemtl {}", name.unwrap_or_default()), format!("{:?}, which differs in case, was used", entry.name));
        return mtl::material(entry, assembly);
    }
    if let Some(name) = name {
        assembly.warn(format!("usemtl {name}"), "no material library defines this material; grey stands in");
    }
    Ok(Material::diffuse(name.unwrap_or("default"), Rgb::splat(GREY)))
}
