//! Media within shapes: what they absorb colours the inside of glass.
//!
//! Version 0.x states σa and σs, or σt and the albedo, and takes what is missing from its preset `Skin1`; versions 2 and 3 state σt (else 1)
//! and the albedo (else 0.75). All are per unit of the scene and are multiplied by `scale`. σa = σt · (1 − albedo) is kept; light is not
//! scattered.

use super::reader::Reader;
use super::spectrum;
use super::xml::Node;
use crate::ImportError;
use crate::spectrum::Kind;
use enfilade_math::Rgb;
use enfilade_scene::Bsdf;

/// The coefficients of a medium.
const COEFFICIENTS: [&str; 4] = ["sigma_a", "sigma_s", "sigma_t", "albedo"];
/// Other properties of homogeneous media, without effect on what is kept except for `scale` and `material`.
const SETTINGS: [&str; 10] = [
    "scale",
    "material",
    "g",
    "sample_emitters",
    "has_spectral_extinction",
    "strategy",
    "medium_sampling_weight",
    "channel",
    "monochromatic",
    "sampling_density",
];
/// σa and σs of the preset `Skin1`, which version 0.x takes for what is not stated, per metre.
const SKIN: [Rgb; 2] = [Rgb::new(3.2, 17.0, 48.0), Rgb::new(74.0, 88.0, 101.0)];
/// Extinction and albedo where versions 2 and 3 find none.
const EXTINCTION: f32 = 1.0;
const ALBEDO: f32 = 0.75;

impl<'n> Reader<'n, '_> {
    /// The medium within a shape. Reports those around it.
    pub(super) fn medium_inside(&mut self, shape: &'n Node) -> Result<Option<&'n Node>, ImportError> {
        let mut inside = None;
        for child in shape.children.iter().filter(|c| matches!(c.tag.as_str(), "medium" | "subsurface" | "ref")) {
            let target = self.resolve(child)?;
            match (target.tag.as_str(), child.name.as_str()) {
                ("subsurface", _) => self.warn(child, "scattering below surfaces is not supported; the shape is empty inside"),
                ("medium", "exterior") => self.warn(child, "media outside of shapes are not supported; it was left out"),
                ("medium", _) => inside = Some(target),
                _ => (),
            }
        }
        Ok(inside)
    }

    /// What a medium absorbs, per metre; black where nothing of it can be kept.
    fn absorption(&mut self, medium: &'n Node) -> Result<Rgb, ImportError> {
        if let Some(&known) = self.media.get(&std::ptr::from_ref(medium)) {
            return Ok(known);
        }
        let absorption = self.read_medium(medium)? * (1.0 / self.a.meters_per_unit()) as f32;
        self.media.insert(medium, absorption);
        Ok(absorption)
    }

    /// The absorption of a medium per unit of the file.
    fn read_medium(&mut self, medium: &'n Node) -> Result<Rgb, ImportError> {
        if medium.plugin != "homogeneous" {
            self.warn(medium, format!("{} media are not supported, only homogeneous ones; it was left out", medium.plugin));
            return Ok(Rgb::BLACK);
        }
        self.report_unknown(medium, &[COEFFICIENTS.as_slice(), &SETTINGS].concat(), &["phase"]);
        let mut stated = [None; 4];
        for (name, value) in COEFFICIENTS.into_iter().zip(&mut stated) {
            let Some(property) = self.property(medium, name)? else { continue };
            let Some(constant) = self.constant(property)? else {
                self.warn(property, "only constant coefficients of media are supported; the medium was left out");
                return Ok(Rgb::BLACK);
            };
            *value = Some(coefficient(constant, if name == "albedo" { 1.0 } else { f32::MAX })?);
        }
        if stated == [None; 4] && (self.version < 2 || medium.child("material").is_some()) {
            let preset = medium.raw_text("material").unwrap_or("Skin1");
            self.warn(medium, format!("media by the name of a substance ({preset:?}) are not supported; it was left out"));
            return Ok(Rgb::BLACK);
        }
        let [absorption, scattering] = absorption_and_scattering(stated, self.version);
        if !scattering.is_black() {
            self.warn(medium, "scattering within media is not supported; only absorption was kept, for the inside of glass");
        }
        let scale = medium.float_or("scale", 1.0)?;
        if !(0.0..=f64::from(f32::MAX)).contains(&scale) {
            return Err(medium.error(format!("found the scale {scale}, expected a number from 0 on")));
        }
        Ok(absorption * scale as f32)
    }

    /// The colour that a coefficient is everywhere: itself, or the value of a `constvolume`. `None` where it varies.
    fn constant(&self, property: &'n Node) -> Result<Option<&'n Node>, ImportError> {
        match (property.tag.as_str(), property.plugin.as_str()) {
            ("volume", "constvolume") => self.property(property, "value"),
            ("volume" | "texture", _) => Ok(None),
            _ => Ok(Some(property)),
        }
    }

    /// A bsdf whose solid dielectrics are filled with a medium. Reports a medium for which there is none.
    pub(super) fn filled(&mut self, mut bsdf: Bsdf, medium: &'n Node) -> Result<Bsdf, ImportError> {
        let absorption = self.absorption(medium)?;
        if !fill(&mut bsdf, absorption) && !absorption.is_black() {
            self.warn(medium, "media are supported only within dielectric and roughdielectric bsdfs; it was left out of others");
        }
        Ok(bsdf)
    }
}

/// Fills solid dielectrics; false where there are none.
fn fill(bsdf: &mut Bsdf, with: Rgb) -> bool {
    match bsdf {
        Bsdf::Dielectric { absorption, .. } => {
            *absorption = with;
            true
        }
        Bsdf::Blend { first, second, .. } => fill(first, with) | fill(second, with),
        _ => false,
    }
}

/// A coefficient of each colour, from 0 to `most`.
fn coefficient(node: &Node, most: f32) -> Result<Rgb, ImportError> {
    let color = spectrum::color(node, Kind::Factor)?;
    let range = if most == 1.0 { "from 0 to 1" } else { "from 0 on" };
    match color.to_array().into_iter().find(|c| !(0.0..=most).contains(c)) {
        Some(other) => Err(node.error(format!("found {other}, expected numbers {range}"))),
        None => Ok(color),
    }
}

/// σa and σs by those of [`COEFFICIENTS`] that a file of this version states.
fn absorption_and_scattering([absorption, scattering, extinction, albedo]: [Option<Rgb>; 4], version: u32) -> [Rgb; 2] {
    let (default, sum) = if version < 2 { (SKIN, SKIN[0] + SKIN[1]) } else { ([Rgb::BLACK; 2], Rgb::splat(EXTINCTION)) };
    if absorption.is_some() || scattering.is_some() {
        return [absorption.unwrap_or(default[0]), scattering.unwrap_or(default[1])];
    }
    let share = if version < 2 { Rgb::from([0, 1, 2].map(|i| SKIN[1][i] / sum[i])) } else { Rgb::splat(ALBEDO) };
    let (extinction, albedo) = (extinction.unwrap_or(sum), albedo.unwrap_or(share));
    [extinction * (Rgb::WHITE - albedo), extinction * albedo]
}
