//! Images, samples and batches as numpy arrays, without copying more than batches need.

use enfilade_frame::Dtype;
use enfilade_loader::{Image, Sample, Values};
use numpy::{Element, IntoPyArray, PyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// numpy's name of a type.
pub fn dtype_name(dtype: Dtype) -> &'static str {
    match dtype {
        Dtype::F16 => "float16",
        Dtype::F32 => "float32",
        Dtype::I16 => "int16",
        Dtype::U8 => "uint8",
    }
}

/// An array of that shape around the values, which are not copied.
fn shaped<'py, T: Element>(py: Python<'py>, values: Vec<T>, shape: &[usize]) -> PyResult<Bound<'py, PyAny>> {
    let flat: Bound<'py, PyArray<T, _>> = values.into_pyarray(py);
    Ok(flat.reshape(shape.to_vec())?.into_any())
}

/// Values of any type as an array.
fn array<'py>(py: Python<'py>, values: Values, shape: &[usize]) -> PyResult<Bound<'py, PyAny>> {
    match values {
        Values::F16(v) => shaped(py, v, shape),
        Values::F32(v) => shaped(py, v, shape),
        Values::I16(v) => shaped(py, v, shape),
        Values::U8(v) => shaped(py, v, shape),
    }
}

/// Bytes 0 and 1 as an array of bool.
fn truths<'py>(py: Python<'py>, values: Values, shape: &[usize]) -> PyResult<Bound<'py, PyAny>> {
    match values {
        Values::U8(v) => shaped(py, v.into_iter().map(|v| v != 0).collect::<Vec<bool>>(), shape),
        other => array(py, other, shape),
    }
}

/// Height and width, and channels where there are several.
fn shape(image: &Image) -> Vec<usize> {
    if image.channels == 1 { vec![image.height, image.width] } else { vec![image.height, image.width, image.channels] }
}

