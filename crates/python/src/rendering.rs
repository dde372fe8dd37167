//! `enfilade.render`, and pictures of what it gives.

use crate::arrays;
use crate::camera::Camera;
use crate::interrupt::{Interrupt, watched};
use crate::keywords;
use crate::progress::Bar;
use crate::render_options::RenderOptions;
use crate::scene::Scene;
use enfilade_dataset::ColorKind;
use enfilade_frame::{Dtype, Frame, LAYERS, Layer, LayerSpec, Pass, Values, f16};
use enfilade_loader::sample_of;
use enfilade_pipeline::Shot;
use enfilade_scene::Pose;
use enfilade_show::exposure::{Brightness, Exposure, display_exposure};
use enfilade_show::picture::{Picture, jpeg, png};
use enfilade_show::preview::{Subject, preview};
use enfilade_show::sheet::{Canvas, Resize};
use numpy::{Element, PyReadonlyArrayDyn};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

/// Renders views, one frame each: the function behind `enfilade.render`.
#[pyfunction]
#[pyo3(signature = (scene, cameras, *, progress, **options))]
pub fn render<'py>(
    py: Python<'py>,
    scene: &Bound<'py, Scene>,
    cameras: Vec<PyRef<'py, Camera>>,
    progress: Option<bool>,
    options: Option<&Bound<'py, PyDict>>,
) -> PyResult<Vec<Bound<'py, PyDict>>> {
    // Find out what is wanted.
    let options: RenderOptions = keywords::options(options, "render", &["scene", "camera", "progress"])?;
    let layers = options.layers()?;
    let shot = options.shot(layers.as_deref())?;
    check(layers.as_deref(), &shot)?;

    // Render, and hand the layers over.
    let views: Vec<(enfilade_scene::Camera, Pose)> = (0..).zip(&cameras).map(|(frame, camera)| view(camera, frame)).collect();
    let (bar, loaded) = (Bar::new(py, progress, "render")?, &scene.get().0);
    let frames = watched(py, &bar, |cx: &Interrupt| loaded.render(&views, &shot, cx))?;
    let sample = |(index, frame): (usize, Frame)| {
        let ((camera, pose), name) = (&views[index], cameras[index].name.as_str());
        let sample = sample_of(&frame, layers.as_deref(), camera, pose, [loaded.name(), name]);
        let missing = |layer: Layer| PyValueError::new_err(format!("{name:?} has no layer {}: its model has none", layer.spec().name));
        arrays::sample(py, index, sample.map_err(missing)?)
    };
    frames.into_iter().enumerate().map(sample).collect()
}

fn view(camera: &Camera, frame: u32) -> (enfilade_scene::Camera, Pose) {
    (camera.camera.clone(), Pose { frame, ..camera.pose })
}

/// Refuses layers that these settings do not give, before hours of rendering.
fn check(layers: Option<&[Layer]>, shot: &Shot) -> PyResult<()> {
    let Some(layers) = layers else { return Ok(()) };
    if layers.is_empty() {
        return Err(PyValueError::new_err("no layers were asked for; name at least one"));
    }
    let kept = layers.iter().find(|layer| layer.spec().pass == Pass::Rendered).filter(|_| shot.color == ColorKind::Rendered);
    kept.map_or(Ok(()), |layer| {
        let name = layer.spec().name;
        let plain = name.trim_end_matches("_rendered");
        Err(PyValueError::new_err(format!("{name} exists only for denoised frames; without denoising, {plain} is the rendered layer")))
    })
}

/// Pictures of layers of a sample as bytes of PNG (or JPEG) files: "display" is its colour as people see it, other names are those of layers. Names
/// of what the sample does not have are left out. Pictures wider than `width` are shrunk.
#[pyfunction]
#[pyo3(signature = (sample, names, *, width=None, lossy=false))]
pub fn pictures<'py>(
    py: Python<'py>,
    sample: &Bound<'py, PyDict>,
    names: Vec<String>,
    width: Option<u32>,
    lossy: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let frame = frame_of(sample)?;
    let made: Vec<(String, Vec<u8>)> = py.detach(|| {
        let exposure = Exposure::from(display_exposure(&Brightness::of_frame(&frame, 1).into_iter().collect::<Vec<_>>()));
        let file = |picture: &Picture| if lossy { jpeg(picture) } else { png(picture, None) };
        let picture = |name: String| {
            let subject = if name == "display" { Subject::Displayed } else { Subject::Layer(Layer::from_name(&name)?) };
            let shown = preview(subject, &frame, exposure)?.picture;
            Some((name, file(&shrunk(shown, subject, width))))
        };
        names.into_iter().filter_map(picture).collect()
    });
    let out = PyDict::new(py);
    made.into_iter().try_for_each(|(name, bytes)| out.set_item(name, PyBytes::new(py, &bytes)))?;
    Ok(out)
}

fn shrunk(picture: Picture, subject: Subject, width: Option<u32>) -> Picture {
    let Some(width) = width.filter(|&width| width < picture.width()) else { return picture };
    let height = (u64::from(picture.height()) * u64::from(width) / u64::from(picture.width())).max(1) as u32;
    let is_of_numbers = matches!(subject, Subject::Layer(layer) if matches!(layer.spec().dtype, Dtype::I16 | Dtype::U8));
    let mut canvas = Canvas::new(width, height, [0; 3]);
    canvas.place(0, 0, width, height, &picture, if is_of_numbers { Resize::Exact } else { Resize::Smooth });
    canvas.into_picture()
}

/// The layers of a sample that have the type and size of the table of layers, as a frame.
fn frame_of(sample: &Bound<'_, PyDict>) -> PyResult<Frame> {
    let mut frame: Option<Frame> = None;
    for spec in &LAYERS {
        let Some(value) = sample.get_item(spec.name)? else { continue };
        let Some(([height, width], values)) = values(&value, spec) else { continue };
        let frame = frame.get_or_insert_with(|| Frame::new(width, height));
        if [frame.width, frame.height] == [width, height] {
            frame.insert(spec.layer, values);
        }
    }
    let mut frame = frame.ok_or_else(|| PyValueError::new_err("the sample has no layer that could be shown"))?;
    if frame.get(Layer::RenderEntityId).is_none() {
        // If no layer identifies the pixels that show the scene, all do.
        let pixels = frame.pixels();
        frame.insert(Layer::RenderEntityId, Values::I16(vec![1; pixels]));
    }
    Ok(frame)
}

fn values(value: &Bound<'_, PyAny>, spec: &LayerSpec) -> Option<([u32; 2], Values)> {
    fn of<T: Element + Copy>(value: &Bound<'_, PyAny>) -> Option<(Vec<usize>, Vec<T>)> {
        let array: PyReadonlyArrayDyn<T> = value.extract().ok()?;
        let array = array.as_array();
        Some((array.shape().to_vec(), array.iter().copied().collect()))
    }
    let (shape, values) = match spec.dtype {
        Dtype::F16 => of::<f16>(value).map(|(shape, v)| (shape, Values::F16(v))),
        Dtype::F32 => of::<f32>(value).map(|(shape, v)| (shape, Values::F32(v))),
        Dtype::I16 => of::<i16>(value).map(|(shape, v)| (shape, Values::I16(v))),
        Dtype::U8 => of::<u8>(value).map(|(shape, v)| (shape, Values::U8(v))),
    }?;
    match shape[..] {
        [height, width] if spec.channels == 1 && height * width > 0 => Some(([height as u32, width as u32], values)),
        [height, width, found] if found == spec.channels && height * width > 0 => Some(([height as u32, width as u32], values)),
        _ => None,
    }
}
