//! Furniture catalogues of Sweet Home 3D (`.sh3f`): an archive with `PluginFurnitureCatalog.properties` and the models that it lists.
//!
//! | key | meaning |
//! |---|---|
//! | `name#N`, `category#N`, `creator#N`, `license#N` | as they say; `license` alone is that of all pieces |
//! | `model#N` | the model within the archive; OBJ is read, with materials and pictures of its folder |
//! | `width#N`, `depth#N`, `height#N`, `elevation#N` | centimetres; the model is scaled to them |
//! | `modelRotation#N` | a matrix, row by row, that turns the model upright, its front toward +z |
//! | `lightSourceX#N`, `…Y`, `…Z`, `…Diameter` | lamps: centimetres from the left, the front and below |
//! | `doorOrWindow#N`, `staircaseCutOutShape#N` | such pieces are left out, as are outdoor ones, vehicles and people |
//!
//! The format is that of Sweet Home 3D's own reader, `com.eteks.sweethome3d.io.DefaultFurnitureCatalog`.

use super::table::{Front, Table};
use super::{Notes, properties};
use crate::error::Error;
use enfilade_home::assets::{Body, Bulb, Model};
use enfilade_import::ImportOptions;
use enfilade_math::{DMat3, Vec3};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use zip::ZipArchive;

const CATALOGUE: &str = "PluginFurnitureCatalog.properties";
/// Categories whose pieces are not furniture of a home.
const ELSEWHERE: [&str; 5] = ["doors and windows", "exterior", "vehicles", "characters", "staircases"];
/// Diameter of a light source that does not say its own, centimetres.
const BULB_CM: f32 = 5.0;
/// No model is larger, bytes, the pictures and other files beside it included.
const LARGEST: u64 = 1 << 30;
/// No list of pieces is larger, bytes.
const LONGEST_LIST: u64 = 1 << 26;

/// A piece of a catalogue.
pub(super) struct Piece {
    /// By which `assets.toml` knows it: its id, or its name.
    pub name: String,
    title: String,
    archive: PathBuf,
    model: String,
    size: Vec3,
    elevation: f32,
    rotation: Option<DMat3>,
    bulbs: Vec<Bulb>,
    licence: String,
}

/// The pieces of these catalogues that homes could use.
pub(super) fn pieces(catalogues: &[&PathBuf]) -> Result<Vec<Piece>, Error> {
    let mut all = Vec::new();
    for file in catalogues {
        let mut archive = open(file).map_err(|problem| Error::usage(problem, "download the catalogue again"))?;
        let bytes = bytes_of(&mut archive, CATALOGUE, LONGEST_LIST).map_err(|problem| {
            Error::usage(format!("{}: {problem}", file.display()), "is it a furniture library of Sweet Home 3D? download it again")
        })?;
        all.extend(of_catalogue(file, &properties::parse(&bytes))?);
    }
    Ok(all)
}

fn of_catalogue(file: &Path, values: &BTreeMap<String, String>) -> Result<Vec<Piece>, Error> {
    let mut pieces = Vec::new();
    for number in 1.. {
        let of = |key: &str| values.get(&format!("{key}#{number}")).map(|value| value.trim()).filter(|value| !value.is_empty());
        let Some(title) = of("name") else { break };
        let elsewhere = of("category").is_some_and(|found| ELSEWHERE.contains(&found.to_lowercase().as_str()));
        if elsewhere || of("doorOrWindow") == Some("true") || of("staircaseCutOutShape").is_some() {
            continue;
        }
        let refuse = |key: &str, expected: &str| {
            let found = of(key).map_or("nothing".into(), |found| format!("{found:?}"));
            let message = format!("{}: {CATALOGUE}: {key}#{number} ({title}): found {found}, expected {expected}", file.display());
            Error::usage(message, "mend the catalogue, or download it again")
        };
        let numbers = |key: &str| -> Result<Vec<f32>, Error> {
            let read = |word: &str| word.parse::<f32>().ok().filter(|v| v.is_finite());
            let found: Option<Vec<f32>> = of(key).map_or(Some(Vec::new()), |value| value.split_whitespace().map(read).collect());
            found.ok_or_else(|| refuse(key, "numbers"))
        };
        let length = |key: &str| {
            let found = numbers(key)?;
            found.first().copied().filter(|v| *v > 0.0).ok_or_else(|| refuse(key, "centimetres above zero"))
        };
        let size = 0.01 * Vec3::new(length("width")?, length("depth")?, length("height")?);
        let rotation = match numbers("modelRotation")?[..] {
            [a, b, c, d, e, f, g, h, i] => Some(DMat3::from_cols_array(&[a, b, c, d, e, f, g, h, i].map(f64::from)).transpose()),
            [] => None,
            _ => return Err(refuse("modelRotation", "nine numbers")),
        };
        let lights = [numbers("lightSourceX")?, numbers("lightSourceY")?, numbers("lightSourceZ")?, numbers("lightSourceDiameter")?];
        let creator = of("creator").map_or(String::new(), |creator| format!(", by {creator}"));
        let licence = of("license").or(values.get("license").map(|text| text.trim())).unwrap_or("licence not stated");
        pieces.push(Piece {
            name: of("id").unwrap_or(title).into(),
            title: title.into(),
            archive: file.into(),
            model: of("model").ok_or_else(|| refuse("model", "the name of a model"))?.trim_start_matches('/').into(),
            size,
            elevation: 0.01 * numbers("elevation")?.first().copied().unwrap_or(0.0).max(0.0),
            rotation,
            bulbs: bulbs(&lights, size),
            licence: format!("{licence}{creator}"),
        });
    }
    Ok(pieces)
}

