//! The content of a file by its first bytes, for messages about files that do not match their names: a web page in place of a download, a
//! picture, a scene in another format.

use crate::{Format, ImportError};
use enfilade_scene::is_git_lfs_pointer;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Bytes that are looked at.
pub(crate) const HEAD: u64 = 1 << 16;

const EMPTY_ZIP: &str = "an empty ZIP archive";
/// Libraries of materials, which OBJ files refer to.
const MATERIALS: &str = "a library of materials (MTL)";
/// Reasons that servers give in text, in lower case.
const SERVER_ERRORS: [&str; 9] = [
    "not found",
    "access denied",
    "forbidden",
    "bad request",
    "unauthorized",
    "too many requests",
    "internal server error",
    "bad gateway",
    "service unavailable",
];

/// Signatures, the contents of files that begin with them, and the extension of scenes in that format.
const SIGNATURES: [(&[u8], &str, Option<&str>); 33] = [
    (b"glTF", "a binary glTF", Some("glb")),
    (b"#usda", "USD as text", Some("usda")),
    (b"PXR-USDC", "binary USD", Some("usdc")),
    (b"ply\n", "a PLY", Some("ply")),
    (b"ply\r", "a PLY", Some("ply")),
    (b"Kaydara FBX Binary", "an FBX", Some("fbx")),
    (b"; FBX", "an FBX as text", Some("fbx")),
    (b"BLENDER", "a file of Blender", None),
    (b"PK\x03\x04", "a ZIP archive", Some("zip")),
    (b"PK\x05\x06", EMPTY_ZIP, None),
    (b"\x1f\x8b", "packed by gzip", None),
    (b"BZh", "packed by bzip2", None),
    (b"\xfd7zXZ\0", "packed by xz", None),
    (b"\x28\xb5\x2f\xfd", "packed by Zstandard", None),
    (b"7z\xbc\xaf\x27\x1c", "a 7z archive", None),
    (b"Rar!", "a RAR archive", None),
    (b"\x89PNG", "a PNG picture", None),
    (b"\xff\xd8\xff", "a JPEG picture", None),
    (b"GIF8", "a GIF picture", None),
    (b"DDS ", "a DDS picture", None),
    (b"\xabKTX", "a KTX picture", None),
    (b"\x76\x2f\x31\x01", "an OpenEXR picture", None),
    (b"#?RADIANCE", "a Radiance HDR picture", None),
    (b"#?RGBE", "a Radiance HDR picture", None),
    (b"II*\0", "a TIFF picture", None),
    (b"MM\0*", "a TIFF picture", None),
    (b"%PDF", "a PDF document", None),
    (b"\x89HDF", "an HDF5 file", None),
    (b"SQLite format 3", "an SQLite database", None),
    (b"\x7fELF", "a program", None),
    (b"MZ", "a program of Windows", None),
    (b"AC10", "a drawing of AutoCAD (DWG)", None),
    (b"ISO-10303-21", "a STEP or IFC file", None),
];

/// Outermost elements of XML files, the contents of these files, and the extension of scenes in that format.
const ROOTS: [(&str, &str, Option<&str>); 17] = [
    ("mujoco", "a model of MuJoCo", Some("mjcf")),
    ("robot", "a robot in URDF", Some("urdf")),
    ("sdf", "a world or model of Gazebo (SDF)", Some("sdf")),
    ("world", "a world of Gazebo", None),
    ("gazebo", "a world of Gazebo", Some("world")),
    ("collada", "a scene in COLLADA", Some("dae")),
    ("x3d", "a scene in X3D", None),
    ("svg", "a drawing (SVG)", None),
    ("error", "the error message of a server", None),
    ("home", "a plan of Sweet Home 3D, whose homes are .sh3d files", None),
    ("materialx", "materials in MaterialX", None),
    ("vtkfile", "data of VTK", None),
    ("annotation", "annotations of pictures", None),
    ("opencv_storage", "data of OpenCV", None),
    ("plist", "a property list", None),
    ("kml", "places in KML", None),
    ("model", "a 3MF or AMF model", None),
];

