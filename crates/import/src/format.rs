//! The scene formats and their file name extensions: the one table of them.

use crate::{ImportError, UpAxis, UpStated};
use std::path::Path;

/// The scene formats that can be imported, one per module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// glTF 2.0, as text or binary.
    Gltf,
    /// Wavefront OBJ with MTL materials.
    Obj,
    /// Mitsuba scene description, versions 0.5 to 3.
    Mitsuba,
    /// V-Ray scene description.
    VRay,
    /// pbrt's scene description, versions 3 and 4; its text may be compressed by gzip.
    Pbrt,
    /// Stanford PLY: one mesh.
    Ply,
    /// Universal Scene Description, as text, binary or archive.
    Usd,
    /// Autodesk FBX, binary or as text.
    Fbx,
    /// COLLADA, versions 1.4 and 1.5.
    Collada,
    /// STL, binary or as text: meshes.
    Stl,
    /// Robots and furniture in URDF.
    Urdf,
    /// Worlds and models of Gazebo in SDF.
    Sdf,
    /// Models of MuJoCo (MJCF): robots and their worlds.
    Mjcf,
    /// A scene file of another format with what it refers to, in a ZIP archive.
    Zip,
    /// Homes and furniture libraries of Sweet Home 3D.
    SweetHome,
    /// Scenes of published collections, such as HSSD-200, in their own layouts.
    Collection,
    /// The scene package that `enfilade import` writes.
    Package,
}

/// Extensions of files that are not read, in lower case, and what to do with them.
const OTHERS: [(&[&str], &str); 18] = [
    (&["blend"], "open it in Blender and export glTF 2.0 (.glb)"),
    (&["skp"], "open it in SketchUp and export COLLADA (.dae) or glTF (.glb)"),
    (&["max"], "open it in 3ds Max and export FBX or USD, or a .vrscene with V-Ray"),
    (&["ma", "mb"], "open it in Maya and export FBX or USD"),
    (&["c4d"], "open it in Cinema 4D and export FBX, glTF or USD"),
    (&["hip", "hiplc", "hipnc"], "open it in Houdini and export USD or glTF"),
    (&["3dm"], "open it in Rhino and export glTF, OBJ or FBX"),
    (&["rvt", "rfa"], "open it in Revit and export FBX"),
    (&["dwg", "dxf"], "open it in FreeCAD or a program for CAD, and export glTF, OBJ or COLLADA (.dae)"),
    (
        &["ifc", "ifczip"],
        "convert it with IfcConvert of IfcOpenShell (IfcConvert house.ifc house.glb), or open it in Blender with Bonsai and export glTF",
    ),
    (&["step", "stp", "iges", "igs", "brep", "fcstd"], "open it in FreeCAD and export glTF or OBJ, which makes triangles of it"),
    (&["3mf", "amf", "off"], "open it in MeshLab, or a slicer, and export OBJ, PLY or STL"),
    (
        &["3ds", "lwo", "lws", "wrl", "x3d", "x3dv", "ac", "x", "ms3d"],
        "open it in Blender and export glTF (.glb), or convert it with assimp (assimp export FILE room.glb)",
    ),
    (&["abc", "vdb"], "open it in Blender and export glTF (.glb) or USD"),
    (&["xacro"], "make URDF of it with ROS (xacro FILE > robot.urdf)"),
    (&["rar", "7z", "tar", "tgz", "bz2", "xz", "zst"], "unpack it, and give the scene file within or its folder"),
    (
        &["las", "laz", "e57", "pcd", "pts", "ptx", "xyz"],
        "a cloud of points has no surfaces: make a mesh of it with CloudCompare or MeshLab and export PLY",
    ),
    (&["splat", "ksplat", "spz"], "splats have no surfaces: reconstruct a mesh of the pictures and export glTF, OBJ or PLY"),
];

