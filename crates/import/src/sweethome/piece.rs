//! Furniture, doors, windows and lamps: their placement and their looks.

use super::home::Home;
use super::model::{self, Model, ModelPart, Models};
use super::paint::{self, Paint};
use super::xml::Element;
use crate::ImportError;
use enfilade_math::{DAffine3, DMat3, DVec2, DVec3, Rgb, Vec2, srgb_from_linear};
use enfilade_scene::{Alpha, Bsdf, ColorParam, Light, Material, PartLabel};
use std::rc::Rc;

/// Factor of the square of a lamp's power in Sweet Home 3D's photographs, times the squared largest value of a colour there.
const LAMP: f64 = 5.0 * 255.0 * 255.0;
/// The default light colour of homes.
pub(super) const HOME_LIGHT: f64 = 208.0 / 255.0;

/// A piece of the home that is shown.
pub(super) struct Piece<'x> {
    pub element: Element<'x>,
    /// Height of its level's floor, centimetres.
    pub base: f64,
    pub is_opening: bool,
    stair: Option<[f64; 2]>,
    corners: [DVec2; 4],
}

/// Gathers all visible pieces, those of groups included.
pub(super) fn collect<'x>(
    parent: &Element<'x>,
    level: Option<&'x str>,
    depth: usize,
    home: &mut Home,
    out: &mut Vec<Piece<'x>>,
) -> Result<(), ImportError> {
    for element in parent.children() {
        let level = element.text("level").or(level);
        let shown = element.flag("visible", true) && home.shows(level);
        match element.tag() {
            "furnitureGroup" if shown && depth == 0 => return Err(element.error("groups are nested too deep; ungroup some")),
            "furnitureGroup" if shown => collect(&element, level, depth - 1, home, out)?,
            "pieceOfFurniture" | "doorOrWindow" | "light" | "shelfUnit" if shown => {
                out.push(Piece::read(element, home.elevation_of(level))?);
            }
            tag if shown && element.text("model").is_some() => {
                home.a.warn(format!("<{tag}>"), "this kind of furniture is not known; all pieces of it were left out");
            }
            _ => (),
        }
    }
    Ok(())
}

