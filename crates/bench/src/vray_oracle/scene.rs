//! The scene of the first example of Hypersim's toolkit: its empty scene, seen by one camera, with a few hundred textured squares.

use anyhow::{Context, Result};
use enfilade_import::{ImportOptions, Imported, load};
use enfilade_math::DVec3;
use enfilade_scene::{Camera, Intrinsics, Quiet};
use enfilade_vray::edit::{CameraKeyframe, CameraPath, set_camera};
use enfilade_vrscene::{Document, Include, Item, Plugin, Value};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Size of V-Ray's picture.
pub const SIZE: [u32; 2] = [1024, 768];

/// How the example exposes its pictures (`_vray_user_params.py`).
const EXPOSURE: [(&str, f64); 3] = [("ISO", 400.0), ("shutter_speed", 300.0), ("f_number", 2.0)];

/// V-Ray's own picture of the scene, linear.
pub fn picture(scenes: &Path) -> PathBuf {
    scenes.join("hypersim-real/vray_empty_scene/_empty_cam_quads_linear.0000.exr")
}

/// Writes the scene into `folder` and imports it. `tags` is the folder of the squares' pictures; without it they are plain grey.
///
/// # Errors
/// When a file of the example is not there or not as expected.
pub fn import(scenes: &Path, tags: Option<&Path>, folder: &Path) -> Result<Imported> {
    let empty = scenes.join("vrscene/hypersim_empty.vrscene");
    let mut document = Document::parse(std::fs::read(&empty).with_context(|| empty.display().to_string())?)?;
    let mut physical = Plugin::new("CameraPhysical", "physical");
    for (parameter, value) in EXPOSURE {
        physical.set(parameter, &Value::Float(value));
    }
    document.push(physical);
    set_camera(&mut document, &camera());
    document.items.push(Item::Include(Include::new("quads.vrscene")));
    let table = scenes.join("hypersim-real/vray_empty_scene/quads_params.csv");
    let table = std::fs::read_to_string(&table).with_context(|| table.display().to_string())?;
    std::fs::write(folder.join("quads.vrscene"), quads(&table, tags.unwrap_or(Path::new("tags")))?)?;
    let file = folder.join("scene.vrscene");
    std::fs::write(&file, document.to_bytes())?;
    let options = ImportOptions { allow_missing_textures: tags.is_none(), ..ImportOptions::default() };
    Ok(load(&file, &options, &Quiet)?)
}

/// The imported camera with the size of V-Ray's picture.
pub fn taken_with(imported: &Imported) -> Camera {
    Camera::from(Intrinsics::from_fov_x(SIZE[0], SIZE[1], imported.scene.cameras[0].fov_x_rad))
}

/// The camera as the header of V-Ray's picture has it (`cameraTransform`, `cameraFov`): it looks at the origin.
fn camera() -> CameraPath {
    let position = DVec3::new(17_000.0, 0.0, 20_000.0);
    let z = position.normalize();
    let x = DVec3::Y;
    let y = z.cross(x);
    let world_from_camera = [0, 1, 2].map(|row| [x[row], y[row], z[row]]);
    let keyframes = vec![CameraKeyframe { frame: 0, position: position.to_array(), world_from_camera }];
    CameraPath { keyframes, frame_time_s: 1.0, fov_x_rad: 45f64.to_radians(), size: SIZE, lens: None }
}

/// The squares of the table as plugins, with the materials that the toolkit gives them.
fn quads(table: &str, tags: &Path) -> Result<String> {
    let mut text = String::new();
    for (i, line) in table.lines().skip(1).enumerate() {
        let cells: Vec<&str> = line.trim().split(',').collect();
        let [numbers @ .., image] = cells.as_slice() else { continue };
        let n: Vec<f64> = numbers.iter().map(|c| c.parse()).collect::<Result<_, _>>().with_context(|| line.to_string())?;
        let [w, h, r00, r01, r02, r10, r11, r12, r20, r21, r22, x, y, z] = n[..] else {
            anyhow::bail!("expected 14 numbers and a file in {line:?}");
        };
        let image = tags.join(Path::new(image).file_name().unwrap_or_default());
        write!(
            text,
            "Node quad_{i:04} {{ geometry=quad_mesh_{i}; material=quad_mtl_{i}; transform=Transform(Matrix(Vector({r00},{r10},{r20}), \
             Vector({r01},{r11},{r21}), Vector({r02},{r12},{r22})), Vector({x},{y},{z})); }}\n\
             GeomStaticMesh quad_mesh_{i} {{ vertices=ListVector(Vector(0,0,0), Vector({w},0,0), Vector(0,{h},0), Vector({w},{h},0)); \
             faces=ListInt(2,0,3,1,3,0); map_channels=List(List(1, ListVector(Vector(0,0,0), Vector(1,0,0), Vector(0,1,0), Vector(1,1,0)), \
             ListInt(2,0,3,1,3,0))); }}\n\
             MtlSingleBRDF quad_mtl_{i} {{ brdf=quad_brdf_{i}; }}\n\
             BRDFVRayMtl quad_brdf_{i} {{ diffuse=quad_color_{i}; roughness=0; reflect=AColor(0,0,0,1); refract=AColor(0,0,0,1); fresnel=1; }}\n\
             TexCombineColor quad_color_{i} {{ color=Color(0,0,0); texture=quad_tex_{i}; texture_multiplier=1; }}\n\
             TexBitmap quad_tex_{i} {{ bitmap=quad_buffer_{i}; uvwgen=quad_uvw_{i}; }}\n\
             UVWGenChannel quad_uvw_{i} {{ uvw_channel=1; wrap_u=1; wrap_v=1; wrap_mode=1; }}\n\
             BitmapBuffer quad_buffer_{i} {{ file=\"{}\"; gamma=1; color_space=0; filter_type=-1; interpolation=3; }}\n",
            image.display()
        )?;
    }
    Ok(text)
}