impl Format {
    /// Every format with its file name extensions, in lower case.
    pub const ALL: [(Self, &'static [&'static str]); 17] = [
        (Self::Gltf, &["gltf", "glb"]),
        (Self::Obj, &["obj"]),
        (Self::Mitsuba, &["xml"]),
        (Self::Pbrt, &["pbrt", "pbrt.gz"]),
        (Self::Ply, &["ply"]),
        (Self::Usd, &["usd", "usda", "usdc", "usdz"]),
        (Self::Fbx, &["fbx"]),
        (Self::Collada, &["dae"]),
        (Self::Stl, &["stl"]),
        (Self::Urdf, &["urdf"]),
        (Self::Sdf, &["sdf", "world"]),
        (Self::Mjcf, &["mjcf"]),
        (Self::Zip, &["zip"]),
        (Self::SweetHome, &["sh3d", "sh3f"]),
        (Self::VRay, &["vrscene"]),
        (Self::Collection, &["json", "house", "semantic.txt"]),
        (Self::Package, &["scene"]),
    ];

    /// Ends of names that consist of several extensions, in lower case.
    const LONG: [&str; 3] = ["pbrt.gz", "scene_instance.json", "semantic.txt"];

    /// Name of the format's scenes in messages.
    pub(crate) const fn words(self) -> &'static str {
        match self {
            Self::Gltf => "a glTF",
            Self::Obj => "an OBJ",
            Self::Mitsuba => "a scene of Mitsuba",
            Self::Pbrt => "a scene of pbrt",
            Self::Ply => "a PLY",
            Self::Usd => "USD",
            Self::Fbx => "an FBX",
            Self::Collada => "COLLADA",
            Self::Stl => "an STL",
            Self::Urdf => "a robot in URDF",
            Self::Sdf => "a world or model in SDF",
            Self::Mjcf => "a model of MuJoCo",
            Self::Zip => "a ZIP archive",
            Self::SweetHome => "a home of Sweet Home 3D",
            Self::VRay => "a scene of V-Ray",
            Self::Collection => "a scene of a collection",
            Self::Package => "a scene package",
        }
    }

    /// The upward axis where a scene of the format states none.
    pub(crate) const fn up_axis(self) -> UpAxis {
        if matches!(self, Self::Stl | Self::Urdf | Self::Sdf | Self::Mjcf) { UpAxis::Z } else { UpAxis::Y }
    }

    /// Where a scene of the format states which way is up, unless it leaves that out.
    pub(crate) const fn up_stated(self) -> UpStated {
        match self {
            Self::Obj | Self::Ply | Self::Stl | Self::Mitsuba | Self::Pbrt | Self::Package => UpStated::Nowhere,
            Self::Gltf => UpStated::ByRule,
            _ => UpStated::ByFile,
        }
    }

    /// All extensions as written in messages: `.gltf, .glb, …`, in the order of [`ALL`](Self::ALL).
    pub fn extensions() -> String {
        Self::ALL.iter().flat_map(|(_, extensions)| *extensions).map(|extension| format!(".{extension}")).collect::<Vec<_>>().join(", ")
    }

    /// Advice on a file of another program by its extension; `None` for formats that are read and for unknown ones.
    pub(crate) fn remedy(path: &Path) -> Option<&'static str> {
        let extension = extension(path)?;
        OTHERS.iter().find(|(extensions, _)| extension.split('.').any(|word| extensions.contains(&word))).map(|(_, remedy)| *remedy)
    }

    /// The format of a file by the extension of its name, in whatever case.
    ///
    /// ```
    /// use enfilade_import::Format;
    ///
    /// assert_eq!(Format::of("rooms/Hall.PBRT.gz".as_ref())?, Format::Pbrt);
    /// assert!(Format::of("hall.blend".as_ref()).unwrap_err().to_string().contains("expected one of .gltf, .glb"));
    /// # Ok::<(), enfilade_import::ImportError>(())
    /// ```
    ///
    /// # Errors
    /// When no format has that extension.
    pub fn of(path: &Path) -> Result<Self, ImportError> {
        let extension = extension(path);
        let found = match (&extension, Self::remedy(path)) {
            (None, _) => "the file name has no extension".to_string(),
            (Some(e), Some(remedy)) => format!("no importer for .{e} files: {remedy}"),
            (Some(e), None) => format!("no importer for .{e} files"),
        };
        Self::ALL
            .iter()
            .find(|(_, extensions)| extension.as_deref().is_some_and(|e| extensions.contains(&e)))
            .map(|&(format, _)| format)
            .ok_or_else(|| ImportError::UnknownFormat { file: path.to_path_buf(), found, known: Self::extensions() })
    }
}