impl<'x> Piece<'x> {
    fn read(element: Element<'x>, base: f64) -> Result<Self, ImportError> {
        let size = DVec2::new(element.length("width")?, element.length("depth")?);
        let center = DVec2::new(element.required("x")?, element.required("y")?);
        let turn = DVec2::from_angle(element.number_or("angle", 0.0)?);
        let corner = |x, y| center + turn.rotate(0.5 * size * DVec2::new(x, y));
        let bottom = base + element.number_or("elevation", 0.0)?;
        let top = bottom + element.length("height")?;
        Ok(Self {
            element,
            base,
            is_opening: element.tag() == "doorOrWindow" || element.flag("doorOrWindow", false),
            stair: element.text("staircaseCutOutShape").map(|_| [bottom, top]),
            corners: [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        })
    }

    /// True for staircases that lead through a floor at `elevation`, or through a ceiling from the level of `from`.
    pub fn opens_floor_at(&self, elevation: f64, from: f64) -> bool {
        // The last step may be somewhat below the floor that it leads to.
        const STEP: f64 = 30.0;
        self.stair.is_some_and(|[bottom, top]| bottom < elevation - STEP && top + STEP >= elevation && bottom + STEP >= from.min(bottom))
    }

    /// The corners of its rectangle on the plan.
    pub fn footprint(&self) -> [DVec2; 4] {
        self.corners
    }
}

/// Adds a piece: its model's parts, placed and painted, and its lamps.
pub(super) fn add(piece: &Piece, root: &Element, home: &mut Home) -> Result<(), ImportError> {
    let element = piece.element;
    let name = name(element, &mut home.models);
    let model = deformed(element, model_of(piece, home)?, home)?;
    let size = DVec3::new(element.length("width")?, element.length("height")?, element.length("depth")?);
    let normal = normalization(element, root, &model, home)?;
    let placement = placement(piece, size, &model, normal, home)?;
    let shared = model.parts.len() > 1;
    let is_light = element.tag() == "light";
    let object = home.a.push_object(&name, None);
    for part in model.parts.iter().filter(|p| !(is_light && p.is_light_mark())) {
        let Some((material, covered)) = material_of(element, part, home)? else { continue };
        let mesh = if covered { mapped(part.mesh, normal * part.file_from_mesh, size, home)? } else { part.mesh };
        let part_name = if shared { format!("{name}.{}", part.name) } else { name.clone() };
        home.a.push_part_of(object, &part_name, mesh, material, placement * normal * part.file_from_mesh, PartLabel::NONE);
    }
    if is_light {
        add_lamps(element, &name, placement, root, home)?;
    }
    Ok(())
}

/// Name of a piece, with a number where there are several, and with the catalogue's in brackets.
fn name(element: Element, models: &mut Models) -> String {
    let name = element.text("name").unwrap_or("piece");
    let count = models.names.entry(name.to_string()).or_default();
    *count += 1;
    let numbered = if *count > 1 { format!("{name}_{count}") } else { name.to_string() };
    element.text("catalogId").map_or(numbered.clone(), |id| format!("{numbered} ({id})"))
}

fn model_of(piece: &Piece, home: &mut Home) -> Result<Rc<Model>, ImportError> {
    let element = piece.element;
    let Some(file) = element.text("model") else {
        home.a.warn(element.place(), "the piece has no model, so nothing of it is seen");
        return Ok(Rc::new(Model { parts: Vec::new() }));
    };
    if let Some(known) = home.models.known.get(file) {
        return Ok(known.clone());
    }
    let model = match model::load(home.archive, file, &mut home.a) {
        Ok(model) => {
            if model.parts.is_empty() && element.tag() != "light" {
                home.a.warn(element.place(), format!("the model {file} has lines alone and no surface, so nothing of it is seen"));
            }
            model
        }
        Err(problem) => {
            home.a.warn(element.place(), format!("the model {file} {problem}; a box of the piece's size stands in"));
            model::cuboid(&mut home.a)?
        }
    };
    let model = Rc::new(model);
    home.models.known.insert(file.to_string(), model.clone());
    Ok(model)
}

/// The model with its doors, drawers and arms as the piece has them opened, drawn and turned. The piece's size is the size of this model.
fn deformed(element: Element, model: Rc<Model>, home: &mut Home) -> Result<Rc<Model>, ImportError> {
    let movements: Vec<Element> = element.children().filter(|c| c.tag() == "transformation").collect();
    if movements.is_empty() {
        return Ok(model);
    }
    let mut parts = model.parts.clone();
    for movement in movements {
        let moved_from_file = matrix(movement)?;
        let name = movement.text("name").unwrap_or_default();
        let joint = name.strip_prefix("sweethome3d_").filter(|joint| !joint.is_empty());
        let mut moved = parts.iter_mut().filter(|p| joint.is_some_and(|joint| p.hangs_on(joint))).peekable();
        if moved.peek().is_none() {
            let message = format!("parts of the model are moved at {name:?}, which is no hinge, rail or ball of it; they stay as they are");
            home.a.warn(element.place(), message);
        }
        moved.for_each(|p| p.file_from_mesh = moved_from_file * p.file_from_mesh);
    }
    Ok(Rc::new(Model { parts }))
}

/// A matrix of three rows and four columns.
fn matrix(element: Element) -> Result<DAffine3, ImportError> {
    match element.numbers("matrix")?.as_deref() {
        Some(&[a, b, c, x, d, e, f, y, g, h, i, z]) => {
            let turn = DMat3::from_cols_array(&[a, b, c, d, e, f, g, h, i]).transpose();
            Ok(DAffine3::from_mat3_translation(turn, DVec3::new(x, y, z)))
        }
        other => {
            let found = other.map_or(0, |numbers| numbers.len());
            Err(element.error(format!("found {found} numbers in matrix, expected twelve; save the home again")))
        }
    }
}

/// From the model to a box of side one around the origin, turned upright.
fn normalization(element: Element, root: &Element, model: &Model, home: &Home) -> Result<DAffine3, ImportError> {
    let rotation = match element.numbers("modelRotation")?.as_deref() {
        None => None,
        Some(&[a, b, c, d, e, f, g, h, i]) => Some(DMat3::from_cols_array(&[a, b, c, d, e, f, g, h, i]).transpose()),
        Some(other) => {
            return Err(element.error(format!("found {} numbers in modelRotation, expected nine; save the home again", other.len())));
        }
    };
    let old = root.number_or("version", 0.0)? < 5500.0;
    Ok(model.normalized(rotation, !old && element.flag("modelCenteredAtOrigin", true), &home.a))
}

/// From the box of side one to its place in the home: mirrored, sized, pitched and rolled about its centre, turned and moved.
fn placement(piece: &Piece, size: DVec3, model: &Model, normal: DAffine3, home: &Home) -> Result<DAffine3, ImportError> {
    let element = piece.element;
    let mirror = if element.flag("modelMirrored", false) { -1.0 } else { 1.0 };
    let mut sized = DAffine3::from_scale(size * DVec3::new(mirror, 1.0, 1.0));
    let mut height = size.y;
    let (pitch, roll) = (element.number_or("pitch", 0.0)?, element.number_or("roll", 0.0)?);
    if pitch != 0.0 || roll != 0.0 {
        sized = DAffine3::from_mat3(DMat3::from_rotation_z(-roll) * DMat3::from_rotation_x(-pitch)) * sized;
        let (min, max) = model.bounds(sized * normal, &home.a);
        sized = DAffine3::from_translation(-0.5 * (min + max)) * sized;
        height = max.y - min.y;
    }
    let turned = DAffine3::from_mat3(DMat3::from_rotation_y(-element.number_or("angle", 0.0)?));
    let up = piece.base + element.number_or("elevation", 0.0)? + 0.5 * height;
    Ok(DAffine3::from_translation(DVec3::new(element.required("x")?, up, element.required("y")?)) * turned * sized)
}

/// The material of a model's part on this piece, and whether a picture covers it by centimetres. `None` where the piece hides it.
fn material_of(element: Element, part: &ModelPart, home: &mut Home) -> Result<Option<(u32, bool)>, ImportError> {
    let material = part.material;
    let whole = element.color("color")?.is_some() || element.child("texture", None).is_some();
    let own = home.a.material_at(material).clone();
    let source = if whole {
        Some(element).filter(|_| !part.is_pane())
    } else {
        element.children().filter(|c| c.tag() == "material").find(|c| c.text("name") == Some(own.name.as_str()))
    };
    let shininess = source.map_or(Ok(None), |s| s.number("shininess"))?.or(element.number("shininess")?);
    let (color, texture) = match source {
        Some(s) => (s.color("color")?, s.child("texture", None).filter(|_| !part.is_mirror())),
        None => (None, None),
    };
    if color.is_some_and(|(alpha, _)| alpha == 0) && texture.is_none() && !whole {
        return Ok(None);
    }
    if color.is_none() && texture.is_none() && shininess.is_none() {
        return Ok(Some((material, false)));
    }
    // The pictures of single materials follow the model's own coordinates.
    let by_model = !whole && !home.a.mesh_at(part.mesh).uvs.is_empty();
    let covered = texture.is_some() && !by_model;
    let paint = Paint { color, texture, shininess: shininess.unwrap_or(0.0) };
    let (key, _) = paint.key();
    let key = format!("{material} {key} {shininess:?} {by_model}");
    if let Some(known) = home.repainted.get(&key) {
        return Ok(Some((*known, covered)));
    }
    let new = match (texture, color) {
        (Some(texture), _) => {
            let read = if by_model { paint::texture_of_model } else { paint::texture };
            let found = read(texture, &own.name, &mut home.a)?;
            Some(found.map_or(Rgb::splat(0.5).into(), |t| ColorParam { factor: Rgb::WHITE, texture: Some(t) }))
        }
        (None, Some((_, rgb))) => Some(rgb.into()),
        (None, None) => None,
    };
    let index = home.a.push_material(repainted(own, new, shininess));
    home.repainted.insert(key, index);
    Ok(Some((index, covered)))
}

/// A material with another colour and shininess; panes and metals stay what they are.
fn repainted(mut material: Material, color: Option<ColorParam>, shininess: Option<f64>) -> Material {
    if let (Some(color), Alpha::Opaque) = (color, &material.alpha)
        && color.texture.is_some()
    {
        material.normal_map = None;
    }
    if let Bsdf::ThinDielectric { transmittance, .. } = &mut material.bsdf {
        *transmittance = color.map_or(*transmittance, model::tinted);
    }
    let Some(base) = model::base_color(&mut material.bsdf) else { return material };
    *base = color.unwrap_or(*base);
    let base = *base;
    let takes_shine = match &material.bsdf {
        Bsdf::Diffuse { .. } => true,
        Bsdf::Principled(p) => p.metallic.factor == 0.0,
        _ => false,
    };
    if let Some(shininess) = shininess.filter(|_| takes_shine) {
        material.bsdf = paint::bsdf(base, shininess);
    }
    material
}

/// A copy of a mesh with coordinates in centimetres for pictures: across its front, and up its front and on over its top.
fn mapped(mesh: u32, unit_from_mesh: DAffine3, size: DVec3, home: &mut Home) -> Result<u32, ImportError> {
    let mut copy = home.a.mesh_at(mesh).clone();
    let place = |p: &enfilade_math::Vec3| (unit_from_mesh.transform_point3(p.as_dvec3()) + 0.5) * size;
    let uv = |p: DVec3| Vec2::new(p.x as f32, (p.y + size.z - p.z) as f32);
    copy.uvs = copy.positions.iter().map(|p| uv(place(p))).collect();
    let file = home.a.file().to_path_buf();
    Ok(home.a.push_mesh(copy, &file, "furniture")?.unwrap_or(mesh))
}

fn add_lamps(element: Element, name: &str, placement: DAffine3, root: &Element, home: &mut Home) -> Result<(), ImportError> {
    let power = element.number_or("power", 0.5)?.max(0.0);
    let of_home = match root.child("environment", None) {
        Some(e) => e.color("lightColor")?.map_or(Rgb::splat(HOME_LIGHT as f32), |(_, c)| c.map(srgb_from_linear)),
        None => Rgb::splat(HOME_LIGHT as f32),
    };
    for source in element.children().filter(|c| c.tag() == "lightSource") {
        let at = DVec3::new(source.required("x")? - 0.5, source.required("z")? - 0.5, 0.5 - source.required("y")?);
        let color = source.color("color")?.map_or(Rgb::WHITE, |(_, c)| c.map(srgb_from_linear));
        let position = placement.transform_point3(at).as_vec3();
        // Sweet Home 3D's photographs give a sphere of radius r the radiance LAMP·power²/r²: π·r² of it is seen from anywhere.
        let intensity = color * of_home * (LAMP * power * power * std::f64::consts::PI) as f32;
        if power > 0.0 {
            home.a.push_light(Light::Point { name: name.to_string(), position, intensity });
        }
    }
    Ok(())
}
