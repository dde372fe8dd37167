//! Geoms: which are seen, their forms, and their parts of the scene.

use super::forms::{ENDLESS_M, Form, laid_out};
use super::omitted::Omitted;
use super::pictures::Layout;
use super::settings::{Settings, along};
use super::shade::Shade;
use super::tree::Element;
use super::walk::{Place, Walk};
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_math::{DAffine3, DVec3};
use enfilade_scene::PartLabel;

/// Groups of geoms that MuJoCo's viewer shows.
const SHOWN: std::ops::RangeInclusive<i64> = 0..=2;

impl Walk<'_> {
    /// Adds a geom.
    pub(super) fn geom(&mut self, geom: &Element, at: &Place, a: &mut Assembly) -> Result<(), ImportError> {
        let geom = self.settings.complete(geom, at.class.as_deref())?;
        let group = geom.number("group")?.unwrap_or(0.0) as i64;
        let chosen = &a.options().geom_groups;
        if if chosen.is_empty() { !SHOWN.contains(&group) } else { !chosen.iter().any(|shown| i64::from(*shown) == group) } {
            self.omitted.groups += 1;
            return Ok(());
        }
        let collides = ["contype", "conaffinity"].iter().any(|bits| geom.text(bits) != Some("0"));
        if (group, collides) == (0, true) || (group, collides) == (1, false) {
            self.omitted.doubled[group as usize] += 1;
        }
        let shade = self.shades.get(&geom, &self.settings, a)?;
        if shade.is_invisible() {
            self.omitted.invisible += 1;
            return Ok(());
        }
        let (placement, length) = placement(&geom, &self.settings)?;
        let Some(form) = form(&geom, length, &mut self.omitted, a)? else { return Ok(()) };
        let before = a.contents();
        self.place(&geom, &form, &shade, at, at.file_from_here * placement, a)?;
        if let Some(body) = at.body {
            a.carry(body, before);
        }
        Ok(())
    }

    fn place(
        &mut self,
        geom: &Element,
        form: &Form,
        shade: &Shade,
        at: &Place,
        file_from_geom: DAffine3,
        a: &mut Assembly,
    ) -> Result<(), ImportError> {
        let asset = match form {
            Form::Mesh(name) => match self.meshes.get(name, geom, &self.settings, a)? {
                Some(asset) => Some(asset),
                None => return Ok(()),
            },
            _ => None,
        };
        let (placement, own_uvs) = match &asset {
            Some(asset) => (asset.geom_from_mesh, !asset.mesh.uvs.is_empty()),
            None => (DAffine3::from_scale(form.scale()), false),
        };
        let layout = shade.picture.map(|picture| picture.layout).filter(|layout| !own_uvs || *layout != Layout::Flat);
        let key = (form.key(), layout);
        let pushed = match self.pushed.get(&key) {
            Some(known) => *known,
            None => {
                let mesh = asset.as_ref().map_or_else(|| form.mesh(), |asset| asset.mesh.clone());
                let mesh = layout.map_or_else(|| mesh.clone(), |layout| laid_out(&mesh, layout));
                let file = a.file().to_path_buf();
                let pushed = a.push_mesh(mesh, &file, &key.0)?;
                self.pushed.insert(key, pushed);
                pushed
            }
        };
        let Some(mesh) = pushed else { return Ok(()) };
        let half = form.half();
        let material = self.shades.push(shade, [half.x, half.y], own_uvs, a);
        let name = part_name(geom, form, at);
        // What stands in the world itself is no part of one thing: each geom there is a thing.
        let object = if at.link == 0 { a.push_object(&name, Some(at.object)) } else { at.object };
        a.push_part_of(object, &name, mesh, material, file_from_geom * placement, PartLabel::NONE);
        Ok(())
    }
}

/// The name of a part: the geom's, else the body's with that of the mesh.
fn part_name(geom: &Element, form: &Form, at: &Place) -> String {
    match (geom.name(), form) {
        ("", Form::Mesh(mesh)) if *mesh != at.name => format!("{}.{mesh}", at.name),
        ("", _) => at.name.clone(),
        (name, _) => name.to_string(),
    }
}

/// Where a geom is in its body, and half the length that its two ends (`fromto`) give it.
fn placement(geom: &Element, settings: &Settings) -> Result<(DAffine3, Option<f64>), ImportError> {
    let Some(ends) = geom.vector::<6>("fromto")? else { return Ok((settings.placement(geom)?, None)) };
    let (from, to) = (DVec3::from_slice(&ends), DVec3::from_slice(&ends[3..]));
    let turn = along(from - to).ok_or_else(|| geom.wrong("both ends in fromto are one point".into()))?;
    Ok((DAffine3::from_rotation_translation(turn, 0.5 * (from + to)), Some(0.5 * from.distance(to))))
}

/// The form of a geom; `None`, with a warning, of kinds that are not read.
fn form(geom: &Element, length: Option<f64>, omitted: &mut Omitted, a: &mut Assembly) -> Result<Option<Form>, ImportError> {
    let size = geom.numbers("size", 1..=3)?.unwrap_or_default();
    let kind = geom.text("type").unwrap_or("sphere");
    if kind != "mesh" && geom.text("mesh").is_some() {
        let place = geom.place(a);
        a.warn(place, format!("a {kind} that is fitted to a mesh is not read; it was left out"));
        return Ok(None);
    }
    let at = |i: usize| {
        let found = size.get(i).copied().filter(|length| *length > 0.0);
        found.ok_or_else(|| geom.wrong(format!("found {size:?} as size, expected lengths above zero for a {kind}")))
    };
    // Two ends take the place of the last length.
    let along = |i: usize| length.map_or_else(|| at(i), Ok);
    let across = |length: Option<f64>| match length {
        Some(half) => Ok(DVec3::new(at(0)?, at(0)?, half)),
        None => Ok::<_, ImportError>(DVec3::new(at(0)?, at(1)?, at(2)?)),
    };
    Ok(Some(match kind {
        "plane" => {
            let sides = [0, 1].map(|i| size.get(i).copied().unwrap_or(0.0));
            omitted.endless += usize::from(sides.iter().any(|side| *side <= 0.0));
            Form::Plane(sides.map(|side| if side > 0.0 { side } else { ENDLESS_M }))
        }
        "sphere" => Form::Ellipsoid(DVec3::splat(at(0)?)),
        "ellipsoid" => Form::Ellipsoid(across(length)?),
        "box" => Form::Box(across(length)?),
        "cylinder" => Form::Cylinder { radius: at(0)?, half: along(1)? },
        "capsule" => Form::Capsule { radius: at(0)?, half: along(1)? },
        "mesh" => Form::Mesh(geom.text("mesh").ok_or_else(|| geom.wrong("a geom of the type mesh names no mesh".into()))?.into()),
        other => {
            let place = geom.place(a);
            a.warn(place, format!("geoms of the type {other:?} are not read; it was left out"));
            return Ok(None);
        }
    }))
}
