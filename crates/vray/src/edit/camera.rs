//! Sets the camera: its keyframes and field of view, and a texture that bends its rays where it is no pinhole.

use super::{add, set_on_settings, set_where_present, text};
use enfilade_vrscene::{Document, Item, Plugin, Transform, Value};

/// The camera's pose in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraKeyframe {
    /// Number of the frame; keyframes are in rising order.
    pub frame: i64,
    /// Centre of the camera, asset units.
    pub position: [f64; 3],
    /// Axes of the camera in the world: x right, y up, z backward, as rows of `world_from_camera`.
    pub world_from_camera: [[f64; 3]; 3],
}

/// A camera and the way that it takes.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraPath {
    /// At least one.
    pub keyframes: Vec<CameraKeyframe>,
    /// Seconds between frames.
    pub frame_time_s: f64,
    /// Horizontal field of view, radians.
    pub fov_x_rad: f64,
    /// Width and height of the image, pixels.
    pub size: [u32; 2],
    /// The lens of a camera that is not a pinhole.
    pub lens: Option<LensTexture>,
}

/// A picture that bends the rays of a pinhole camera: red and green are the place (u, v), on [0, 1] from the lower left corner, where
/// the pinhole image has what this place of the bent image shows. Its outermost texels belong to the corners of the image.
#[derive(Clone, Debug, PartialEq)]
pub struct LensTexture {
    /// Path of the EXR file on the machine that renders.
    pub file: String,
    /// Columns and rows.
    pub size: [u32; 2],
}

/// The scene as this camera sees it, frame by frame: a pinhole with square pixels, without depth of field and motion blur. Of another
/// camera the keyframes go, and so do its shifts, which would move the picture although the field of view is stated.
///
/// # Panics
/// When there is no keyframe.
pub fn set_camera(scene: &mut Document, path: &CameraPath) {
    assert!(!path.keyframes.is_empty(), "a camera is somewhere");
    let fov = Value::Float(path.fov_x_rad);
    set_on_settings(
        scene,
        "RenderView",
        &[("transform", transforms(&path.keyframes)), ("fov", fov.clone()), ("orthographic", Value::Int(0))],
    );
    set_on_settings(scene, "SettingsCamera", &[("type", Value::Int(0)), ("fov", fov.clone())]);
    let last = path.keyframes.last().map_or(0, |key| key.frame);
    let frames = (0..=last).map(|frame| i32::try_from(frame).unwrap_or(i32::MAX)).collect();
    set_on_settings(
        scene,
        "SettingsOutput",
        &[
            ("img_width", Value::Int(path.size[0].into())),
            ("img_height", Value::Int(path.size[1].into())),
            ("img_pixelAspect", Value::Int(1)),
            ("img_file_needFrameNumber", Value::Int(1)),
            ("anim_start", Value::Int(0)),
            ("anim_end", Value::Float(last as f64 * path.frame_time_s)),
            ("frame_start", Value::Int(0)),
            ("frames_per_second", Value::Float(1.0 / path.frame_time_s)),
            ("frames", Value::Ints(frames)),
        ],
    );
    let mut physical = vec![
        ("specify_fov", Value::Int(1)),
        ("fov", fov),
        ("zoom_factor", Value::Int(1)),
        ("lens_shift", Value::Int(0)),
        ("horizontal_shift", Value::Int(0)),
        ("horizontal_offset", Value::Int(0)),
        ("vertical_offset", Value::Int(0)),
        // A texture bends the rays, or nothing does.
        ("distortion_type", Value::Int(if path.lens.is_some() { 3 } else { 0 })),
        ("distortion", Value::Int(0)),
    ];
    // Remove the lens of an earlier camera.
    scene.items.retain(|item| !matches!(item, Item::Plugin(plugin) if plugin.name().starts_with(LENS.as_bytes())));
    if let Some(lens) = &path.lens {
        physical.push(("lens_file", text("")));
        physical.push(("distortion_tex", Value::Name(format!("{LENS}_texture").into_bytes())));
        set_on_settings(scene, "CameraPhysical", &physical);
        add_lens(scene, lens);
    } else {
        scene.of_kind_mut("CameraPhysical").filter(|camera| refers_to_lens(camera)).for_each(|camera| _ = camera.remove("distortion_tex"));
        set_where_present(scene, "CameraPhysical", &physical);
    }
    turn_off_blur(scene);
}