/// The content of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Content {
    /// No bytes, or zeros alone, as interrupted downloads leave them.
    Nothing(&'static str),
    /// A page of the web, with its title.
    Page(Option<String>),
    /// What a server answers in place of a file, in a line of text.
    ServerError(String),
    /// XML with this outermost element, in lower case; true for a scene of Nori.
    Xml(String, bool),
    /// A list in JSON.
    JsonList,
    /// A number, text or other single value in JSON.
    JsonValue(String),
    /// A table in JSON; true for one that glTF's marks are in.
    JsonTable(bool),
    /// The format of a signature, and the extension of scenes in it.
    Signed(&'static str, Option<&'static str>),
}

impl Content {
    /// The content by the first bytes; `None` if it may be anything, such as text.
    pub(crate) fn of(head: &[u8]) -> Option<Self> {
        if head.is_empty() {
            return Some(Self::Nothing("empty"));
        }
        if head.iter().all(|byte| *byte == 0) {
            return Some(Self::Nothing("nothing but zeros"));
        }
        if let Some((_, what, extension)) = SIGNATURES.iter().find(|(signature, ..)| head.starts_with(signature)) {
            return Some(Self::Signed(what, *extension));
        }
        if let [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] = head {
            return Some(Self::Signed("a WebP picture", None));
        }
        let text = String::from_utf8_lossy(head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head));
        let text = text.trim_start();
        match text.chars().next()? {
            '<' => markup(text),
            '[' => is_json_value(text[1..].trim_start()).then_some(Self::JsonList),
            '{' => {
                let is_table = text[1..].trim_start().starts_with(['"', '}']);
                is_table.then(|| Self::JsonTable(text.contains("\"asset\"") && text.contains("\"version\"")))
            }
            _ => server_error(text).or_else(|| json_value(text)),
        }
    }

    /// In words, after "it is".
    pub(crate) fn words(&self) -> String {
        match self {
            Self::Nothing(what) => (*what).to_string(),
            Self::Page(title) => format!("a web page{}", title.as_ref().map_or(String::new(), |title| format!(" ({title:?})"))),
            Self::ServerError(line) => format!("the error message of a server ({line:?})"),
            Self::Xml(_, true) => "a scene of Nori".into(),
            Self::Xml(root, false) => match ROOTS.iter().find(|(known, ..)| known == root) {
                Some((_, what, _)) => (*what).to_string(),
                None => format!("XML of another program, with <{root}> around all"),
            },
            Self::JsonList => "a list in JSON".into(),
            Self::JsonValue(value) => format!("a single value ({value})"),
            Self::JsonTable(true) => "a glTF as text".into(),
            Self::JsonTable(false) => "a table in JSON".into(),
            Self::Signed(what, _) => (*what).to_string(),
        }
    }

    /// Advice on what to do with it.
    pub(crate) fn remedy(&self) -> String {
        let rename = |extension: &str| format!("if it is the scene, let its name end with .{extension}");
        let known = |extension: &str| Format::ALL.iter().any(|(_, all)| all.contains(&extension));
        match self {
            Self::Nothing(_) | Self::Page(_) | Self::ServerError(_) | Self::Signed(EMPTY_ZIP, _) => {
                "download or copy the file again".into()
            }
            Self::Xml(root, _) if root == "error" => "download or copy the file again".into(),
            Self::Xml(_, true) => "write it as a scene of Mitsuba, whose elements are much the same, or give its meshes (OBJ)".into(),
            Self::Xml(root, false) => {
                let extension = ROOTS.iter().find(|(known, ..)| known == root).and_then(|(.., extension)| *extension);
                let other = || "give the scene that belongs to it, or export one as glTF from the program that opens it".to_string();
                extension.filter(|extension| known(extension)).map_or_else(other, rename)
            }
            Self::JsonTable(true) => rename("gltf"),
            Self::JsonList | Self::JsonValue(_) | Self::JsonTable(false) => "give the scene file that belongs to it".into(),
            Self::Signed(_, Some(extension)) => rename(extension),
            Self::Signed(what, None) if what.contains("packed") || what.contains("archive") => {
                "unpack it, and give the scene file in it".into()
            }
            Self::Signed(what, None) if what.contains("picture") || *what == MATERIALS => "give the scene file that it belongs to".into(),
            Self::Signed(..) => "open it in a program that reads it, and export the scene as glTF".into(),
        }
    }

    /// Whether it is a picture.
    pub(crate) fn is_picture(&self) -> bool {
        matches!(self, Self::Signed(what, _) if what.contains("picture"))
    }

    /// Whether a scene in this format cannot begin so.
    fn is_foreign(&self, format: Format) -> bool {
        let signed = |extensions: &[&str]| matches!(self, Self::Signed(_, Some(extension)) if extensions.contains(extension));
        match format {
            _ if matches!(self, Self::Nothing(_) | Self::Page(_) | Self::ServerError(_)) => true,
            // A short text may be a scene of other formats.
            _ if matches!(self, Self::JsonValue(_)) => matches!(format, Format::Gltf | Format::Collection),
            Format::Gltf => !(signed(&["glb"]) || matches!(self, Self::JsonTable(_))),
            Format::Mitsuba => !matches!(self, Self::Xml(root, false) if root == "scene"),
            Format::Obj | Format::VRay => true,
            Format::Pbrt => !matches!(self, Self::Signed("packed by gzip", _)),
            Format::Ply => !signed(&["ply"]),
            Format::Usd => !signed(&["usda", "usdc", "zip"]),
            Format::Fbx => !signed(&["fbx"]),
            Format::SweetHome | Format::Zip => !signed(&["zip"]),
            Format::Collada => !matches!(self, Self::Xml(root, false) if root == "collada"),
            Format::Urdf => !matches!(self, Self::Xml(root, false) if root == "robot"),
            Format::Sdf => !matches!(self, Self::Xml(root, false) if root == "sdf" || root == "gazebo"),
            Format::Mjcf => !matches!(self, Self::Xml(root, false) if root == "mujoco"),
            Format::Collection => !matches!(self, Self::JsonTable(_)),
            Format::Stl | Format::Package => false,
        }
    }
}

