//! Annotated scans of HM3D: `<scan>.semantic.txt` and `<scan>.semantic.glb`, with the scan itself, `<scan>.glb` or `<scan>.basis.glb`.
//!
//! Made from habitat-sim's `HM3DSemanticScene.cpp`, which reads the text, and the description of HM3D-Semantics (arXiv 2210.05633), by
//! which the pictures of the semantic model have a colour of their own for every object. Metres, z up, as habitat-sim's stages from GLB
//! files.
//!
//! | in the files | what becomes of it |
//! |---|---|
//! | the text | number, colour (six hexadecimal digits) and category of every object; its room is not used |
//! | the pictures of the semantic model | the object of a triangle is the one whose colour most of four points within it have |
//! | the scan | its meshes and pictures, apart by objects, where its triangles are those of the semantic model, one by one to 1 mm; otherwise the semantic model's triangles in grey, and the report says so |
//! | triangles of other colours | `unannotated`, without a label |

use super::assets;
use super::objects::Objects;
use crate::assembly::{Assembly, Piece};
use crate::{ImportError, Imported, UpAxis};
use enfilade_geometry::Mesh;
use enfilade_math::{DVec3, Rgb, Vec2};
use enfilade_scene::{Bsdf, Image, Material, PartLabel, Pixels, Scene, TextureRef};
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

/// The end of the text's name, and the line that it begins with.
pub(super) const TEXT: &str = ".semantic.txt";
const HEADER: &str = "HM3D Semantic Annotations";
/// Corners of two models nearer than this are the same, metres.
const SAME_M: f64 = 1e-3;
/// Points within a triangle whose texels are looked at, by the weights of its corners.
const POINTS: [[f32; 3]; 4] = [[1.0 / 3.0; 3], [0.6, 0.2, 0.2], [0.2, 0.6, 0.2], [0.2, 0.2, 0.6]];

/// A piece, and some of its triangles.
type Share = (usize, Vec<usize>);

/// Number and category of an object.
type Named = (i64, String);

/// Imports a scan by its text.
pub(super) fn load(bytes: &[u8], mut a: Assembly) -> Result<Imported, ImportError> {
    let file = a.file().to_path_buf();
    let by_color = parse(&enfilade_scene::decoded_text(bytes)).map_err(|(line, problem)| a.malformed(format!("line {line}"), problem))?;
    a.set_units(1.0, UpAxis::Z);
    let beside = |end: &str| with_end(&file, end);
    let semantic = assets::read(&beside(".semantic.glb"), a.allows_missing_textures(), &a)?;
    let colors = colors(&semantic.scene, &by_color);
    let scan = [".basis.glb", ".glb"].map(beside).into_iter().find(|scan| scan.is_file());
    let pieces = pieces(&semantic, scan.as_deref(), &mut a)?;
    place(&by_color, &colors, &pieces, &mut a)?;
    a.finish()
}

/// The path with another end than the text's.
fn with_end(file: &Path, end: &str) -> PathBuf {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    file.with_file_name(format!("{}{end}", name.strip_suffix(TEXT).unwrap_or(&name)))
}

/// Objects by their colours, or a line and what is wrong with it.
fn parse(text: &str) -> Result<HashMap<[u8; 3], Named>, (usize, String)> {
    let mut lines = text.lines().enumerate();
    if !lines.next().is_some_and(|(_, first)| first.contains(HEADER)) {
        return Err((1, format!("found no {HEADER:?}; expected the text of an annotated scan of HM3D, so unpack the collection again")));
    }
    let mut objects = HashMap::new();
    for (i, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
        // 7,A1B2C3,"chair, old",2: the category may contain commas, and is always quoted.
        let parsed = || {
            let (before, rest) = line.split_once('"')?;
            let (category, _) = rest.rsplit_once('"')?;
            let mut words = before.split(',').map(str::trim).filter(|word| !word.is_empty());
            let number = words.next()?.parse::<i64>().ok()?;
            let color = u32::from_str_radix(words.next()?, 16).ok()?.to_be_bytes();
            Some(([color[1], color[2], color[3]], (number, category.to_string())))
        };
        let Some((color, object)) = parsed() else {
            return Err((i + 1, format!("found {line:?}, expected number, colour, \"category\" and room; unpack the collection again")));
        };
        objects.insert(color, object);
    }
    Ok(objects)
}

/// The colour of every triangle of every part, where it is an object's.
fn colors(scene: &Scene, objects: &HashMap<[u8; 3], Named>) -> Vec<Vec<Option<[u8; 3]>>> {
    let of_part = |part: &enfilade_scene::Part| {
        let mesh = &scene.meshes[part.mesh as usize];
        let texture = base_texture(&scene.materials[part.material as usize]).map(|t| (t, &scene.images[t.image as usize]));
        let color = |triangle: &[u32; 3]| {
            let (texture, image) = texture?;
            let corners = triangle.map(|i| mesh.uvs.get(i as usize).copied().unwrap_or_default());
            let mut votes: BTreeMap<[u8; 3], usize> = BTreeMap::new();
            for weights in POINTS {
                let uv = corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2];
                if let Some(color) = texel(image, texture, uv).filter(|color| objects.contains_key(color)) {
                    *votes.entry(color).or_default() += 1;
                }
            }
            votes.into_iter().max_by_key(|(color, count)| (*count, std::cmp::Reverse(*color))).map(|(color, _)| color)
        };
        mesh.triangles.iter().map(color).collect()
    };
    scene.parts.iter().map(of_part).collect()
}