/// Turns off depth of field and motion blur wherever V-Ray has them: for plain cameras in settings of their own, for physical ones in
/// the camera. All are off by default, so nothing is added to a scene that has none of these plugins.
fn turn_off_blur(scene: &mut Document) {
    let off = Value::Int(0);
    set_where_present(scene, "SettingsCameraDof", &[("on", off.clone())]);
    set_where_present(scene, "SettingsMotionBlur", &[("on", off.clone())]);
    let physical = [("use_dof", off.clone()), ("use_moblur", off.clone()), ("blades_enable", off.clone())];
    set_where_present(scene, "CameraPhysical", &physical);
    // Older versions of V-Ray do not know it.
    let rolling = "rolling_shutter_mode";
    scene.of_kind_mut("CameraPhysical").filter(|camera| camera.parameter(rolling).is_some()).for_each(|camera| camera.set(rolling, &off));
}

const LENS: &str = "HYPERSIM_camera_lens_distortion";

fn refers_to_lens(camera: &Plugin) -> bool {
    camera.parameter("distortion_tex").is_some_and(|texture| texture.raw().starts_with(LENS.as_bytes()))
}

fn transforms(keyframes: &[CameraKeyframe]) -> Value {
    let transform = |key: &CameraKeyframe| {
        // V-Ray writes where the axes go: the columns.
        let r = key.world_from_camera;
        let matrix = std::array::from_fn(|axis| [r[0][axis] as f32, r[1][axis] as f32, r[2][axis] as f32]);
        Value::Transform(Transform { matrix, offset: key.position })
    };
    match keyframes {
        [only] => transform(only),
        many => Value::Animated(many.iter().map(|key| (key.frame as f64, transform(key))).collect()),
    }
}

/// Buffer, texture and coordinates of a lens. The corners of the image are at the centres of the corner texels. The picture's values are
/// numbers, not colours, so nothing may filter, tile or decode it.
fn add_lens(scene: &mut Document, lens: &LensTexture) {
    let [c, r] = lens.size.map(|n| n as f32);
    let matrix = [[(c - 1.0) / c, 0.0, 0.0], [0.0, (r - 1.0) / r, 0.0], [0.0, 0.0, 1.0]];
    let offset = [f64::from(0.5 / c), f64::from(0.5 / r), 0.0];
    let name = |part: &str| format!("{LENS}_{part}");
    let refer = |part: &str| Value::Name(name(part).into_bytes());
    add(
        scene,
        "BitmapBuffer",
        &name("buffer"),
        &[
            ("file", text(&lens.file)),
            ("load_file", Value::Int(1)),
            ("filter_type", Value::Int(0)),
            ("filter_blur", Value::Int(1)),
            ("interpolation", Value::Int(0)),
            ("color_space", Value::Int(0)),
            ("gamma", Value::Int(1)),
        ],
    );
    let coordinates = [
        ("uvw_channel", Value::Int(1)),
        ("uvw_transform", Value::Transform(Transform { matrix, offset })),
        ("wrap_u", Value::Int(1)),
        ("wrap_v", Value::Int(1)),
        ("wrap_mode", Value::Int(1)),
        ("crop_u", Value::Int(0)),
        ("crop_v", Value::Int(0)),
        ("duvw_scale", Value::Int(1)),
    ];
    add(scene, "UVWGenChannel", &name("uvw"), &coordinates);
    let texture = [
        ("bitmap", refer("buffer")),
        ("uvwgen", refer("uvw")),
        ("tile", Value::Int(0)),
        ("nouvw_color", Value::AColor([0.0; 4])),
        ("placement_type", Value::Int(0)),
        ("u", Value::Int(0)),
        ("v", Value::Int(0)),
        ("w", Value::Int(1)),
        ("h", Value::Int(1)),
        ("alpha_from_intensity", Value::Int(0)),
    ];
    add(scene, "TexBitmap", &name("texture"), &texture);
}