/// The format of a scene file that has this one by its name: models of MuJoCo are called `.xml`, as Mitsuba's scenes are.
///
/// # Errors
/// [`ImportError::Malformed`] if the content does not match the name, with what it is and what to do. A file that cannot be read is left to
/// its importer.
pub(crate) fn checked(path: &Path, format: Format) -> Result<Format, ImportError> {
    let mut head = Vec::new();
    let is_file = path.metadata().is_ok_and(|data| data.is_file());
    let read = File::open(path).ok().filter(|_| is_file).map(|file| file.take(HEAD).read_to_end(&mut head).is_ok());
    if read == Some(true) { checked_head(path, &head, format) } else { Ok(format) }
}

/// The format of a file that begins with `head`, as [`checked`] has it.
///
/// # Errors
/// As there.
pub(crate) fn checked_head(path: &Path, head: &[u8], format: Format) -> Result<Format, ImportError> {
    let is_mujoco = || matches!(Content::of(head), Some(Content::Xml(root, false)) if root == "mujoco");
    let format = if format == Format::Mitsuba && is_mujoco() { Format::Mjcf } else { format };
    refuse_head(path, head, format).map(|()| format)
}

/// Refuses a file that begins with `head` if that does not match its format.
///
/// # Errors
/// As [`checked`].
fn refuse_head(path: &Path, head: &[u8], format: Format) -> Result<(), ImportError> {
    if is_git_lfs_pointer(head) {
        return Ok(());
    }
    let content = Content::of(head).or_else(|| material_library(head));
    let is_usdz = format == Format::Usd && path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("usdz"));
    let is_plain_usd = |content: &Content| matches!(content, Content::Signed(_, Some("usda" | "usdc")));
    let is_foreign = |content: &Content| content.is_foreign(format) || is_usdz && is_plain_usd(content);
    let Some(content) = content.filter(is_foreign) else { return Ok(()) };
    let other = match content {
        Content::Signed(EMPTY_ZIP, _) if format == Format::Zip => String::new(),
        _ if is_usdz && is_plain_usd(&content) => ", not an archive (usdz)".into(),
        _ => format!(", not {}", format.words()),
    };
    let problem = format!("it is {}{other}; {}", content.words(), content.remedy());
    Err(ImportError::malformed(path, "whole file", problem))
}

