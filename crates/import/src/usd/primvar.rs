//! Primvars: values over a surface, per surface, face, vertex or corner, with or without indices.

use super::stage::Prim;
use crate::ImportError;
use crate::assembly::Assembly;
use std::rc::Rc;

/// How far one value reaches.
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

/// How many faces, points and corners a surface has.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    pub faces: usize,
    pub points: usize,
    pub corners: usize,
}

impl<const N: usize> Primvar<N> {
    /// The primvar of an attribute; `None` where there is no such attribute or it has no values. `default` is its interpolation
    /// where none is stated.
    ///
    /// # Errors
    /// When it has values of the wrong kind, or too few.
    pub(super) fn read(prim: &Prim, attribute: &str, default: &str, sizes: Sizes, a: &mut Assembly) -> Result<Option<Self>, ImportError> {
        let Some((value, site)) = prim.value_at(attribute) else { return Ok(None) };
        let place = || format!("<{}>.{attribute} in {}", prim.path, site.layer.location);
        let Some(numbers) = value.as_numbers(N) else {
            return Err(a.malformed(place(), format!("expected values of {N} numbers each; correct the attribute's type")));
        };
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
            return Err(a.malformed(place(), format!("found {found} {what}, expected {wanted} ({interpolation:?}); export the file again")));
        }
        if let Some(bad) = indices.into_iter().flatten().find(|i| **i < 0.0 || **i >= values as f64) {
            return Err(a.malformed(place(), format!("found index {bad}, but there are only {values} values; export the file again")));
        }
        Ok(Some(Self { data: Rc::new(numbers.to_vec()), indices: indices.map(|i| Rc::new(i.to_vec())), interpolation }))
    }

    /// Which value holds at a corner: that of its face and its point.
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

    /// True when one value holds everywhere.
    pub(super) fn is_constant(&self) -> bool {
        self.data.chunks(N).all(|c| c == &self.data[..N])
    }
}