/// Light sources in the space of furniture: x to the left of who looks at its front, y to the front.
fn bulbs([x, y, z, diameter]: &[Vec<f32>; 4], size: Vec3) -> Vec<Bulb> {
    let sources = x.iter().zip(y).zip(z).enumerate();
    let of = |(k, ((x, y), z)): (usize, ((&f32, &f32), &f32))| Bulb {
        at: Vec3::new(0.5 * size.x - 0.01 * x, 0.5 * size.y - 0.01 * y, 0.01 * z),
        diameter: 0.01 * diameter.get(k).copied().filter(|d| *d > 0.0).unwrap_or(BULB_CM),
    };
    sources.map(of).collect()
}

impl Piece {
    /// The model, which is read when it is wanted.
    /// What is dropped or guessed then comes to `notes`.
    pub fn model(self, table: &Table, notes: Notes) -> Model {
        let choice = table.of(&self.name);
        let families = choice.families_or(&self.title);
        let size = choice.size.unwrap_or(self.size);
        let archive = self.archive.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned());
        let (title, elevation, shines) = (self.title.clone(), self.elevation, !self.bulbs.is_empty());
        let file = format!("{archive}, {}", self.name);
        let licence = choice.licence.clone().unwrap_or_else(|| self.licence.clone());
        let turn = choice.front.turn();
        let mut model = Model::new(title, size, families, Box::new(move || self.read(turn, size, &notes).map(Arc::new)));
        (model.file, model.licence) = (file, licence);
        (model.elevation, model.shines, model.weight) = (elevation, shines, choice.weight);
        model
    }

    /// What it looks like.
    fn read(&self, turn: DMat3, size: Vec3, notes: &Notes) -> Result<Body, String> {
        let place = format!("{}: {}", self.archive.display(), self.model);
        let folder = tempfile::tempdir().map_err(|error| format!("{place}: no folder to unpack it to ({error}); set TMPDIR"))?;
        unpack(&self.archive, &self.model, folder.path()).map_err(|problem| format!("{place}: {problem}"))?;
        // A picture that a catalogue forgot is not worth a model.
        let options = ImportOptions { allow_missing_textures: true, ..ImportOptions::default() };
        let imported = enfilade_import::load(&folder.path().join(&self.model), &options, notes).map_err(|error| {
            let unpacked = format!("{}/", folder.path().display());
            format!("{}: {}", self.archive.display(), error.to_string().replace(&unpacked, ""))
        })?;
        // The rotation is for y up, as the file has it.
        let up = DMat3::from_cols_array(&[1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0]);
        let rotation = self.rotation.map_or(DMat3::IDENTITY, |rotation| up * rotation * up.transpose());
        let mut body = Body::new(imported.scene, turn * rotation, Some(size)).map_err(|problem| format!("{place}: {problem}"))?;
        let turned = (turn * Front::Z.turn().transpose()).as_mat3();
        let moved = |bulb: &Bulb| Bulb { at: turned * (bulb.at * size / self.size), ..*bulb };
        body.bulbs = self.bulbs.iter().map(moved).collect();
        Ok(body)
    }
}

fn open(file: &Path) -> Result<ZipArchive<BufReader<File>>, String> {
    let at = file.display();
    let opened = File::open(file).map_err(|error| format!("{at}: cannot be read ({error})"))?;
    ZipArchive::new(BufReader::new(opened)).map_err(|error| format!("{at}: not an archive that can be read ({error})"))
}

/// A file of the archive, which must not be larger than `most` bytes: what is packed can be a thousand times as large.
fn bytes_of(archive: &mut ZipArchive<BufReader<File>>, name: &str, most: u64) -> Result<Vec<u8>, String> {
    let entry = archive.by_name(name).map_err(|error| format!("{name} is not in it ({error})"))?;
    let mut bytes = Vec::new();
    entry.take(most + 1).read_to_end(&mut bytes).map_err(|error| format!("{name}: damaged ({error})"))?;
    if bytes.len() as u64 > most {
        return Err(format!("{name} is larger than the {most} bytes that it may have; leave this model out"));
    }
    Ok(bytes)
}

/// Writes the model and what lies beside it in the archive below `folder`.
fn unpack(archive: &Path, model: &str, folder: &Path) -> Result<(), String> {
    let mut archive = open(archive)?;
    let beside = model.rsplit_once('/').map_or("", |(beside, _)| beside);
    let needed: Vec<String> = archive
        .file_names()
        .filter(|name| if beside.is_empty() { *name == model } else { name.strip_prefix(beside).is_some_and(|rest| rest.starts_with('/')) })
        .filter(|name| !name.ends_with('/'))
        .map(Into::into)
        .collect();
    if !needed.iter().any(|name| name == model) {
        return Err("the model is not in the archive; download the catalogue again".into());
    }
    let mut most = LARGEST;
    for name in needed {
        let inside = archive.by_name(&name).ok().and_then(|entry| entry.enclosed_name());
        let target = folder.join(inside.ok_or_else(|| format!("{name} would lie outside of the archive's folder"))?);
        let bytes = bytes_of(&mut archive, &name, most)?;
        most -= bytes.len() as u64;
        let written = target.parent().map_or(Ok(()), std::fs::create_dir_all).and_then(|()| std::fs::write(&target, bytes));
        written.map_err(|error| format!("{name}: cannot be unpacked ({error}); make room in the folder for temporary files"))?;
    }
    Ok(())
}
