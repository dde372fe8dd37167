//! Arrays in memory: a shape and the elements, of one of the six types that Hypersim's files have.

use enfilade_frame::{Values, f16};

/// The storage type of an element; always little-endian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "plain words")]
pub enum Element {
    F16,
    F32,
    F64,
    I16,
    I64,
    U8,
}

/// The elements of an array, last index fastest.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs, reason = "plain words")]
pub enum Elements {
    F16(Vec<f16>),
    F32(Vec<f32>),
    F64(Vec<f64>),
    I16(Vec<i16>),
    I64(Vec<i64>),
    U8(Vec<u8>),
}

/// An array of any rank.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    /// Length of each axis, slowest first.
    pub shape: Vec<usize>,
    /// Values, as many as the product of the shape.
    pub values: Elements,
}

impl Element {
    /// Bytes per element.
    pub const fn size(self) -> usize {
        match self {
            Self::F64 | Self::I64 => 8,
            Self::F32 => 4,
            Self::F16 | Self::I16 => 2,
            Self::U8 => 1,
        }
    }

    /// numpy's name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::F16 => "float16",
            Self::F32 => "float32",
            Self::F64 => "float64",
            Self::I16 => "int16",
            Self::I64 => "int64",
            Self::U8 => "uint8",
        }
    }
}

impl Elements {
    /// Number of elements.
    pub fn len(&self) -> usize {
        self.as_bytes().len() / self.element().size()
    }

    /// True when there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Their storage type.
    pub fn element(&self) -> Element {
        match self {
            Self::F16(_) => Element::F16,
            Self::F32(_) => Element::F32,
            Self::F64(_) => Element::F64,
            Self::I16(_) => Element::I16,
            Self::I64(_) => Element::I64,
            Self::U8(_) => Element::U8,
        }
    }

    /// Little-endian bytes, as in the file.
    pub fn as_bytes(&self) -> &[u8] {
        match self {
            Self::F16(v) => bytemuck::cast_slice(v),
            Self::F32(v) => bytemuck::cast_slice(v),
            Self::F64(v) => bytemuck::cast_slice(v),
            Self::I16(v) => bytemuck::cast_slice(v),
            Self::I64(v) => bytemuck::cast_slice(v),
            Self::U8(v) => v,
        }
    }

    /// Zeros, `count` of them.
    pub(crate) fn zeroed(element: Element, count: usize) -> Self {
        match element {
            Element::F16 => Self::F16(bytemuck::zeroed_vec(count)),
            Element::F32 => Self::F32(bytemuck::zeroed_vec(count)),
            Element::F64 => Self::F64(bytemuck::zeroed_vec(count)),
            Element::I16 => Self::I16(bytemuck::zeroed_vec(count)),
            Element::I64 => Self::I64(bytemuck::zeroed_vec(count)),
            Element::U8 => Self::U8(bytemuck::zeroed_vec(count)),
        }
    }

    /// Little-endian bytes, to be filled.
    pub(crate) fn as_bytes_mut(&mut self) -> &mut [u8] {
        match self {
            Self::F16(v) => bytemuck::cast_slice_mut(v),
            Self::F32(v) => bytemuck::cast_slice_mut(v),
            Self::F64(v) => bytemuck::cast_slice_mut(v),
            Self::I16(v) => bytemuck::cast_slice_mut(v),
            Self::I64(v) => bytemuck::cast_slice_mut(v),
            Self::U8(v) => v,
        }
    }

    /// The elements whose bytes are `bytes`, a whole number of them.
    pub(super) fn from_bytes(element: Element, bytes: &[u8]) -> Self {
        match element {
            Element::F16 => Self::F16(bytemuck::pod_collect_to_vec(bytes)),
            Element::F32 => Self::F32(bytemuck::pod_collect_to_vec(bytes)),
            Element::F64 => Self::F64(bytemuck::pod_collect_to_vec(bytes)),
            Element::I16 => Self::I16(bytemuck::pod_collect_to_vec(bytes)),
            Element::I64 => Self::I64(bytemuck::pod_collect_to_vec(bytes)),
            Element::U8 => Self::U8(bytes.to_vec()),
        }
    }

    /// The elements as layer values; gives the elements back when no layer is stored so.
    pub fn into_values(self) -> Result<Values, Self> {
        match self {
            Self::F16(v) => Ok(Values::F16(v)),
            Self::F32(v) => Ok(Values::F32(v)),
            Self::I16(v) => Ok(Values::I16(v)),
            Self::U8(v) => Ok(Values::U8(v)),
            other => Err(other),
        }
    }
}

impl From<Values> for Elements {
    fn from(values: Values) -> Self {
        match values {
            Values::F16(v) => Self::F16(v),
            Values::F32(v) => Self::F32(v),
            Values::I16(v) => Self::I16(v),
            Values::U8(v) => Self::U8(v),
        }
    }
}

impl Array {
    /// An array of doubles.
    ///
    /// # Panics
    /// When the shape does not hold that many.
    pub fn f64(shape: &[usize], values: Vec<f64>) -> Self {
        Self::new(shape, Elements::F64(values))
    }

    /// An array of 64-bit integers.
    ///
    /// # Panics
    /// When the shape does not hold that many.
    pub fn i64(shape: &[usize], values: Vec<i64>) -> Self {
        Self::new(shape, Elements::I64(values))
    }

    /// An array of any elements.
    ///
    /// # Panics
    /// When the shape does not hold that many.
    pub fn new(shape: &[usize], values: Elements) -> Self {
        assert_eq!(shape.iter().product::<usize>(), values.len(), "array of shape {shape:?}");
        Self { shape: shape.to_vec(), values }
    }

    pub(super) fn view(&self) -> ArrayView<'_> {
        ArrayView { shape: &self.shape, element: self.values.element(), bytes: self.values.as_bytes() }
    }
}

/// An array that borrows its elements.
#[derive(Clone, Copy)]
pub(crate) struct ArrayView<'a> {
    /// Length of each axis, slowest first.
    pub shape: &'a [usize],
    /// Storage type of an element.
    pub element: Element,
    /// Little-endian bytes of all elements.
    pub bytes: &'a [u8],
}

impl<'a> ArrayView<'a> {
    /// The values of a layer.
    pub fn of_values(shape: &'a [usize], values: &'a Values) -> Self {
        let element = match values {
            Values::F16(_) => Element::F16,
            Values::F32(_) => Element::F32,
            Values::I16(_) => Element::I16,
            Values::U8(_) => Element::U8,
        };
        Self { shape, element, bytes: values.as_bytes() }
    }
}