/// The error of a server, perhaps after its number, if the text is nothing else.
fn server_error(text: &str) -> Option<Content> {
    let line = text.trim();
    let reason = line.trim_start_matches(|c: char| c.is_ascii_digit()).trim_matches([' ', ':', '.', '-']).to_ascii_lowercase();
    SERVER_ERRORS.contains(&reason.as_str()).then(|| Content::ServerError(line.into()))
}

/// A single value in JSON, if the text is nothing else.
fn json_value(text: &str) -> Option<Content> {
    let value: serde_json::Value = serde_json::from_str(text).ok()?;
    Some(Content::JsonValue(value.to_string().chars().take(60).collect()))
}

/// A library of materials by its first statement; only scenes must not begin so.
fn material_library(head: &[u8]) -> Option<Content> {
    let text = String::from_utf8_lossy(head);
    let first = text.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with('#'))?;
    first.starts_with("newmtl ").then_some(Content::Signed(MATERIALS, None))
}

/// Whether JSON may continue so within a list.
fn is_json_value(rest: &str) -> bool {
    rest.starts_with(|c: char| matches!(c, '{' | '[' | '"' | ']' | '-') || c.is_ascii_digit())
        || ["true", "false", "null"].iter().any(|word| rest.starts_with(word))
}

/// The content of an XML or HTML file.
fn markup(text: &str) -> Option<Content> {
    let mut rest = text;
    // Declarations that may precede the outermost element.
    while rest.starts_with("<?") || rest.starts_with("<!") {
        let is_page = rest.get(..14).is_some_and(|start| start.eq_ignore_ascii_case("<!doctype html"));
        if is_page {
            return Some(Content::Page(title(text)));
        }
        let end = if rest.starts_with("<!--") { "-->" } else { ">" };
        rest = rest.split_once(end)?.1.trim_start();
    }
    let tag = rest.strip_prefix('<')?;
    let root: String = tag.chars().take_while(|c| c.is_alphanumeric() || matches!(c, '_' | '-' | ':' | '.')).collect();
    let root = root.rsplit(':').next().unwrap_or_default().to_lowercase();
    match root.as_str() {
        "" => None,
        "html" | "head" | "body" => Some(Content::Page(title(text))),
        "scene" => {
            let attributes = tag.split('>').next().unwrap_or_default();
            let is_nori = !attributes.contains("version") && tag.contains("<mesh ");
            Some(Content::Xml(root, is_nori))
        }
        _ => Some(Content::Xml(root, false)),
    }
}

