//! numpy's archives of arrays (`.npz`), as `numpy.savez` and `numpy.savez_compressed` write them: NEP 1, versions 1 to 3.

use crate::archive::Archive;
use std::collections::BTreeMap;
use std::path::Path;

/// Begin of every array file.
const MAGIC: &[u8] = b"\x93NUMPY";

/// An array.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Array {
    pub shape: Vec<usize>,
    pub values: Values,
}

/// Elements of an array, in C order.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Values {
    Numbers(Vec<f64>),
    Texts(Vec<String>),
}

/// The arrays of an archive, by name.
///
/// # Errors
/// What is wrong with it, and where.
pub(super) fn arrays(file: &Path, bytes: Vec<u8>) -> Result<BTreeMap<String, Array>, (String, String)> {
    let whole = |problem: String| ("whole file".to_string(), format!("{problem}; save it with numpy.savez"));
    let archive = Archive::new(file, bytes).map_err(whole)?;
    let mut arrays = BTreeMap::new();
    for name in archive.names().iter().filter(|name| name.ends_with(".npy")) {
        let key = name.trim_end_matches(".npy").to_string();
        let place = || format!("array {key:?}");
        let bytes = archive.read(name).map_err(|error| (place(), format!("it cannot be unpacked ({error}); save it again")))?;
        let array = array(&bytes).map_err(|problem| (place(), problem))?;
        arrays.insert(key, array);
    }
    if arrays.is_empty() {
        return Err(whole("there are no arrays in it".into()));
    }
    Ok(arrays)
}

fn array(bytes: &[u8]) -> Result<Array, String> {
    let damaged = || "it is no array of numpy, or cut short; save it again".to_string();
    let rest = bytes.strip_prefix(MAGIC).ok_or_else(damaged)?;
    let (length, start) = match rest {
        [1, _, low, high, ..] => (usize::from(u16::from_le_bytes([*low, *high])), 4),
        [2 | 3, _, a, b, c, d, ..] => (u32::from_le_bytes([*a, *b, *c, *d]) as usize, 6),
        _ => return Err(damaged()),
    };
    let head = rest.get(start..).and_then(|rest| rest.get(..length)).ok_or_else(damaged)?;
    let head = String::from_utf8_lossy(head);
    let data = &rest[start + length..];
    let after = |key: &str| head.split_once(key).map(|(_, rest)| rest.trim_start());
    let kind = after("'descr':")
        .and_then(|rest| rest.strip_prefix('\'')?.split_once('\''))
        .map(|(kind, _)| kind)
        .ok_or_else(|| format!("found {:?}, expected numbers or texts; save it as float64", head.trim()))?;
    let shape = after("'shape':").and_then(|rest| rest.strip_prefix('(')?.split_once(')')).map_or("", |(shape, _)| shape);
    let axes: Option<Vec<usize>> = shape.split(',').map(str::trim).filter(|axis| !axis.is_empty()).map(|axis| axis.parse().ok()).collect();
    let axes = axes.ok_or_else(damaged)?;
    let count = axes.iter().try_fold(1usize, |product, axis| product.checked_mul(*axis)).ok_or_else(damaged)?;
    let by_columns = after("'fortran_order':").is_some_and(|rest| rest.starts_with("True")) && axes.len() > 1;
    let values =
        values(kind, data).ok_or_else(|| format!("found elements of the type {kind:?}, expected numbers or texts; save it as float64"))?;
    let found = match &values {
        Values::Numbers(numbers) => numbers.len(),
        Values::Texts(texts) => texts.len(),
    };
    if found == count {
        let values = match values {
            Values::Numbers(numbers) if by_columns => Values::Numbers(by_rows(numbers, &axes)),
            Values::Texts(texts) if by_columns => Values::Texts(by_rows(texts, &axes)),
            values => values,
        };
        Ok(Array { shape: axes, values })
    } else {
        Err(format!("{found} elements for a shape of ({shape}); it is cut short, save it again"))
    }
}

/// The elements of an array whose first axis changes fastest (a transposed array of numpy, Fortran's order), with the last one fastest.
fn by_rows<T: Clone>(values: Vec<T>, axes: &[usize]) -> Vec<T> {
    let place = |index: usize| {
        let (mut rest, mut stride, mut place) = (index, values.len(), 0);
        for &axis in axes.iter().rev() {
            stride /= axis;
            place += rest % axis * stride;
            rest /= axis;
        }
        place
    };
    (0..values.len()).map(|index| values[place(index)].clone()).collect()
}

/// The elements of a type such as `<f8`; `None` of types that are neither numbers nor texts.
fn values(kind: &str, data: &[u8]) -> Option<Values> {
    fn each<const N: usize>(data: &[u8], value: impl Fn([u8; N]) -> f64) -> Values {
        Values::Numbers(data.as_chunks::<N>().0.iter().map(|bytes| value(*bytes)).collect())
    }
    let texts = |size: usize, text: &dyn Fn(&[u8]) -> String| Values::Texts(data.chunks_exact(size.max(1)).map(text).collect());
    Some(match kind {
        "<f8" => each(data, f64::from_le_bytes),
        ">f8" => each(data, f64::from_be_bytes),
        "<f4" => each(data, |bytes| f64::from(f32::from_le_bytes(bytes))),
        "<f2" => each(data, |bytes| f64::from(half::f16::from_le_bytes(bytes))),
        "<i8" => each(data, |bytes| i64::from_le_bytes(bytes) as f64),
        "<u8" => each(data, |bytes| u64::from_le_bytes(bytes) as f64),
        "<i4" => each(data, |bytes| f64::from(i32::from_le_bytes(bytes))),
        "<u4" => each(data, |bytes| f64::from(u32::from_le_bytes(bytes))),
        "|u1" | "|b1" => each(data, |[byte]| f64::from(byte)),
        _ => match kind.split_at_checked(2)? {
            ("<U", size) => texts(4 * size.parse::<usize>().ok()?, &|bytes| {
                let characters = bytes.as_chunks::<4>().0.iter().map(|c| u32::from_le_bytes(*c)).take_while(|c| *c != 0);
                characters.filter_map(char::from_u32).collect()
            }),
            ("|S", size) => texts(size.parse().ok()?, &|bytes| String::from_utf8_lossy(bytes).trim_end_matches('\0').to_string()),
            _ => return None,
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transposed_arrays_are_those_that_numpy_shows() {
        // numpy.array([[1, 2, 3], [4, 5, 6]]) and the same by way of a transposed array: its elements are stored by columns.
        let stored = |order: &str, numbers: [f64; 6]| {
            let header = format!("{:<117}\n", format!("{{'descr': '<f8', 'fortran_order': {order}, 'shape': (1, 2, 3), }}"));
            let data: Vec<u8> = numbers.into_iter().flat_map(f64::to_le_bytes).collect();
            array(&[MAGIC, &[1, 0], &(header.len() as u16).to_le_bytes(), header.as_bytes(), &data[..]].concat()).unwrap()
        };
        let numbers = |array: Array| match array.values {
            Values::Numbers(numbers) => (array.shape, numbers),
            Values::Texts(_) => panic!("no numbers"),
        };
        let rows = (vec![1, 2, 3], vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(numbers(stored("False", [1.0, 2.0, 3.0, 4.0, 5.0, 6.0])), rows);
        assert_eq!(numbers(stored("True", [1.0, 4.0, 2.0, 5.0, 3.0, 6.0])), rows);
        assert_eq!(by_rows(Vec::<f64>::new(), &[0, 3]), [0.0; 0]);
    }
}
