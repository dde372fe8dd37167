//! Primvars: values over a surface, per surface, face, vertex or corner, with or without indices.

use super::stage::Prim;
use super::value::Value;
use crate::assembly::Assembly;
use std::rc::Rc;

/// The scope of one value: the whole surface, a face, a point or a corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Interpolation {
    Constant,
    Uniform,
    Vertex,
    FaceVarying,
}

/// Values of `N` numbers over a surface.
#[derive(Clone, Debug)]
pub(super) struct Primvar<const N: usize> {
    data: Rc<Vec<f64>>,
    indices: Option<Rc<Vec<f64>>>,
    interpolation: Interpolation,
}

/// Numbers of faces, points and corners of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    pub faces: usize,
    pub points: usize,
    pub corners: usize,
}

impl<const N: usize> Primvar<N> {
    /// The primvar of an attribute; `None` where there is no such attribute or it has no values. `default` is its interpolation
    /// where none is stated. One of the wrong kind, or with too few values, is left out with a warning.
    pub(super) fn read(prim: &Prim, attribute: &str, default: &str, sizes: Sizes, a: &mut Assembly) -> Option<Self> {
        let (value, site) = prim.value_at(attribute)?;
        Self::checked(prim, value, attribute, default, sizes).unwrap_or_else(|problem| {
            let place = format!("<{}>.{attribute} in {}", prim.path, site.layer.location);
            a.warn(place, format!("{problem}; it was left out"));
            None
        })
    }

    fn checked(prim: &Prim, value: &Value, attribute: &str, default: &str, sizes: Sizes) -> Result<Option<Self>, String> {
        let Some(numbers) = value.as_numbers(N) else { return Err(format!("expected values of {N} numbers each")) };
        if numbers.is_empty() {
            return Ok(None);
        }
        let named = prim.property(attribute, "interpolation").and_then(|v| v.as_text());
        let interpolation = match named.unwrap_or(default) {
            "uniform" => Interpolation::Uniform,
            "vertex" | "varying" => Interpolation::Vertex,
            "faceVarying" => Interpolation::FaceVarying,
            _ => Interpolation::Constant,
        };
        let indices = prim.value(&format!("{attribute}:indices")).and_then(|v| v.as_numbers(1)).filter(|i| !i.is_empty());
        let wanted = match interpolation {
            Interpolation::Constant => 1,
            Interpolation::Uniform => sizes.faces,
            Interpolation::Vertex => sizes.points,
            Interpolation::FaceVarying => sizes.corners,
        };
        let values = numbers.len() / N;
        let found = indices.map_or(values, <[f64]>::len);
        if found < wanted {
            let what = if indices.is_some() { "indices" } else { "values" };
            return Err(format!("found {found} {what}, expected {wanted} ({interpolation:?})"));
        }
        if let Some(bad) = indices.into_iter().flatten().find(|i| **i < 0.0 || **i >= values as f64) {
            return Err(format!("found index {bad}, but there are only {values} values"));
        }
        Ok(Some(Self { data: Rc::new(numbers.to_vec()), indices: indices.map(|i| Rc::new(i.to_vec())), interpolation }))
    }

    /// Index of the value at a corner with this face and point.
    pub(super) fn element(&self, face: usize, point: usize, corner: usize) -> u32 {
        let place = match self.interpolation {
            Interpolation::Constant => 0,
            Interpolation::Uniform => face,
            Interpolation::Vertex => point,
            Interpolation::FaceVarying => corner,
        };
        self.indices.as_ref().map_or(place as u32, |i| i[place] as u32)
    }

    /// A value.
    pub(super) fn get(&self, element: u32) -> [f64; N] {
        let at = element as usize * N;
        std::array::from_fn(|i| self.data[at + i])
    }

    /// The mean of all values.
    pub(super) fn mean(&self) -> [f64; N] {
        let count = (self.data.len() / N) as f64;
        std::array::from_fn(|i| self.data.iter().skip(i).step_by(N).sum::<f64>() / count)
    }

    /// True when there is one value for the whole mesh.
    pub(super) fn is_constant(&self) -> bool {
        self.data.chunks(N).all(|c| c == &self.data[..N])
    }
}
