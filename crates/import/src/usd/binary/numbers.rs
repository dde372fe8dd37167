//! Numbers in crate files: plain, or packed.

use super::cursor::{Checked, Cursor, index};
use half::f16;

/// Shorter arrays are not packed.
pub(super) const SHORTEST_PACKED: usize = 16;

/// The type of a stored number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Bool,
    U8,
    I32,
    U32,
    I64,
    U64,
    F16,
    F32,
    F64,
}

impl Kind {
    /// Bytes that a number takes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::Bool | Self::U8 => 1,
            Self::F16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    fn is_integer(self) -> bool {
        matches!(self, Self::I32 | Self::U32 | Self::I64 | Self::U64)
    }

    /// One number from exactly its bytes.
    pub(super) fn number(self, b: &[u8]) -> f64 {
        let bits = b.iter().rev().fold(0u64, |n, b| n << 8 | u64::from(*b));
        match self {
            Self::Bool | Self::U8 | Self::U32 | Self::U64 => bits as f64,
            Self::I32 => f64::from(bits as u32 as i32),
            Self::I64 => bits as i64 as f64,
            Self::F16 => f64::from(f16::from_bits(bits as u16)),
            Self::F32 => f64::from(f32::from_bits(bits as u32)),
            Self::F64 => f64::from_bits(bits),
        }
    }
}

/// Numbers per element and how they are stored, of the types that consist of numbers.
pub(super) fn layout(kind: u8) -> Option<(usize, Kind)> {
    Some(match kind {
        1 => (1, Kind::Bool),
        2 => (1, Kind::U8),
        3 => (1, Kind::I32),
        4 => (1, Kind::U32),
        5 => (1, Kind::I64),
        6 => (1, Kind::U64),
        7 => (1, Kind::F16),
        8 => (1, Kind::F32),
        9 | 56 => (1, Kind::F64),
        13 => (4, Kind::F64),
        14 => (9, Kind::F64),
        15 => (16, Kind::F64),
        16 => (4, Kind::F64),
        17 => (4, Kind::F32),
        18 => (4, Kind::F16),
        19..=30 => (2 + usize::from((kind - 19) / 4), [Kind::F64, Kind::F32, Kind::F16, Kind::I32][usize::from((kind - 19) % 4)]),
        _ => return None,
    })
}

/// Numbers one after the other.
pub(super) fn plain_numbers(c: &mut Cursor, count: u64, kind: Kind) -> Checked<Vec<f64>> {
    let here = *c;
    let Some(size) = count.checked_mul(kind.size() as u64) else { return here.error("found an impossible count; the file is damaged") };
    Ok(c.take(size)?.chunks_exact(kind.size()).map(|b| kind.number(b)).collect())
}

/// Packed integers, or floating-point numbers packed as whole numbers or as places in a table.
pub(super) fn packed_numbers(c: &mut Cursor, count: usize, kind: Kind) -> Checked<Vec<f64>> {
    let unsigned = |v: i64| match kind {
        Kind::U32 => f64::from(v as u32),
        Kind::U64 => v as u64 as f64,
        Kind::I32 => f64::from(v as i32),
        _ => v as f64,
    };
    if kind.is_integer() {
        return Ok(c.integers(count, kind.size() == 8)?.into_iter().map(unsigned).collect());
    }
    let here = *c;
    match c.u8()? {
        b'i' => Ok(c.integers(count, false)?.into_iter().map(|v| f64::from(v as i32)).collect()),
        b't' => {
            let entries = u64::from(c.u32()?);
            let table = plain_numbers(c, entries, kind)?;
            let places = c.integers(count, false)?;
            places.into_iter().map(|i| index(&table, i64::from(i as u32), "entry", &here).copied()).collect()
        }
        other => here.error(format!("found {other} as the packing of numbers, expected `i` or `t`; the file is damaged")),
    }
}
