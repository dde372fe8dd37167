//! Version 3 or 4: the files do not state it, so their words are counted.

use super::gzip::unpacked;
use super::tokens::{Kind, Tokens};
use crate::ImportError;
use crate::assembly::Assembly;
use std::path::Path;

/// The version of pbrt that a file is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Version {
    V3,
    V4,
}

/// Words that version 3 alone has: directives, materials, types of parameters, films.
const THIRD: [&str; 18] = [
    "WorldEnd",
    "matte",
    "plastic",
    "metal",
    "mirror",
    "glass",
    "uber",
    "substrate",
    "translucent",
    "disney",
    "fourier",
    "kdsubsurface",
    "color",
    "xyz",
    "mapname",
    "Kd",
    "Ks",
    "image",
];

/// Words that version 4 alone has. `conductor` and the others are materials, `reflectance` a parameter of theirs.
const FOURTH: [&str; 17] = [
    "Option",
    "Attribute",
    "ColorSpace",
    "Import",
    "diffuse",
    "coateddiffuse",
    "conductor",
    "coatedconductor",
    "dielectric",
    "thindielectric",
    "diffusetransmission",
    "interface",
    "measured",
    "bilinearmesh",
    "reflectance",
    "gbuffer",
    "spectral",
];

/// The version that most words of the file, and of those that it includes itself, belong to. Truth values in quotation marks count
/// for version 3, those without for version 4. Without any evidence it is version 4.
///
/// # Errors
/// When the file cannot be cut into words.
pub(super) fn detect(bytes: &[u8], file: &Path, a: &mut Assembly) -> Result<Version, ImportError> {
    let (mut third, mut fourth) = (0, 0);
    for included in count(bytes, file, &mut third, &mut fourth)? {
        // What is missing is reported where it is needed.
        if let Ok((path, bytes)) = a.read(&included) {
            let bytes = unpacked(bytes, &path)?;
            count(&bytes, &path, &mut third, &mut fourth)?;
        }
    }
    if third > 0 && fourth > 0 {
        let winner = if third > fourth { 3 } else { 4 };
        a.warn("whole file", format!("it has words of version 3 ({third}) and of version 4 ({fourth}); it was read as version {winner}"));
    }
    Ok(if third > fourth { Version::V3 } else { Version::V4 })
}

/// Counts words, and returns the files that the text includes.
fn count(bytes: &[u8], file: &Path, third: &mut usize, fourth: &mut usize) -> Result<Vec<String>, ImportError> {
    let text = enfilade_scene::decoded_text(bytes);
    let mut tokens = Tokens::new(&text, file);
    let (mut included, mut directive, mut declared) = (Vec::new(), "", "");
    while let Some(token) = tokens.next()? {
        match token.kind {
            Kind::Bare("true" | "false") => *fourth += 1,
            Kind::Bare(word) if word.starts_with(|c: char| c.is_ascii_alphabetic()) => {
                (directive, declared) = (word, "");
                *third += usize::from(THIRD.contains(&word));
                *fourth += usize::from(FOURTH.contains(&word));
            }
            Kind::Quoted("true" | "false") => *third += 1,
            Kind::Quoted(text) => match text.split_once(' ') {
                Some((kind, name)) => {
                    declared = name.trim();
                    *third += usize::from(THIRD.contains(&kind) || THIRD.contains(&declared));
                    *fourth += usize::from(FOURTH.contains(&declared));
                }
                None if matches!(directive, "Include" | "Import") => included.push(text.to_string()),
                // The name of a plugin; `diffuse` is an area light of both versions.
                None if (declared.is_empty() && matches!(directive, "Material" | "Film" | "Shape")) || declared == "type" => {
                    *third += usize::from(THIRD.contains(&text));
                    *fourth += usize::from(FOURTH.contains(&text));
                }
                None => (),
            },
            _ => (),
        }
    }
    Ok(included)
}