/// The title of a web page.
fn title(text: &str) -> Option<String> {
    let lower = text.to_ascii_lowercase();
    let start = lower.find("<title")?;
    let start = start + lower[start..].find('>')? + 1;
    let end = start + lower[start..].find("</title")?;
    let title: String = text.get(start..end)?.split_whitespace().collect::<Vec<_>>().join(" ").chars().take(60).collect();
    (!title.is_empty()).then_some(title)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(bytes: &[u8]) -> String {
        Content::of(bytes).map_or("unknown".into(), |content| content.words())
    }

    #[test]
    fn files_are_told_by_how_they_begin() {
        for (bytes, expected) in [
            (&b""[..], "empty"),
            (b"\0\0\0\0", "nothing but zeros"),
            (b"<!DOCTYPE html><html><head><title>Google Drive -\n Virus scan</title>", "a web page (\"Google Drive - Virus scan\")"),
            (b"\xef\xbb\xbf<?xml version=\"1.0\"?><!-- x --><mujoco model=\"kitchen\">", "a model of MuJoCo"),
            (b"<?xml version='1.0'?><Error><Code>NoSuchKey</Code></Error>", "the error message of a server"),
            (b"<scene><integrator type=\"path\"/><mesh type=\"obj\"/></scene>", "a scene of Nori"),
            (b"<strange:thing/>", "XML of another program, with <thing> around all"),
            (b" [ {\"id\": 1}]", "a list in JSON"),
            (b"[1,2,3]", "a list in JSON"),
            (b"[\n -0.5]", "a list in JSON"),
            (b"[null]", "a list in JSON"),
            (b"{\"asset\": {\"version\": \"2.0\"}}", "a glTF as text"),
            (b"{\"a\": 1}", "a table in JSON"),
            (b"glTF\x02\0\0\0", "a binary glTF"),
            (b"\x89PNG\r\n", "a PNG picture"),
            (b"\x1f\x8b\x08", "packed by gzip"),
            (b"404: Not Found", "the error message of a server (\"404: Not Found\")"),
            (b"Not Found\n", "the error message of a server (\"Not Found\")"),
            (b"404 is a house\n", "unknown"),
            (b"3", "a single value (3)"),
            (b" null\n", "a single value (null)"),
            (b"\"scene\"", "a single value (\"scene\")"),
            (b"# a comment\nv 0 0 0\n", "unknown"),
            (b"[INCLUDE] x", "unknown"),
        ] {
            assert_eq!(words(bytes), expected, "{}", String::from_utf8_lossy(bytes));
        }
    }

    #[test]
    fn a_library_of_materials_is_no_scene() {
        let refused = refuse_head(Path::new("a.obj"), b"# Blender MTL file\n\nnewmtl a\nKd 1 1 1\n", Format::Obj).unwrap_err();
        assert!(refused.to_string().contains("it is a library of materials (MTL), not an OBJ"), "{refused}");
        assert!(refuse_head(Path::new("a.obj"), b"# a\nmtllib newmtl.mtl\n", Format::Obj).is_ok());
    }

    #[test]
    fn every_format_takes_what_it_reads_and_refuses_pages() {
        let scene = b"<scene version=\"3.0.0\"/>";
        for (format, bytes) in [
            (Format::Gltf, &b"glTF\x02\0\0\0"[..]),
            (Format::Gltf, b"{\"asset\": {}}"),
            (Format::Mitsuba, scene),
            (Format::Pbrt, b"\x1f\x8b\x08"),
            (Format::Ply, b"ply\nformat ascii 1.0\n"),
            (Format::Usd, b"#usda 1.0"),
            (Format::Usd, b"PXR-USDC"),
            (Format::Usd, b"PK\x03\x04"),
            (Format::Fbx, b"Kaydara FBX Binary  \0"),
            (Format::SweetHome, b"PK\x03\x04"),
            (Format::Zip, b"PK\x03\x04"),
            (Format::Collada, b"\xef\xbb\xbf<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"x\">"),
            (Format::Urdf, b"<robot name=\"a\"/>"),
            (Format::Sdf, b"<sdf version=\"1.6\"/>"),
            (Format::Collection, b"{\"stage_instance\": {}}"),
        ] {
            assert!(!Content::of(bytes).unwrap().is_foreign(format), "{format:?}");
        }
        for (format, _) in Format::ALL {
            assert!(Content::Page(None).is_foreign(format), "{format:?}");
        }
    }
}
