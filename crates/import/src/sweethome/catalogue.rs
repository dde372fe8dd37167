//! Furniture libraries: an archive with `PluginFurnitureCatalog.properties` and the models that it lists.

use super::{model, properties};
use crate::archive::Archive;
use crate::assembly::Assembly;
use crate::{ImportError, Imported};
use enfilade_math::{DAffine3, DMat3, DVec3, Rgb, Vec3};
use enfilade_scene::{Environment, PartLabel, is_git_lfs_pointer};
use std::collections::BTreeMap;
use std::path::Path;

/// The list of a library's pieces.
pub(super) const NAME: &str = "PluginFurnitureCatalog.properties";
/// Free space between neighbouring pieces of a library, metres.
const GAP: f64 = 0.5;
/// Diameter of a light source that does not state its own, metres.
const BULB: f32 = 0.05;

/// The kind of a piece, by its library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CatalogueKind<'k> {
    /// The category, in the library's language.
    pub category: &'k str,
    /// A door or window.
    pub is_opening: bool,
    /// A staircase.
    pub is_staircase: bool,
}

/// A source of light of a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CatalogueLight {
    /// Metres from the piece's left, from its front, and from below, as seen by someone who looks at its front.
    pub at: Vec3,
    /// Metres.
    pub diameter: f32,
}

/// A piece of a furniture library.
#[derive(Clone, Debug, PartialEq)]
pub struct CataloguePiece {
    /// The library's own name for it, which no other piece has.
    pub id: Option<String>,
    /// Name of the model for people.
    pub title: String,
    /// The model's file within the archive.
    pub model: String,
    /// Width, depth and height, metres; the model is scaled to them.
    pub size: Vec3,
    /// Height above the floor, metres.
    pub elevation: f32,
    /// Turns the model upright, y up, its front toward +z. `None` where it is so.
    pub rotation: Option<DMat3>,
    /// Light sources in it.
    pub lights: Vec<CatalogueLight>,
    /// Licence of the model and who made it.
    pub licence: String,
}

/// The pieces of a furniture library of the kinds that are wanted.
///
/// # Errors
/// When the file cannot be read or is no library, or a wanted piece has no model, no size, or numbers that make no sense.
pub fn catalogue(file: &Path, wanted: impl Fn(CatalogueKind) -> bool) -> Result<Vec<CataloguePiece>, ImportError> {
    let archive = open(file)?;
    let problem = |e| ImportError::malformed(file, NAME, format!("{e}; is it a furniture library of Sweet Home 3D? download it again"));
    let values = properties::parse(&archive.read(archive.find(NAME).unwrap_or(NAME)).map_err(problem)?);
    (1..).map_while(|n| Entry::new(&values, n, file)).filter(|e| wanted(e.kind())).map(|e| e.piece()).collect()
}

impl CataloguePiece {
    /// Loads the model as a scene of its own, in the model's unit and with the model's axes, y up; pictures that are missing become grey.
    ///
    /// # Errors
    /// When the library, or the model within it, cannot be read.
    pub fn load(&self, library: &Path) -> Result<Imported, ImportError> {
        let archive = open(library)?;
        let model = model::read(&archive, &self.model).and_then(|model| model.ok_or_else(|| "has lines alone and no surface".to_string()));
        model.map_err(|problem| ImportError::malformed(library, &self.model, format!("the model {problem}; download the catalogue again")))
    }
}

fn open(file: &Path) -> Result<Archive, ImportError> {
    let bytes = std::fs::read(file).map_err(|source| ImportError::Read {
        file: file.to_path_buf(),
        source,
        remedy: "check the path and the permission to read it".into(),
    })?;
    if is_git_lfs_pointer(&bytes) {
        return Err(ImportError::GitLfs { file: file.to_path_buf() });
    }
    Archive::new(file, bytes).map_err(|e| ImportError::malformed(file, "whole file", format!("{e}; download it again")))
}

/// One numbered piece of the list.
struct Entry<'v> {
    values: &'v BTreeMap<String, String>,
    number: usize,
    title: &'v str,
    file: &'v Path,
}

impl<'v> Entry<'v> {
    /// Piece `number`; `None` behind the last one.
    fn new(values: &'v BTreeMap<String, String>, number: usize, file: &'v Path) -> Option<Self> {
        let title = values.get(&format!("name#{number}")).map(|t| t.trim()).filter(|t| !t.is_empty())?;
        Some(Self { values, number, title, file })
    }