/// The extension of a file's name, in lower case; both of `.pbrt.gz` and `.semantic.txt`.
fn extension(path: &Path) -> Option<String> {
    let lower = |e: &std::ffi::OsStr| e.to_string_lossy().to_lowercase();
    path.extension().map(lower).map(|e| match path.file_stem().and_then(|s| Path::new(s).extension()) {
        Some(inner) if e == "gz" || e == "txt" => format!("{}.{e}", lower(inner)),
        _ => e,
    })
}

/// The name of a scene by its file: the file's name without its extension, which may be as long as `.scene_instance.json`.
///
/// ```
/// use enfilade_import::scene_name;
///
/// assert_eq!(scene_name("hssd/scenes/102344193.scene_instance.json".as_ref()), "102344193");
/// assert_eq!(scene_name("rooms/hall.pbrt.gz".as_ref()), "hall");
/// assert_eq!(scene_name("rooms/hall.v2.glb".as_ref()), "hall.v2");
/// ```
pub fn scene_name(file: &Path) -> String {
    let name = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy();
    let long = Format::LONG.iter().find(|end| name.to_lowercase().ends_with(&format!(".{end}")));
    let before = long.and_then(|end| name.get(..name.len() - end.len() - 1)).filter(|before| !before.is_empty());
    before.map_or_else(|| file.file_stem().unwrap_or(file.as_os_str()).to_string_lossy().into_owned(), str::to_string)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_told_by_extension_whatever_its_case() {
        assert_eq!(Format::of(Path::new("a/Room.GLB")).unwrap(), Format::Gltf);
        assert_eq!(Format::of(Path::new("scene.xml")).unwrap(), Format::Mitsuba);
        assert_eq!(Format::of(Path::new("scene.PBRT.gz")).unwrap(), Format::Pbrt);
        assert!(Format::of(Path::new("room.obj.gz")).unwrap_err().to_string().contains("no importer for .obj.gz files"));
        let message = Format::of(Path::new("a/room.blend")).unwrap_err().to_string();
        assert_eq!(
            message,
            "a/room.blend: no importer for .blend files: open it in Blender and export glTF 2.0 (.glb); expected one of .gltf, .glb, .obj, .xml, .pbrt, .pbrt.gz, .ply, .usd, .usda, .usdc, .usdz, .fbx, .dae, .stl, .urdf, .sdf, .world, .mjcf, .zip, .sh3d, .sh3f, .vrscene, .json, .house, .semantic.txt, .scene"
        );
        for (file, advice) in [
            ("a.SKP", "SketchUp"),
            ("a.ifc", "IfcConvert"),
            ("a.stp", "FreeCAD"),
            ("a.3ds", "assimp"),
            ("a.tar.gz", "unpack it"),
            ("a.7z", "unpack it"),
        ] {
            let message = Format::of(Path::new(file)).unwrap_err().to_string();
            assert!(message.contains(advice) && message.contains("; expected one of .gltf"), "{message}");
        }
        let read: Vec<&str> = Format::ALL.iter().flat_map(|(_, extensions)| *extensions).copied().collect();
        assert!(OTHERS.iter().flat_map(|(extensions, _)| *extensions).all(|other| !read.contains(other)));
        assert!(Format::of(Path::new("room")).unwrap_err().to_string().contains("no extension"));
    }
}