/// A sample as a dictionary.
pub fn sample(py: Python<'_>, index: usize, sample: Sample) -> PyResult<Bound<'_, PyDict>> {
    let out = PyDict::new(py);
    for (layer, image) in sample.layers {
        let shape = shape(&image);
        out.set_item(layer.spec().name, array(py, image.values, &shape)?)?;
    }
    if let Some(mask) = sample.mask {
        let shape = shape(&mask);
        out.set_item("mask", truths(py, mask.values, &shape)?)?;
    }
    if let Some(k) = sample.k {
        out.set_item("K", shaped(py, k.concat(), &[3, 3])?)?;
    }
    if let Some(pose) = sample.world_from_camera {
        out.set_item("world_from_camera", shaped(py, pose.concat(), &[4, 4])?)?;
    }
    let window = sample.window;
    out.set_item("scene", sample.scene)?;
    out.set_item("camera", sample.camera)?;
    out.set_item("frame", sample.frame)?;
    out.set_item("index", index)?;
    out.set_item("window", (window.top, window.left, window.height, window.width))?;
    Ok(out)
}

/// Several samples as one dictionary.
pub struct Batch {
    indices: Vec<i64>,
    images: Vec<(&'static str, Vec<usize>, Values)>,
    mask: Option<(Vec<usize>, Values)>,
    k: Option<Vec<f64>>,
    poses: Option<Vec<f64>>,
    windows: Vec<i64>,
    names: [Vec<String>; 2],
    frames: Vec<i64>,
}

impl Batch {
    /// Puts samples of one size into one array per layer. `Err` names the one that differs.
    pub fn of(samples: Vec<(usize, Sample)>) -> Result<Self, String> {
        let count = samples.len();
        let (_, first) = &samples[0];
        check_alike(first, &samples)?;
        let stacked =
            |image: &Image, all: &mut dyn Iterator<Item = &Image>| ([&[count], &shape(image)[..]].concat(), stack(image, count, all));
        let images = first.layers.iter().enumerate().map(|(i, (layer, image))| {
            let (shape, values) = stacked(image, &mut samples.iter().map(|(_, sample)| &sample.layers[i].1));
            (layer.spec().name, shape, values)
        });
        let images = images.collect();
        let mask = first.mask.as_ref().map(|mask| stacked(mask, &mut samples.iter().filter_map(|(_, sample)| sample.mask.as_ref())));
        let k: Option<Vec<f64>> = samples.iter().map(|(_, sample)| sample.k).collect::<Option<Vec<_>>>().map(|all| all.concat().concat());
        let poses = samples.iter().map(|(_, sample)| sample.world_from_camera).collect::<Option<Vec<_>>>();
        let window = |sample: &Sample| [sample.window.top, sample.window.left, sample.window.height, sample.window.width].map(|v| v as i64);
        Ok(Self {
            images,
            mask,
            k,
            poses: poses.map(|all| all.concat().concat()),
            windows: samples.iter().flat_map(|(_, sample)| window(sample)).collect(),
            indices: samples.iter().map(|(index, _)| *index as i64).collect(),
            frames: samples.iter().map(|(_, sample)| i64::from(sample.frame)).collect(),
            names: [|s: &Sample| s.scene.clone(), |s: &Sample| s.camera.clone()].map(|of| samples.iter().map(|(_, s)| of(s)).collect()),
        })
    }

    /// The batch as a dictionary of arrays whose first axis counts samples.
    pub fn into_dict(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let count = self.indices.len();
        let out = PyDict::new(py);
        for (name, shape, values) in self.images {
            out.set_item(name, array(py, values, &shape)?)?;
        }
        if let Some((shape, values)) = self.mask {
            out.set_item("mask", truths(py, values, &shape)?)?;
        }
        if let Some(k) = self.k {
            out.set_item("K", shaped(py, k, &[count, 3, 3])?)?;
        }
        if let Some(poses) = self.poses {
            out.set_item("world_from_camera", shaped(py, poses, &[count, 4, 4])?)?;
        }
        let [scenes, cameras] = self.names;
        out.set_item("scene", scenes)?;
        out.set_item("camera", cameras)?;
        out.set_item("frame", shaped(py, self.frames, &[count])?)?;
        out.set_item("index", shaped(py, self.indices, &[count])?)?;
        out.set_item("window", shaped(py, self.windows, &[count, 4])?)?;
        Ok(out)
    }
}

/// Says which sample has images of another size or type than the first.
fn check_alike(first: &Sample, samples: &[(usize, Sample)]) -> Result<(), String> {
    for (_, sample) in samples {
        for ((layer, expected), (_, found)) in first.layers.iter().zip(&sample.layers) {
            let alike = |image: &Image| (image.height, image.width, image.values.dtype());
            if alike(found) != alike(expected) {
                let describe = |image: &Image| format!("{}x{} pixels of {}", image.height, image.width, dtype_name(image.values.dtype()));
                let place = format!("{} of {}/{} frame {}", layer.spec().name, sample.scene, sample.camera, sample.frame);
                let (found, expected) = (describe(found), describe(expected));
                return Err(format!("{place} has {found}, the first of its batch {expected}; give `crop` or `resize`, and not `stored`"));
            }
        }
    }
    Ok(())
}

/// The values of images of one size and type, one after the other.
fn stack(first: &Image, count: usize, all: &mut dyn Iterator<Item = &Image>) -> Values {
    macro_rules! stacked {
        ($kind:ident) => {{
            let mut values = Vec::with_capacity(count * first.values.len());
            for image in all {
                let Values::$kind(v) = &image.values else { unreachable!("images of one type") };
                values.extend_from_slice(v);
            }
            Values::$kind(values)
        }};
    }
    match first.values {
        Values::F16(_) => stacked!(F16),
        Values::F32(_) => stacked!(F32),
        Values::I16(_) => stacked!(I16),
        Values::U8(_) => stacked!(U8),
    }
}