/// The picture of a material's colour.
fn base_texture(material: &Material) -> Option<&TextureRef> {
    match &material.bsdf {
        Bsdf::Principled(p) => p.base_color.texture.as_ref(),
        Bsdf::Diffuse { reflectance } => reflectance.texture.as_ref(),
        _ => material.emission.texture.as_ref(),
    }
}

/// The texel at a texture coordinate, v upward, without interpolation.
fn texel(image: &Image, texture: &TextureRef, uv: Vec2) -> Option<[u8; 3]> {
    let Pixels::Rgba8 { texels, .. } = &image.pixels else { return None };
    let [[a, b, c], [d, e, f]] = texture.uv_transform;
    let (u, v) = (a * uv.x + b * uv.y + c, d * uv.x + e * uv.y + f);
    let index = |share: f32, size: u32| (((share - share.floor()) * size as f32) as u32).min(size.saturating_sub(1));
    let (x, y) = (index(u, image.width), index(1.0 - v, image.height));
    texels.get(y as usize * image.width as usize + x as usize).map(|[r, g, b, _]| [*r, *g, *b])
}

/// The scan's pieces where its triangles are those of the semantic model, otherwise the semantic model's in grey.
fn pieces(semantic: &Imported, scan: Option<&Path>, a: &mut Assembly) -> Result<Vec<Piece>, ImportError> {
    if let Some(file) = scan {
        let imported = assets::read(file, a.allows_missing_textures(), a)?;
        if agree(&semantic.scene, &imported.scene) {
            // The semantic model was read too.
            a.note_inputs(&semantic.inputs);
            return a.adopt(imported, file);
        }
        a.warn("scan", format!("the triangles of {} are not those of the semantic model, which was used without pictures", file.display()));
    } else {
        a.warn("scan", "neither the .basis.glb nor the .glb of the scan is beside it; the semantic model was used without pictures");
    }
    let mut plain = semantic.clone();
    plain.scene.images.clear();
    plain.scene.materials = vec![Material::diffuse("scan", Rgb::splat(0.5))];
    plain.scene.parts.iter_mut().for_each(|part| part.material = 0);
    let file = a.file().to_path_buf();
    a.adopt(plain, &file)
}

/// True where two scenes have the same triangles, part by part and one by one.
fn agree(first: &Scene, second: &Scene) -> bool {
    let corners = |scene: &Scene, part: usize, triangle: usize| -> [DVec3; 3] {
        let part = &scene.parts[part];
        scene.meshes[part.mesh as usize].corners(triangle).map(|p| part.world_from_mesh.transform_point3(p.as_dvec3()))
    };
    let count = |scene: &Scene, part: usize| scene.meshes[scene.parts[part].mesh as usize].triangles.len();
    first.parts.len() == second.parts.len()
        && (0..first.parts.len()).all(|part| {
            count(first, part) == count(second, part)
                && (0..count(first, part)).all(|t| {
                    let pairs = corners(first, part, t).into_iter().zip(corners(second, part, t));
                    pairs.into_iter().all(|(p, q)| p.distance(q) < SAME_M)
                })
        })
}

/// Places the triangles of each object, those without one last.
fn place(
    by_color: &HashMap<[u8; 3], Named>,
    colors: &[Vec<Option<[u8; 3]>>],
    pieces: &[Piece],
    a: &mut Assembly,
) -> Result<(), ImportError> {
    // By the object's number; what has none comes last.
    let mut of_objects: BTreeMap<(i64, &str), Vec<Share>> = BTreeMap::new();
    for (part, triangles) in colors.iter().enumerate() {
        for (triangle, color) in triangles.iter().enumerate() {
            let key = color.and_then(|c| by_color.get(&c)).map_or((i64::MAX, ""), |(number, category)| (*number, category.as_str()));
            let of_parts = of_objects.entry(key).or_default();
            match of_parts.last_mut() {
                Some((known, list)) if *known == part => list.push(triangle),
                _ => of_parts.push((part, vec![triangle])),
            }
        }
    }
    let (mut objects, file) = (Objects::default(), a.file().to_path_buf());
    for ((number, category), of_parts) in of_objects {
        let is_object = number != i64::MAX;
        let object = if is_object { Some(objects.next(Some(category), &number.to_string())) } else { None };
        let (name, label) = object.map_or(("unannotated".to_string(), PartLabel::NONE), |object| (object.name, object.label));
        let several = of_parts.len() > 1;
        let whole = is_object.then(|| a.push_object(&name, None));
        for (i, (part, triangles)) in of_parts.into_iter().enumerate() {
            let Some(piece) = pieces.get(part) else { continue };
            let mesh = taken(a.mesh_at(piece.mesh), &triangles);
            let own = if several { format!("{name}/{i}") } else { name.clone() };
            if let Some(mesh) = a.push_mesh(mesh, &file, &own)? {
                let object = whole.unwrap_or_else(|| a.push_object(&own, None));
                a.push_part_of(object, &own, mesh, piece.material, piece.model_from_mesh, label);
            }
        }
    }
    objects.finish(a);
    Ok(())
}

/// Mesh of some triangles, with the vertices that they use.
fn taken(mesh: &Mesh, triangles: &[usize]) -> Mesh {
    let (mut out, mut known) = (Mesh::default(), HashMap::new());
    for triangle in triangles.iter().filter_map(|&t| mesh.triangles.get(t)) {
        out.triangles.push(triangle.map(|vertex| {
            *known.entry(vertex).or_insert_with(|| {
                out.positions.push(mesh.positions[vertex as usize]);
                out.normals.extend(mesh.normals.get(vertex as usize));
                out.uvs.extend(mesh.uvs.get(vertex as usize));
                (out.positions.len() - 1) as u32
            })
        }));
    }
    out
}
