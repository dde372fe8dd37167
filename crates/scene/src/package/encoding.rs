//! The bytes of packages: the first line, the hash, the body.

use crate::{Labels, Scene, SceneError};

/// First bytes of packages, before their number.
pub(super) const NAME: &str = "enfilade scene ";
/// Rises with every change of the types in a [`Scene`]: postcard writes no names.
pub(super) const VERSION: u32 = 4;
/// The number of packages of scenes with joints that stay as they are: their bodies follow the scene.
const JOINTED: u32 = 6;
/// The number of packages of scenes that move: the bodies as well.
const MOVING: u32 = 7;
/// The number of packages of scenes in which parts deform: bodies of a kind that earlier versions do not know.
const DEFORMING: u32 = 10;
/// Behind the number in the first line of packages that lack what another one has.
pub(super) const CHANGES: &str = " changes";
/// Name of the package beside one that lacks what this has.
pub const FIRST_PACKAGE: &str = "first.scene";
/// More than the first line of any package has: as much as [`super::is_current_package`] looks at.
pub const PACKAGE_HEAD_BYTES: u64 = 32;

/// Why bytes are not a scene package.
#[derive(Debug, thiserror::Error)]
pub enum PackageError {
    /// Not the first line of a package.
    #[error("not a scene package (expected it to begin with \"{NAME}{VERSION}\"); import the scene again")]
    Magic,
    /// A package of another version of the program.
    #[error("found a scene package of version {found}, expected {VERSION}: it was written by {}; import the scene again", age(*found))]
    Version {
        /// The number in its first line.
        found: u32,
    },
    /// The bytes are not what was written.
    #[error("the package is damaged or cut short: its checksum does not match; import the scene again")]
    Checksum,
    /// The encoding does not fit this version's types.
    #[error("the package cannot be decoded ({0}); import the scene again with this version")]
    Decode(String),
    /// The package beside it cannot be used.
    #[error("it has only what differs from {FIRST_PACKAGE} beside it, {problem}; keep both files in one folder, or import the scene again")]
    First {
        /// What is wrong with that file, as a clause.
        problem: String,
    },
    /// The labels do not fit the scene.
    #[error("the package has {labels} labels for {parts} parts; expected one per part: make it again")]
    Labels {
        /// Number of labels.
        labels: usize,
        /// Number of parts.
        parts: usize,
    },
    /// The scene inside is not valid.
    #[error(transparent)]
    Scene(#[from] SceneError),
}

pub(super) fn whole(scene: &Scene, labels: Option<&Labels>) -> Vec<u8> {
    let labels = labels.map(encoded).unwrap_or_default();
    headed("", scene, &[encoded(scene), bodies(scene), labels].concat())
}

pub(super) fn encoded<T: serde::Serialize>(data: &T) -> Vec<u8> {
    postcard::to_stdvec(data).expect("plain data encodes")
}

/// The bodies of a scene; nothing of one that has none.
pub(super) fn bodies(scene: &Scene) -> Vec<u8> {
    if scene.bodies.is_empty() { Vec::new() } else { encoded(&scene.bodies) }
}

pub(super) fn headed(kind: &str, scene: &Scene, body: &[u8]) -> Vec<u8> {
    let version = match (scene.bodies.is_empty(), scene.is_still()) {
        (true, _) => VERSION,
        (false, true) => JOINTED,
        (false, false) if scene.deforming_parts().contains(&true) => DEFORMING,
        (false, false) => MOVING,
    };
    [format!("{NAME}{version}{kind}\n").as_bytes(), blake3::hash(body).as_bytes(), body].concat()
}

/// What the first line of a package says.
#[derive(Clone, Copy)]
pub(super) struct Kind {
    /// True if it lacks what another one has.
    pub lacks: bool,
    /// True if bodies follow the scene.
    pub bodies: bool,
    /// True if the scene moves.
    pub moves: bool,
}

/// The kind of a package, and the bytes after its first line.
pub(super) fn split_head(bytes: &[u8]) -> Result<(Kind, &[u8]), PackageError> {
    let head = &bytes[..bytes.len().min(PACKAGE_HEAD_BYTES as usize)];
    let line = head.split_inclusive(|&b| b == b'\n').next().unwrap_or_default();
    let text = line.strip_prefix(NAME.as_bytes()).and_then(|rest| std::str::from_utf8(rest.strip_suffix(b"\n")?).ok());
    let number = text.map(|text| text.strip_suffix(CHANGES).map_or((false, text), |number| (true, number)));
    match number.and_then(|(lacks, number)| Some((lacks, number.parse().ok()?))) {
        Some((lacks, version @ (VERSION | JOINTED | MOVING | DEFORMING))) => {
            let moves = matches!(version, MOVING | DEFORMING);
            Ok((Kind { lacks, bodies: version != VERSION, moves }, &bytes[line.len()..]))
        }
        Some((_, found)) => Err(PackageError::Version { found }),
        None => Err(PackageError::Magic),
    }
}

/// The kind of a package, its hash, and its body, which has that hash.
pub(super) fn split(bytes: &[u8]) -> Result<(Kind, [u8; 32], &[u8]), PackageError> {
    let (kind, rest) = split_head(bytes)?;
    let (hash, body) = rest.split_first_chunk::<32>().ok_or(PackageError::Checksum)?;
    if blake3::hash(body).as_bytes() == hash { Ok((kind, *hash, body)) } else { Err(PackageError::Checksum) }
}

fn age(found: u32) -> &'static str {
    if found > DEFORMING { "a newer enfilade" } else { "an earlier enfilade" }
}

/// The scene and the labels in the body of a package that lacks nothing.
pub(super) fn decoded(kind: Kind, body: &[u8]) -> Result<(Scene, Option<Labels>), PackageError> {
    let (mut scene, mut rest): (Scene, &[u8]) = postcard::take_from_bytes(body).map_err(undecoded)?;
    if kind.bodies {
        (scene.bodies, rest) = postcard::take_from_bytes(rest).map_err(undecoded)?;
    }
    let labels = if rest.is_empty() { None } else { Some(postcard::from_bytes(rest).map_err(undecoded)?) };
    Ok((scene, labels))
}

pub(super) fn undecoded(error: postcard::Error) -> PackageError {
    PackageError::Decode(error.to_string())
}