    fn of(&self, key: &str) -> Option<&'v str> {
        self.values.get(&format!("{key}#{}", self.number)).map(|v| v.trim()).filter(|v| !v.is_empty())
    }

    fn kind(&self) -> CatalogueKind<'v> {
        CatalogueKind {
            category: self.of("category").unwrap_or_default(),
            is_opening: self.of("doorOrWindow") == Some("true"),
            is_staircase: self.of("staircaseCutOutShape").is_some(),
        }
    }

    fn refuse(&self, key: &str, expected: &str) -> ImportError {
        let found = self.of(key).map_or("nothing".into(), |found| format!("{found:?}"));
        let problem = format!("found {found}, expected {expected}; fix the catalogue, or download it again");
        ImportError::malformed(self.file, format!("{NAME}: {key}#{} ({})", self.number, self.title), problem)
    }

    fn numbers(&self, key: &str) -> Result<Vec<f32>, ImportError> {
        let read = |word: &str| word.parse::<f32>().ok().filter(|v| v.is_finite());
        let found: Option<Vec<f32>> = self.of(key).map_or(Some(Vec::new()), |value| value.split_whitespace().map(read).collect());
        found.ok_or_else(|| self.refuse(key, "numbers"))
    }

    /// Metres above zero.
    fn length(&self, key: &str) -> Result<f32, ImportError> {
        let found = self.numbers(key)?.first().copied().filter(|v| *v > 0.0);
        found.map(|v| 0.01 * v).ok_or_else(|| self.refuse(key, "centimetres above zero"))
    }

    fn piece(&self) -> Result<CataloguePiece, ImportError> {
        let rotation = match self.numbers("modelRotation")?[..] {
            [a, b, c, d, e, f, g, h, i] => Some(DMat3::from_cols_array(&[a, b, c, d, e, f, g, h, i].map(f64::from)).transpose()),
            [] => None,
            _ => return Err(self.refuse("modelRotation", "nine numbers")),
        };
        let creator = self.of("creator").map_or(String::new(), |creator| format!(", by {creator}"));
        let licence = self.of("license").or(self.values.get("license").map(|text| text.trim())).unwrap_or("licence not stated");
        Ok(CataloguePiece {
            id: self.of("id").map(Into::into),
            title: self.title.into(),
            model: self.of("model").ok_or_else(|| self.refuse("model", "the name of a model"))?.trim_start_matches('/').into(),
            size: Vec3::new(self.length("width")?, self.length("depth")?, self.length("height")?),
            elevation: 0.01 * self.numbers("elevation")?.first().copied().unwrap_or(0.0).max(0.0),
            rotation,
            lights: self.lights()?,
            licence: format!("{licence}{creator}"),
        })
    }

    fn lights(&self) -> Result<Vec<CatalogueLight>, ImportError> {
        let [x, y, z, diameter] = ["lightSourceX", "lightSourceY", "lightSourceZ", "lightSourceDiameter"].map(|key| self.numbers(key));
        let (x, y, z, diameter) = (x?, y?, z?, diameter?);
        let places = x.iter().zip(&y).zip(&z).enumerate();
        let of = |(k, ((x, y), z)): (usize, ((&f32, &f32), &f32))| CatalogueLight {
            at: 0.01 * Vec3::new(*x, *y, *z),
            diameter: diameter.get(k).filter(|d| **d > 0.0).map_or(BULB, |d| 0.01 * d),
        };
        Ok(places.map(of).collect())
    }
}

/// All pieces of a library beside one another in rows on the floor, under a white sky.
pub(super) fn load(archive: &Archive, mut a: Assembly) -> Result<Imported, ImportError> {
    let file = a.file().to_path_buf();
    let values = properties::parse(&a.read_scene_file()?);
    let mut pieces = Vec::new();
    for entry in (1..).map_while(|n| Entry::new(&values, n, &file)) {
        match entry.piece() {
            Ok(piece) => pieces.push(piece),
            Err(e) => a.warn(format!("name#{}", entry.number), format!("{e}; the piece was left out")),
        }
    }
    let area: f64 = pieces.iter().map(|p| (f64::from(p.size.x) + GAP) * (f64::from(p.size.y) + GAP)).sum();
    let (row_width, mut corner, mut row_depth) = (area.sqrt(), DVec3::ZERO, 0.0f64);
    let total = pieces.len();
    for (done, piece) in pieces.iter().enumerate() {
        a.progress(done + 1, total);
        let model = match model::load(archive, &piece.model, &mut a) {
            Ok(model) => model,
            Err(problem) => {
                a.warn(&piece.title, format!("the model {} {problem}; the piece was left out", piece.model));
                continue;
            }
        };
        let size = DVec3::new(f64::from(piece.size.x), f64::from(piece.size.z), f64::from(piece.size.y));
        if corner.x > 0.0 && corner.x + size.x > row_width {
            corner = DVec3::new(0.0, 0.0, corner.z + row_depth + GAP);
            row_depth = 0.0;
        }
        let middle = corner + 0.5 * size;
        corner.x += size.x + GAP;
        row_depth = row_depth.max(size.z);
        let placement =
            DAffine3::from_scale_rotation_translation(size, Default::default(), middle) * model.normalized(piece.rotation, true, &a);
        let title = piece.id.as_ref().map_or(piece.title.clone(), |id| format!("{} ({id})", piece.title));
        let object = a.push_object(&title, None);
        for part in &model.parts {
            let name = if model.parts.len() > 1 { format!("{title}.{}", part.name) } else { title.clone() };
            a.push_part_of(object, &name, part.mesh, part.material, placement * part.file_from_mesh, PartLabel::NONE);
        }
    }
    let depth = corner.z + row_depth;
    a.set_environment(Environment::Constant { radiance: Rgb::WHITE }, NAME);
    let eye = DVec3::new(0.5 * row_width, 0.5 * row_width + 1.6, depth + 0.5 * row_width);
    let down = DMat3::from_rotation_x(-(0.6f64));
    a.push_camera("overview", DAffine3::from_mat3_translation(down, eye), 1.2, 4.0 / 3.0);
    a.finish()
}
