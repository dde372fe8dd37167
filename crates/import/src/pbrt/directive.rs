//! The directives: what each does to the graphics state, or which module it is for.

use super::definition::{MaterialDefinition, TextureDefinition};
use super::gzip::unpacked;
use super::params::{Params, Place};
use super::reader::Reader;
use super::state::{self, Saved, State};
use super::tokens::{Kind, Tokens};
use crate::ImportError;
use enfilade_math::{DAffine3, DVec3, Rgb};
use std::rc::Rc;

/// Files within files deeper than this are taken for a mistake.
const MAX_INCLUDES_DEEP: usize = 32;

/// A scene includes at most this many files, counted each time.
const MAX_INCLUDED: usize = 10_000;

impl Reader<'_> {
    /// Carries out one directive, whose word has been read.
    pub(super) fn directive(&mut self, word: &str, mut place: Place, tokens: &mut Tokens) -> Result<(), ImportError> {
        if let Some(transform) = state::transform(word, tokens)? {
            match word {
                "Identity" | "Transform" => self.state.set(transform),
                _ => self.state.concatenate(transform),
            }
            return Ok(());
        }
        match word {
            "AttributeBegin" => self.saved.push(Saved::Attributes(self.state.clone())),
            "TransformBegin" => self.saved.push(Saved::Transform(self.state.ctm, self.state.active)),
            "AttributeEnd" | "TransformEnd" => self.restore(word, &place)?,
            "ReverseOrientation" => self.state.reversed = !self.state.reversed,
            "TransformTimes" => drop(state::numbers::<2>(tokens)?),
            "ActiveTransform" => self.active_transform(&place, tokens)?,
            "WorldBegin" => self.world_begin(),
            // What follows is another picture in version 2 and nothing in later ones.
            "WorldEnd" => (),
            "ObjectEnd" => self.object_end(&place)?,
            "Option" => drop(Params::read(tokens, place)?),
            _ => {
                let first = quoted(tokens, word)?;
                place.what = format!("{word} \"{first}\"");
                self.named(word, first, place, tokens)?;
            }
        }
        Ok(())
    }

    /// Obeys a directive that a string follows.
    fn named(&mut self, word: &str, first: String, place: Place, tokens: &mut Tokens) -> Result<(), ImportError> {
        match word {
            "Include" | "Import" => self.include(&first, &place),
            "CoordinateSystem" => {
                self.coordinate_systems.insert(first, self.state.ctm);
                Ok(())
            }
            "CoordSysTransform" => {
                match self.coordinate_systems.get(&first) {
                    Some(&transform) => self.state.set(transform),
                    None => self.warn(&place, "no coordinate system has this name; the transform stays as it was"),
                }
                Ok(())
            }
            "ColorSpace" => {
                if first != "srgb" {
                    self.warn(&place, "colours are taken for sRGB's primaries");
                }
                Ok(())
            }
            "ObjectBegin" => self.object_begin(first, &place),
            "ObjectInstance" => self.object_instance(&first, &place),
            "NamedMaterial" => {
                let known = self.material_names.get(&first).copied();
                self.state.material = known.ok_or_else(|| place.error("no MakeNamedMaterial before it has this name"))?;
                Ok(())
            }
            "MediumInterface" => {
                let outside = matches!(tokens.peek()?.map(|t| t.kind), Some(Kind::Quoted(_)));
                let outside = if outside { quoted(tokens, word)? } else { String::new() };
                if !outside.is_empty() {
                    self.warn(&place, format!("the medium {outside:?} outside of shapes was dropped: rooms are full of nothing"));
                }
                self.state.inside = first.into();
                Ok(())
            }
            "Texture" => {
                let (kind, class) = (quoted(tokens, word)?, quoted(tokens, word)?);
                let params = self.params(tokens, place, "texture")?;
                self.define_texture(TextureDefinition::new(first, &kind, class, params));
                Ok(())
            }
            _ => self.with_params(word, first, place, tokens),
        }
    }

    /// Carries out a directive that a string and parameters follow.
    fn with_params(&mut self, word: &str, first: String, place: Place, tokens: &mut Tokens) -> Result<(), ImportError> {
        match word {
            "Attribute" => {
                let params = Params::read(tokens, place)?;
                Rc::make_mut(&mut self.state.defaults).push((first, params));
            }
            "Material" => {
                let params = self.params(tokens, place, "material")?;
                self.state.material = self.define_material(MaterialDefinition::new(None, first, params));
            }
            "MakeNamedMaterial" => {
                let params = self.params(tokens, place, "material")?;
                let class = params.string("type")?.ok_or_else(|| params.place.error("there is no \"string type\""))?.to_string();
                let index = self.define_material(MaterialDefinition::new(Some(first.clone()), class, params));
                self.material_names.insert(first, index);
            }
            "MakeNamedMedium" => {
                let params = self.params(tokens, place, "medium")?;
                self.define_medium(first, &params)?;
            }
            "Shape" => {
                let params = self.params(tokens, place, "shape")?;
                self.shape(&first, &params)?;
            }
            "LightSource" => {
                let params = self.params(tokens, place, "light")?;
                self.light(&first, &params)?;
            }
            "AreaLightSource" => {
                let params = self.params(tokens, place, "light")?;
                self.state.area_light = match first.as_str() {
                    "diffuse" | "area" => Some(Rc::new(params)),
                    _ => {
                        self.warn(&params.place, "area lights of this type are not supported; the shapes do not shine");
                        None
                    }
                };
            }
            "Camera" => {
                let params = Params::read(tokens, place)?;
                self.coordinate_systems.insert("camera".into(), self.state.ctm.inverse());
                self.camera = Some((params, first, self.state.ctm));
            }
            "Film" => self.film = Some(Params::read(tokens, place)?),
            "Sampler" | "Integrator" | "SurfaceIntegrator" | "VolumeIntegrator" | "PixelFilter" | "Filter" | "Accelerator" | "Renderer" => {
                drop(Params::read(tokens, place)?);
            }
            "Volume" => {
                let params = Params::read(tokens, place)?;
                self.warn(&params.place, "media are not supported; it was left out");
            }
            _ => return Err(place.error(format!("{word} is not a directive of pbrt; correct the spelling or remove it"))),
        }
        Ok(())
    }

    /// The parameters of a directive of a kind, with those that `Attribute` adds to that kind.
    fn params(&self, tokens: &mut Tokens, place: Place, target: &str) -> Result<Params, ImportError> {
        let params = Params::read(tokens, place)?;
        // Those of the innermost block come first.
        let params = params.with_defaults(self.state.defaults.iter().rev().filter(|(kind, _)| kind == target).map(|(_, p)| p));
        self.bind(&params);
        Ok(params)
    }

    fn restore(&mut self, word: &str, place: &Place) -> Result<(), ImportError> {
        match self.saved.pop() {
            Some(Saved::Attributes(state)) if word == "AttributeEnd" => self.state = state,
            Some(Saved::Transform(ctm, active)) if word == "TransformEnd" => (self.state.ctm, self.state.active) = (ctm, active),
            Some(_) => return Err(place.error("the block was begun by another word; close blocks in the order in which they were opened")),
            None => return Err(place.error("no block is open; remove it")),
        }
        Ok(())
    }

    fn active_transform(&mut self, place: &Place, tokens: &mut Tokens) -> Result<(), ImportError> {
        self.state.active = match tokens.next()?.map(|t| t.kind) {
            Some(Kind::Bare("StartTime" | "All")) => true,
            Some(Kind::Bare("EndTime")) => {
                self.warn(place, "motion is not supported; everything is placed as at the first moment");
                false
            }
            _ => return Err(place.error("expected StartTime, EndTime or All")),
        };
        Ok(())
    }

    fn world_begin(&mut self) {
        self.in_world = true;
        self.settle_handedness();
        self.state = State { defaults: self.state.defaults.clone(), ..State::new() };
        self.coordinate_systems.insert("world".into(), DAffine3::IDENTITY);
    }

    /// Decides by the camera whether the world is left-handed.
    fn settle_handedness(&mut self) {
        let mirrored = self.camera.as_ref().is_some_and(|(_, _, camera_from_world)| camera_from_world.matrix3.determinant() < 0.0);
        self.file_from_world = if mirrored { DAffine3::IDENTITY } else { DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)) };
    }

    fn include(&mut self, name: &str, place: &Place) -> Result<(), ImportError> {
        self.included += 1;
        if self.included > MAX_INCLUDED || self.including.len() >= MAX_INCLUDES_DEEP {
            let problem = format!("files are included more than {MAX_INCLUDES_DEEP} deep or {MAX_INCLUDED} times; check for a circle");
            return Err(place.error(problem));
        }
        let (path, bytes) = self.a.read(name)?;
        if self.including.contains(&path) {
            return Err(place.error("the file includes itself, directly or by way of others; remove one of the includes"));
        }
        let bytes = unpacked(bytes, &path)?;
        self.file(&bytes, &path)
    }

    /// Only absorption is kept, for the inside of glass.
    fn define_medium(&mut self, name: String, params: &Params) -> Result<(), ImportError> {
        let class = params.string("type")?.unwrap_or("homogeneous").to_string();
        let scale = params.float_or("scale", 1.0)? as f32;
        let absorption = self.color(params, "sigma_a", crate::spectrum::Kind::Factor, Rgb::new(0.0011, 0.0024, 0.014))?;
        let scattering = self.color(params, "sigma_s", crate::spectrum::Kind::Factor, Rgb::new(2.55, 3.21, 3.77))?;
        if class != "homogeneous" || params.has("preset") {
            self.warn(&params.place, "only homogeneous media with sigma_a and sigma_s are supported; it was left out");
            return Ok(());
        }
        if !scattering.is_black() {
            self.warn(&params.place, "scattering within media is not supported; only its absorption was kept, for the inside of glass");
        }
        self.media.insert(name, absorption * scale);
        self.report_unused(params, &["g"]);
        Ok(())
    }

    /// The final checks, warnings and additions at the end of the scene.
    pub(super) fn end_of_scene(&mut self, file: &std::path::Path) -> Result<(), ImportError> {
        if !self.saved.is_empty() || self.object.is_some() {
            let open = self.saved.len() + usize::from(self.object.is_some());
            self.a.warn("end of file", format!("{open} blocks are still open; the file may be cut short"));
        }
        if !self.in_world {
            let problem = "there is no WorldBegin, so this is not a whole scene; import the file that includes it";
            return Err(ImportError::malformed(file, "end of file", problem));
        }
        self.finish_camera()
    }
}

/// The string that a directive begins with.
fn quoted(tokens: &mut Tokens, word: &str) -> Result<String, ImportError> {
    match tokens.peek()?.map(|t| t.kind) {
        Some(Kind::Quoted(text)) => {
            tokens.next()?;
            Ok(text.to_string())
        }
        _ => Err(tokens.error(format!("{word}: expected a directive of pbrt and a string in quotation marks after it"))),
    }
}
